"""Keeping some room to walls."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from mesa_mobility.behaviors import WallDistance
from shapely import LineString, Point

from mesa_mobility.errors import ModelError
from tests.fixtures.options import Chooser, Ending, candidates

WALL = (0.0, 0.0, 4.0, 0.0)


def cost(point, *walls, core=0.15, within=0.5) -> float:
    chooser = Chooser([Ending(point)], position=(2.0, 2.0), core=core, walls=walls)
    return float(WallDistance(within=within).cost(candidates(chooser))[0])


@pytest.mark.parametrize(
    ("point", "expected"),
    [
        ((2.0, 0.5), 0.0),
        ((2.0, 0.25), 0.5),
        ((2.0, 0.15), 0.7),
        ((2.0, -0.25), 0.5),
        # Beside the end of the wall: 0.25 m away by 0.2 m and 0.15 m.
        ((4.2, 0.15), 0.5),
        ((9.0, 0.0), 0.0),
    ],
)
def test_what_an_option_costs(point, expected):
    assert cost(point, WALL) == pytest.approx(expected, abs=1e-12)


def test_wide_bodies_come_as_near_with_their_middle():
    assert cost((2.0, 0.4), WALL, core=0.35) == cost((2.0, 0.4), WALL) == pytest.approx(0.2)


def test_the_nearest_wall_counts_alone():
    assert cost((2.0, 0.25), WALL, (2.3, -1.0, 2.3, 1.0)) == pytest.approx(0.5)


def test_without_walls_nothing_costs():
    assert cost((2.0, 0.2)) == 0.0


near = st.floats(-1.0, 1.0)


@given(near, near, near, near, near, near)
@settings(max_examples=100, deadline=None)
def test_the_distance_is_shapelys(x, y, x1, y1, x2, y2):
    assume(np.hypot(x2 - x1, y2 - y1) > 1e-6)
    away = LineString([(x1, y1), (x2, y2)]).distance(Point(x, y))
    expected = max(1.0 - away / 0.5, 0.0)
    found = cost((x, y), (x1, y1, x2, y2))
    np.testing.assert_allclose(found, expected, atol=1e-6)


def test_a_width_of_nothing_is_refused():
    with pytest.raises(ModelError, match="wall_distance: within"):
        WallDistance(within=0.0)
