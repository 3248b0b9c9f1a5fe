"""Walls near a pedestrian: tests of several places at once agree with tests of each."""

import math

import numpy as np
import pytest
from numba import njit

from mesa_mobility.compiled.simd import LANES, SAMPLES, WIDE
from mesa_mobility.crowd.collision.sampled import Decider
from mesa_mobility.crowd.collision.walls import (
    BARRIER_FIELDS,
    drop_beside,
    path_off2,
    places_beside,
    walls_to_ego,
)

ENDS = np.array([[0.5, -1.0, 0.5, 1.0], [-1.0, -0.6, 1.0, -0.6], [-0.4, 0.3, -0.4, 0.3]])
"""A wall across, one along, and one that is a point, in the pedestrian's frame."""


@njit
def _lay(row, x, y, c, s, core, walls, farthest, radius, to):
    return walls_to_ego(Decider(row, 0, x, y, c, s, core, walls[0]), walls, farthest, radius, to)


@njit
def _drop(circles, at, row, n, barriers, first, size, known, apart, dropped):
    drop_beside(circles, (at, row, n), barriers, (first, size, known), apart, dropped)


@njit
def _beside(places, at, row, barriers, first, size, known, apart):
    return places_beside(places, at, row, barriers, first, size, known, apart)


@njit
def _off2(paths, path, barriers, known):
    return path_off2(paths, path, barriers, known)


@pytest.fixture
def barriers():
    """``ENDS`` as barriers, and room for two more."""
    laid = np.full((BARRIER_FIELDS, len(ENDS) + 2), np.nan, dtype=np.float32)
    ax, ay, bx, by = ENDS.T
    length2 = (bx - ax) ** 2 + (by - ay) ** 2
    inverse = np.divide(1.0, length2, out=np.zeros(len(ENDS)), where=length2 > 0.0)
    laid[:, : len(ENDS)] = ax, ay, bx - ax, by - ay, inverse
    return laid


def off(x, y):
    """Metres from places to the nearest of ``ENDS``, each of which runs along an axis."""
    away = [
        np.hypot(
            np.maximum.reduce([min(ax, bx) - x, x - max(ax, bx), np.zeros_like(x)]),
            np.maximum.reduce([min(ay, by) - y, y - max(ay, by), np.zeros_like(y)]),
        )
        for ax, ay, bx, by in ENDS
    ]
    return np.minimum.reduce(away)


@pytest.fixture
def rng():
    return np.random.default_rng(11)


@pytest.mark.parametrize("n", [1, 16, 37])
def test_circles_within_a_wall_are_dropped(rng, barriers, n):
    circles = rng.uniform(-1.2, 1.2, (3, 60)).astype(np.float32)
    circles[2] = rng.uniform(0.0, 0.15, 60)
    dropped = np.zeros(n + WIDE, dtype=np.int32)
    dropped[:n:7] = 1
    # Those at the second of two levels.
    fences = np.stack([barriers + 0.1, barriers])
    size = barriers.shape[1]
    _drop(circles, 2, 60, n, fences, BARRIER_FIELDS * size, size, len(ENDS), 0.25, dropped)
    x, y, radius = circles[:, 2 : 2 + n].astype(float)
    expected = off(x, y) + radius < 0.25
    expected[::7] = True
    assert dropped[:n].astype(bool).tolist() == expected.tolist()


def test_places_beside_a_wall_are_marked_by_bits(rng, barriers):
    for _ in range(20):
        places = rng.uniform(-1.2, 1.2, (2, 3, LANES)).astype(np.float32)
        size = barriers.shape[1]
        bits = _beside(places, LANES, 3 * LANES, barriers, 0, size, len(ENDS), 0.2)
        expected = off(*places[:, 1].astype(float)) < 0.2
        assert [bool(bits >> lane & 1) for lane in range(LANES)] == expected.tolist()
    assert _beside(places, LANES, 3 * LANES, barriers, 0, size, 0, 0.2) == 0


def test_a_path_is_as_far_from_the_walls_as_its_nearest_sample(rng, barriers):
    paths = rng.uniform(-1.2, 1.2, (20, 3, SAMPLES)).astype(np.float32)
    for path in range(len(paths)):
        expected = off(*paths[path, :2].astype(float)).min()
        assert _off2(paths, path, barriers, len(ENDS)) == pytest.approx(expected**2, abs=1e-6)
    assert _off2(paths, 0, barriers, 0) == math.inf


def test_walls_are_seen_from_where_a_pedestrian_is_and_faces():
    # At (2, 1) and facing +y: +y is ahead, -x is to the left.
    walls = np.array(
        [[0.0, 2.0, 4.0, 2.0, 1.0], [1.9, 0.0, 1.9, 5.0, 0.01], [3.0, 1.5, 3.0, 1.5, 1.25]]
    )
    to = np.zeros((BARRIER_FIELDS, 3), dtype=np.float32)
    assert _lay(0, 2.0, 1.0, 0.0, 1.0, 0.2, walls, 1.5, 0.2, to) == 2
    # The second is touched.
    expected = [[1.0, 0.5], [2.0, -1.0], [0.0, 0.0], [-4.0, 0.0], [1.0 / 16.0, 0.0]]
    assert to[:, :2] == pytest.approx(np.array(expected), abs=1e-6)


def test_of_a_long_wall_what_is_near_is_kept():
    walls = np.array([[-5000.0, 3.0, 5000.0, 3.0, 9.0]])
    to = np.zeros((BARRIER_FIELDS, 1), dtype=np.float32)
    assert _lay(0, 0.0, 0.0, 1.0, 0.0, 0.2, walls, 1.5, 0.2, to) == 1
    # Twice the reach of 1.5 m and one more to either side.
    assert to[:, 0] == pytest.approx([-4.0, 3.0, 8.0, 0.0, 1.0 / 64.0], abs=1e-5)
