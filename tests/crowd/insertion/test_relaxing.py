"""Places moved apart until bodies have room."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.distance import pdist
from shapely import LineString, Point, box

from mesa_mobility import Exit, FloorPlan
from mesa_mobility.crowd.insertion.relaxing import MARGIN, relaxed

ROOM = FloorPlan(
    box(0, 0, 4, 3), exits=[Exit("door", (4, 1), (4, 2))], obstacles=[box(1.5, 1.0, 2.5, 2.0)]
)


def test_two_bodies_part_by_half_of_their_overlap_each():
    moved = relaxed(np.array([[0.6, 0.5], [0.8, 0.5]]), np.full(2, 0.15), ROOM)
    np.testing.assert_allclose(moved, [[0.55, 0.5], [0.85, 0.5]], atol=MARGIN)
    assert moved[1, 0] - moved[0, 0] >= 0.3


def test_bodies_leave_walls_by_the_nearest_way():
    moved = relaxed(np.array([[0.05, 1.0], [1.4, 1.5]]), np.full(2, 0.2), ROOM)
    np.testing.assert_allclose(moved, [[0.2, 1.0], [1.3, 1.5]], atol=3 * MARGIN)
    np.testing.assert_array_less(0.2, moved[0, 0])


def test_people_on_an_exit_stay_there():
    places = np.array([[3.99, 1.5]])
    np.testing.assert_array_equal(relaxed(places, np.array([0.2]), ROOM), places)


@pytest.mark.parametrize("apart", [0.0, 1e-16, 1e-10])
def test_two_at_the_same_place_part(apart):
    moved = relaxed(np.array([[0.5, 0.5], [0.5, 0.5 + apart]]), np.full(2, 0.15), ROOM)
    assert np.linalg.norm(moved[0] - moved[1]) >= 0.3
    assert np.linalg.norm(moved.mean(axis=0) - 0.5) < 1e-9


def test_two_a_denormal_number_apart_part():
    moved = relaxed(np.array([[0.0, 0.0], [0.0, 5e-324]]), np.full(2, 0.12), ROOM)
    assert np.linalg.norm(moved[0] - moved[1]) >= 0.24


def test_bodies_that_need_not_be_apart_only_leave_walls():
    places = np.array([[0.5, 0.5], [0.6, 0.5]])
    np.testing.assert_array_equal(relaxed(places, np.full(2, 0.2), ROOM, apart=False), places)


@settings(max_examples=40)
@given(
    places=st.lists(st.tuples(st.floats(0.0, 4.0), st.floats(0.0, 3.0)), min_size=1, max_size=20),
    radii=st.lists(st.sampled_from([0.12, 0.15, 0.2]), min_size=20, max_size=20),
)
def test_bodies_have_room_afterwards_and_those_with_room_before_stay(places, radii):
    points, own = np.array(places), np.array(radii[: len(places)])
    moved = relaxed(points, own, ROOM)
    # Walls by shapely alone: the outline and the pillar, less the door.
    walls = ROOM.free.boundary.difference(LineString([(4, 1), (4, 2)]))
    away = np.array([walls.distance(Point(place)) for place in moved])
    assert (away >= own - 1e-9).all()
    assert all(ROOM.free.covers(Point(place)) for place in moved)
    one, other = np.triu_indices(len(own), 1)
    assert (pdist(moved) >= own[one] + own[other] - 1e-9).all()
    np.testing.assert_array_equal(relaxed(moved, own, ROOM), moved)


def test_more_bodies_than_there_is_room_for_are_left_overlapping():
    places = np.random.default_rng(1).uniform((0, 0), (1.0, 1.0), (60, 2))
    small = FloorPlan(box(0, 0, 1, 1), exits=[Exit("door", (1, 0.4), (1, 0.6))])
    assert pdist(relaxed(places, np.full(60, 0.15), small)).min() < 0.3 - 1e-3


@pytest.mark.parametrize("apart", [True, False])
def test_nobody_is_nowhere(apart):
    assert relaxed(np.empty((0, 2)), np.empty(0), ROOM, apart=apart).shape == (0, 2)
