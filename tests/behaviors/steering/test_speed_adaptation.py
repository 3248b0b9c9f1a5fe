"""People walk as fast as those ahead of them let them."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mesa_mobility.behaviors.steering.speed_adaptation import adapt_speeds
from shapely import box

from mesa_mobility import Exit, FloorPlan
from mesa_mobility.crowd.state.records import Crowd
from mesa_mobility.crowd.state.view import CrowdView
from tests.fixtures.maps import shipped_map
from tests.fixtures.scenes import model_of

AT = complex(20.0, 20.0)
OWN = 1.4


def speed(*others, way=12.0 + 0j, own=OWN):
    """m/s of somebody at ``AT`` who goes ``way``; others are (place from there, velocity)."""
    crowd = Crowd(len(others) + 1)
    places = np.array([AT, *(AT + place for place, _ in others)])
    velocities = np.array([0j, *(velocity for _, velocity in others)])
    crowd.x[:], crowd.y[:] = places.real, places.imag
    crowd.vx[:], crowd.vy[:] = velocities.real, velocities.imag
    target = np.array([[(AT + way).real, (AT + way).imag]])
    rows = np.arange(len(places))
    return float(
        adapt_speeds(rows[:1], CrowdView(rows, crowd).grid, crowd, target, np.array([own]))[0]
    )


@pytest.mark.parametrize(
    ("gap", "ahead", "expected"),
    [
        # u + (g - 0.28 - 0.7 u) / 3
        (1.52, 1.2, 1.2 + 0.4 / 3.0),
        (1.12, 1.2, 1.2),
        (0.82, 1.2, 1.1),
        (3.58, 0.5, 0.5 + 2.95 / 3.0),
        # Never more than its own, nor less than three quarters of it.
        (3.9, 1.0, OWN),
        (0.29, 0.0, 1.05),
        (2.0, 0.0, 1.05),
    ],
)
def test_it_follows_from_the_gap_and_the_speed_of_those_ahead(gap, ahead, expected):
    assert speed((gap, ahead + 0j)) == pytest.approx(min(expected, OWN))


@pytest.mark.parametrize(
    "other",
    [
        (-1.0, 0j),  # behind
        (1.0 + 0.26j, 0j),  # beside the strip
        (1.0 - 0.26j, 0j),
        (4.1, 0j),  # too far
        (1.0, -0.4 + 0j),  # comes towards it
    ],
)
def test_who_does_not_count(other):
    assert speed(other) == OWN


def test_those_to_the_side_count_by_their_share():
    # 0.125 m of 0.25 m aside: half of what is lacking straight ahead.
    straight = speed((1.0, 0j))
    assert speed((1.0 + 0.125j, 0j)) == pytest.approx((straight + OWN) / 2.0)


def test_the_slowest_of_several_decides():
    near, far = (1.0 + 0j, 1.2 + 0j), (1.5 + 0j, 0.9 + 0j)
    assert OWN > speed(near) > speed(far) > 0.75 * OWN
    assert speed(near, far) == min(speed(near), speed(far))


def test_somebody_who_has_arrived_or_waits_keeps_its_speed():
    assert speed((0.5, 0j), way=0j) == OWN
    assert speed((0.5, 0j), own=0.0) == 0.0


places = st.complex_numbers(max_magnitude=6.0)
velocities = st.complex_numbers(max_magnitude=2.0)


@given(st.lists(st.tuples(places, velocities), max_size=5), st.floats(0.1, 2.0))
def test_it_lies_between_three_quarters_of_its_own_and_its_own(others, own):
    assert 0.75 * own - 1e-12 <= speed(*others, own=own) <= own


@given(st.lists(st.tuples(places, velocities), max_size=4), st.sampled_from([1j, -1.0, -1j]))
def test_it_does_not_depend_on_where_north_is(others, turn):
    # Quarter turns about the own place are exact but for the rounding of sums.
    others = [(complex(round(p.real, 3), round(p.imag, 3)), v) for p, v in others]
    edges = {abs(p.imag) for p, _ in others} | {abs(p.real) for p, _ in others}
    if any(abs(edge - limit) < 1e-6 for edge in edges for limit in (0.0, 0.25, 4.0)):
        return
    turned = [(p * turn, v * turn) for p, v in others]
    assert speed(*turned, way=12.0 * turn) == pytest.approx(speed(*others), abs=1e-6)


def test_a_platoon_takes_over_the_speed_of_its_slow_leader():
    plan = FloorPlan(box(0.0, 0.0, 60.0, 0.5), exits=[Exit("end", (60.0, 0.0), (60.0, 0.5))])
    model = model_of(plan, shipped_map(), rng=1)
    model.add_pedestrians(
        [(1.0 + 1.5 * k, 0.25) for k in range(4)],
        headings=[0.0] * 4,
        preferred_speeds=[1.5, 1.5, 1.5, 0.7],
    )
    for _ in range(1800):
        model.step()
    rows = model.recorder.arrays()
    # They close up first, and then keep their distance for 42 s.
    late = rows["frame"] >= 540
    for person in range(4):
        own = late & (rows["person"] == person)
        way = np.ptp(rows["x"][own])
        assert way / (np.ptp(rows["frame"][own]) / 30.0) == pytest.approx(0.7, abs=0.05)
