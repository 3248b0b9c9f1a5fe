"""Exits and gates that close while somebody is in them."""

import numpy as np
import pytest
from shapely import LineString, Point, box

from mesa_mobility import Exit, FloorPlan, Gate, PedestrianType
from mesa_mobility.results import Trajectories, check_safety
from tests.fixtures.maps import shipped_map
from tests.fixtures.scenes import advance, model_of

CORE = 0.14


def room(*gates):
    return FloorPlan(box(0, 0, 10, 6), exits=[Exit("door", (10, 2.5), (10, 3.5))], gates=gates)


def in_line(model, line, since):
    """(frames, people) who are across a line of a door, counted from the recorded places."""
    run = Trajectories.of(model)
    late = run.frame > since
    away = [Point(x, y).distance(line) for x, y in zip(run.x[late], run.y[late], strict=True)]
    deep = np.array(away) < CORE - 1e-3
    return int(deep.sum()), run.person[late][deep]


def closing_on(x, *, frames, **keywords):
    """A model in which a door closes on somebody at x after some frames, and 300 frames more."""
    model = model_of(room(), shipped_map(), rng=1)
    (person,) = model.add_pedestrians([(x, 3.0)], headings=[0.0], **keywords)
    advance(model, frames)
    model.floor_plan.close_gate("door")
    closed = model.frame
    advance(model, 300)
    return model, person, closed


@pytest.mark.parametrize("x", [9.9, 9.95, 9.99])
def test_somebody_who_waits_in_an_exit_that_closes_steps_off(x):
    model, person, closed = closing_on(x, frames=10, pre_movement=60.0)
    frames, _ = in_line(model, LineString([(10, 2.5), (10, 3.5)]), closed)
    # Less than a second and a half; without a way out nobody went, and all 300 were counted.
    assert frames < 45
    assert model.inside == 1
    assert person.position[0] < 10.0 - CORE
    safety = check_safety(Trajectories.of(model), model.floor_plan.walls)
    assert safety.wall_crossings == 0


def test_somebody_who_crosses_an_exit_as_it_closes_leaves():
    model = model_of(room(), shipped_map(), rng=1)
    model.add_pedestrians([(8.0, 3.0)], headings=[0.0])
    while model.crowd.x[0] < 10.0 - 0.8 * CORE:
        advance(model, 1)
    assert model.inside == 1
    model.floor_plan.close_gate("door")
    closed = model.frame
    advance(model, 60)
    frames, _ = in_line(model, LineString([(10, 2.5), (10, 3.5)]), closed)
    assert model.inside == 0
    assert frames <= 10


@pytest.mark.parametrize("back", [0.3, 0.6])
def test_somebody_on_their_way_to_it_does_not(back):
    model = model_of(room(), shipped_map(), rng=1)
    model.add_pedestrians([(8.0, 3.0)], headings=[0.0])
    while model.crowd.x[0] < 10.0 - back:
        advance(model, 1)
    model.floor_plan.close_gate("door")
    closed = model.frame
    advance(model, 90)
    assert model.inside == 1
    assert in_line(model, LineString([(10, 2.5), (10, 3.5)]), closed)[0] == 0


@pytest.mark.parametrize("x", [4.9, 5.0, 5.07])
def test_a_gate_that_closes_on_somebody_who_waits(x):
    plan = room(Gate("gate", (5, 0), (5, 6)))
    model = model_of(plan, shipped_map(), rng=1)
    (person,) = model.add_pedestrians([(x, 3.0)], headings=[1.5], pre_movement=60.0)
    advance(model, 10)
    plan.close_gate("gate")
    advance(model, 300)
    assert abs(person.position[0] - 5.0) >= CORE - 1e-3
    frames, _ = in_line(model, LineString([(5, 0), (5, 6)]), 10)
    assert frames < 60


def test_a_crowd_in_front_of_an_exit_that_closes():
    model = model_of(room(), shipped_map(), rng=4)
    model.add_pedestrians([(x, y) for x in np.arange(6.5, 9.9, 0.45) for y in np.arange(1, 5, 0.5)])
    advance(model, 150)
    inside, walls = model.inside, model.floor_plan.walls
    model.floor_plan.close_gate("door")
    advance(model, 300)
    frames, people = in_line(model, LineString([(10, 2.5), (10, 3.5)]), 150)
    assert inside - 2 <= model.inside <= inside
    assert frames < 60
    assert len(set(people.tolist())) <= 2
    safety = check_safety(Trajectories.of(model), walls)  # those before it had closed
    assert (safety.overlaps, safety.wall_crossings) == (0, 0)


def test_a_wheelchair_backs_off():
    plan = room()
    kind = PedestrianType.named("wheelchair_manual")
    model = model_of(plan, kind.mobility_map, rng=1)
    model.add_pedestrians([(9.8, 3.0)], headings=[0.0], pre_movement=60.0)
    advance(model, 5)
    plan.close_gate("door")
    advance(model, 600)
    assert model.crowd.x[0] + float(model.crowd.core[0]) <= 10.0 + 1e-3
