"""Experiments on the floor plans and buildings of files."""

import hashlib
import json
from pathlib import Path

import pytest

from mesa_mobility.experiments import Experiment, run_experiment, write_report
from mesa_mobility.experiments.workers import one_run
from mesa_mobility.results import by_level, by_lift, by_stairs, read_parquet
from tests.fixtures.buildings import two_storeys, with_refuge_and_lift


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


@pytest.fixture(scope="module")
def store(tmp_path_factory):
    """The store of a run in a building with a lift, half of its people in wheelchairs."""
    folder = tmp_path_factory.mktemp("lift")
    with_refuge_and_lift().write_geojson(folder / "office.geojson")
    experiment = Experiment(
        "floor_plan",
        {"pedestrians": 10},
        fixed={
            "plan": str(folder / "office.geojson"),
            "population": "able_bodied: 0.5, wheelchair_powered: 0.5",
        },
        max_seconds=200,
        keep=["doors", "trajectories"],
        seeds="common",  # the path of the plan counts otherwise
    )
    return run_experiment(experiment, folder / "s", executor="serial")


def test_runs_have_columns_of_levels_stairs_lifts_and_refuges(store):
    building, row = with_refuge_and_lift(), store.frame().iloc[0]
    assert row["status"] == "done", row["error"]
    [file] = Path(str(store), "trajectories").iterdir()
    tracks = read_parquet(file)
    levels, lifts = by_level(tracks, building), by_lift(tracks, building)
    stairs = by_stairs(tracks, building)
    assert row["level.1.clear_s"] == levels.clear_s[1] > 0.0
    assert row["level.0.clear_s"] == pytest.approx(row["egress_s"])
    assert row["level.1.people"] == levels.people[1] == row["level.1.at_start"]
    assert row["stairs.south.people"] == stairs.people["south"]
    assert row["stairs.south.mean_s"] == stairs.mean_s["south"]
    assert row["lift.lift.people"] == row["lift.lift.carried"] == lifts.people["lift"] > 0
    assert row["lift.lift.longest_wait_s"] == lifts.longest_wait_s["lift"]
    assert row["stairs.south.people"] + row["lift.lift.people"] == row["level.1.people"]
    assert (row["refuge.north lobby.waiting"], row["cannot_leave"]) == (0.0, 0.0)
    [mean] = store.estimates("mean lift.lift.mean_wait_s").values()
    assert mean.value == lifts.mean_wait_s["lift"]


@pytest.mark.thorough
def test_reports_have_tables_of_levels_stairs_and_lifts(store, tmp_path):
    write_report(store, tmp_path / "report.html")
    text = (tmp_path / "report.html").read_text()
    for head in ("Levels", "Stairs", "Lifts"):
        assert f"{head}: means over the runs" in text


def test_runs_without_kept_doors_say_who_cannot_leave(tmp_path):
    with_refuge_and_lift().write_geojson(tmp_path / "office.geojson")
    content = json.loads((tmp_path / "office.geojson").read_text())
    for each in content["features"]:
        if each["properties"].get("kind") == "lift":
            each["properties"]["closed"] = [f"lift at level {k}" for k in (0, 1)]
    (tmp_path / "office.geojson").write_text(json.dumps(content))
    fixed = {"plan": str(tmp_path / "office.geojson"), "population": "wheelchair_powered"}
    experiment = Experiment(
        "floor_plan", {"pedestrians": 6}, fixed=fixed, max_seconds=90, seeds="common"
    )
    row = run_experiment(experiment, tmp_path / "s", executor="serial").frame().iloc[0]
    assert row["status"] in ("done", "blocked"), row["error"]
    assert row["cannot_leave"] == row["refuge.north lobby.waiting"] == row["left_inside"] > 0
    assert (row["lift.lift.trips"], row["lift.lift.carried"]) == (0.0, 0.0)
    assert not [name for name in row.index if name.startswith(("level.", "stairs."))]


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
