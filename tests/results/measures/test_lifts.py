"""People in lifts of a building, in tracks that are made by hand and in a run that is read back."""

import math

import numpy as np
import pytest
from typer.testing import CliRunner

from mesa_mobility import Building, Exit, Level, Lift, Trajectories
from mesa_mobility.commands.app import app
from mesa_mobility.commands.run import _figures
from mesa_mobility.errors import ResultsError
from mesa_mobility.results import by_lift, occupancy_by_lift, rides
from mesa_mobility.results.run import read_run
from tests.fixtures.buildings import HALL, RISE, with_refuge_and_lift


def three_storeys():
    """Halls 3 m above each other. The doors of two lifts are at y = 6.5, about x = 20.45 and 2.45.
    Their cars are from y = 6.6 to 8."""
    levels = [Level(k, HALL, 3.0 * k, exits=[Exit(f"west {k}", (0, 3), (0, 5))]) for k in range(3)]
    doors = {"lift": ((20.0, 6.5), (20.9, 6.5)), "goods": ((2.0, 6.5), (2.9, 6.5))}
    return Building(levels, lifts=[Lift(name, levels, door) for name, door in doors.items()])


def far(z):
    """5.1 m from the door, at some elevation."""
    return (16.0, 4.0, z)


def near(z):
    """3.2 m from the door."""
    return (18.0, 4.5, z)


def car(z):
    return (20.45, 7.4, z)


# A place a second. The car goes up to level 2, then down to 1 and to 0, and up again.
PEOPLE = [
    # Down from 2 to 0, with a stop at 1. Out of the building in the last second.
    [
        *[far(6)] * 2,
        *[near(6)] * 3,
        *[car(z) for z in (6, 6, 4.5, 3, 3, 1.5, 0)],
        *[near(0), far(0), (-0.1, 4.0, 0.0)],
    ],
    # Comes near and goes away again before they wait. Down from 2 to 1.
    [near(6), near(6), far(6), near(6), near(6), *[car(z) for z in (6, 6, 4.5, 3)], *[near(3)] * 6],
    # Down from 1 to 0.
    [*[near(3)] * 9, car(3), car(1.5), car(0), *[near(0)] * 3],
    # Gets in and out again.
    [*[near(0)] * 13, car(0), near(0)],
    # On the way up at the end.
    [*[far(0)] * 10, *[near(0)] * 3, car(0), car(2)],
    # On the way up from 1 to 2 at the start.
    [car(4), car(6), *[far(6)] * 13],
    # Passes the level above the car, and does not ride.
    [far(6), *[near(6)] * 14],
]


def tracks_of(people):
    """Tracks of one frame a second; person 0 has left at the end."""
    places = np.array(people, dtype=float)
    count, frames = places.shape[:2]
    x, y, z = places.transpose(1, 0, 2).reshape(-1, 3).T
    return Trajectories(
        np.repeat(np.arange(frames), count),
        np.tile(np.arange(count), frames),
        x,
        y,
        0.0 * x,
        frame_rate=1.0,
        inside_at_end=np.arange(1, count),
        fields={"z": z},
    )


def test_the_rides_of_people():
    found = rides(tracks_of(PEOPLE), three_storeys())
    assert list(found) == ["lift", "goods"]
    lift = found["lift"]
    assert lift.person.tolist() == [5, 0, 1, 2, 4]
    assert lift.start.tolist() == [0.0, 5.0, 5.0, 9.0, 13.0]
    assert lift.end.tolist() == [2.0, 12.0, 9.0, 12.0, np.inf]
    assert lift.from_level.tolist() == [1, 2, 2, 1, 0]
    assert lift.to_level.tolist() == [2, 0, 1, 0, 1]
    np.testing.assert_array_equal(lift.wait, [np.nan, 3.0, 2.0, 9.0, 3.0])
    assert len(found["goods"].person) == 0


def test_the_table_of_lifts():
    table = by_lift(tracks_of(PEOPLE), three_storeys())
    assert table.index.tolist() == ["lift", "goods"]
    assert table[["people", "down", "up", "rides", "most"]].to_numpy().tolist() == [
        [5, 3, 1, 4, 2],
        [0, 0, 0, 0, 0],
    ]
    # Waits of 3, 2, 9 and 3 s; rides of 2, 7, 4 and 3 s.
    np.testing.assert_array_equal(table.mean_wait_s, [4.25, np.nan])
    np.testing.assert_array_equal(table.longest_wait_s, [9.0, np.nan])
    np.testing.assert_array_equal(table.mean_ride_s, [4.0, np.nan])


def test_people_in_a_lift_second_by_second():
    found = occupancy_by_lift(tracks_of(PEOPLE), three_storeys())
    assert [n for _, n in found["lift"]] == [1, 1, 0, 0, 0, 2, 2, 2, 2, 2, 2, 2, 0, 2, 1]
    assert {n for _, n in found["goods"]} == {0}
    every = occupancy_by_lift(tracks_of(PEOPLE), three_storeys(), every=5.0)["lift"]
    assert every == [[0.0, 1], [5.0, 2], [10.0, 2]]


def test_somebody_who_has_just_ridden_calls_again():
    way = [*[near(3)] * 2, car(3), car(0), car(0), *[near(0)] * 2, car(0), car(0), car(3), near(3)]
    lift = rides(tracks_of([[near(0)] * 11, way]), three_storeys())["lift"]
    assert lift.start.tolist() == [2.0, 7.0]
    assert lift.wait.tolist() == [2.0, 2.0]
    assert lift.to_level.tolist() == [0, 1]


