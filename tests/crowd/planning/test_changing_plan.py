"""Obstacles that come and go, and doors that close and open, while people walk."""

from contextlib import suppress

import numpy as np
import pytest
import shapely
from mesa_mobility.behaviors import Displacement
from shapely import box

from mesa_mobility.errors import FloorPlanError, ModelError
from tests.fixtures.maps import shipped_map, strider
from tests.fixtures.oracles.counting import crossings, during, overlaps, track, wall_crossings
from tests.fixtures.scenes import advance, core_of, corridor, dead_end, model_of, put, two_doors


def test_an_obstacle_is_seen_by_the_next_decision(in_parts):
    model = model_of(corridor(), strider(), behaviors=[Displacement()], preset=in_parts)
    person = put(model, 1.0, 2.0)
    advance(model, 20)
    model.floor_plan.add_obstacle(box(3.5, 1.0, 4.0, 3.0))
    advance(model, 25)
    assert person.position[0] == pytest.approx(2.875, abs=1e-6)
    advance(model, 12)
    # 0.625 m of floor ahead: half a metre and no room for the core, so half of it.
    assert person.position[0] == pytest.approx(3.125, abs=1e-6)


def test_an_obstacle_taken_away_is_not_in_the_way_any_more():
    model = model_of(corridor(), strider(), behaviors=[Displacement()])
    obstacle = model.floor_plan.add_obstacle(box(3.0, 1.0, 3.5, 3.0))
    person = put(model, 1.0, 2.0)
    advance(model, 24)
    assert person.position[0] == pytest.approx(2.0, abs=1e-6)
    model.floor_plan.remove_obstacle(obstacle)
    advance(model, 45)
    assert person.position[0] == pytest.approx(3.875, abs=1e-6)


def test_people_walk_round_an_obstacle_put_down_in_a_run():
    model = model_of(corridor(length=25.0), shipped_map(), rng=3, frames_per_step=3)
    rng = np.random.default_rng(3)
    first = model.floor_plan.random_points(
        15, rng, within=box(0, 0, 6, 4), spacing=0.6, clearance=0.3
    )
    model.add_pedestrians(first)
    advance(model, 30)
    barrier = box(14.0, 0.0, 14.5, 2.5)
    model.floor_plan.add_obstacle(barrier)
    model.run(max_seconds=60)
    assert model.inside == 0
    rows = model.recorder.arrays()
    points = shapely.points(rows["x"], rows["y"])
    assert not shapely.intersects(barrier.buffer(core_of(model) - 0.001), points).any()
    assert wall_crossings(rows, model.floor_plan.walls) == 0
    assert overlaps(rows, core_of(model)) == 0


def test_a_closed_exit_sends_people_to_the_other():
    model = model_of(two_doors(), shipped_map(), rng=4, frames_per_step=3)
    model.add_pedestrians([(5.0, 4.0), (4.5, 6.0)])
    advance(model, 15)
    model.floor_plan.close_gate("right")
    model.run(max_seconds=60)
    assert model.inside == 0
    rows = model.recorder.arrays()
    left, right = (model.floor_plan.gate(name) for name in ("left", "right"))
    assert set(crossings(rows, left.a, left.b).values()) == {1}
    assert set(crossings(rows, right.a, right.b).values()) == {0}


def test_a_closed_exit_is_a_wall():
    model = model_of(corridor(both_ends=True), strider(), behaviors=[Displacement()])
    model.floor_plan.close_gate("east")
    person = put(model, 18.8, 2.0)
    advance(model, 45)
    assert person.position[0] == pytest.approx(19.8, abs=1e-6)
    model.floor_plan.open_gate("east")
    advance(model, 24)
    assert model.inside == 0


def test_with_every_exit_closed_people_stay_and_leave_once_one_opens():
    model = model_of(dead_end(x=8.0, depth=8.0), shipped_map(), rng=6, frames_per_step=3)
    model.floor_plan.close_gate("west")
    model.add_pedestrians([(4.0, 1.0), (5.0, 2.0), (3.0, 3.0)])
    advance(model, 150)
    assert model.inside == 3
    model.floor_plan.open_gate("west")
    model.run(max_seconds=40)
    assert model.inside == 0
    rows = model.recorder.arrays()
    assert overlaps(rows, core_of(model)) == 0
    assert np.isfinite(track(rows, 0)).all()


@pytest.mark.thorough
@pytest.mark.parametrize("seed", range(3))
def test_whatever_comes_and_goes_nobody_is_run_into_or_walked_through(seed):
    rng = np.random.default_rng(seed)
    model = model_of(two_doors(), shipped_map(), rng=seed, frames_per_step=3)
    plan, core = model.floor_plan, core_of(model)
    model.add_pedestrians(plan.random_points(15, rng, spacing=0.6, clearance=0.3))
    standing, built, come, intervals = [], 0, 0, []
    for _ in range(60):
        where = np.array([person.position for person in model.agents]).reshape(-1, 2)
        low = rng.uniform(0.5, 7.0, 2)
        block = box(*low, *(low + rng.uniform(0.2, 0.8, 2)))
        room = shapely.distance(block, shapely.points(where)) > core + 0.01
        if standing and rng.random() < 0.4:
            plan.remove_obstacle(standing.pop(0))
        elif room.all() and block.distance(plan.walkable.exterior) > 0.4:
            try:
                standing.append(plan.add_obstacle(block))
                built += 1
            except FloorPlanError:  # it would have cut off a corner
                continue
        door = ("left", "right")[int(rng.integers(2))]
        (plan.open_gate if rng.random() < 0.7 else plan.close_gate)(door)
        # Refused where somebody is or will be, or where there is no floor.
        with suppress(ModelError, FloorPlanError):
            come += len(model.add_pedestrians([rng.uniform(0.4, 7.6, 2)]))
        start = model.frame
        advance(model, int(rng.integers(1, 6)) * 3)
        intervals.append((start, model.frame, plan.walls))
    assert built > 15
    assert come > 15
    rows = model.recorder.arrays()
    assert overlaps(rows, core, tolerance=1e-5) == 0
    for first, last, walls in intervals:
        part = during(rows, first, last, plan, core)
        assert wall_crossings(part, walls) == 0, (first, last)
