"""Terms add up, whatever their order, compiled or in plain NumPy."""

import math
from functools import cache

import pytest
from mesa_mobility.behaviors import (
    FacingDeviation,
    Headway,
    Interference,
    PreferredSpeed,
    PreferredVelocity,
    RightOfWay,
    RoomAhead,
    TargetDistance,
    VelocityChange,
)
from shapely import Point, box

from mesa_mobility import CostTerm, FloorPlan
from mesa_mobility.crowd import Preset
from tests.fixtures.engine import ENGINE
from tests.fixtures.maps import shipped_map, wanderer
from tests.fixtures.oracles.costs import equation_one
from tests.fixtures.oracles.decisions import Oracle
from tests.fixtures.oracles.numpy_terms import (
    Change,
    Clearance,
    Deviation,
    Distance,
    Near,
    Room,
    Speed,
    StraightOn,
    Velocity,
    Way,
)
from tests.fixtures.plugin_terms import CompiledKeepRight, KeepOff, KeepRight, SameSpeed
from tests.fixtures.scenes import corridor, model_of, two_doors


def walk(
    plan: FloorPlan,
    map_,
    terms,
    people: int = 12,
    seconds: float = 40.0,
    preset: str | Preset = ENGINE,
) -> bytes:
    """All positions and headings of a run, as bytes."""
    # With most seeds, two options of somebody cost the same but for rounding, which decides then.
    model = model_of(plan, map_, behaviors=terms, preset=preset, rng=11, frames_per_step=3)
    model.add_pedestrians(plan.random_points(people, model.rng, spacing=0.6, clearance=0.3))
    model.run(max_seconds=seconds)
    rows = model.recorder.arrays()
    assert len(rows["x"]) > 500
    return b"".join(rows[name].tobytes() for name in ("frame", "person", "x", "y", "heading"))


def ours() -> list[CostTerm]:
    return [TargetDistance(1.0), FacingDeviation(0.5), PreferredSpeed(2.0), Interference(1.0)]


@cache
def our_walk() -> bytes:
    """The run that others are compared with."""
    return walk(two_doors(), shipped_map(), ours())


def test_the_order_of_terms_changes_nothing():
    for k in range(1, 4):
        assert walk(two_doors(), shipped_map(), [*ours()[k:], *ours()[:k]]) == our_walk()
    assert walk(two_doors(), shipped_map(), ours()[::-1]) == our_walk()


def test_the_order_of_terms_changes_nothing_where_some_are_plain_numpy():
    terms = [KeepRight(0.3), TargetDistance(), Near(), Speed(2.0), FacingDeviation(0.5)]
    runs = {walk(two_doors(), shipped_map(), order) for order in (terms, terms[::-1])}
    assert len(runs) == 1


@pytest.mark.parametrize(
    ("place", "twin"), [(0, Distance(1.0)), (1, Deviation(0.5)), (2, Speed(2.0)), (3, Near(1.0))]
)
def test_the_same_term_compiled_and_in_numpy_give_the_same_trajectories(place, twin):
    terms = ours()
    terms[place] = twin
    assert walk(two_doors(), shipped_map(), terms) == our_walk()


def test_all_terms_in_numpy_give_the_same_trajectories():
    plain = [Distance(1.0), Deviation(0.5), Speed(2.0), Near(1.0)]
    assert walk(two_doors(), shipped_map(), plain) == our_walk()


def of_the_default() -> list[CostTerm]:
    return [
        TargetDistance(1.0),
        FacingDeviation(0.5),
        PreferredVelocity(2.0),
        Interference(1.0),
        Headway(2.0),
        RightOfWay(3.0),
    ]


@cache
def default_walk() -> bytes:
    return walk(two_doors(), shipped_map(), of_the_default())


@pytest.mark.parametrize(("place", "twin"), [(2, Velocity(2.0)), (4, Room(2.0)), (5, Way(3.0))])
def test_terms_of_the_default_give_the_same_trajectories_in_numpy(place, twin):
    others = of_the_default()
    others[place] = twin
    assert walk(two_doors(), shipped_map(), others) == default_walk()
    del others[place]
    assert walk(two_doors(), shipped_map(), others) != default_walk()


