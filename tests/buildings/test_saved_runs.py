"""Runs in buildings that commands make and save."""

import json

import numpy as np
import pytest
from matplotlib.figure import Figure
from typer.testing import CliRunner

from mesa_mobility import Building, FloorPlan, PedestrianModel, Trajectories
from mesa_mobility.buildings import read_floor
from mesa_mobility.commands.app import app
from mesa_mobility.errors import FloorPlanError, ResultsError
from mesa_mobility.results import (
    by_stairs,
    climbs,
    crossings,
    occupancy,
    occupancy_by_level,
    occupancy_by_stairs,
)
from mesa_mobility.results.floor import draw_floor, storeys_of
from mesa_mobility.results.run import read_run
from tests.fixtures.buildings import RISE, two_storeys, with_refuge_and_lift


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
    tracks = run.trajectories
    upper, lower = storeys_of(tracks, run.plan)
    assert (upper.title, lower.title) == ("level 1", "level 0")
    assert (upper.rows ^ lower.rows).all()
    assert (tracks.z[upper.rows] == RISE).all()
    assert (tracks.z[lower.rows] < RISE).all()
    # A straight flight, and two flights and a landing, from either end.
    assert len(upper.stairs) == len(lower.stairs) == 4


def test_panels_have_refuges_with_their_names_and_cars_of_lifts():
    building = with_refuge_and_lift()
    model = PedestrianModel(building, record=True, rng=1)
    model.add_pedestrians(building.places([(4.0, 4.0)], level=1))
    model.run(max_seconds=1)
    upper, lower = storeys_of(Trajectories.of(model), building)
    # A flight, and a car of 1.1 m by 1.4 m with the 0.1 m of its doorway.
    assert [each.area for each in upper.stairs] == pytest.approx([17 * 0.29 * 1.2, 1.1 * 1.5])
    assert lower.refuges == ()
    axes = Figure().subplots()
    handles = draw_floor(axes, upper.plan, upper.stairs, upper.refuges)
    # The door of the lift is not an exit to the eye.
    assert [each.get_label() for each in handles] == ["wall", "stairs or lift", "refuge"]
    [name] = axes.texts
    assert (name.get_text(), name.get_position()) == ("north lobby", (17, 2.5))


def test_what_takes_one_plan_says_so(folder, tmp_path):
    with pytest.raises(ResultsError, match="a run in a building of 2 levels, expected one on a"):
        _ = read_run(folder).floor_plan
    command = ["export", str(folder), "--no-progress", "-o", str(tmp_path / "tracks.sqlite")]
    assert isinstance(CliRunner().invoke(app, command).exception, ResultsError)


@pytest.mark.parametrize("name", ["run.html", "run.png", "run.gif"])
def test_pages_films_and_stills_show_all_storeys(folder, tmp_path, name):
    command = ["export", str(folder), "--no-progress", "--to", "1", "-o", str(tmp_path / name)]
    answer = CliRunner().invoke(app, command)
    assert answer.exit_code == 0, answer.output
    assert (tmp_path / name).stat().st_size > 0


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


def test_everybody_is_exported_with_elevations(folder, tmp_path):
    office, tracks = read_run(folder).plan, read_run(folder).trajectories
    command = ["export", str(folder), "--no-progress", "-o"]
    for name in ("all.txt", "all.parquet"):
        answer = CliRunner().invoke(app, [*command, str(tmp_path / name)])
        assert answer.exit_code == 0, answer.output
    again = Trajectories.read(tmp_path / "all.parquet")
    assert (again.z == tracks.z).all()
    assert (again.level == tracks.level).all()
    # Everybody walks on for three frames beyond their exit, on the ground floor.
    text = Trajectories.read(tmp_path / "all.txt")
    assert len(text) == len(tracks) + 3 * tracks.people
    for person in range(tracks.people):
        own, read = tracks.rows_of(person), text.rows_of(person)
        assert np.abs(text.z[read[:-3]] - tracks.z[own]).max() < 1e-4
        assert (text.z[read[-3:]] == 0.0).all()
    assert by_stairs(text, office)["down"].tolist() == by_stairs(tracks, office)["down"].tolist()
    answer = CliRunner().invoke(app, [*command, str(tmp_path / "all.sqlite")])
    assert isinstance(answer.exception, ResultsError)


def test_levels_and_stairs_add_up_to_all_people(folder):
    run = read_run(folder)
    tracks, office = run.trajectories, run.plan
    curves = [*occupancy_by_level(tracks, office, 0.1).values()]
    curves += occupancy_by_stairs(tracks, office, 0.1).values()
    everybody = np.array(occupancy(tracks, 0.1))
    assert (sum(np.array(each)[:, 1] for each in curves) == everybody[:, 1]).all()
    # The head of the straight stair is passed where its line is, to a frame of 1/30 s.
    way, line = climbs(tracks, office)["south"], crossings(tracks, *office.flights[0].head)
    assert len(line.time)
    assert way.over_head().time == pytest.approx(line.time, abs=1.0 / 30.0 + 1e-9)
    assert (way.over_head().direction == line.direction).all()


def test_the_summary_has_tables_of_levels_and_stairs(folder):
    run = read_run(folder)
    levels, stairs = run.summary["by_level"], run.summary["by_stairs"]
    assert [each["level"] for each in levels] == [1, 0]
    assert sum(each["at_start"] for each in levels) == 20
    assert levels[1]["clear_s"] == pytest.approx(run.summary["egress_s"], abs=1e-6)
    upstairs = levels[0]
    assert 0.0 < upstairs["clear_s"] < run.summary["egress_s"]
    assert [each["stairs"] for each in stairs] == ["south", "north"]
    assert sum(each["down"] for each in stairs) == upstairs["people"] == upstairs["at_start"]
    assert all(each["up"] == 0 for each in stairs)
    assert run.summary["by_lift"] == run.summary["overlapping_pairs"] == []
    assert run.summary["crossings"] == []


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
        (
            '{"type": "FeatureCollection", "features": [{"properties": {"level": 3}}]}',
            "has no area to walk on",
        ),
    ],
)
def test_what_is_neither_is_refused_in_one_line(tmp_path, text, says):
    (tmp_path / "x.geojson").write_text(text)
    with pytest.raises(FloorPlanError, match=says) as caught:
        read_floor(tmp_path / "x.geojson")
    assert "\n" not in str(caught.value)
