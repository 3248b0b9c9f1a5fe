"""`mesa-mobility validate tracks`: measured tracks beside their replay."""

import json

import pytest
from shapely import box

from mesa_mobility import Exit, FloorPlan
from tests.validation.tracks.test_setting import text


@pytest.fixture
def files(tmp_path):
    """Tracks of twelve people in metres, and their floor."""
    tracks, plan = tmp_path / "run.txt", tmp_path / "hall.geojson"
    tracks.write_text(text())
    FloorPlan(box(0, 0, 20, 4), exits=[Exit("end", (20, 0), (20, 4))]).to_file(plan)
    return tracks, plan


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ("--line 1,2,3", "--line: got '1,2,3', expected four numbers X,Y,X,Y in metres"),
        ("--line 1,2,1,2", "--line: got '1,2,1,2', expected two different ends"),
        ("--line 1,2,nan,2", "expected four numbers"),
        ("--area 1,0,1,4", "--area: got '1,0,1,4', expected two corners of an area"),
        ("--area POLYGON", "--area"),
        ("--area 40,0,50,4", "hall.geojson: the area to measure is not on the floor"),
        ("--from 150 --to 120", "run.txt: replay from frame"),
        ("--frame-rate 25", "it has 10 frames a second, but frame_rate=25 was given"),
        ("--unit km", "unit"),
        ("--speeds fast", "distribution 'fast': expected a number"),
        ("--seeds 0", "Invalid value for '--seeds'"),
        ("--set headwy.time=1", "unknown parameter 'headwy.time'"),
        ("--preset none.toml", "none.toml: no such file"),
    ],
)
def test_bad_input_is_one_line(command, files, options, message):
    tracks, plan = files
    outcome = command("validate", "tracks", tracks, "--plan", plan, *options.split())
    assert outcome.status == 2
    assert outcome.out == ""
    assert message in outcome.err
    assert len(outcome.err.splitlines()) == 1


def test_files_that_are_not_there_are_bad_input(command, files, tmp_path):
    tracks, plan = files
    for arguments, message in (
        ((tmp_path / "none.txt", "--plan", plan), "none.txt: no such file"),
        ((tracks, "--plan", tmp_path / "none.wkt"), "none.wkt"),
        ((tracks,), "Missing option '--plan'"),
        ((), "Missing argument 'FILE'"),
    ):
        outcome = command("validate", "tracks", *arguments)
        assert outcome.status == 2
        assert message in outcome.err
        assert len(outcome.err.splitlines()) == 1


def test_tracks_is_a_command_only_as_the_first_word(command):
    outcome = command("validate", "walking", "tracks")
    assert outcome.status == 2
    assert "unknown experiment 'tracks'" in outcome.err


@pytest.mark.thorough
def test_a_crowd_is_replayed_and_compared(command, files, tmp_path):
    tracks, plan = files
    out, page = tmp_path / "out", tmp_path / "page.html"
    outcome = command(
        "validate",
        "tracks",
        tracks,
        "--plan",
        plan,
        "--seeds",
        2,
        "--jobs",
        1,
        "--json",
        "--speeds",
        1.0,
        "--set",
        "headway.time=0.5",
        "--out",
        out,
        "--report",
        page,
    )
    answer = json.loads(outcome.out.splitlines()[-1])["run"]
    assert outcome.status == (0 if answer["passed"] else 1)
    assert answer["passed"] == (not answer["failed"])
    assert answer["preset"] == "default"
    found = answer["measured"]
    # Everybody walks at 1 m/s, one after the other, a second apart.
    assert found["speed: measured m/s"] == pytest.approx(1.0)
    assert found["speed m/s"] == pytest.approx(1.0, abs=0.1)
    assert found["flow 1/s"] == pytest.approx(1.0, abs=0.12)
    assert answer["criterion"]["flow 1/s"] == "0.88 to 1.12"
    assert (found["overlaps"], found["runs"]) == (0.0, 2)
    assert "replayed from frame" in outcome.err
    assert {each.name for each in out.iterdir()} == {"run.png", "validation.json"}
    assert json.loads((out / "validation.json").read_text())["run"]["passed"] == answer["passed"]
    written = page.read_text(encoding="utf-8")
    assert "headway.time = 0.5" in written
    assert "data:image/png;base64," in written
