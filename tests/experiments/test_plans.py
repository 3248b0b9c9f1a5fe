"""Experiments on the floor plans and buildings of files."""

import hashlib
import json

import pytest

from mesa_mobility.experiments import Experiment, run_experiment, write_report
from mesa_mobility.experiments.workers import one_run
from tests.fixtures.buildings import two_storeys


@pytest.fixture
def office(tmp_path):
    """The file of a building of two storeys."""
    path = tmp_path / "office.geojson"
    two_storeys().write_geojson(path)
    return path


@pytest.mark.thorough
def test_runs_in_a_building_and_their_report(tmp_path, office):
    experiment = Experiment(
        "floor_plan",
        {"pedestrians": 3},
        fixed={"plan": str(office)},
        replications=2,
        max_seconds=90,
        keep=["doors", "trajectories"],
    )
    store = run_experiment(experiment, tmp_path / "s", executor="serial")
    frame = store.frame()
    assert list(frame["status"]) == ["done", "done"], list(frame["error"])
    digest = json.dumps(two_storeys().to_geojson(), sort_keys=True).encode()
    assert hashlib.sha256(digest).hexdigest() in frame["inputs"][0]
    page = tmp_path / "report.html"
    write_report(store, page)
    text = page.read_text()
    assert "level by level from the top" in text
    assert "Clearing times: " in text


def test_a_run_that_fails_at_its_start_is_kept_as_failed(tmp_path, monkeypatch):
    """It has recorded nothing; the others go on."""

    def broken(*_):
        raise RuntimeError("no inputs")

    monkeypatch.setattr(one_run, "inputs_of", broken)
    experiment = Experiment("straight_walk", {"pedestrians": [2, 3]}, keep=["trajectories"])
    store = run_experiment(experiment, tmp_path / "s", executor="serial")
    assert list(store.frame()["error"]) == ["RuntimeError: no inputs"] * 2
    assert not list((tmp_path / "s" / "trajectories").iterdir())


def test_warnings_of_models_are_in_the_rows(tmp_path, recwarn):
    """The shed has no way out, and is left out."""
    path = tmp_path / "plan.wkt"
    path.write_text(
        "GEOMETRYCOLLECTION (POLYGON ((0 0, 6 0, 6 4, 0 4, 0 0)), "
        "POLYGON ((9 0, 11 0, 11 2, 9 2, 9 0)))"
    )
    experiment = Experiment(
        "floor_plan",
        {"pedestrians": 1},
        fixed={"plan": str(path), "exits": "longest"},
        max_seconds=0.1,
    )
    store = run_experiment(experiment, tmp_path / "s", executor="serial")
    [(text, runs)] = store.warnings().items()
    assert "plan.wkt: left out" in text
    assert runs == 1
    assert not [each for each in recwarn if "left out" in str(each.message)]
