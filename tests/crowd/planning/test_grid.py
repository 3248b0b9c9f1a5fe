"""Where people are in the grid, and what is kept of them in its order."""

import numpy as np
import pytest
from numba import njit

from mesa_mobility.crowd.collision.sampled import Decider
from mesa_mobility.crowd.planning.grid import place_in
from mesa_mobility.crowd.planning.neighbours import neighbours_within
from mesa_mobility.crowd.planning.workspace import make_neighbours
from mesa_mobility.crowd.state.clearances import MARGIN
from mesa_mobility.crowd.state.people_grid import COVERED, build_grid, cover_in, grid_of_frame
from mesa_mobility.crowd.state.records import Crowd


@njit
def _place(grid, x, y, who):
    return place_in(grid, x, y, who)


@njit
def _cover(grid, at, i, state):
    cover_in(grid, at, i, state)


@njit
def _within(grid, me, place, radius, counts_within, box, to):
    return neighbours_within(grid, me, place, radius, counts_within, box, to)


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
    grid = grid_of_frame(np.arange(50), crowd.records)
    kept, people = grid.table, grid.people
    assert (kept[:2] == [crowd.x[people], crowd.y[people]]).all()
    assert (kept[2:4] == [crowd.vx[people], crowd.vy[people]]).all()
    assert (kept[:2] == [grid.x, grid.y]).all()
    assert kept[4] == pytest.approx(np.full(50, 0.6))
    assert kept[5] == pytest.approx(np.full(50, 0.8))
    assert kept[COVERED] == pytest.approx(crowd.box[people, 0] + 0.3)
    assert kept[COVERED + 1] == pytest.approx(crowd.box[people, 1] + 0.4)
    assert kept[COVERED + 2] == pytest.approx(np.full(50, 0.75))


def test_what_somebody_covers_is_kept_up_to_date(crowd):
    grid = grid_of_frame(np.arange(50), crowd.records)
    before = grid.table.copy()
    crowd.box[7] = 0.7, 1.6, 1.3, 2.4
    at = int(np.flatnonzero(grid.people == 7)[0])
    _cover(grid, at, 7, crowd.records)
    assert grid.table[COVERED:, at] == pytest.approx([1.0, 2.0, 0.75])
    before[COVERED:, at] = grid.table[COVERED:, at]
    assert (grid.table == before).all()


@pytest.mark.parametrize(("radius", "range_"), [(0.5, 0.5), (3.0, 2.0), (30.0, 4.0)])
def test_neighbours_are_found_in_the_order_of_the_grid(crowd, radius, range_):
    grid = grid_of_frame(np.arange(50), crowd.records)
    x, y, to = grid.x, grid.y, make_neighbours(50, 0, 0)
    c, s, x0, y0, x1, y1 = 0.6, 0.8, -0.5, -1.0, 1.5, 0.75
    for i in range(0, 50, 7):
        px, py = crowd.x[i], crowd.y[i]
        me = Decider(i, 0, px, py, c, s, 0.25, to.own)
        place = int(np.flatnonzero(grid.people == i)[0])
        found, count = _within(grid, me, place, radius, range_, (x0, y0, x1, y1), to)
        away, others = np.hypot(x - px, y - py), grid.people != i
        dx, dy, circle = grid.table[COVERED] - px, grid.table[COVERED + 1] - py, grid.table[9]
        ahead, left = c * dx + s * dy, c * dy - s * dx
        off = np.hypot(ahead - np.clip(ahead, x0, x1), left - np.clip(left, y0, y1))
        reach = off < circle + 0.25 + MARGIN
        expected = np.flatnonzero((away <= radius) & others & reach)
        assert to.near[:found].tolist() == expected.tolist()
        expected = np.flatnonzero((away <= range_) & others)
        assert to.rows[:count].tolist() == grid.people[expected].tolist()
        assert (to.others[:COVERED, :count] == grid.table[:COVERED, expected]).all()
