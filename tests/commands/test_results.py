"""`mesa-mobility results`, and what `run` says of doors and rooms."""

import json
import re

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
    # The corridor itself is the room that is found between its doors.
    assert summary["rooms"] == {"end": pytest.approx(left), "room 1": pytest.approx(left)}


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


def test_the_report_of_a_run_made_or_saved(command, rooms, tmp_path):
    page = tmp_path / "made.html"
    options = ("--seed", 5, "--rooms", rooms, "--report", page, "--out", tmp_path / "run")
    outcome = command("run", "corridor", *options)
    assert outcome.status == 0, outcome.err
    assert f"written to {page}" in outcome.err
    saved = tmp_path / "saved.html"
    outcome = command("results", tmp_path / "run", "--rooms", rooms, "--report", saved)
    assert outcome.status == 0, outcome.err
    for each in (page, saved):
        text = each.read_text(encoding="utf-8")
        assert 'id="level-of-service"' in text
        # The room of the file, which all three have left after 2.1 s.
        assert "room end" in text
        words = re.search(r'<pre class="command">(.*?)</pre>', text)[1]
        said = "mesa-mobility run corridor --seed 5 --preset default"
        assert re.sub("<[^>]+>", "", words) == said
        assert "trajectories.parquet" in text


def test_what_lacks_for_a_report_is_found_out_before_the_run(command, tmp_path, monkeypatch):
    outcome = command("run", "corridor", "--pdf", "--out", tmp_path / "run")
    assert outcome.status == 2
    assert outcome.err == "error: --pdf: prints a report, expected --report FILE as well\n"
    monkeypatch.setenv("MESA_MOBILITY_BROWSER", "no-such-browser")
    page = tmp_path / "page.html"
    outcome = command("run", "corridor", "--report", page, "--pdf", "--out", tmp_path / "run")
    assert outcome.status == 2
    assert "no browser to write PDF: MESA_MOBILITY_BROWSER is 'no-such-browser'" in outcome.err
    assert not page.exists()
    assert not (tmp_path / "run").exists()


def test_designs_compared_on_the_command_line(command, tmp_path):
    from mesa_mobility.experiments import Experiment, run_experiment

    model = "tests.fixtures.experiments.models:Leaving"
    experiment = Experiment(model, {"width": [1.0, 1.2]}, replications=20, seeds="common")
    run_experiment(experiment, tmp_path / "store", executor="serial")
    given = ("experiment", "compare", tmp_path / "store", "--by", "width")
    outcome = command(*given, "--json")
    assert outcome.status == 0, outcome.err
    answer = json.loads(outcome.out)
    [found] = answer["comparisons"]
    assert (answer["figure"], found["first"], found["second"]) == ("egress_s", 1.0, 1.2)
    assert found["different"]
    table = command(*given)
    assert "different" in table.out
    assert table.err == "time until everybody is out (s), by width\n"
    outcome = command("experiment", "compare", tmp_path / "store", "--by", "height")
    assert outcome.status == 2
    assert "no parameter 'height', expected one of width" in outcome.err
