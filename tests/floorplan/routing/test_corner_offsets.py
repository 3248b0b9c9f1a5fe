"""Passing a corner side by side."""

from math import hypot

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import LineString, Polygon, box

from mesa_mobility import Building, Level, Stairs
from mesa_mobility.floorplan import Exit, FloorPlan, Router, Targets, line_of_sight

# Two halls at a right angle, 20 m wide both. Round their corner, (20, 20), the way on leads to the
# right: what is behind it is in view from below y = 19.8, where the route bends.
HALLS = FloorPlan(
    Polygon([(0, 0), (40, 0), (40, 20), (20, 20), (20, 50), (0, 50)]),
    exits=[Exit("end", (40, 0), (40, 20))],
)
BEND = (19.8, 19.8)
DOOR = FloorPlan(
    box(0, 0, 20, 10).union(box(20, 4.5, 20.2, 5.5)).union(box(20.2, 0, 30, 10)),
    exits=[Exit("far", (30, 0), (30, 10))],
)


def aims(plan: FloorPlan, place: tuple[float, float], area: float):
    """The point aimed at alone, and with so much area taken by those before."""
    router = Router(plan)
    places = np.array([place])
    targets = router.targets(places, [0])
    return targets.points[0], router.abreast(places, targets, np.array([area]))[0]


def passes_at(place, point) -> float:
    """x where the way to a point crosses the height of the bend."""
    share = (place[1] - BEND[1]) / (place[1] - point[1])
    return place[0] + share * (point[0] - place[0])


@pytest.mark.parametrize(
    ("place", "area", "out"),
    [
        # 16 m2 over the 8 m to the corner are 2 m; over 4 m they are 4 m.
        ((15.0, 19.8 + (8.0**2 - 4.8**2) ** 0.5), 16.0, 2.0),
        ((17.6, 19.8 + (4.0**2 - 2.2**2) ** 0.5), 6.4, 1.6),
        # Nobody goes farther out than it is: straight down from 2.2 m.
        ((17.6, 19.8 + (4.0**2 - 2.2**2) ** 0.5), 16.0, 2.2),
        # Nor into the wall on the other side, but for a body's breadth.
        ((0.3, 30.0), 1e6, 19.5),
    ],
)
def test_those_behind_pass_farther_out(place, area, out):
    _, point = aims(HALLS, place, area)
    assert point[1] < BEND[1]
    assert passes_at(place, point) == pytest.approx(BEND[0] - out, abs=0.02)


@pytest.mark.parametrize(
    ("low", "out"), [(0.0, 19.8), (5.0, 9.8), (8.0, 3.8), (10.0, 0.0), (15.0, 0.0)]
)
def test_they_spread_as_far_as_the_way_on_is_as_wide_as_the_way_there(low, out):
    # The way on is 20 - low wide, the way there 20 m: as much as it is narrower, they have less.
    plan = FloorPlan(
        Polygon([(0, 0), (20, 0), (20, low), (40, low), (40, 20), (20, 20), (20, 50), (0, 50)]),
        exits=[Exit("end", (40, low), (40, 20))],
    )
    place = (5.0, 26.0)
    alone, point = aims(plan, place, 1e6)
    if out:
        assert passes_at(place, point) == pytest.approx(max(BEND[0] - out, place[0]), abs=0.3)
    else:
        assert point.tolist() == alone.tolist()


def test_whatever_the_arrays_are_made_of():
    router = Router(HALLS)
    places = np.array([[15.0, 26.0], [17.0, 23.0], [10.0, 30.0]])
    found = router.targets(places, [0, 0, 0])
    areas = np.array([3.0, 16.0, 40.0])
    expected = router.abreast(places, found, areas)
    corners = np.repeat(found.corners, 2, axis=0).astype(np.int32)[::2]
    points = found.points.copy(order="F")
    other = Targets(points, found.gates, found.distances, corners)
    assert not places.copy(order="F").flags.c_contiguous
    assert (router.abreast(places.copy(order="F"), other, areas.astype(int)) == expected).all()
    assert (points == found.points).all()
    assert (expected != found.points).any(axis=1).all()


@pytest.mark.parametrize("place", [(15.0, 26.0), (3.0, 45.0), (19.0, 21.0)])
def test_the_first_person_cuts_the_corner(place):
    alone, point = aims(HALLS, place, 0.0)
    assert point.tolist() == alone.tolist()
    # By the corner, or straight for the exit that is in view past it.
    assert LineString([place, alone]).distance(LineString([BEND, BEND])) < 0.3


