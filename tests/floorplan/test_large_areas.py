"""Memory and cells go by people and walls, not by area."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numba import njit
from shapely import box

from mesa_mobility import Exit, FloorPlan, PedestrianModel, Trajectories
from mesa_mobility.crowd.planning.grid import people_within
from mesa_mobility.crowd.state import people_grid as neighbours
from mesa_mobility.crowd.state.people_grid import build_grid
from mesa_mobility.floorplan import WallIndex
from mesa_mobility.floorplan.floor import wall_index as walls
from mesa_mobility.results import check_safety
from tests.fixtures.maps import strider


@njit
def _within(grid, x, y, but, radius, found):
    return people_within(grid, x, y, but, radius, found)


PLACES = np.array([(20.0, 20.0), (9_980.0, 20.0), (20.0, 9_980.0), (9_980.0, 9_980.0)])


def test_the_grids_of_a_plan_of_100_square_kilometres_are_small():
    plan = FloorPlan(box(0, 0, 10_000, 10_000), exits=[Exit("out", (10_000, 15), (10_000, 25))])
    table = plan.wall_index.cell_table(1.0, 6.0)
    assert table.nx * table.ny <= walls.MOST_CELLS
    assert len(table.indices) < 100_000
    grid = build_grid(np.arange(4), *PLACES.T.copy())
    assert grid.nx * grid.ny <= neighbours.MOST_CELLS
    model = PedestrianModel(plan, mobility_map=strider(), record=True, rng=1)
    around = model._scene.environment.surroundings
    assert around.nx * around.ny <= walls.MOST_CELLS
    model.add_pedestrians(PLACES, preferred_speeds=1.25)
    model.run(max_seconds=20)
    # 20 m at 1.25 m/s: the one at the exit is through it.
    assert model.inside == 3
    assert check_safety(Trajectories.of(model), plan.walls, plan.free).passed


def test_in_small_areas_cells_have_the_size_that_was_asked_for():
    table = WallIndex([[0, 0, 100, 0], [0, 100, 100, 100]]).cell_table(1.0, 1.0)
    assert (table.cell_size, table.nx, table.ny) == (1.0, 103, 103)
    grid = build_grid(np.arange(2), np.array([0.0, 300.0]), np.array([0.0, 300.0]))
    assert (grid.size, grid.nx, grid.ny) == (1.5, 201, 201)


@settings(deadline=None, max_examples=40)
@given(st.integers(0, 2**31), st.sampled_from([30.0, 900.0, 20_000.0]), st.floats(1.0, 8.0))
def test_neighbours_are_those_within_the_radius_however_large_cells_are(seed, side, radius):
    rng = np.random.default_rng(seed)
    middle = rng.uniform(0, side, (8, 2))
    xy = np.concatenate([middle, *(middle + rng.normal(0, 3, (8, 2)) for _ in range(4))])
    grid = build_grid(np.arange(len(xy)), *xy.T.copy())
    found = np.empty(len(xy), dtype=np.int64)
    for i, (x, y) in enumerate(xy):
        count = _within(grid, x, y, i, radius, found)
        near = set(np.flatnonzero(np.hypot(*(xy - (x, y)).T) <= radius).tolist()) - {i}
        assert set(grid.people[found[:count]].tolist()) == near


@settings(deadline=None, max_examples=20)
@given(st.integers(0, 2**31), st.sampled_from([50.0, 5_000.0, 20_000.0]))
def test_walls_within_reach_are_listed_however_large_cells_are(seed, side):
    rng = np.random.default_rng(seed)
    start = rng.uniform(0, side, (30, 2))
    rows = np.concatenate([start, start + rng.normal(0, 4, (30, 2))], axis=1)
    table = WallIndex(rows).cell_table(1.0, 5.0)
    assert table.nx * table.ny <= walls.MOST_CELLS
    for x, y in start[:10] + rng.normal(0, 3, (10, 2)):
        column = int((x - table.x0) // table.cell_size)
        row = int((y - table.y0) // table.cell_size)
        if not (0 <= column < table.nx and 0 <= row < table.ny):
            continue
        cell = row * table.nx + column
        listed = set(table.indices[table.offsets[cell] : table.offsets[cell + 1]].tolist())
        away = rows[:, 2:] - rows[:, :2]
        share = ((np.array([x, y]) - rows[:, :2]) * away).sum(axis=1) / (away**2).sum(axis=1)
        nearest = rows[:, :2] + np.clip(share, 0, 1)[:, None] * away
        within = np.flatnonzero(np.hypot(*(nearest - (x, y)).T) <= 5.0)
        assert set(within.tolist()) <= listed


@pytest.mark.parametrize("side", [50.0, 10_000.0])
def test_steps_through_walls_are_counted_on_floors_of_any_size(side):
    track = np.column_stack([np.linspace(9.0, 11.0, 21), np.full(21, 10.0)])
    run = Trajectories(
        frame=np.arange(21),
        person=np.zeros(21, np.int32),
        x=track[:, 0],
        y=track[:, 1],
        heading=np.zeros(21),
    )
    edge = [[0, 0, side, 0], [side, 0, side, side], [side, side, 0, side], [0, side, 0, 0]]
    assert check_safety(run, edge).wall_crossings == 0
    assert check_safety(run, [*edge, [10.05, 5, 10.05, 15]]).wall_crossings == 1
