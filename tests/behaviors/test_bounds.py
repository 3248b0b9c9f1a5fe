"""A bound of a group is never more than what any of its options costs."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mesa_mobility.behaviors import (
    Displacement,
    FacingDeviation,
    PreferredSpeed,
    PreferredVelocity,
    Sideways,
    Stepping,
    TargetDistance,
    VelocityChange,
)

from tests.fixtures.records import me, option, options

TERMS = [
    Displacement,
    FacingDeviation,
    PreferredSpeed,
    PreferredVelocity,
    Stepping,
    TargetDistance,
    VelocityChange,
    Sideways,
]

START = (0.25, 0.5)
VELOCITY = (0.75, -0.5)

angles = st.floats(-math.pi, math.pi)
shares = st.floats(0.0, 1.0)


def cost(term, x, y, angle, duration, speed, target, preferred):
    return term.kernel.value(
        option=option(x, y, angle, duration, speed),
        me=me(START, target, preferred, VELOCITY),
        p=term(),
    )


def bound(term, x, y, radius, angle, turn, duration, slowest, fastest, target, preferred):
    return term.bound.value(
        options=options(x, y, radius, angle, turn, duration, (slowest, fastest)),
        me=me(START, target, preferred, VELOCITY),
        p=term(),
    )


@pytest.mark.parametrize("term", TERMS)
@settings(deadline=None)  # compiled at the first
@given(
    radius=st.floats(0.0, 0.6),
    turn=st.floats(0.0, math.pi),
    speeds=st.tuples(st.floats(0.0, 2.0), st.floats(0.0, 2.0)).map(sorted),
    facing=angles,
    taken=st.tuples(angles, shares, st.floats(-1.0, 1.0), shares),
    target=st.tuples(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0)),
    preferred=st.floats(0.0, 2.0),
    duration=st.sampled_from([0.4, 0.8, 1.5]),
)
def test_no_option_of_a_group_costs_less(
    term, radius, turn, speeds, facing, taken, target, preferred, duration
):
    where, out, turned, faster = taken
    x, y = 1.0 + out * radius * math.cos(where), -0.5 + out * radius * math.sin(where)
    speed = speeds[0] + faster * (speeds[1] - speeds[0])
    least = bound(term, 1.0, -0.5, radius, facing, turn, duration, *speeds, target, preferred)
    of_option = cost(term, x, y, facing + turned * turn, duration, speed, target, preferred)
    assert of_option >= least - 1e-6


@pytest.mark.parametrize("term", TERMS)
@settings(deadline=None)  # compiled at the first
@given(
    facing=angles,
    target=st.tuples(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0)),
    speed=st.floats(0.0, 2.0),
    preferred=st.floats(0.0, 2.0),
)
def test_a_group_of_one_is_known_exactly(term, facing, target, speed, preferred):
    least = bound(term, 0.0, 0.0, 0.0, facing, 0.0, 0.8, speed, speed, target, preferred)
    assert least == pytest.approx(
        cost(term, 0.0, 0.0, facing, 0.8, speed, target, preferred), abs=1e-9
    )


def test_a_bound_is_worth_something():
    # 3 m away from the middle of a circle of 0.5 m; the facing off by a right angle, give or take
    # 0.2 rad and what the circle does to the direction; 0.4 m/s too slow at the least.
    assert bound(TargetDistance, 0, 0, 0.5, 0, 0, 0.4, 0, 1, (3.0, 0.0), 1.0) == 2.5
    seen = math.tan(math.asin(0.5 / 3.0))
    assert bound(
        FacingDeviation, 0, 0, 0.5, math.pi / 2, 0.2, 0.4, 0, 1, (3.0, 0.0), 1.0
    ) == pytest.approx(math.pi / 2 - 0.2 - seen, abs=1e-7)
    assert bound(PreferredSpeed, 0, 0, 0.5, 0, 0, 0.4, 0.2, 0.6, (3.0, 0.0), 1.0) == pytest.approx(
        1.5 * 0.4
    )
    # From (0.25, 0.5) to (0.65, 0.5) in 0.4 s, which is 0.4 m short of 2 m/s, give or take 0.1 m.
    assert bound(
        PreferredVelocity, 0.65, 0.5, 0.1, 0, 0, 0.4, 0, 2, (3.25, 0.5), 2.0
    ) == pytest.approx(1.5 * (0.4 - 0.1) / 0.4)
    # From there to (1.05, 0.3) in 0.8 s: 1 m/s and -0.25 m/s after 0.75 and -0.5, so 0.25 m/s more
    # of each: 0.0625 / w along the way and 0.3125 / w across it, which counts 1.5 times, where w is
    # 0.8125 ** 0.5 m/s; give or take 0.125 m/s, all of it across.
    assert bound(
        VelocityChange, 1.05, 0.3, 0.1, 0, 0, 0.8, 0, 2, (3.25, 0.5), 1.0
    ) == pytest.approx(math.hypot(0.0625, 1.5 * 0.3125) / math.sqrt(0.8125) - 1.5 * 0.125)
    assert bound(Displacement, 0, 0, 0.5, 0, 0, 0.4, 0.2, 0.5, (3.0, 0.0), 1.0) == -0.2