@pytest.mark.parametrize("place", [(10.0, 15.0), (25.0, 10.0), (35.0, 19.0)])
def test_who_has_no_corner_to_pass_goes_on(place):
    alone, point = aims(HALLS, place, 100.0)
    assert point.tolist() == alone.tolist()


@pytest.mark.parametrize("place", [(19.0, 8.0), (15.0, 1.0), (19.7, 6.5), (12.0, 9.0)])
@pytest.mark.parametrize("area", [0.5, 5.0, 500.0])
def test_a_door_is_waited_for_where_it_is(place, area):
    alone, point = aims(DOOR, place, area)
    assert point.tolist() == alone.tolist()


# An area that vanishes when it is divided by a distance counts as none, and nobody passes abreast.
@given(
    x=st.floats(0.5, 19.5),
    y=st.floats(20.5, 49.5),
    area=st.floats(0.0, 500.0, allow_subnormal=False),
)
@settings(deadline=None, max_examples=60)
def test_what_is_aimed_at_is_in_view_and_the_more_the_farther_out(x, y, area):
    near, far = (aims(HALLS, (x, y), a)[1] for a in (area, 2.0 * area))
    for point in (near, far):
        assert line_of_sight(HALLS, (x, y), point)
    if near[1] < BEND[1] and far[1] < BEND[1]:
        assert passes_at((x, y), far) <= passes_at((x, y), near) + 1e-9
    assert hypot(near[0] - x, near[1] - y) > 0.0


# The lower flight of a landing of 1.5 m leads to the left below y = 1.2, and the newel ends at
# (0, 1.2). Routes that keep 0.2 m from walls bend at (0.2, 1.0).
LANDING = box(0.0, 0.0, 1.5, 2.6)
STOREYS = Building(
    [
        Level(0, box(0, 0, 3, 2.6), exits=[Exit("out", (3, 0), (3, 2.6))]),
        Level(1, LANDING, 3.06),
        Level(2, LANDING, 6.12),
    ],
    [
        Stairs.dog_leg(
            f"stair {k}", k, k - 1, ((0, 0), (0, 1.2)), risers=18, tread=0.29, turn="right"
        )
        for k in (1, 2)
    ],
)


@pytest.mark.parametrize(
    ("area", "out"),
    # 0.6 m2 over the 1.5 m to the corner are 0.4 m. The flight is 1 m wide from the corner on.
    [(0.3, 0.2), (0.6, 0.4), (1e6, 1.0)],
)
def test_those_who_see_a_flight_from_its_landing_pass_the_newel_abreast(area, out):
    plan = STOREYS.floor_plan
    places = STOREYS.places([(1.4, 1.9)], level=1)
    origin = STOREYS.places([(0.0, 0.0)], level=1)[0]
    router = Router(plan)
    targets = router.targets(places, [0])
    assert router.nodes.xy[targets.corners[0, 0]] - origin == pytest.approx([0.2, 1.0], abs=0.01)
    x, y = router.abreast(places, targets, np.array([area]))[0] - origin
    at = 1.4 + (1.9 - 1.0) / (1.9 - y) * (x - 1.4)
    assert y < 1.0
    # Up to a body's breadth of the wall.
    assert at == pytest.approx(0.2 + out, abs=0.02 if out < 1.0 else 0.2)


def test_those_whose_way_passes_no_newel_keep_it():
    # Straight along the lower flight, 0.7 m from the newel.
    places = STOREYS.places([(1.2, 0.4)], level=1)
    router = Router(STOREYS.floor_plan)
    targets = router.targets(places, [0])
    assert targets.corners[0, 0] == -1
    assert router.abreast(places, targets, np.array([9.0])).tolist() == targets.points.tolist()


def test_round_the_end_of_a_wall_in_a_corridor_nobody_spreads():
    # The same landing in one plane: corridors of 1.2 m do not count as wide.
    plan = FloorPlan(
        LANDING.union(box(-4, 0, 0, 1.2)).union(box(-4, 1.4, 0, 2.6)),
        exits=[Exit("end", (-4, 0), (-4, 1.2))],
    )
    alone, point = aims(plan, (1.0, 2.2), 9.0)
    assert point.tolist() == alone.tolist()
