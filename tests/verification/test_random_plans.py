"""Random plans: everybody gets out, by an exit of its own, past people and walls."""

import numpy as np
import pytest
import shapely

from mesa_mobility.verification.scenarios.random_plans import (
    NARROWEST,
    SHAPES,
    draw_plan,
    random_run,
)
from tests.fixtures.oracles.counting import off_floor, overlaps, wall_crossings
from tests.fixtures.scenes import core_of

PLANS = [(shape, both_ways) for both_ways in (False, True) for shape in SHAPES]


def walked(seed: int, people: int) -> None:
    """Count by shapely and SciPy what happened on a random plan: nothing must."""
    shape, both_ways = PLANS[seed % len(PLANS)]
    run = random_run(seed, shape=shape, both_ways=both_ways, people=people)
    rows, plan = run.model.recorder.arrays(), run.model.floor_plan
    count = len(np.unique(rows["person"]))
    assert count >= 3
    assert run.model.inside == 0, "frozen"
    assert overlaps(rows, core_of(run.model)) == 0
    assert wall_crossings(rows, plan.walls) == 0
    assert off_floor(rows, plan.free) == 0
    # The last place of each is beyond an exit, by less than the step of a frame.
    lines = shapely.union_all([exit_.line for exit_ in plan.exits])
    order = np.lexsort((rows["frame"], rows["person"]))
    last = order[np.append(np.diff(rows["person"][order]) != 0, True)]
    places = shapely.points(rows["x"][last], rows["y"][last])
    assert len(places) == count
    assert (shapely.distance(places, lines) < 0.15).all(), "lost"


@pytest.mark.thorough
@pytest.mark.parametrize("seed", range(20))
def test_everybody_gets_out_of_a_random_plan(seed):
    walked(seed, 12)


@pytest.mark.parametrize("seed", [1_000_599, 1_000_794])
def test_nobody_starts_where_two_obstacles_leave_no_way(seed):
    walked(seed, 30)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(1000, 1200))
def test_everybody_gets_out_of_200_random_plans(seed):
    walked(seed, 40)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("both_ways", [False, True])
def test_plans_are_what_they_are_called(shape, both_ways):
    areas = []
    for seed in range(5):
        drawn = draw_plan(np.random.default_rng(seed), shape, both_ways=both_ways)
        names = {exit_.name for exit_ in drawn.plan.exits}
        assert names == ({"east", "west"} if both_ways else {"east"})
        assert all(door.length >= NARROWEST for door in drawn.plan.openings())
        assert {exits for _, exits in drawn.starts} == (
            {("east",), ("west",)} if both_ways else {None}
        )
        areas.append(drawn.plan.area)
    assert len(set(areas)) == 5
