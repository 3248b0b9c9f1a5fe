"""A term's bounds change the time that a run takes, never its result."""

import numpy as np
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
from mesa_mobility.models import Doorway

from mesa_mobility import CostTerm
from tests.fixtures.engine import ENGINE
from tests.fixtures.oracles.numpy_terms import Clearance, StraightOn
from tests.fixtures.plugin_terms import KeepOff


class Distance(TargetDistance):
    bound = None


class SameDistance(TargetDistance):
    name = "same_distance"


class Unbounded(SameDistance):
    bound = None


class Facing(FacingDeviation):
    bound = None


class Speed(PreferredSpeed):
    bound = None


class Velocity(PreferredVelocity):
    bound = None


class Change(VelocityChange):
    bound = None


class Nothing(CostTerm):
    name = "nothing"

    def cost(self, candidates):
        return np.zeros(len(candidates))


def run(*terms):
    model = Doorway(rng=3, record=True, preset=ENGINE)
    model.terms = [*terms, Interference(), Headway(), RightOfWay()]
    model.run(max_seconds=3.0)
    return [column.tobytes() for column in model.recorder.arrays().values()]


@pytest.fixture(scope="module")
def bounded():
    return run(TargetDistance(), FacingDeviation(), PreferredSpeed())


@pytest.mark.parametrize(
    "terms",
    [
        (Distance, FacingDeviation, PreferredSpeed),
        (TargetDistance, Facing, PreferredSpeed),
        (Distance, Facing, Speed),
        (TargetDistance, FacingDeviation, PreferredSpeed, Nothing),
    ],
)
def test_a_run_is_the_same_without_bounds(bounded, terms):
    assert run(*(term() for term in terms)) == bounded


def test_a_run_is_the_same_without_the_bound_of_the_velocity():
    usual = (TargetDistance(), FacingDeviation())
    assert run(*usual, PreferredVelocity()) == run(*usual, Velocity())


def test_a_weight_below_zero_takes_the_bound_away():
    usual = (TargetDistance(), FacingDeviation(), PreferredSpeed())
    reward = run(*usual, SameDistance(weight=-0.25))
    assert reward == run(*usual, Unbounded(weight=-0.25))


def test_a_run_is_the_same_without_the_bound_of_the_change_of_velocity():
    usual = (TargetDistance(), PreferredVelocity())
    changes = run(*usual, VelocityChange())
    assert changes == run(*usual, Change())
    assert changes != run(*usual)


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("compiled", "plain", "weight"),
    [(RoomAhead, StraightOn, 3.0), (KeepOff, Clearance, 1.0), (KeepOff, Clearance, -0.25)],
)
def test_a_run_is_the_same_if_walls_are_looked_at_for_every_option(compiled, plain, weight):
    # A kernel waits until an option may win; terms in NumPy are computed for all options before.
    # Where the weight is negative, neither may wait.
    usual = (TargetDistance(), FacingDeviation(), PreferredVelocity())
    walled = run(*usual, compiled(weight))
    assert walled == run(*usual, plain(weight))
    assert walled == run(Distance(), Facing(), Velocity(), compiled(weight))
    assert walled != run(*usual)


def test_other_terms_give_another_run(bounded):
    assert run(TargetDistance(), FacingDeviation(), PreferredSpeed(weight=1.0)) != bounded
