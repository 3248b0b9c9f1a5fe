"""Passages too narrow for two people."""

import numpy as np
import pytest
from shapely import Polygon, box

from mesa_mobility import Exit, FloorPlan
from mesa_mobility.floorplan.routing.passages import narrow_mouths, narrow_passages
from tests.fixtures.scenes import two_rooms


@pytest.mark.parametrize(("width", "depth"), [(1.0, 0.2), (0.7, 10.0), (1.2, 3.0)])
def test_a_passage_between_two_rooms_has_a_mouth_at_each_end(width, depth):
    found = narrow_passages(two_rooms(width, depth))
    low, high = 4.0 - width / 2, 4.0 + width / 2
    assert found.first_mouth.tolist() == [0, 2]
    assert sorted(map(tuple, found.mouths.round(6).tolist())) == [
        (10.0, pytest.approx(low), 10.0, pytest.approx(high), 1.0, 0.0),
        (10.0 + depth, pytest.approx(low), 10.0 + depth, pytest.approx(high), -1.0, 0.0),
    ]
    assert Polygon(found.outline).area == pytest.approx(width * depth)


def test_a_passage_with_room_for_two_is_none():
    assert len(narrow_passages(two_rooms(1.3, 0.2)).mouths) == 0


def test_a_way_to_an_exit_is_none():
    floor = box(0, 0, 8, 8).union(box(8, 3.5, 12, 4.5))
    plan = FloorPlan(floor, exits=[Exit("east", (12, 3.5), (12, 4.5))])
    assert len(narrow_passages(plan).mouths) == 0


def test_a_passage_round_a_bend_is_one():
    hook = Polygon([(8, 1), (12, 1), (12, 8), (11, 8), (11, 2), (8, 2)])
    floor = box(0, 0, 8, 4).union(hook).union(box(8.5, 8, 14, 12))
    plan = FloorPlan(floor, exits=[Exit("west", (0, 0), (0, 4)), Exit("up", (9, 12), (13, 12))])
    found = narrow_passages(plan)
    assert found.first_mouth.tolist() == [0, 2]
    middles = (found.mouths[:, :2] + found.mouths[:, 2:4]) / 2
    assert sorted(map(tuple, middles.tolist())) == [(8.0, 1.5), (11.5, 8.0)]
    assert np.allclose(np.hypot(*found.mouths[:, 4:].T), 1.0)


def test_mouths_of_passages_and_of_exits():
    """Both sides of a door; an exit in a wall; not one as wide as asked for."""
    found = narrow_mouths(two_rooms(0.9, 0.2), 1.4)
    assert sorted(map(tuple, found[:, 4:].round(6).tolist())) == [(-1.0, 0.0), (1.0, 0.0)]
    plan = FloorPlan(
        box(0.0, 0.0, 8.0, 8.0),
        exits=[Exit("right", (8.0, 5.0), (8.0, 6.2)), Exit("below", (2.0, 0.0), (3.4, 0.0))],
    )
    assert narrow_mouths(plan, 1.4).tolist() == [[8.0, 5.0, 8.0, 6.2, 1.0, 0.0]]
    assert narrow_mouths(plan, 1.2).shape == (0, 6)
    plan.close_gate("right")
    assert narrow_mouths(plan, 1.4).shape == (0, 6)
