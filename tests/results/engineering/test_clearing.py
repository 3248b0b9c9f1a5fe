"""When shares of people have left, and the rooms that they leave."""

import json

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mesa_mobility import Exit, FloorPlan, SpeedZone
from mesa_mobility.errors import FloorPlanError, ResultsError
from mesa_mobility.results import (
    Room,
    clearing,
    measure,
    read_rooms,
    room_figures,
    rooms_of,
    time_to_share,
    write_results,
)
from tests.fixtures.buildings import two_storeys, with_refuge_and_lift
from tests.results.measures.test_storeys import PEOPLE, tracks_of

WEST = "POLYGON ((0 0, 5 0, 5 4, 0 4, 0 0))"


@pytest.mark.parametrize(
    ("times", "share", "expected"),
    [
        ([4, 1, 3, 2], 0.5, 2),
        ([4, 1, 3, 2], 0.51, 3),
        ([4, 1, 3, 2], 1.0, 4),
        ([7], 0.01, 7),
        (list(range(1, 21)), 0.95, 19),
        ([1, 2, np.inf, np.inf], 0.5, 2),
        ([1, 2, np.inf, np.inf], 0.75, np.inf),
    ],
)
def test_the_least_time_by_which_a_share_has_left(times, share, expected):
    assert time_to_share(np.array(times, dtype=float), share) == expected


@given(
    st.lists(st.one_of(st.floats(0, 1e6), st.just(np.inf)), min_size=1),
    st.floats(0.001, 1.0),
)
def test_by_that_time_and_not_before_the_share_has_left(times, share):
    values = np.array(times)
    found = time_to_share(values, share)
    wanted = share * len(values)
    assert np.sum(values <= found) >= wanted - 1e-6
    assert np.sum(values < found) < wanted


def test_shares_must_be_shares():
    assert np.isnan(time_to_share(np.array([]), 0.5))
    for share in (0.0, 1.1, np.nan):
        with pytest.raises(ResultsError, match="above 0, at most 1"):
            time_to_share(np.array([1.0]), share)


def test_those_still_inside_are_censored(two_leave_one_stays, room):
    row = clearing(two_leave_one_stays, room).loc[("floor", "all")]
    # They leave after 1 and 2 s; the third is inside when the run ends after 2 s.
    assert row[["people", "left", "t50_s", "censored_s"]].tolist() == [3, 2, 2.0, 2.0]
    assert row[["t95_s", "t100_s"]].isna().all()


def test_a_room_is_empty_when_the_last_has_left_it_for_good(two_leave_one_stays, room):
    rooms = [Room("west", WEST), Room("east", "POLYGON ((5 0, 10 0, 10 4, 5 4, 5 0))")]
    table = clearing(two_leave_one_stays, room, rooms)
    east = table.loc[("room", "east")]
    assert east[["people", "left", "t50_s", "t100_s"]].tolist() == [2, 2, 1.0, 2.0]
    assert table.loc[("room", "west"), ["people", "left"]].tolist() == [1, 0]
    assert room_figures(two_leave_one_stays, room, rooms) == {
        "west": {"people": 1, "first_s": None, "last_s": None, "flow_per_s": None},
        "east": {"people": 2, "first_s": 1.0, "last_s": 2.0, "flow_per_s": 1.0},
    }


def test_storeys_and_stairs(two_leave_one_stays):
    table = clearing(tracks_of(PEOPLE), two_storeys())
    # As by hand in the tests of storeys: levels left after 2 and 4 s, and by one person never.
    upper, lower = table.loc[("level", "1")], table.loc[("level", "0")]
    assert upper[["people", "left", "t50_s"]].tolist() == [3, 2, 4.0]
    assert lower[["people", "left", "t50_s", "t100_s"]].tolist() == [2, 2, 1.0, 7.0]
    assert table.loc[("stairs", "south"), ["people", "left", "t50_s"]].tolist() == [2, 1, 5.0]
    assert table.loc[("stairs", "north"), ["people", "left", "t100_s"]].tolist() == [1, 1, 4.0]


def test_shares_of_a_run_as_counted_from_its_occupancy(leaving):
    plan, tracks = leaving
    row = clearing(tracks, plan).loc[("floor", "all")]
    inside = tracks.inside()
    for share, time in ((0.5, row.t50_s), (0.95, row.t95_s), (1.0, row.t100_s)):
        first = np.flatnonzero(30 - inside >= share * 30)[0] / 30.0
        assert time == pytest.approx(first)


