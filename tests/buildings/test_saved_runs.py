"""Runs in buildings that commands make and save."""

import json

import pytest
from typer.testing import CliRunner

from mesa_mobility import Building, FloorPlan, Trajectories
from mesa_mobility.buildings import read_floor
from mesa_mobility.commands.app import app
from mesa_mobility.errors import FloorPlanError, ResultsError
from mesa_mobility.results.floor import storeys_of
from mesa_mobility.results.run import read_run
from tests.fixtures.buildings import RISE, two_storeys


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """The folder of a run of 20 people in an office of two storeys."""
    there = tmp_path_factory.mktemp("runs")
    two_storeys().write_geojson(there / "office.geojson")
    settings = ["--set", f"plan={there / 'office.geojson'}", "--set", "pedestrians=20"]
    command = ["run", "floor_plan", *settings, "--seed", "1", "--no-progress"]
    answer = CliRunner().invoke(app, [*command, "--out", str(there / "run")])
    assert answer.exit_code == 0, answer.output
    return there / "run"


def test_the_folder_holds_the_building_and_true_places(folder):
    run = read_run(folder)
    assert isinstance(run.plan, Building)
    assert [level.elevation for level in run.plan.levels] == [0.0, RISE]
    assert set(run.trajectories.level) >= {0, 1}
    assert run.trajectories.z.max() == RISE
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["left_inside"] == summary["overlaps"] == summary["wall_crossings"] == 0
    assert summary["off_floor"] == 0
    assert (folder / "trajectories.png").stat().st_size > 0


def test_each_level_has_a_panel_and_each_row_is_in_one(folder):
    run = read_run(folder)
    upper, lower = storeys_of(run.trajectories, run.plan)
    assert (upper.title, lower.title) == ("level 1", "level 0")
    assert len(upper.tracks) + len(lower.tracks) == len(run.trajectories)
    assert (upper.tracks.z == RISE).all()
    assert (lower.tracks.z < RISE).all()
    # A straight flight, and two flights and a landing, from either end.
    assert len(upper.stairs) == len(lower.stairs) == 4


def test_commands_that_show_one_plan_say_that_they_do_not(folder):
    with pytest.raises(ResultsError, match="a run in a building of 2 levels, expected one on a"):
        _ = read_run(folder).floor_plan
    answer = CliRunner().invoke(app, ["replay", str(folder), "--no-open"])
    assert isinstance(answer.exception, ResultsError)


def test_the_people_of_one_level_are_exported(folder, tmp_path):
    command = ["export", str(folder), "--level", "1", "--no-progress", "-o"]
    answer = CliRunner().invoke(app, [*command, str(tmp_path / "level_1.txt")])
    assert answer.exit_code == 0, answer.output
    written = Trajectories.read(tmp_path / "level_1.txt")
    tracks = read_run(folder).trajectories
    on = tracks.level == 1
    assert set(written.person) == set(tracks.person[on])
    assert written.x.max() <= 24.0
    answer = CliRunner().invoke(app, [*command, str(tmp_path / "level_1.sqlite")])
    assert answer.exit_code == 0, answer.output


def test_a_level_is_asked_for_in_buildings_alone(folder, tmp_path):
    run = read_run(folder)
    with pytest.raises(FloorPlanError, match="there is no level 7; there are 0, 1"):
        run.on(7)
    with pytest.raises(ResultsError, match="a run on a floor plan, expected one in a building"):
        run.on(1).on(1)


def test_a_file_holds_a_plan_or_a_building(tmp_path):
    office = two_storeys()
    office.write_geojson(tmp_path / "office.geojson")
    office.floor_plan_of(0).write_geojson(tmp_path / "plan.geojson")
    assert isinstance(read_floor(tmp_path / "office.geojson"), Building)
    plan = read_floor(tmp_path / "plan.geojson")
    assert isinstance(plan, FloorPlan)
    assert plan.to_geojson() == FloorPlan.from_geojson(tmp_path / "plan.geojson").to_geojson()


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("[]", "expected a GeoJSON FeatureCollection"),
        ('{"type": "FeatureCollection", "features": [{"properties": {"level": 3}}]}', "feature 0"),
    ],
)
def test_what_is_neither_is_refused_in_one_line(tmp_path, text, says):
    (tmp_path / "x.geojson").write_text(text)
    with pytest.raises(FloorPlanError, match=says) as caught:
        read_floor(tmp_path / "x.geojson")
    assert "\n" not in str(caught.value)
