"""The example package: installed, it is listed, runs, and passes its own tests."""

import json
import os
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

FOLDER = Path(__file__).parents[2] / "examples" / "plugin_package"


@pytest.fixture
def extras(install, monkeypatch) -> None:
    """The package as pip would install it in place."""
    groups = tomllib.loads((FOLDER / "pyproject.toml").read_text())["project"]["entry-points"]
    lines = [
        line
        for group, entries in groups.items()
        for line in (f"[{group}]", *(f"{name} = {target}" for name, target in entries.items()))
    ]
    install("crowd_extras_site", "\n".join(lines))
    monkeypatch.syspath_prepend(str(FOLDER))
    for name in [name for name in sys.modules if name.split(".")[0] == "crowd_extras"]:
        monkeypatch.delitem(sys.modules, name)


@pytest.mark.usefixtures("extras")
def test_it_is_listed(command):
    behaviors, models = command("behaviors"), command("models")
    assert behaviors.status == models.status == 0
    for name in ("keep_left", "keep_away", "see_the_doctor"):
        assert any(line.startswith(f"{name} ") for line in behaviors.out.splitlines())
    assert "People leave a waiting room" in models.out
    assert "broken" not in behaviors.err + models.err


@pytest.mark.slow
@pytest.mark.usefixtures("extras")
def test_it_runs(command, tmp_path):
    outcome = command(
        "run", "clinic", "--seed", 1, "--set", "pedestrians=12", "--behavior", "keep_left=0.5",
        "--out", tmp_path / "out", "--json", "--no-progress",
    )  # fmt: skip
    assert outcome.status == 0, outcome.err
    summary = json.loads(outcome.out.splitlines()[-1])
    assert (summary["left_inside"], summary["overlaps"]) == (0, 0)
    from mesa_mobility.results import read_parquet

    infected = read_parquet(tmp_path / "out" / "trajectories.parquet").fields["infected"]
    assert infected.dtype == bool
    assert 0 < infected.mean() < 1


@pytest.mark.slow
def test_its_own_tests_pass():
    path = os.pathsep.join([str(FOLDER), *filter(None, [os.environ.get("PYTHONPATH")])])
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(FOLDER)],
        capture_output=True, text=True, cwd=FOLDER, env={**os.environ, "PYTHONPATH": path},
    )  # fmt: skip
    assert done.returncode == 0, done.stdout
