"""`mesa-mobility results`, and what `run` says of doors and rooms."""

import json

import pandas as pd
import pytest

pytestmark = pytest.mark.usefixtures("plugins")


@pytest.fixture
def rooms(tmp_path):
    ring = [[2.9, -1], [9, -1], [9, 9], [2.9, 9], [2.9, -1]]
    room = {
        "type": "Feature",
        "properties": {"kind": "room", "name": "end"},
        "geometry": {"type": "Polygon", "coordinates": [ring]},
    }
    file = tmp_path / "rooms.geojson"
    file.write_text(json.dumps({"type": "FeatureCollection", "features": [room]}))
    return file


def test_the_summary_has_doors_and_rooms(command, rooms):
    outcome = command("run", "corridor", "--seed", 5, "--json", "--rooms", rooms)
    summary = json.loads(outcome.out.splitlines()[-1])
    # Walking 1 m/s from 3.0, 2.5 and 2.0 m, they cross 4 m after 1.0, 1.5 and 2.0 s.
    door = {"people": 3, "first_s": 1.0, "last_s": 2.0, "flow_per_s": 2.0}
    assert summary["doors"] == {"end": pytest.approx(door, abs=1e-6)}
    # Frames of 0.1 s: they have left in the first frame beyond.
    left = {"people": 3, "first_s": 1.1, "last_s": 2.1, "flow_per_s": 2.0}
    assert summary["rooms"] == {"end": pytest.approx(left)}


def test_tables_beside_the_run(command, rooms, tmp_path):
    command("run", "corridor", "--seed", 5, "--out", tmp_path / "run")
    outcome = command("results", tmp_path / "run", "--rooms", rooms)
    assert outcome.status == 0, outcome.err
    folder = tmp_path / "run" / "results"
    assert f"written to {folder}" in outcome.err
    doors = pd.read_csv(folder / "doors.csv")
    assert doors.loc[doors.type == "all", "people"].tolist() == [3]
    clearing = pd.read_csv(folder / "clearing.csv").set_index(["type", "place"])
    assert clearing.loc[("all", "all"), ["t50_s", "t100_s"]].tolist() == [1.6, 2.1]
    assert clearing.loc[("all", "end"), "t100_s"] == 2.1
    assert command("results", tmp_path / "run", "--out", tmp_path / "other").status == 0
    assert (tmp_path / "other" / "n_t.csv").exists()


def test_bad_input_is_one_line(command, rooms, tmp_path):
    outcome = command("results", tmp_path)
    assert outcome.status == 2
    assert "no summary.json" in outcome.err
    rooms.write_text("{}")
    for arguments in (("run", "corridor"), ("results", tmp_path)):
        outcome = command(*arguments, "--rooms", rooms)
        assert outcome.status == 2
        assert outcome.err == f"error: {rooms}: expected a GeoJSON FeatureCollection\n"
