"""Routes to places: lengths and targets against geometry."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mesa_mobility import FloorPlan, Gate
from mesa_mobility.floorplan import lines_of_sight
from mesa_mobility.live.point_routes import PointRoutes

CLEARANCE = 0.2


def walled():
    """A room with a wall 6 m high and 0.2 m thick in its middle, and a gate above it."""
    return FloorPlan(
        "POLYGON ((0 0, 10 0, 10 8, 0 8, 0 0))",
        gates=[Gate("gap", (5, 6), (5, 8)), Gate("other", (1, 7), (1, 8))],
        obstacles=["POLYGON ((4.9 0, 5.1 0, 5.1 6, 4.9 6, 4.9 0))"],
    )


def from_one(routes, start, place):
    aims = routes.targets(np.array([start], dtype=float), place)
    return aims.points[0].tolist(), float(aims.lengths[0])


def test_the_way_round_a_wall_is_by_its_corners():
    target, length = from_one(PointRoutes(walled(), CLEARANCE), (2.0, 1.0), (8.0, 1.0))
    # Corner to corner it is as long as can be; routes keep 0.2 m from the corners.
    tight = 2 * math.hypot(2.9, 5.0) + 0.2
    assert tight < length < tight + 4 * CLEARANCE
    assert target[1] > 6.0


def test_a_place_in_view_is_the_target():
    target, length = from_one(PointRoutes(walled(), CLEARANCE), (1.0, 1.0), (4.0, 5.0))
    assert target == [4.0, 5.0]
    assert length == pytest.approx(5.0)


def test_a_closed_gate_leaves_no_way_until_it_opens():
    plan = walled()
    routes = PointRoutes(plan, CLEARANCE)
    before = from_one(routes, (2.0, 1.0), (8.0, 1.0))
    plan.close_gate("gap")
    assert from_one(routes, (2.0, 1.0), (8.0, 1.0)) == ([2.0, 1.0], math.inf)
    plan.open_gate("gap")
    assert from_one(routes, (2.0, 1.0), (8.0, 1.0)) == before


def test_a_floor_without_corners_has_straight_ways():
    plan = FloorPlan(
        "POLYGON ((0 0, 4 0, 4 4, 0 4, 0 0))",
        gates=[Gate("a", (1, 0), (1, 4)), Gate("b", (2, 0), (2, 4))],
    )
    assert from_one(PointRoutes(plan, CLEARANCE), (0.5, 0.5), (3.5, 0.5)) == ([3.5, 0.5], 3.0)


INSIDE = st.tuples(st.floats(0.3, 9.7), st.floats(0.3, 7.7)).filter(
    lambda place: abs(place[0] - 5.0) > 0.4
)
ROUTES = PointRoutes(walled(), CLEARANCE)


@given(INSIDE, INSIDE)
def test_ways_are_no_shorter_than_the_air_line_and_alike_both_ways(start, place):
    target, length = from_one(ROUTES, start, place)
    _, back = from_one(ROUTES, place, start)
    assert math.dist(start, place) - 1e-9 <= length < 25.0
    assert back == pytest.approx(length, abs=1e-6)
    assert lines_of_sight(walled(), [start], [target])[0] or target == list(start)
