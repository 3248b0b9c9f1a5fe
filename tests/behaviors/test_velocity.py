import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mesa_mobility.behaviors import PreferredVelocity, VelocityChange

from mesa_mobility import MobilityMap, Options
from mesa_mobility.crowd import PRESETS
from mesa_mobility.crowd.options.repertoire import repertoire
from mesa_mobility.errors import ModelError
from tests.fixtures.options import (
    Chooser,
    Ending,
    candidates,
    crowded,
    one_option,
    shifts,
    turned_and_moved,
    turns,
)
from tests.fixtures.records import me, option, options

angles = st.floats(-math.pi, math.pi)
places = st.tuples(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0))


def cost(x, y, target, preferred, duration, start=(0.0, 0.0)):
    speed = math.dist((x, y), start) / duration
    return PreferredVelocity.kernel.function(
        option(x, y, 0.0, duration, speed), me(start, target, preferred)
    )


def bound(x, y, radius, target, preferred, duration, start=(0.0, 0.0)):
    return PreferredVelocity.bound.function(
        options(x, y, radius, 0.0, 0.3, duration, (0.0, 2.0)), me(start, target, preferred)
    )


@pytest.mark.parametrize(
    ("point", "start", "target", "preferred", "duration", "expected"),
    [
        ((1.5, 0.0), (0.0, 0.0), (5.0, 0.0), 1.0, 1.5, 0.0),  # just so
        ((0.0, 0.0), (0.0, 0.0), (5.0, 0.0), 1.0, 1.5, 1.5),  # stood still: all of 1.5 m
        ((0.0, 0.0), (0.0, 0.0), (5.0, 0.0), 1.0, 0.4, 1.5),  # for however long
        ((-1.5, 0.0), (0.0, 0.0), (5.0, 0.0), 1.0, 1.5, 3.0),  # the other way
        ((0.0, 1.5), (0.0, 0.0), (5.0, 0.0), 1.0, 1.5, 1.5 * math.sqrt(2.0)),  # across
        ((0.6, 0.0), (0.0, 0.0), (5.0, 0.0), 1.0, 0.4, 0.75),  # half a metre a second too fast
        ((2.0, 1.0), (2.0, 1.8), (2.0, 0.0), 1.25, 0.8, 0.375),  # 1 m/s down; 1.25 m/s desired
        ((1.24, 0.32), (1.0, 0.0), (4.0, 4.0), 0.5, 0.4, 0.75),  # 1 m/s along 3-4-5; half desired
        ((0.3, 0.4), (0.0, 0.0), (0.0, 0.0), 1.0, 1.5, 0.5),  # at the target one wants to stay
        ((0.3, 0.4), (0.0, 0.0), (9.0, 0.0), 0.0, 0.4, 1.875),  # so with no way to go
    ],
)
def test_numbers_worked_out_by_hand(point, start, target, preferred, duration, expected):
    shown = Chooser(
        [Ending(point, displacement=math.dist(point, start), duration=duration)],
        target=target,
        preferred_speed=preferred,
        position=start,
    )
    assert PreferredVelocity().cost(candidates(shown)) == pytest.approx([expected], abs=1e-12)


def test_a_near_target_does_not_slow_down():
    # Half a metre away the desired speed is 1 m/s as well, not what would end at the target.
    options = one_option(Ending((1.5, 0.0), displacement=1.5), target=(0.5, 0.0))
    assert PreferredVelocity().cost(options) == pytest.approx([0.0], abs=1e-12)


def test_each_one_walks_at_its_own_speed_to_its_own_target():
    to_the_right = Ending((1.5, 0.0), displacement=1.5, duration=1.5)
    first = Chooser([to_the_right], target=(9.0, 0.0), preferred_speed=1.0)
    second = Chooser([to_the_right] * 2, target=(-9.0, 0.0), preferred_speed=0.5)
    assert PreferredVelocity().cost(candidates(first, second)) == pytest.approx([0.0, 2.25, 2.25])


@given(crowded)
@settings(deadline=None)
def test_distance_from_the_wish_of_any_batch(options):
    displacement = options.points - options.positions[options.owner]
    aim = (options.targets - options.positions)[options.owner]
    away = np.linalg.norm(aim, axis=1, keepdims=True)
    e = np.divide(aim, away, out=np.zeros_like(aim), where=away > 0.0)
    seconds = options.durations[:, None]
    wish = options.preferred_speeds[options.owner][:, None] * e * seconds
    expected = np.linalg.norm(displacement - wish, axis=1) * 1.5 / options.durations
    np.testing.assert_allclose(PreferredVelocity().cost(options), expected, rtol=1e-9, atol=1e-9)


