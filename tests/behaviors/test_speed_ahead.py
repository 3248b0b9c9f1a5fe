"""Walking as fast as the people ahead."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mesa_mobility.behaviors import SpeedAhead

from mesa_mobility.errors import ModelError
from tests.fixtures.options import (
    Chooser,
    Ending,
    candidates,
    shifts,
    turned_and_moved,
    turns,
)


def cost(point, *neighbours, target=(20.0, 0.0)) -> float:
    # 1.5 s: an option that leads 1.5 m walks at 1 m/s.
    ending = Ending(point, 0.0, math.hypot(*point), 1.5)
    chooser = Chooser([ending], target=target, neighbours=neighbours)
    return float(SpeedAhead(width=0.4, gap=0.5, range=2.0).cost(candidates(chooser))[0])


@pytest.mark.parametrize(
    ("point", "place", "velocity", "expected"),
    [
        # 1 m/s behind somebody who stands: in full up to half a metre, then less by e each 2 m.
        ((1.5, 0.0), (0.4, 0.0), (0.0, 0.0), 1.0),
        ((1.5, 0.0), (0.5, 0.0), (0.0, 0.0), 1.0),
        ((1.5, 0.0), (2.5, 0.0), (0.0, 0.0), math.exp(-1.0)),
        # As fast as they are: nothing; slower costs as much as faster.
        ((1.5, 0.0), (0.5, 0.0), (1.0, 0.0), 0.0),
        ((1.5, 0.0), (0.5, 0.0), (1.25, 0.0), 0.25),
        ((1.5, 0.0), (0.5, 0.0), (0.75, 0.0), 0.25),
        # Speeds along the way alone count.
        ((1.5, 0.7), (0.5, 0.0), (1.0, 9.0), 0.0),
        # Half as much half a width to the side; nobody beside, behind or a width away.
        ((1.5, 0.0), (0.5, 0.2), (0.0, 0.0), 0.5),
        ((1.5, 0.0), (0.5, -0.4), (0.0, 0.0), 0.0),
        ((1.5, 0.0), (0.0, 0.1), (0.0, 0.0), 0.0),
        ((1.5, 0.0), (-0.5, 0.0), (0.0, 0.0), 0.0),
    ],
)
def test_what_an_option_costs(point, place, velocity, expected):
    assert cost(point, (place, velocity)) == pytest.approx(expected, rel=1e-7, abs=1e-12)


def test_the_costs_of_neighbours_add_up():
    one, other = ((0.5, 0.0), (0.0, 0.0)), ((2.5, 0.0), (0.5, 0.0))
    both = cost((1.5, 0.0), one, other)
    assert both == pytest.approx(1.0 + 0.5 * math.exp(-1.0))


def test_ahead_is_towards_the_target():
    assert cost((0.0, 1.5), ((0.0, 0.5), (0.0, 0.0)), target=(0.0, 9.0)) == pytest.approx(1.0)
    assert cost((0.0, 1.5), ((0.5, 0.0), (0.0, 0.0)), target=(0.0, 9.0)) == 0.0


def test_somebody_at_their_target_follows_nobody():
    assert cost((1.5, 0.0), ((0.5, 0.0), (0.0, 0.0)), target=(0.0, 0.0)) == 0.0


def test_nobody_beyond_the_target_is_followed():
    assert cost((1.5, 0.0), ((0.5, 0.0), (0.0, 0.0)), target=(0.6, 0.0)) == pytest.approx(1.0)
    assert cost((1.5, 0.0), ((0.5, 0.0), (0.0, 0.0)), target=(0.4, 0.0)) == 0.0


@pytest.mark.parametrize(("degrees", "share"), [(0, 1), (119, 1), (121, 0), (180, 0), (-121, 0)])
def test_nobody_follows_those_who_come_the_other_way(degrees, share):
    angle = math.radians(degrees)
    neighbour = (0.5, 0.0), (0.0, 0.0), (math.cos(angle), math.sin(angle)), 0.0
    assert cost((1.5, 0.0), neighbour) == pytest.approx(share)


@given(st.integers(0, 10_000), turns, shifts)
@settings(deadline=None)
def test_turning_and_moving_everything_changes_nothing(seed, turn, shift):
    rng = np.random.default_rng(seed)  # nobody is exactly beside anybody
    chooser = candidates(
        Chooser(
            [Ending(tuple(rng.normal(size=2)), 0.0, 1.0, 1.5) for _ in range(5)],
            target=tuple(rng.normal(size=2)),
            neighbours=[(tuple(rng.normal(size=2)), tuple(rng.normal(size=2))) for _ in range(4)],
        )
    )
    before = SpeedAhead().cost(chooser)
    after = SpeedAhead().cost(turned_and_moved(chooser, turn, shift))
    np.testing.assert_allclose(after, before, atol=1e-6)
    assert (before >= 0.0).all()


@pytest.mark.parametrize("numbers", [{"width": 0.0}, {"gap": -0.1}, {"range": 0.0}])
def test_numbers_out_of_range_are_refused(numbers):
    with pytest.raises(ModelError, match=f"speed_ahead: {next(iter(numbers))}"):
        SpeedAhead(**numbers)
