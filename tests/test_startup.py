"""Starting without looking for garbage."""

import gc
import os
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


@pytest.mark.parametrize(
    ("code", "slow"),
    [
        ("import mesa_mobility", "mesa numba numpy pandas scipy networkx shapely pyarrow"),
        ("from mesa_mobility.errors import MobilityError", "mesa numba numpy pandas scipy"),
        ("from mesa_mobility import PedestrianModel", "matplotlib rich scipy.stats"),
    ],
)
def test_an_import_brings_only_what_it_needs(code, slow):
    script = f"import sys; {code}; print(sorted(set({slow.split()}) & set(sys.modules)))"
    done = subprocess.run(
        [sys.executable, "-c", script],
        capture_output=True,
        text=True,
        check=True,
        timeout=120,
        env=os.environ | {"PYTHONPATH": str(Path(__file__).parents[1])},
    )
    assert done.stdout == "[]\n"
