"""Stairs: flights and landings, worked out by hand."""

import math
from itertools import pairwise

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from shapely import box

from mesa_mobility import Level, Stairs
from mesa_mobility.buildings.connections.flights import speed_factor
from mesa_mobility.errors import FloorPlanError


def straight(**changes):
    """Down towards +x from x = 2, 1.2 m wide."""
    values = {"head": ((2, 1.2), (2, 0)), "risers": 18, "tread": 0.29} | changes
    return Stairs.straight("main", 1, 0, **values)


def dog_leg(**changes):
    values = {"head": ((2, 1.2), (2, 0)), "risers": 18, "tread": 0.25, "well": 0.4} | changes
    return Stairs.dog_leg("main", 1, 0, **values)


def of_flights(turns, risers=(7, 4, 7), **changes):
    return Stairs.of_flights(
        "main", 1, 0, ((2, 1.2), (2, 0)), risers=risers, turns=turns, tread=0.25, **changes
    )


def corners(line):
    return np.array(line).round(9).tolist()


def test_a_straight_flight_has_a_tread_between_any_two_risers():
    [flight], landings = straight().parts(3.06, 0.0)
    assert landings == []
    assert flight.going == pytest.approx(17 * 0.29)
    assert flight.width == pytest.approx(1.2)
    assert flight.down.tolist() == [1.0, 0.0]
    assert corners(flight.foot) == [[6.93, 1.2], [6.93, 0.0]]
    assert (flight.upper, flight.lower) == ("level 1", "level 0")
    assert (flight.top, flight.bottom) == (3.06, 0.0)


def test_a_dog_leg_turns_left_on_the_way_down():
    (upper, lower), [landing] = dog_leg().parts(3.6, 0.0)
    assert corners(upper.foot) == [[4.0, 1.2], [4.0, 0.0]]
    # The left end, as seen on the way back, is nearer to the well.
    assert corners(lower.head) == [[4.0, 1.6], [4.0, 2.8]]
    assert lower.down.tolist() == [-1.0, 0.0]
    assert corners(lower.foot) == [[2.0, 1.6], [2.0, 2.8]]
    assert landing.area.symmetric_difference(box(4.0, 0.0, 5.2, 2.8)).area < 1e-9
    assert (upper.bottom, landing.elevation, lower.top) == pytest.approx((1.8, 1.8, 1.8))
    assert (upper.lower, lower.upper) == (landing.name, landing.name)
    assert (upper.upper, lower.lower) == ("level 1", "level 0")


def test_a_dog_leg_turns_right_on_the_way_down():
    (_, lower), [landing] = dog_leg(turn="right", landing=2.0).parts(3.6, 0.0)
    assert corners(lower.head) == [[4.0, -1.6], [4.0, -0.4]]
    assert lower.down.tolist() == [-1.0, 0.0]
    assert landing.area.symmetric_difference(box(4.0, -1.6, 6.0, 1.2)).area < 1e-9


def test_a_landing_straight_on():
    (upper, lower), [landing] = of_flights(["on"], (9, 9), landing=1.5).parts(3.6, 0.0)
    # Eight treads of 0.25 m.
    assert corners(upper.foot) == [[4.0, 1.2], [4.0, 0.0]]
    assert landing.area.symmetric_difference(box(4.0, 0.0, 5.5, 1.2)).area < 1e-9
    assert corners(lower.head) == [[5.5, 1.2], [5.5, 0.0]]
    assert corners(lower.foot) == [[7.5, 1.2], [7.5, 0.0]]
    assert (upper.bottom, landing.elevation, lower.top) == pytest.approx((1.8, 1.8, 1.8))
    assert (upper.name, lower.name, landing.name) == ("main 2", "main 1", "landing of main")


@pytest.mark.parametrize(("turn", "sign"), [("left", 1), ("right", -1)])
def test_quarter_turns_lead_round_the_corner(turn, sign):
    """Flights of 1.5, 0.75 and 1.5 m, and posts of 0.1 m; the right turn is the mirror image."""
    flights, landings = of_flights([turn, turn]).parts(3.6, 0.0)

    def seen(line):
        ends = [[x, y if sign == 1 else 1.2 - y] for x, y in line]
        return corners(ends if sign == 1 else ends[::-1])

    assert seen(flights[0].foot) == [[3.5, 1.2], [3.5, 0.0]]
    assert seen(flights[1].head) == [[3.6, 1.2], [4.8, 1.2]]
    assert seen(flights[1].foot) == [[3.6, 1.95], [4.8, 1.95]]
    # The second landing lies beyond; the way back runs beside the first flight.
    assert seen(flights[2].head) == [[3.6, 2.05], [3.6, 3.25]]
    assert seen(flights[2].foot) == [[2.1, 2.05], [2.1, 3.25]]
    areas = [box(3.5, 0.0, 4.8, 1.2), box(3.6, 1.95, 4.8, 3.25)]
    for landing, area in zip(landings, areas, strict=True):
        if sign == -1:
            area = shapely.transform(area, lambda xy: xy * [1, -1] + [0, 1.2])
        assert landing.area.symmetric_difference(area).area < 1e-9
    assert [each.elevation for each in landings] == pytest.approx([2.2, 1.4])
    assert [each.name for each in landings] == ["landing 2 of main", "landing 1 of main"]
    sheets = ["level 1", "landing 2 of main", "landing 1 of main", "level 0"]
    assert [(each.upper, each.lower) for each in flights] == list(pairwise(sheets))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"risers": (18,), "turns": []}, "expected 2 to 20 flights of 3 risers or more"),
        ({"risers": (9, 2), "turns": ["on"]}, "expected 2 to 20 flights of 3 risers or more"),
        ({"risers": (9, 9), "turns": []}, "expected a turn on, left, right between each two"),
        ({"risers": (9, 9), "turns": ["back"]}, "expected a turn on, left, right between each"),
    ],
)
def test_flights_and_turns_must_fit(changes, message):
    with pytest.raises(FloorPlanError, match=message):
        of_flights(**changes)


