"""Where people are in the grid, and what is kept of them in its order."""

import numpy as np
import pytest
from numba import njit

from mesa_mobility.crowd.planning.grid import (
    COVERED,
    Nearby,
    cover_in,
    headways,
    neighbours_within,
    place_in,
)
from mesa_mobility.crowd.state.people_grid import build_grid
from mesa_mobility.crowd.state.records import Crowd


@njit
def _place(grid, x, y, who):
    return place_in(grid, x, y, who)


@njit
def _cover(moving, at, i, state):
    cover_in(moving, at, i, state)


@njit
def _within(grid, moving, x, y, own, radius, range_, near, sweeps, interacting, others):
    to = Nearby(near, sweeps, interacting, others)
    return neighbours_within(grid, moving, x, y, own, radius, range_, to)


@pytest.fixture
def crowd():
    rng = np.random.default_rng(2)
    crowd = Crowd(50)
    crowd.x[:], crowd.y[:] = rng.uniform(-4.0, 9.0, (2, 50))
    least = rng.uniform(0.0, 1.0, (50, 2))
    crowd.box[:] = np.hstack([least, least + np.array([0.6, 0.8])])
    crowd.core[:] = 0.25
    crowd.vx[:], crowd.vy[:] = rng.uniform(-1.0, 1.0, (2, 50))
    crowd.target_x[:], crowd.target_y[:] = crowd.x + 3.0, crowd.y + 4.0
    return crowd


def test_everybody_is_found_in_the_grid(crowd):
    active = np.arange(0, 50, 2)
    grid = build_grid(active, crowd.x, crowd.y)
    for i in active:
        assert grid.people[_place(grid, crowd.x[i], crowd.y[i], i)] == i


def test_what_is_kept_of_people_is_in_the_order_of_the_grid(crowd):
    grid = build_grid(np.arange(50), crowd.x, crowd.y)
    kept = headways(grid, crowd.records)
    people = grid.people
    assert (kept[:2] == [crowd.vx[people], crowd.vy[people]]).all()
    assert kept[2] == pytest.approx(np.full(50, 0.6))
    assert kept[3] == pytest.approx(np.full(50, 0.8))
    assert kept[COVERED] == pytest.approx(crowd.box[people, 0] + 0.3)
    assert kept[COVERED + 1] == pytest.approx(crowd.box[people, 1] + 0.4)
    assert kept[COVERED + 2] == pytest.approx(np.full(50, 0.75))


def test_what_somebody_covers_is_kept_up_to_date(crowd):
    grid = build_grid(np.arange(50), crowd.x, crowd.y)
    kept = headways(grid, crowd.records)
    before = kept.copy()
    crowd.box[7] = 0.7, 1.6, 1.3, 2.4
    at = int(np.flatnonzero(grid.people == 7)[0])
    _cover(kept, at, 7, crowd.records)
    assert kept[COVERED:, at] == pytest.approx([1.0, 2.0, 0.75])
    before[COVERED:, at] = kept[COVERED:, at]
    assert (kept == before).all()


@pytest.mark.parametrize(("radius", "range_"), [(0.5, 0.5), (3.0, 2.0), (30.0, 4.0)])
def test_neighbours_are_copied_in_the_order_of_the_grid(crowd, radius, range_):
    grid = build_grid(np.arange(50), crowd.x, crowd.y)
    kept = headways(grid, crowd.records)
    near, interacting = np.zeros((2, 58), dtype=np.int64)
    others, sweeps = np.zeros((8, 58)), np.zeros((3, 58))
    for i in range(0, 50, 7):
        own = int(np.flatnonzero(grid.people == i)[0])
        found, count = _within(
            grid, kept, crowd.x[i], crowd.y[i], own, radius, range_, near, sweeps, interacting,
            others,
        )  # fmt: skip
        away = np.hypot(grid.x - crowd.x[i], grid.y - crowd.y[i])
        expected = np.flatnonzero((away <= radius) & (grid.people != i))
        assert near[:found].tolist() == grid.people[expected].tolist()
        assert (sweeps[:, :found] == kept[COVERED:, expected]).all()
        expected = np.flatnonzero((away <= range_) & (grid.people != i))
        assert interacting[:count].tolist() == grid.people[expected].tolist()
        assert (others[:2, :count] == [grid.x[expected], grid.y[expected]]).all()
        assert (others[2 : 2 + COVERED, :count] == kept[:COVERED, expected]).all()