def test_zones_and_refuges_with_names_are_rooms():
    soft = SpeedZone("POLYGON ((1 1, 2 1, 2 2, 1 2, 1 1))", 0.5, name="soft")
    second = SpeedZone(soft.area, 0.5, name="soft 2")
    zones = [soft, second, soft, SpeedZone(soft.area, 0.5)]
    plan = FloorPlan(WEST, exits=[Exit("out", (5, 1), (5, 2))], zones=zones)
    assert [each.name for each in rooms_of(plan)] == ["room 1", "soft", "soft 2", "soft 3"]
    assert {each.level for each in rooms_of(plan)} == {0}
    found = rooms_of(with_refuge_and_lift())
    assert [(each.name, each.level) for each in found] == [
        ("level 0 room 1", 0),
        ("level 1 room 1", 1),
        ("north lobby", 1),
    ]


def collection(**properties):
    ring = [[0, 0], [5, 0], [5, 4], [0, 4], [0, 0]]
    return {
        "type": "FeatureCollection",
        "features": [
            {
                "type": "Feature",
                "properties": {"kind": "room", "name": "west", **properties},
                "geometry": {"type": "Polygon", "coordinates": [ring]},
            }
        ],
    }


def test_rooms_from_a_file(tmp_path):
    file = tmp_path / "rooms.geojson"
    file.write_text(json.dumps(collection(level=2)))
    [room] = read_rooms(file)
    assert (room.name, room.level, room.shape.area) == ("west", 2, 20.0)
    with pytest.raises(FloorPlanError, match="cannot be read"):
        read_rooms(tmp_path / "missing.geojson")


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"kind": "zone"}, "feature 0: expected a Feature with the property kind 'room'"),
        ({"name": ""}, "feature 0: room: expected a name"),
        ({"name": 3}, "feature 0: room: expected a name"),
        ({"level": "two"}, "feature 0: level must be a whole number"),
    ],
)
def test_what_is_no_room_is_refused(wrong, said):
    with pytest.raises(FloorPlanError, match=said):
        read_rooms(collection(**wrong))


@pytest.mark.parametrize("coordinates", [[], [[0, 0]], [[[0, 0], [1e400, 0], [1, 1], [0, 0]]], "x"])
def test_areas_that_are_none_are_refused(coordinates):
    broken = collection()
    broken["features"][0]["geometry"]["coordinates"] = coordinates
    with pytest.raises(FloorPlanError, match="feature 0"):
        read_rooms(broken)


@pytest.mark.parametrize(
    ("rooms", "said"),
    [
        ([Room("a", WEST), Room("a", WEST)], "'a' is there twice"),
        ([Room("a", WEST, level=3)], "no level 3, expected one of 0"),
        ([Room("a", "POLYGON ((90 90, 91 90, 91 91, 90 90))")], "has no floor in it"),
    ],
)
def test_rooms_must_be_on_the_plan(two_leave_one_stays, room, rooms, said):
    with pytest.raises(ResultsError, match=said):
        clearing(two_leave_one_stays, room, rooms)


def test_the_tables_of_a_run(two_leave_one_stays, room, tmp_path):
    write_results(measure(two_leave_one_stays, room, [Room("west", WEST)]), tmp_path)
    tables = {each.stem: pd.read_csv(each) for each in tmp_path.glob("*.csv")}
    assert sorted(tables) == ["clearing", "doors", "maps", "n_t", "queues", "waiting"]
    pictures = sorted(each.stem for each in tmp_path.glob("*.png"))
    assert pictures == ["dense", "level_of_service", "speed", "usage"]
    doors = tables["doors"].set_index("door")
    assert doors.people.to_dict() == {"middle": 0, "east": 2}
    assert doors.loc["east", ["type", "first_s", "clogs"]].tolist() == ["all", 0.954545, 0]
    assert tables["clearing"].place.tolist() == ["all", "room 1", "room 2", "west"]
    assert tables["n_t"].people.tolist() == [1, 2]
    assert tables["waiting"].longest_wait_s.tolist() == [2.0]
    cells = tables["maps"].set_index(["x", "y"])
    assert cells.people.sum() == 1 + 2 + 3
    assert cells.floor_m2.sum() == pytest.approx(39.0)
