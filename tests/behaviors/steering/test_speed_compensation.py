"""Free walkers correct their accumulated distance error."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mesa_mobility.behaviors.steering.speed_compensation import (
    FREELY,
    MAKES_UP,
    MOST,
    compensate_speed,
)

from mesa_mobility.crowd.state.records import NO_OPTION, Crowd
from tests.fixtures.maps import make_map, stand, straight
from tests.fixtures.scenes import corridor, model_of, put


def after(walked: float, *, desired: float = 1.25, frames: int = 45, behind: float = 0.0) -> Crowd:
    """A person with a desired speed that has walked so many metres in so many frames."""
    crowd = Crowd(1)
    crowd.from_x[:], crowd.from_y[:] = 2.0, -1.0
    # 3-4-5: a movement along neither axis.
    crowd.to_x[:], crowd.to_y[:] = 2.0 + 0.6 * walked, -1.0 + 0.8 * walked
    crowd.target_x[:], crowd.target_y[:] = 2.0 + 6.0, -1.0 + 8.0
    crowd.start[:], crowd.end[:], crowd.option[:] = 30, 30 + frames, 7
    crowd.agenda["desired_speed"], crowd.agenda["behind"] = desired, behind
    return crowd


def next_speed(crowd: Crowd, speed: float = 1.25) -> float:
    return float(compensate_speed(np.array([0]), crowd, np.array([speed]))[0])


@pytest.mark.parametrize(
    ("walked", "behind", "expected"),
    [
        (1.875, 0.0, 1.25),  # 1.25 m/s for 1.5 s
        (1.95, 0.0, 1.20),  # 7.5 cm too far: 5 cm/s less for 1.5 s
        (1.80, 0.0, 1.30),
        (1.80, 0.06, 1.34),  # and 6 cm from before
        (1.80, 0.60, 17 / 12),  # nobody is further behind than 25 cm
        (1.95, -0.60, 13 / 12),
        (1.70, 0.06, 1.25 + 0.235 / 1.5),  # 0.12 m/s too slow
        (1.56, 0.06, 1.25),  # 0.21 m/s too slow: it could not walk freely, and starts anew
        # 0.117 m/s too fast, of which 0.04 make up for the 6 cm: it is 11.5 cm ahead now.
        (2.05, 0.06, 1.25 - 0.115 / 1.5),
        # 0.15 m/s too fast, as somebody is whose recordings have no slower step.
        (2.10, 0.06, 1.25 - 0.165 / 1.5),
        (2.25, 0.06, 1.25),  # 0.25 m/s too fast, more than 0.2 + 0.04
    ],
)
def test_by_hand(walked, behind, expected):
    crowd = after(walked, behind=behind)
    assert next_speed(crowd) == pytest.approx(expected)
    assert crowd.agenda["desired_speed"][0] == 1.25


def test_ground_beside_the_way_to_the_target_does_not_count():
    # 1.95 m along (0.6, 0.8); the way to the target is at 16.26 degrees to it, cosine 0.96.
    crowd = after(1.95)
    crowd.target_x[:], crowd.target_y[:] = 2.0 + 8.0, -1.0 + 6.0
    assert next_speed(crowd) == pytest.approx(1.25 + (1.875 - 0.96 * 1.95) / 1.5)


def test_all_ground_counts_where_the_target_was_a_corner_on_the_way():
    crowd = after(1.95)
    crowd.target_x[:], crowd.target_y[:] = 2.0 + 0.5, -1.0
    assert next_speed(crowd) == pytest.approx(1.20)


def test_a_slow_person_who_makes_a_long_step_waits_until_it_is_made_up_for():
    # 0.32 m in 1.5 s where 0.03 are due: 29 cm ahead, more than is kept of several movements.
    crowd = after(0.32, desired=0.02)
    assert next_speed(crowd, 0.02) == 0.0
    assert crowd.agenda["behind"][0] == pytest.approx(-0.29)


def test_the_error_starts_anew_before_the_first_move_and_after_a_fallback():
    for option in (NO_OPTION, -2):
        crowd = after(1.95)
        crowd.option[:] = option
        assert next_speed(crowd) == 1.25
        assert crowd.agenda["behind"][0] == 0.0


def test_people_who_stand_stay():
    assert next_speed(after(1.80), 0.0) == 0.0
    # The error belongs to the old preferred speed; nobody walks backwards to correct it.
    assert next_speed(after(1.95, behind=-0.15), 0.01) == 0.0


@settings(deadline=None)  # compiled at the first
@given(
    walked=st.floats(0.0, 4.0),
    desired=st.floats(0.0, 2.0),
    frames=st.sampled_from([12, 24, 45]),
    behind=st.floats(-MOST, MOST),
    speed=st.floats(0.0, 2.0),
)
def test_within_bounds(walked, desired, frames, behind, speed):
    crowd = after(walked, desired=desired, frames=frames, behind=behind)
    got = next_speed(crowd, speed)
    assert got >= 0.0
    # Nobody is further ahead than 25 cm, or than what one free movement leads too far.
    most = max(MOST, (max(behind / MAKES_UP, 0.0) + FREELY) * frames / 30.0)
    assert -most / MAKES_UP - 1e-12 <= got - speed <= MOST / MAKES_UP + 1e-12
    # Whoever makes up for an error may be faster or slower than preferred by as much.
    allowed = [min(behind / MAKES_UP, 0.0) - FREELY, max(behind / MAKES_UP, 0.0) + FREELY]
    faster = walked / (frames / 30.0) - desired
    if not allowed[0] - 1e-9 <= faster <= allowed[1] + 1e-9:
        assert got == speed


@pytest.mark.parametrize(
    ("slow", "fast", "speed"),
    [(1.1, 1.2, 1.12), (1.1, 1.2, 1.15), (1.1, 1.2, 1.18), (1.05, 1.3, 1.205)],
)
def test_on_average_everybody_walks_at_its_own_speed(slow, fast, speed):
    # Steps of two speeds alone: who likes another speed takes now the one, now the other.
    steps = [straight(1.5 * slow, 45), straight(1.5 * fast, 45)]
    model = model_of(corridor(length=80.0), make_map([[stand(), *steps], steps]), rng=1)
    person = put(model, 1.0, 2.0, preferred_speeds=speed)
    times = {}
    while model.inside and model.frame < 3000:
        model.step()
        for line in (10.0, 70.0):
            if model.inside and person.position[0] >= line:
                times.setdefault(line, model.elapsed)
    walked = 60.0 / (times[70.0] - times[10.0])
    assert walked == pytest.approx(speed, abs=0.01)
