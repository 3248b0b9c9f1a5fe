"""Points that step towards their targets reach an exit, from everywhere, through no wall."""

import numpy as np
import pytest
import shapely
from shapely import Point, Polygon, affinity, box

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan import Exit, FloorPlan, Gate, Router


@pytest.mark.parametrize(
    "name",
    [
        "room",
        "corridor",
        "l_corridor",
        "u_corridor",
        "two_rooms",
        "two_rooms_turning_back",
        "hall",
        "bend",
    ],
)
@pytest.mark.parametrize("step", [0.1, 0.37])
def test_everybody_gets_out(plans, places_in, walkers, name: str, step: float) -> None:
    plan = plans[name]()
    starts = places_in(plan, 0.25)
    assert len(starts) > 400
    walk = walkers(plan, starts, step=step)
    assert len(walk.left) == 0
    assert walk.wall_crossings == 0
    assert walk.gates_crossed.max(initial=0) <= 1


@pytest.mark.parametrize("name", ["room", "l_corridor", "two_rooms", "hall", "bend"])
def test_nobody_walks_farther_than_expected(plans, places_in, walkers, name: str) -> None:
    plan = plans[name]()
    starts = places_in(plan, 0.25, 0.15)
    expected = Router(plan).targets(starts, np.zeros(len(starts), int)).distances
    lengths = walkers(plan, starts).lengths
    # Steps end up to 0.1 m behind the exit, and pass corners a little late or early; doors are
    # crossed up to 0.25 m farther from the jamb than the shortest way does.
    assert (lengths <= 1.05 * expected + 0.25).all()
    assert (lengths >= 0.97 * expected - 0.1).all()


def test_everybody_in_the_first_room_goes_through_the_door_once(plans, places_in, walkers) -> None:
    plan = plans["two_rooms"]()
    starts = places_in(plan, 0.5)
    walk = walkers(plan, starts)
    assert (walk.gates_crossed == (starts[:, 0] < 6.1)).all()


def random_plan(seed: int) -> FloorPlan:
    """A room, mostly with a second one behind a door, with things in the way."""
    rng = np.random.default_rng(seed)
    width, height = rng.uniform(4, 14, 2)
    parts, gates = [box(0, 0, width, height)], []
    if rng.random() < 0.6:
        depth, low, door = rng.uniform(3, 8), rng.uniform(0.3, height - 1.6), rng.uniform(0.8, 1.3)
        wall = rng.choice([0.02, 0.1, 0.3, 1.0])
        parts.append(box(width + wall, 0, width + wall + depth, height))
        parts.append(box(width, low, width + wall, low + door))
        x = width + wall * rng.choice([0, 0.5, 1])
        gates = [Gate("door", (x, low), (x, low + door))] if rng.random() < 0.8 else []
    walkable = shapely.union_all(parts)
    things = []
    for _ in range(rng.integers(0, 9)):
        shape = [
            box(*-rng.uniform([0.1, 0.05], [2, 1]), *rng.uniform([0.1, 0.05], [2, 1])),
            Point(0, 0).buffer(rng.uniform(0.1, 1)),
            Polygon(rng.normal(size=(3, 2))),
            box(-1, -0.05, 1, 0.05).union(box(-0.05, -1, 0.05, 1)),
        ][rng.integers(4)]
        turned = affinity.rotate(shape, rng.uniform(0, 360), origin=(0, 0))
        xmax, ymax = walkable.bounds[2:]
        things.append(affinity.translate(turned, rng.uniform(0, xmax), rng.uniform(0, ymax)))
    exits = []
    for k in range(rng.integers(1, 3)):
        start, length = rng.uniform(0, min(width, height) - 2.5), rng.uniform(0.7, 2.5)
        a, b = [
            ((start, 0), (start + length, 0)),
            ((0, start), (0, start + length)),
            ((start, height), (start + length, height)),
        ][rng.integers(3)]
        exits.append(Exit(f"exit {k}", a, b))
    return FloorPlan(walkable, exits=exits, gates=gates, obstacles=things)


def reachable(plan: FloorPlan, places: np.ndarray) -> np.ndarray:
    """Those places from where bodies of radius 0.2 m reach an exit."""

    def fine(place: np.ndarray) -> bool:
        try:
            plan.check_reachable([place], 0.2)
        except FloorPlanError:
            return False
        return True

    clear = plan.free.buffer(-0.2)
    return places[[clear.covers(Point(p)) and fine(p) for p in places]]


def check_random_plans(places_in, walkers, seeds: range) -> None:
    walked = 0
    for seed in seeds:
        try:
            plan = random_plan(seed)
        except FloorPlanError:
            continue  # overlapping exits, or a part cut off
        starts = reachable(plan, places_in(plan, 0.6))
        walk = walkers(plan, starts)
        assert len(walk.left) == 0, f"plan {seed}: left at {walk.left[:3]}"
        assert walk.wall_crossings == 0, f"plan {seed}"
        walked += len(starts)
    assert walked > 50 * len(seeds)


@pytest.mark.thorough
def test_everybody_gets_out_of_random_plans(places_in, walkers) -> None:
    check_random_plans(places_in, walkers, range(12))


@pytest.mark.slow
def test_everybody_gets_out_of_many_random_plans(places_in, walkers) -> None:
    check_random_plans(places_in, walkers, range(100, 500))
