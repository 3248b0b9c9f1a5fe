"""A bound of a group is never more than what any of its options costs."""

import math

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from mesa_mobility.behaviors import (
    Anticipation,
    Displacement,
    FacingDeviation,
    PreferredSpeed,
    PreferredVelocity,
    Sideways,
    Stepping,
    TargetDistance,
    VelocityChange,
)

TERMS = [
    Displacement, FacingDeviation, PreferredSpeed, PreferredVelocity, Stepping, TargetDistance,
    VelocityChange, Sideways,
]  # fmt: skip

START = (0.25, 0.5)
VELOCITY = (0.75, -0.5)
OWN = {VelocityChange: VELOCITY}
"""What a kernel with ``own_velocity`` takes as well."""

angles = st.floats(-math.pi, math.pi)
shares = st.floats(0.0, 1.0)


def cost(term, x, y, angle, duration, speed, target, preferred):
    return term.kernel.function(
        x, y, math.cos(angle), math.sin(angle), duration, speed, *START, *target,
        preferred, *OWN.get(term, ()), term().parameters() or (0.0,),
    )  # fmt: skip


def bound(term, x, y, radius, angle, turn, duration, slowest, fastest, target, preferred):
    return term.bound.function(
        x, y, radius, math.cos(angle), math.sin(angle), turn, duration, slowest, fastest, *START,
        *target, preferred, *OWN.get(term, ()), term().parameters() or (0.0,),
    )  # fmt: skip


@pytest.mark.parametrize("term", TERMS)
@settings(deadline=None)  # compiled at the first
@given(
    radius=st.floats(0.0, 0.6),
    turn=st.floats(0.0, math.pi),
    speeds=st.tuples(st.floats(0.0, 2.0), st.floats(0.0, 2.0)).map(sorted),
    facing=angles,
    option=st.tuples(angles, shares, st.floats(-1.0, 1.0), shares),
    target=st.tuples(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0)),
    preferred=st.floats(0.0, 2.0),
    duration=st.sampled_from([0.4, 0.8, 1.5]),
)
def test_no_option_of_a_group_costs_less(
    term, radius, turn, speeds, facing, option, target, preferred, duration
):
    where, out, turned, faster = option
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
    # From there to (1.05, 0.3) in 0.8 s: 1 m/s and -0.25 m/s after 0.75 and -0.5, give or take
    # 0.125 m/s.
    assert bound(
        VelocityChange, 1.05, 0.3, 0.1, 0, 0, 0.8, 0, 2, (3.25, 0.5), 1.0
    ) == pytest.approx(0.25 * math.sqrt(2.0) - 0.125)
    assert bound(Displacement, 0, 0, 0.5, 0, 0, 0.4, 0.2, 0.5, (3.0, 0.0), 1.0) == -0.2


def pair_cost(x, y, neighbour, numbers, duration=1.5):
    """Of an option from (0, 0), which need not lead where the neighbour is going."""
    return Anticipation.kernel.function(
        x, y, 1.0, 0.0, duration, math.hypot(x, y) / duration, 0.0, 0.0, 9.0, 0.0, *neighbour,
        1.0, 0.0, 0.0, numbers,
    )  # fmt: skip


def pair_bound(x, y, radius, neighbour, numbers, duration=1.5):
    speed = math.hypot(x, y) / duration
    slowest, fastest = max(speed - radius / duration, 0.0), speed + radius / duration
    return Anticipation.bound.function(
        x, y, radius, 1.0, 0.0, 0.0, duration, slowest, fastest, 0.0, 0.0, 9.0, 0.0, *neighbour,
        1.0, 0.0, 0.0, numbers,
    )  # fmt: skip


