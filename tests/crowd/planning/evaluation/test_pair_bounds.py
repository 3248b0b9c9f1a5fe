"""Bounds of pair terms change the time that a choice takes, never the choice."""

import math

import numpy as np
import pytest
from mesa_mobility.behaviors import (
    FacingDeviation,
    PreferredVelocity,
    TargetDistance,
)

from mesa_mobility import CostTerm, pair_bound_kernel
from tests.fixtures.maps import make_map, stand, straight, wanderer
from tests.fixtures.oracles.costs import equation_one
from tests.fixtures.oracles.decisions import Oracle
from tests.fixtures.plugin_terms import ArmsLength
from tests.fixtures.scenes import advance, corridor, model_of, put, statues, two_doors


class Unbounded(ArmsLength):
    bound = None


class Nothing(CostTerm):
    """Without a bound, so that every option is costed."""

    name = "nothing"

    def cost(self, candidates):
        return np.zeros(len(candidates))


def usual() -> list[CostTerm]:
    return [TargetDistance(1.0), FacingDeviation(0.5), PreferredVelocity(2.0)]


def arms_length(body, end, seconds, others, preferred):
    """``ArmsLength`` in plain Python."""
    away = [
        math.dist(end[:2], (other.x + other.vx * seconds, other.y + other.vy * seconds))
        for other in others
    ]
    return sum(max(1.0 - metres / 2.0, 0.0) for metres in away)


def walk(*terms: CostTerm) -> bytes:
    """Positions in every frame of a run in which few and many people are near one another."""
    plan = two_doors()
    model = model_of(plan, wanderer(31, options=60), behaviors=[*usual(), *terms], rng=3)
    model.add_pedestrians(plan.random_points(24, model.rng, spacing=0.5, clearance=0.3))
    model.run(max_seconds=12)
    rows = model.recorder.arrays()
    return b"".join(rows[name].tobytes() for name in ("frame", "person", "x", "y"))


@pytest.mark.thorough
@pytest.mark.parametrize("weight", [-1.0, 0.0, 3.0])
def test_a_run_is_the_same_as_without_and_as_if_every_option_is_costed(weight):
    runs = {walk(ArmsLength(weight)), walk(Unbounded(weight)), walk(ArmsLength(weight), Nothing())}
    assert len(runs) == 1
    assert (runs == {walk()}) == (weight == 0.0)


@pytest.mark.thorough
@pytest.mark.parametrize("term", [ArmsLength(3.0), ArmsLength(-0.5)])
def test_the_choice_is_the_cheapest_of_all_options(term):
    others = equation_one(w_d=1.0, w_theta=0.5, w_u=2.0)
    plan = two_doors()
    model = model_of(plan, wanderer(31), behaviors=[*usual(), term], rng=3)
    model.add_pedestrians(plan.random_points(12, model.rng, spacing=0.5, clearance=0.3))
    oracle = Oracle(model, lambda *seen: others(*seen) + term.weight * arms_length(*seen))
    while model.running and model.frame < 120:
        for decision in oracle.step():
            assert decision.fault() is None, (decision.frame, decision.person.row)


@pair_bound_kernel
def _left_is_dear(
    x, y, radius, ux, uy, turn, duration, slowest, fastest, sx, sy, tx, ty, nx, ny, nvx, nvy, nex,
    ney, lead, p,
):  # fmt: skip
    return 100.0 if y + radius > sy + 0.1 else 0.0


class LeftIsDear(ArmsLength):
    """Its bound is wrong: no group with an option to the left costs as much."""

    bound = _left_is_dear


@pytest.mark.parametrize(
    ("term", "side"), [(LeftIsDear(0.5), -1.0), (ArmsLength(0.5), 1.0), (LeftIsDear(-0.01), 1.0)]
)
def test_groups_are_left_out_by_the_bound_for_people_who_are_near(term, side):
    # The left is nearer to the target by a hair, and somebody stands on the right: only a wrong
    # bound leads there. Below zero it would be an upper one, so it does not count. There are so
    # many options that groups wait for their turn. Straight on, the way to the target passes 0.4 m
    # from the one who stands, so that bounds count there.
    ways = np.linspace(0.4, 0.7, 100)
    left = [straight(1.5, 45, towards=way, to=0) for way in ways]
    right = [straight(1.49, 45, towards=-way, to=0) for way in ways]
    maps = [make_map([[stand(), *left, *right]]), statues()]
    model = model_of(corridor(), maps, behaviors=[TargetDistance(), term])
    put(model, 6.75, 1.6, type_index=1)
    person = put(model, 5.0, 2.0)
    advance(model, 45)
    assert np.sign(person.position[1] - 2.0) == side