def that_look_ahead() -> list[CostTerm]:
    return [
        TargetDistance(1.0),
        FacingDeviation(0.5),
        PreferredVelocity(2.0),
        Interference(1.0),
        VelocityChange(1.0),
        RoomAhead(3.0),
        KeepOff(0.5),
    ]


def walk_ahead(terms: list[CostTerm]) -> bytes:
    """Round a wall across the way, which people face at times."""
    plan = corridor(12.0, obstacles=[box(6.0, 0.0, 6.2, 3.0)])
    return walk(plan, shipped_map(), terms)


@cache
def compiled_walk_ahead() -> bytes:
    return walk_ahead(that_look_ahead())


@pytest.mark.parametrize(
    ("place", "twin"),
    [(4, Change(1.0)), (5, StraightOn(3.0)), (6, Clearance(0.5))],
)
def test_terms_of_what_lies_ahead_give_the_same_trajectories_in_numpy(place, twin):
    others = that_look_ahead()
    others[place] = twin
    assert walk_ahead(others) == compiled_walk_ahead()
    del others[place]
    assert walk_ahead(others) != compiled_walk_ahead()


class SameDistance(TargetDistance):
    name = "same_distance"


class SameInterference(Interference):
    name = "same_interference"


def test_costs_add_up():
    # A term twice at half its weight is the term once.
    terms = [
        TargetDistance(0.5),
        FacingDeviation(0.5),
        SameDistance(0.5),
        PreferredSpeed(2.0),
        Interference(0.5),
        SameInterference(0.5),
    ]
    assert walk(two_doors(), shipped_map(), terms) == our_walk()


def test_a_term_of_weight_nought_counts_for_nothing():
    terms = [*ours(), KeepRight(0.0), CompiledKeepRight(0.0), SameSpeed(0.0), KeepOff(0.0)]
    assert walk(two_doors(), shipped_map(), terms) == our_walk()


@pytest.mark.thorough
@pytest.mark.parametrize("near", [Interference, Near])
@pytest.mark.parametrize("weight", [-0.5, 3.0])
def test_interference_of_any_weight_is_chosen_by_the_whole_sum(near, weight):
    # A negative weight (people who flock) makes the sum of the other terms an upper bound.
    plan = two_doors()
    terms = [TargetDistance(), FacingDeviation(0.5), PreferredSpeed(2.0), near(weight)]
    model = model_of(plan, wanderer(31), behaviors=terms, rng=3)
    model.add_pedestrians(plan.random_points(12, model.rng, spacing=0.5, clearance=0.3))
    oracle = Oracle(model, equation_one(w_d=1.0, w_theta=0.5, w_v=2.0, w_p=weight))
    while model.running and model.frame < 120:
        for decision in oracle.step():
            assert decision.fault() is None, (decision.frame, decision.person.row)


@pytest.mark.thorough
@pytest.mark.parametrize("walls", [KeepOff, Clearance])
@pytest.mark.parametrize("weight", [-0.5, 3.0])
def test_wall_terms_of_any_weight_are_chosen_by_the_whole_sum(walls, weight):
    others = equation_one(w_d=1.0, w_theta=0.5, w_v=2.0, w_p=1.0)

    def cost(body, end, seconds, about, preferred):
        away = min((wall.distance(Point(end[:2])) for wall in body.walls), default=math.inf)
        nearer = max(1.0 - (away - body.core), 0.0)
        return others(body, end, seconds, about, preferred) + weight * nearer

    plan = two_doors()
    model = model_of(plan, wanderer(31), behaviors=[*ours(), walls(weight)], rng=3)
    model.add_pedestrians(plan.random_points(12, model.rng, spacing=0.5, clearance=0.3))
    oracle = Oracle(model, cost)
    while model.running and model.frame < 120:
        for decision in oracle.step():
            assert decision.fault() is None, (decision.frame, decision.person.row)
