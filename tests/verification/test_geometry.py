"""Floors of the scenarios against the dimensions in the standards, worked out by hand."""

import math

import numpy as np
import pytest
from shapely import MultiPoint, Polygon, box

from mesa_mobility.validation import bottleneck
from mesa_mobility.verification.scenarios import (
    cabins,
    counterflow,
    halls,
    impaired,
    necks,
    rooms,
    walks,
)
from mesa_mobility.verification.scenarios.buildings import lifts, storeys
from mesa_mobility.verification.scenarios.tracks.oval import Oval


def area_of(text: str) -> Polygon:
    from shapely import from_wkt

    return from_wkt(text)


@pytest.mark.parametrize(
    ("floor", "wkt"),
    [
        (rooms.HALL, "POLYGON ((0 0, 30 0, 30 20, 0 20, 0 0))"),
        (rooms.SMALL_ROOM, "POLYGON ((0 0, 8 0, 8 5, 0 5, 0 0))"),
        (rooms.CORNER, "POLYGON ((0 0, 12 0, 12 12, 10 12, 10 2, 0 2, 0 0))"),
        (
            counterflow.ROOMS,
            "POLYGON ((0 0, 10 0, 10 4, 20 4, 20 0, 30 0, 30 10, 20 10, 20 6, 10 6, 10 10, 0 10, "
            "0 0))",
        ),
        (
            necks.TWO_ROOMS,
            "POLYGON ((0 0, 10 0, 10 4.5, 15 4.5, 15 0, 25 0, 25 4.5, 26 4.5, 26 5.5, 25 5.5, "
            "25 10, 15 10, 15 5.5, 10 5.5, 10 10, 0 10, 0 0))",
        ),
        (
            necks.THREE_ROOMS,
            "POLYGON ((0 0, 10 0, 10 4.5, 10.2 4.5, 10.2 0, 20.2 0, 20.2 4.5, 20.4 4.5, 20.4 0, "
            "25.4 0, 25.4 10, 20.4 10, 20.4 5.5, 20.2 5.5, 20.2 10, 10.2 10, 10.2 5.5, 10 5.5, "
            "10 10, 0 10, 0 0))",
        ),
        (halls.WAYS["long"][0], "POLYGON ((0 0, 20 0, 20 81.4, 0 81.4, 0 0))"),
        (halls.WAYS["corner"][0], "POLYGON ((0 0, 30 0, 30 20, 20 20, 20 60, 0 60, 0 0))"),
        (halls.WAYS["short"][0], "POLYGON ((0 0, 20 0, 20 50, 0 50, 0 0))"),
        (walks.corridor_plan(40.0).free, "POLYGON ((0 0, 40 0, 40 2, 0 2, 0 0))"),
        (walks.corridor_plan(60.0, 2.0).free, "POLYGON ((0 0, 60 0, 60 2, 0 2, 0 0))"),
    ],
)
def test_floors_are_the_standards(floor, wkt):
    assert floor.equals(area_of(wkt))


def test_exits_are_the_standards():
    assert list(rooms.FOUR_EXITS.values()) == [
        ((4, 20), (5, 20)),
        ((25, 20), (26, 20)),
        ((4, 0), (5, 0)),
        ((25, 0), (26, 0)),
    ]
    assert list(rooms.TWO_EXITS.values()) == [((21, 20), (22, 20)), ((27, 20), (28, 20))]
    assert rooms.SMALL_ROOM_DOOR == ((8, 2), (8, 3))
    assert counterflow.ENTRANCE_2 == ((20, 4), (20, 6))
    assert halls.WAYS["corner"][1] == ((30, 0), (30, 20))


def test_starts_are_the_standards():
    assert counterflow.START_1.equals(box(0, 0, 5.5, 10))
    assert counterflow.START_2.equals(box(24.7, 0, 30, 10))
    assert necks.START.equals(box(0, 0, 5, 10))