@given(crowded, turns, shifts)
@settings(deadline=None)
def test_does_not_depend_on_where_north_is(options, angle, by):
    # At the target itself rounding makes a direction out of nothing.
    here = (options.targets == options.positions).all(axis=1)[options.owner]
    np.testing.assert_allclose(
        PreferredVelocity().cost(turned_and_moved(options, angle, by))[~here],
        PreferredVelocity().cost(options)[~here],
        atol=1e-9,
    )


@settings(deadline=None)
@given(
    radius=st.floats(0.0, 0.6),
    option=st.tuples(angles, st.floats(0.0, 1.0)),
    start=places,
    target=places,
    preferred=st.floats(0.0, 2.0),
    duration=st.sampled_from([0.4, 0.8, 1.5]),
)
def test_no_option_of_a_group_costs_less_than_its_bound(
    radius, option, start, target, preferred, duration
):
    where, out = option
    x, y = 1.0 + out * radius * math.cos(where), -0.5 + out * radius * math.sin(where)
    least = bound(1.0, -0.5, radius, target, preferred, duration, start)
    assert 0.0 <= least <= cost(x, y, target, preferred, duration, start) + 1e-9


def test_a_bound_is_worth_something():
    # Desired: 1.5 m ahead. A group 0.5 m around the start comes within 1 m of it, in 1.5 s.
    assert bound(0.0, 0.0, 0.5, (9.0, 0.0), 1.0, 1.5) == pytest.approx(1.0)
    assert bound(1.0, 0.0, 0.6, (9.0, 0.0), 1.0, 1.5) == 0.0
    assert bound(0.7, 0.2, 0.0, (9.0, 0.0), 1.0, 0.8) == pytest.approx(
        cost(0.7, 0.2, (9.0, 0.0), 1.0, 0.8)
    )


@pytest.mark.parametrize("preferred", [0.0, 0.7, 1.34])
def test_bounds_hold_for_the_groups_of_the_map_that_ships(preferred):
    rules = PRESETS["default"]
    known = repertoire((MobilityMap.load(None),), rules.durations, rules.shares)
    rng = np.random.default_rng(3)
    bounds = np.append(known.table.groups, len(known.table.options))
    for g in rng.choice(len(known.table.groups), 300, replace=False).tolist():
        target = rng.uniform(-3.0, 3.0, 2)
        group_of = Options(*known.groups.ends[:, g])
        least = PreferredVelocity.bound.function(group_of, me((0.0, 0.0), target, preferred))
        group = known.table.options[bounds[g] : bounds[g + 1]]
        costs = [
            cost(float(o.x), float(o.y), target, preferred, int(o.frames) / 30.0) for o in group
        ]
        assert least <= min(costs) + 1e-5


# -- the velocity of the movement before --------------------------------------------------------


@pytest.mark.parametrize(
    ("point", "start", "velocity", "duration", "expected"),
    [
        ((1.5, 0.0), (0.0, 0.0), (1.0, 0.0), 1.5, 0.0),  # on as before
        ((0.4, 0.0), (0.0, 0.0), (1.0, 0.0), 0.4, 0.0),  # for however long
        ((0.0, 0.0), (0.0, 0.0), (1.0, 0.0), 0.4, 1.0),  # halting
        ((0.8, 0.0), (0.0, 0.0), (0.0, 0.0), 0.8, 0.0),  # setting off costs nothing
        # 0.9 and 0.5 m/s more, after 0.1 and 0.5 m/s: a sixth and five sixths count.
        ((0.8, 0.0), (0.0, 0.0), (0.1, 0.0), 0.8, 0.15),
        ((0.8, 0.0), (0.0, 0.0), (0.5, 0.0), 0.8, 2.5 / 6.0),
        # From 0.6 m/s on, in whatever direction, it counts in full.
        ((0.8, 0.0), (0.0, 0.0), (0.6, 0.0), 0.8, 0.4),
        ((0.0, 0.0), (0.0, 0.0), (-0.36, 0.48), 0.8, 0.6),
        ((0.0, 0.0), (0.0, 0.0), (0.18, -0.24), 0.8, 0.15),  # halting after 0.3: half of it
        ((-1.5, 0.0), (0.0, 0.0), (1.0, 0.0), 1.5, 2.0),  # back
        # Round a corner: 1 m/s less ahead, and 1.5 times 1 m/s to the side.
        ((0.0, 1.5), (0.0, 0.0), (1.0, 0.0), 1.5, math.sqrt(3.25)),
        # 1 m/s after 0.7 and 0.4 aside: 0.3 and -0.4 m/s more, 0.05 / w along the way and 0.4 / w
        # across it, where w is the speed of 0.65 ** 0.5 m/s.
        ((2.9, 1.0), (2.5, 1.0), (0.7, 0.4), 0.4, math.sqrt((0.05**2 + 0.6**2) / 0.65)),
    ],
)
def test_changes_worked_out_by_hand(point, start, velocity, duration, expected):
    shown = Chooser(
        [Ending(point, displacement=math.dist(point, start), duration=duration)],
        position=start,
        velocity=velocity,
    )
    assert VelocityChange(turning=1.5).cost(candidates(shown)) == pytest.approx(
        [expected], abs=1e-12
    )


