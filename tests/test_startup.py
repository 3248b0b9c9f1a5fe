"""Starting without looking for garbage."""

import gc
import os
import re
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import pytest

import mesa_mobility
from mesa_mobility._lazy import names_of
from mesa_mobility._startup import nothing_collected


@pytest.mark.parametrize("collects", [True, False])
def test_garbage_is_looked_for_afterwards_as_before(collects):
    before = gc.isenabled()
    try:
        (gc.enable if collects else gc.disable)()
        with suppress(ValueError), nothing_collected():
            assert not gc.isenabled()
            raise ValueError("bad input")
        assert gc.isenabled() is collects
    finally:
        (gc.enable if before else gc.disable)()
        gc.unfreeze()


def test_what_was_made_within_is_not_gone_through_again():
    try:
        with nothing_collected():
            made = [[] for _ in range(1000)]
        assert gc.get_freeze_count() >= len(made)
    finally:
        gc.unfreeze()


@pytest.mark.parametrize("collects", [True, False])
def test_names_of_a_package_are_imported_without_looking_for_garbage(collects, monkeypatch):
    seen, before = [], gc.isenabled()

    def imported(name):
        seen.append(gc.isenabled())
        raise ImportError(name)

    monkeypatch.setattr("mesa_mobility._lazy.import_module", imported)
    get, _ = names_of("mesa_mobility", mesa_mobility.__file__)
    try:
        (gc.enable if collects else gc.disable)()
        with pytest.raises(ImportError):
            get("PedestrianModel")
        assert (seen, gc.isenabled()) == ([False], collects)
    finally:
        (gc.enable if before else gc.disable)()


RUN = """
from mesa_mobility.cli import main
sys.argv = ["mesa-mobility", "run", "doorway", "--seed", "1", "--seconds", "1", "--no-progress"]
with suppress(SystemExit), redirect_stdout(None):
    main()
"""


@pytest.mark.parametrize(
    ("code", "slow"),
    [
        ("import mesa_mobility", "mesa numba numpy pandas scipy networkx shapely pyarrow"),
        ("from mesa_mobility.errors import MobilityError", "mesa numba numpy pandas scipy"),
        (
            "from mesa_mobility import PedestrianModel, FloorPlan, Exit",
            "matplotlib rich scipy.stats scipy.ndimage scipy.optimize pandas pyarrow",
        ),
        ("from mesa_mobility.results import Trajectories", "scipy.ndimage pandas pyarrow"),
        (RUN, "matplotlib scipy.stats pandas pyarrow"),
    ],
)
def test_an_import_brings_only_what_it_needs(code, slow):
    assert said_by(f"{code}\nprint(sorted(set({slow.split()}) & set(sys.modules)))") == "[]\n"


def test_mesa_imports_pandas_when_it_makes_a_table():
    code = """
from mesa_mobility import Exit, FloorPlan, PedestrianModel
from shapely import box
plan = FloorPlan(box(0, 0, 5, 4), exits=[Exit("door", (5, 1), (5, 3))])
model = PedestrianModel(plan, rng=1)
model.step()
assert "pandas" not in sys.modules
table = model.datacollector.get_model_vars_dataframe()
import pandas
assert type(table) is pandas.DataFrame and type(pandas) is type(sys)
assert sys.modules["pandas"] is pandas
print(len(table))
"""
    assert said_by(code) == "1\n"


@pytest.mark.parametrize(
    "before",
    [
        "import pandas",
        "import mesa",
        "from threading import Event, Thread; Thread(target=Event().wait, daemon=True).start()",
    ],
)
def test_mesa_imports_modules_as_usual(before):
    """If they or Mesa are there already, or another thread may import them meanwhile."""
    code = f"""
{before}
from mesa_mobility import PedestrianModel
import mesa, pandas
print(mesa.datacollection.pd is pandas)
"""
    assert said_by(code) == "True\n"


def test_modules_are_imported_when_they_are_asked_for_meanwhile():
    code = """
from mesa_mobility._mesa import _imported_later
with _imported_later("wave", "tomllib"):
    import wave as later
    assert type(later) is not type(sys)
    import tomllib
    assert "wave" in repr(tomllib.loads("a = 'wave'"))
    import tomllib as now
    assert type(now) is type(sys)
assert "wave" not in sys.modules
import wave
print(later.open is wave.open, type(wave) is type(sys))
"""
    assert said_by(code) == "True True\n"


def test_the_package_takes_mesa_from_one_module():
    imports = re.compile(r"^\s*(import mesa\b|from mesa(?!\.visualization)[. ])", re.M)
    package = Path(mesa_mobility.__file__).parent
    own = [
        path.relative_to(package).as_posix()
        for folder in (package, package.parent / "behaviors", package.parent / "models")
        for path in folder.rglob("*.py")
        if imports.search(path.read_text(encoding="utf-8"))
    ]
    assert own == ["_mesa.py"]


def said_by(code: str) -> str:
    """What a new process prints that runs the code."""
    head = "import sys\nfrom contextlib import redirect_stdout, suppress\n"
    done = subprocess.run(
        [sys.executable, "-c", head + code],
        capture_output=True,
        text=True,
        check=True,
        timeout=300,
        env=os.environ | {"PYTHONPATH": str(Path(__file__).parents[1])},
    )
    return done.stdout