def test_cabins_have_their_doors_and_exits():
    plan = cabins.cabins_plan()
    assert plan.bounds == pytest.approx((0.0, 0.0, 17.95, 10.9))
    # Corridor 17.8 x 0.9, stub 1.2 x 5, 12 doors of 0.9 x 0.1; six cabins of 2.9 x 4.9 below, and
    # five as large and one of 1.7 x 4.9 above.
    expected = 17.8 * 0.9 + 1.2 * 5.0 + 12 * 0.09 + 11 * 2.9 * 4.9 + 1.7 * 4.9
    assert plan.area == pytest.approx(expected)
    doors = [(x, y) for y in (4.95, 5.95) for x in (1.45, 4.45, 10.45, 13.45, 16.45)]
    doors += [(7.45, 4.95), (8.15, 5.95)]
    assert plan.contains(np.array(doors)).all()
    beside = [(x - 0.5, y) for x, y in doors] + [(x + 0.5, y) for x, y in doors]
    assert not plan.contains(np.array(beside)).any()
    assert [exit_.length for exit_ in plan.exits] == pytest.approx([1.2, 0.9])


@pytest.mark.parametrize("width", bottleneck.WIDTHS)
def test_the_bottleneck_is_as_wide_as_it_says(width):
    plan = bottleneck.plan(width)
    # Holding area 8 x 10, neck 1 m long, free area 8 x 5.
    assert plan.area == pytest.approx(80 + width + 40)
    assert plan.gates[0].length == pytest.approx(width)
    # 180 people on 60 m2: 3 persons/m2.
    assert bottleneck.START.area == pytest.approx(60)


def test_the_larger_body_takes_more_than_half_of_the_passage():
    from mesa_mobility.verification import nist

    assert 2 * impaired.LARGER_BODY > nist.NARROW / 2
    assert 2 * impaired.BODY < nist.NARROW / 2


def test_the_single_file_track_is_rimeas():
    from mesa_mobility.verification.scenarios.tracks.single_file import OVAL

    assert Oval(straight=4.0, radius=3.0, width=0.8) == OVAL
    assert OVAL.length == pytest.approx(26.85, abs=0.005)


def test_the_tracks_of_rimea_4_have_their_densities():
    from mesa_mobility.verification import rimea
    from mesa_mobility.verification.scenarios.tracks import track

    numbers = [dict(each.numbers) for each in rimea.TRACKS]
    assert [each["density"] for each in numbers] == [0.5, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0]
    assert {each["width"] for each in numbers} == {2.0}
    # Two straights of 15 m and half circles of 3 m: 48.85 m, 97.7 m2.
    assert 2 * track.STRAIGHT + 2 * math.pi * track.RADIUS == pytest.approx(48.85, abs=0.005)


def test_the_house_has_38_rooms_on_each_of_three_storeys():
    house = storeys.house()
    assert [level.elevation for level in house.levels] == [0.0, 3.06, 6.12]
    # Rooms of 1.8 m x 2.8 m within their walls, doors of 1 m in walls of 0.2 m, the corridor and
    # the landing.
    area = 38 * (1.8 * 2.8 + 1.0 * 0.2) + 38.0 * 1.0 + 2.0 * 4.2
    assert all(level.area.area == pytest.approx(area) for level in house.levels)
    assert [flight.width for flight in house.flights] == pytest.approx([2.0] * 4)
    assert [flight.risers for flight in house.flights] == [9] * 4
    beds = storeys.beds()
    assert len(beds) == 152
    assert house.levels[1].area.buffer(-0.4).contains_properly(MultiPoint(beds))


def test_the_way_over_the_bridge_is_short_and_the_way_round_is_long():
    building = storeys.two_ways()
    ground, bridge = building.levels
    assert (ground.elevation, bridge.elevation) == (0.0, 3.06)
    # Two legs of 30 m, a cross-piece between them, and what is left to the feet of the stairs.
    assert ground.area.area == pytest.approx(2 * 60.0 + 20.0 * 2.0 + 2 * 2.0 * (10.0 - 4.93 - 2.0))
    assert [flight.foot[0][0] for flight in building.flights] == pytest.approx([5.07, 18.93])


def test_the_tower_has_three_storeys_and_a_car_for_all_riders():
    building = lifts.tower(1, speed=1.0, door_s=3.0, capacity=4)
    assert [level.elevation for level in building.levels] == [0.0, 3.5, 7.0]
    assert building.lifts[0].numbers == (1, 0, 2)
    # People start where they call the car: within 4 m of the middle of the door.
    assert all(
        math.dist(c, (6.0, 6.0)) < 4.0 for c in [*lifts.WAITING.exterior.coords, lifts.LOBBY]
    )
    # Doors close and open in 3 s each; 3.5 m and 7 m at 1 m/s.
    assert lifts.way_s(1, speed=1.0, door_s=3.0) == 9.5
    assert lifts.way_s(2, speed=1.0, door_s=3.0) == 13.0