def test_each_ones_own_velocity_counts():
    on = Ending((1.5, 0.0), displacement=1.5, duration=1.5)
    first, second = Chooser([on], velocity=(1.0, 0.0)), Chooser([on] * 2, velocity=(0.3, 0.0))
    costs = VelocityChange().cost(candidates(first, second))
    # 0.7 m/s more, of which half counts after half of 0.6 m/s.
    assert costs == pytest.approx([0.0, 0.35, 0.35], abs=1e-12)


def test_the_walking_speed_given_is_used():
    # On at 1 m/s after 0.8 m/s: all of 0.2 m/s, and half of it where walking is 1.6 m/s.
    options = one_option(Ending((1.5, 0.0), displacement=1.5, duration=1.5), velocity=(0.8, 0.0))
    assert VelocityChange().cost(options) == pytest.approx([0.2], abs=1e-12)
    assert VelocityChange(walking=1.6).cost(options) == pytest.approx([0.1], abs=1e-12)


@pytest.mark.parametrize("walking", [0.0, -0.6, math.nan, math.inf])
def test_a_walking_speed_out_of_range_is_refused_in_one_line(walking):
    says = r"^velocity_change: walking .*expected more than 0 m/s$"
    with pytest.raises(ModelError, match=says) as caught:
        VelocityChange(walking=walking)
    assert "\n" not in str(caught.value)


def test_a_turning_factor_of_one_counts_all_directions_alike():
    round_a_corner = one_option(
        Ending((0.0, 1.5), displacement=1.5, duration=1.5), velocity=(1.0, 0.0)
    )
    for turning, expected in ((1.0, math.sqrt(2.0)), (3.0, math.sqrt(10.0))):
        cost = VelocityChange(turning=turning).cost(round_a_corner)
        assert cost == pytest.approx([expected], abs=1e-12)


@pytest.mark.parametrize("turning", [0.0, 0.99, -2.0, math.nan, math.inf])
def test_a_turning_factor_out_of_range_is_refused_in_one_line(turning):
    with pytest.raises(ModelError, match=r"^velocity_change: turning .*expected 1 or more$"):
        VelocityChange(turning=turning)


@given(crowded)
@settings(deadline=None)
def test_change_of_any_batch(options):
    moved = options.points - options.positions[options.owner]
    velocity = moved / options.durations[:, None]
    before = options.velocities[options.owner]
    share = np.minimum(np.linalg.norm(before, axis=1) / 0.6, 1.0)
    ways = before @ [1.0, 1.0j]
    ways = np.where(ways == 0.0, 1.0, ways)
    # As seen by somebody who walks along the real axis.
    seen = ((velocity - before) @ [1.0, 1.0j]) / (ways / abs(ways))
    expected = share * abs(seen.real + 2.5j * seen.imag)
    costs = VelocityChange(turning=2.5).cost(options)
    np.testing.assert_allclose(costs, expected, rtol=1e-9, atol=1e-9)


@given(crowded, turns, shifts)
@settings(deadline=None)
def test_a_change_does_not_depend_on_where_north_is(options, angle, by):
    costs = VelocityChange().cost(turned_and_moved(options, angle, by))
    np.testing.assert_allclose(costs, VelocityChange().cost(options), atol=1e-9)


def change_at_least(x, y, radius, duration, velocity):
    return VelocityChange.bound.function(
        options(x, y, radius, 0.0, 0.3, duration, (0.0, 2.0)),
        me(velocity=velocity),
        VelocityChange(),
    )


def test_the_bound_of_a_change_is_worth_something():
    # 1.5 m in 1.5 s after 2 m/s; somewhere within 0.3 m of there, which is 0.2 m/s.
    assert change_at_least(1.5, 0.0, 0.3, 1.5, (2.0, 0.0)) == pytest.approx(0.8)
    assert change_at_least(1.5, 0.0, 0.0, 1.5, (0.0, -1.0)) == pytest.approx(math.sqrt(3.25))
    # 0.7 and 0.5 m/s more than the 0.3 m/s before, of which half counts.
    assert change_at_least(1.5, 0.0, 0.0, 1.5, (0.3, 0.0)) == pytest.approx(0.35)
    assert change_at_least(1.5, 0.0, 0.3, 1.5, (0.3, 0.0)) == pytest.approx(0.25)
    # Nothing counts after standing.
    assert change_at_least(1.5, 0.0, 0.0, 1.5, (0.0, 0.0)) == 0.0
    # As before is among what a wide group offers.
    assert change_at_least(1.5, 0.0, 0.3, 1.5, (1.1, 0.0)) == 0.0
    assert change_at_least(0.4, 0.0, 0.3, 0.4, (1.0, 0.7)) == 0.0