def test_only_the_way_on_the_level_before_the_door_counts_as_wait():
    stairs = [(18.0, 4.5, z) for z in (0.0, 1.5)]
    ride = [car(3), car(0), near(0)]
    ways = [
        [*stairs, near(3), near(3), *ride],
        [near(0), far(3), far(3), far(3), *ride],
        [*[near(3)] * 4, *ride],
    ]
    lift = rides(tracks_of(ways), three_storeys())["lift"]
    assert lift.wait.tolist() == [2.0, 0.0, 4.0]


def test_nobody_need_be_there_and_tracks_have_elevations():
    building = three_storeys()
    nobody = Trajectories([], [], [], [], [], last_frame=3, fields={"z": []})
    assert by_lift(nobody, building)["people"].tolist() == [0, 0]
    flat = Trajectories([0], [0], [1.0], [1.0], [0.0])
    for measure in (by_lift, rides, occupancy_by_lift):
        with pytest.raises(ResultsError, match="no elevations, expected those of a building"):
            measure(flat, building)


def test_places_know_their_lift():
    """Behind the line of the door, from the lowest to the highest floor."""
    places = [car(0), car(2.2), car(6), (20.45, 6.55, 3), (20.45, 6.45, 3), car(6.1), (2.5, 7, 1)]
    assert three_storeys().lifts_at(places).tolist() == [0, 0, 0, 0, -1, -1, 1]


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """The run of 10 people, half of them in wheelchairs, and what the command printed of it."""
    there = tmp_path_factory.mktemp("runs")
    with_refuge_and_lift().write_geojson(there / "office.geojson")
    settings = [f"plan={there / 'office.geojson'}", "pedestrians=10"]
    settings.append("population=able_bodied: 0.5, wheelchair_powered: 0.5")
    command = ["run", "floor_plan", "--seed", "1", "--no-progress", "--out", str(there / "run")]
    for each in settings:
        command += ["--set", each]
    answer = CliRunner().invoke(app, command)
    assert answer.exit_code == 0, answer.output
    return read_run(there / "run"), answer.output


def test_a_run_that_is_read_back_says_who_rode(run):
    saved, _ = run
    tracks, building, summary = saved.trajectories, saved.plan, saved.summary
    lift = rides(tracks, building)["lift"]
    kinds = tracks.person_data["type"]
    first = {p: tracks.level[tracks.rows_of(p)[0]] for p in range(tracks.people)}
    upstairs = {p for p, level in first.items() if level == 1 and "wheelchair" in kinds[p]}
    assert len(upstairs) >= 2
    assert set(lift.person) == upstairs
    assert (lift.from_level == 1).all()
    assert (lift.to_level == 0).all()
    # A second, plain method: row by row.
    for person, start, end, wait in zip(lift.person, lift.start, lift.end, lift.wait, strict=True):
        rows = tracks.rows_of(person)
        x, y, z = tracks.x[rows], tracks.y[rows], tracks.z[rows]
        inside = [k for k in range(len(rows)) if y[k] > 6.5 and 19.9 < x[k] < 21.0]
        assert inside == list(range(inside[0], inside[-1] + 1))
        assert start == pytest.approx(inside[0] / 30)
        assert end == pytest.approx((inside[-1] + 1) / 30)
        away = [math.dist((x[k], y[k]), (20.45, 6.5)) for k in range(inside[0])]
        called = inside[0]
        while called > 0 and away[called - 1] < 4.0:
            called -= 1
        assert wait == pytest.approx((inside[0] - called) / 30)
        assert z[inside[0]] == RISE
        assert z[inside[-1]] == 0.0
        # 3.06 m at 1 m/s, after the doors have closed in 3 s and before they open in 3 s.
        assert end - start > 9.06
    [row] = summary["by_lift"]
    assert row["people"] == row["down"] == summary["lifts"][0]["carried"] == len(upstairs)
    # At least one ride down for each: one wheelchair fits.
    assert row["rides"] == len(upstairs)
    assert row["most"] == 1
    assert row["longest_wait_s"] == pytest.approx(lift.wait.max())
    assert row["mean_ride_s"] == pytest.approx((lift.end - lift.start).mean())


def test_the_command_prints_waits(run):
    saved, said = run
    [row], [lift] = saved.summary["by_lift"], saved.summary["lifts"]
    expected = (
        f"{lift['carried']} people carried in {lift['trips']} rides, waited "
        f"{row['mean_wait_s']:.1f} s (mean), {row['longest_wait_s']:.1f} s (longest)"
    )
    assert expected in " ".join(said.split())


def test_the_command_prints_where_the_first_overlap_and_step_through_a_wall_are(run):
    summary = dict(run[0].summary)
    assert (_figures(summary)["Overlaps"], _figures(summary)["Wall crossings"]) == ("0", "0")
    at = {"x": 1.0, "y": 2.0, "z": 3.06, "on": "level 1"}
    summary |= {"overlaps": 2, "overlapping_pairs": [{"frame": 9, "at": at}, {"frame": 10}]}
    summary |= {"wall_crossings": 1, "crossings": [{"frame": 7, "at": at | {"on": ""}}]}
    said = _figures(summary)
    assert said["Overlaps"] == "2, the first in frame 9 on level 1 at (1.00, 2.00, 3.06)"
    assert said["Wall crossings"] == "1, the first in frame 7 at (1.00, 2.00)"