def test_other_shapes_have_no_flights_of_their_own():
    with pytest.raises(FloorPlanError, match="flights and turns of the shape 'flights' alone"):
        Stairs("main", 1, 0, ((2, 1.2), (2, 0)), 18, flights=(9, 9))


def test_of_an_odd_number_of_risers_the_lower_flight_has_one_more():
    (upper, lower), [landing] = dog_leg(risers=17).parts(3.4, 0.0)
    assert (upper.risers, lower.risers) == (8, 9)
    assert landing.elevation == pytest.approx(9 * 0.2)
    assert (upper.going, lower.going) == pytest.approx((7 * 0.25, 8 * 0.25))


@given(
    angle=st.floats(0.0, 6.28),
    width=st.floats(0.7, 3.0),
    risers=st.integers(6, 40),
    turn=st.sampled_from(["left", "right"]),
    well=st.floats(0.1, 1.0),
)
def test_flights_and_landing_of_a_dog_leg_meet_and_do_not_overlap(angle, width, risers, turn, well):
    end = (width * math.cos(angle), width * math.sin(angle))
    stairs = Stairs.dog_leg("s", 1, 0, ((0, 0), end), risers=risers, turn=turn, well=well)
    (upper, lower), [landing] = stairs.parts(0.17 * risers, 0.0)
    drawn = [flight.part(0.0, flight.going) for flight in (upper, lower)]
    assert drawn[0].distance(drawn[1]) == pytest.approx(well, abs=1e-6)
    assert upper.down @ lower.down == pytest.approx(-1.0)
    for area in drawn:
        assert shapely.intersection(area, landing.area, grid_size=1e-9).area < 1e-6
        shared = area.boundary.buffer(1e-6).intersection(landing.area.boundary).length
        assert shared == pytest.approx(width, abs=1e-4)
    assert upper.top - upper.bottom + lower.top - lower.bottom == pytest.approx(0.17 * risers)


@pytest.mark.parametrize(
    ("riser", "tread", "along_slope"),
    [(7.5, 10.0, 1.00), (7.0, 11.0, 1.08), (6.5, 12.0, 1.16), (6.5, 13.0, 1.23)],
)
def test_speeds_are_those_of_the_sfpe_handbook(riser, tread, along_slope):
    """Inches, and m/s along the slope; 1.40 m/s on a level floor."""
    factor = speed_factor(0.0254 * riser, 0.0254 * tread)
    assert factor * 1.40 * math.hypot(riser, tread) / tread == pytest.approx(along_slope, abs=0.015)


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: straight(risers=1), "expected 2 to 200 risers, found 1"),
        (lambda: straight(risers=17.0), "risers, found 17.0"),
        (lambda: straight(tread=0.1), r"treads of 0.2 to 0.6 m, found 0.1"),
        (lambda: straight(head=((0, 0), (0.5, 0))), "clear width of 0.6 m or more, found 0.5"),
        (lambda: straight(head=((0, 0),)), r"head must be two points \(x, y\)"),
        (lambda: straight(head=((0, 0), (0, 0))), "no length"),
        (lambda: dog_leg(turn="up"), "turn to the 'left' or 'right', found 'up'"),
        (lambda: dog_leg(well=0.0), "between its flights, found 0.0"),
        (lambda: dog_leg(landing=0.1), "a landing 0.6 to 10 m deep, found 0.1"),
        (lambda: straight(handrails="up"), "handrails both, left, right, none, found 'up'"),
        (lambda: Stairs("s", 1, 0, ((0, 0), (1, 0)), 18, shape="spiral"), "found 'spiral'"),
        (lambda: straight().parts(6.0, 0.0), "18 risers for a rise of 6 m are 0.333 m each"),
        (lambda: straight().parts(0.0, 3.0), "0.10 to 0.22 m"),
        (lambda: Level(1.5, "POINT (0 0)"), "level 1.5: expected a whole number"),
        (lambda: Level(2, "POINT (0 0)"), "level 2: walkable area must be a Polygon"),
        (lambda: Level(2, "POLYGON ((0 0, 1 0, 1 1, 0 0))", float("nan")), "level 2: elevation"),
    ],
)
def test_what_is_wrong_is_said_in_one_line(make, said):
    with pytest.raises(FloorPlanError, match=said) as error:
        make()
    assert "\n" not in str(error.value)


def test_handrails_are_those_of_every_flight_and_narrow_none():
    for make in (straight, dog_leg, lambda **more: of_flights(["left", "on"], **more)):
        both, left = make().parts(3.06, 0.0)[0], make(handrails="left").parts(3.06, 0.0)[0]
        assert {each.handrails for each in both} == {"both"}
        assert {each.handrails for each in left} == {"left"}
        assert [each.width for each in left] == pytest.approx([1.2] * len(left))
        assert [(each.head, each.going) for each in left] == [(e.head, e.going) for e in both]


def test_the_highest_riser_is_accepted_however_its_height_is_rounded():
    assert 8.8 / 40 > 0.22
    stairs = Stairs.straight("steep", 1, 0, head=((0, 2), (0, 0)), risers=40, tread=0.25)
    flights, _ = stairs.parts(8.8, 0.0)
    assert flights[0].going == pytest.approx(39 * 0.25)