encounters = st.fixed_dictionaries({
    "middle": st.tuples(st.floats(-2.0, 2.0), st.floats(-2.0, 2.0)),
    "duration": st.sampled_from([0.4, 0.8, 1.5]),
    "velocity": st.tuples(st.floats(-2.0, 2.0), st.floats(-2.0, 2.0)),
    "off": st.tuples(st.floats(-1.2, 1.2), st.floats(-1.2, 1.2)),
    "time": st.floats(0.0, 4.0),
    "numbers": st.tuples(
        st.floats(0.3, 2.0), st.floats(0.5, 5.0), st.floats(0.1, 2.0), st.floats(0.1, 1.5)
    ),
})  # fmt: skip
"""Of the option in the middle of a group with a neighbour, who is ``off`` it after ``time``."""


def neighbour_of(encounter):
    """Where the neighbour is now, and its velocity."""
    middle, velocity = (complex(*encounter[name]) for name in ("middle", "velocity"))
    seen = velocity - middle / encounter["duration"]
    place = complex(*encounter["off"]) - encounter["time"] * seen
    return place.real, place.imag, velocity.real, velocity.imag


@settings(deadline=None, max_examples=500)
@given(
    encounter=encounters,
    radius=st.floats(0.0, 0.6),
    where=angles,
    out=st.one_of(st.just(1.0), shares),
)
# The middle of the group comes nearer to the neighbour, an option at the rim does not.
@example(
    encounter={"middle": (0.0, 0.0), "duration": 1.5, "velocity": (-0.1, 2.0), "off": (1.0, 0.0),
               "time": 0.0, "numbers": (2.0, 3.0, 2.0, 0.9)},
    radius=0.3, where=math.pi, out=1.0,
)  # fmt: skip
def test_no_option_of_a_group_costs_less_for_any_neighbour(encounter, radius, where, out):
    (x, y), duration, numbers = encounter["middle"], encounter["duration"], encounter["numbers"]
    neighbour = neighbour_of(encounter)
    least = pair_bound(x, y, radius, neighbour, numbers, duration)
    at = x + out * radius * math.cos(where), y + out * radius * math.sin(where)
    assert 0.0 <= least <= pair_cost(*at, neighbour, numbers, duration) + 1e-9


@settings(deadline=None)
@given(encounter=encounters)
def test_a_group_of_one_is_known_exactly_for_any_neighbour(encounter):
    middle, duration, numbers = encounter["middle"], encounter["duration"], encounter["numbers"]
    neighbour = neighbour_of(encounter)
    assert pair_bound(*middle, 0.0, neighbour, numbers, duration) == pytest.approx(
        pair_cost(*middle, neighbour, numbers, duration), abs=1e-9
    )


def test_a_bound_for_a_neighbour_is_worth_something():
    numbers = (1.0, 3.0, 0.6, 0.9)
    # Head on at 2 m/s from 4 m: in the 2 s until then options that end within 0.15 m, after 1.5 s,
    # drift 0.2 m aside, of which the square is missing. One to the side costs hardly more.
    oncoming = (4.0, 0.0, -1.0, 0.0)
    least = pair_bound(1.5, 0.0, 0.15, oncoming, numbers)
    assert least == pytest.approx(0.96 * 4.0 / 8.0)
    assert pair_cost(1.5, 0.15, oncoming, numbers) == pytest.approx(least, rel=0.01)
    # At 1.2 m/s, 1.1 at the least, upon somebody who stands 2 m away: the squares of 0.9, 1.1 and
    # 1.4 are 0.81, 1.21 and 1.96; in 5/3 s they drift a sixth of a metre.
    standing = (2.0, 0.0, 0.0, 0.0)
    assert pair_bound(1.8, 0.0, 0.15, standing, numbers) == pytest.approx(
        (1.0 - 1.0 / 36.0) * 0.4 / 1.15 * 4.0 / 6.0
    )
    # 0.45 m in 1.5 s are 0.3 m/s: 0.6 m aside in 2 s, and 0.9 m/s, at which nobody counts.
    assert pair_bound(1.5, 0.0, 0.45, oncoming, numbers) == pytest.approx(0.64 * 4.0 / 8.0)
    assert pair_bound(1.8, 0.0, 0.45, standing, numbers) == 0.0
