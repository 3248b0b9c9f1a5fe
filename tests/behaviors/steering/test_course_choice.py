"""People who are held up go where they get on."""

import cmath
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mesa_mobility.behaviors import ChooseCourse
from mesa_mobility.behaviors.steering.course_choice import CourseSettings, choose_courses
from shapely import box

from mesa_mobility import Exit, FloorPlan
from mesa_mobility.crowd.state.records import Crowd
from mesa_mobility.crowd.state.view import CrowdView
from mesa_mobility.errors import ModelError
from mesa_mobility.steering import sight_on

HALL = FloorPlan(box(0.0, 0.0, 40.0, 40.0), exits=[Exit("east", (40.0, 0.0), (40.0, 40.0))])
AT = complex(20.0, 20.0)
SPEED = 1.2
HASTE, WIDTH = 8.0, 0.4


def look(
    *others, plan=HALL, velocity=SPEED + 0j, away=12.0, speed=SPEED, haste=HASTE, west=(), wait=()
):
    """The angle, radians, by which somebody at ``AT`` turns who wants to walk east.

    ``others`` are (place from there, velocity), complex, in metres and m/s.  All want to walk east
    but those numbered in ``west``, and do but those in ``wait``.
    """
    places = np.array([AT, *(AT + place for place, _ in others)])
    velocities = np.array([velocity, *(v for _, v in others)])
    crowd = Crowd(len(places))
    crowd.x[:], crowd.y[:] = places.real, places.imag
    crowd.vx[:], crowd.vy[:] = velocities.real, velocities.imag
    crowd.target_x[:], crowd.target_y[:] = places.real + 5.0, places.imag
    for k in west:
        crowd.target_x[1 + k] -= 10.0
    for k in wait:
        crowd.agenda["waits_until"][1 + k] = 31
    wanted = np.array([[AT.real + away, AT.imag]])
    inside = CrowdView(np.arange(len(places)), crowd)
    (found,) = choose_courses(
        np.array([0]),
        inside,
        30,
        sight_on(plan, 0.0),
        wanted,
        np.array([speed]),
        CourseSettings(haste, WIDTH),
    )
    assert wanted.tolist() == [[AT.real + away, AT.imag]]
    turned = complex(*found) - AT
    assert abs(turned) == pytest.approx(away)
    return cmath.phase(turned) if away else 0.0


def test_somebody_alone_goes_straight():
    assert look() == 0.0


def test_somebody_who_stands_right_ahead_is_passed():
    # Straight on they get 1 - 0.4 of 4.8 m in 4 s: 8 x 1.2 x (1 - 0.6 / 4.8) = 8.4. The fifth
    # course is turned by 0.8 x (5 / 6)^2 = 0.556 rad and passes 0.53 m from somebody 1 m away; it
    # costs 8 x 1.2 x (1 - cos) = 1.44, and 2.4 x sin(0.278) = 0.66 for the change. The fourth, of
    # 0.356 rad, passes 0.35 m away, which holds them up by a quarter: 2.7 and 0.4.
    angle = look((1.0 + 0j, 0j))
    assert abs(angle) == pytest.approx(0.8 * (5 / 6) ** 2)
    assert look((1.0 + 0j, 0j), haste=0.0) == 0.0


@pytest.mark.parametrize("side", [1, -1])
def test_of_two_sides_the_free_one_is_taken(side):
    queue = [(complex(1.0 + 0.5 * k, side * 0.3 * j), 0j) for k in range(4) for j in range(4)]
    assert np.sign(look(*queue)) == -side


@pytest.mark.parametrize(
    "other",
    [
        (1.0 + 0j, SPEED + 0j),  # as fast
        (-1.0 + 0j, 0j),  # behind
        (1.0 + 0.45j, 0j),  # beside the way
        (4.1 + 0j, 0j),  # too far
        (2.5 + 0j, 0.8 + 0j),  # 0.4 m/s slower, and not caught up with in 4 s
    ],
)
def test_who_does_not_hold_one_up(other):
    assert look(other) == 0.0


BLOCKED = (1.0 + 0j, 0j)


@pytest.mark.parametrize("other", [(1.0 + 0j, 0j), (5.0 + 1.0j, -1.0 + 0j), (2.0 - 3.0j, 0j)])
def test_nobody_leaves_their_course_while_somebody_comes_the_other_way(other):
    assert look(BLOCKED, other) != 0.0
    assert look(BLOCKED, other, west=[1]) == 0.0


@pytest.mark.parametrize(
    "other",
    [
        (-1.0 + 0j, 0j),  # behind
        (6.1 + 0j, 0j),  # too far
        (5.0 + 4.0j, 0j),  # 6.4 m away
        (5.5 + 0j, 0j),  # beyond the target
    ],
)
def test_who_does_not_come_the_other_way(other):
    assert look(BLOCKED, other, away=5.2, west=[1]) == look(BLOCKED, away=5.2) != 0.0


def test_whoever_waits_does_not_come_nor_does_anybody_behind_a_wall():
    other = (5.0 + 1.0j, 0j)
    assert look(BLOCKED, other, west=[1], wait=[1]) == look(BLOCKED) != 0.0
    wall = HALL.altered(obstacles=[box(24.0, 20.6, 24.2, 40.0)])
    assert look(BLOCKED, other, plan=wall, west=[1]) != 0.0


def test_nobody_passes_people_behind_the_target():
    assert look((2.0 + 0j, 0j), away=1.5) == 0.0
    assert look((1.0 + 0j, 0j), away=0.0) == 0.0


def test_no_course_leads_into_a_wall_and_people_behind_one_do_not_count():
    # The wall runs 0.3 m to the left of the way.
    beside = HALL.altered(obstacles=[box(20.0, 20.3, 40.0, 20.5)])
    assert look((1.0 - 0.15j, 0j), plan=HALL) > 0.0
    assert look((1.0 - 0.15j, 0j), plan=beside) < 0.0
    across = HALL.altered(obstacles=[box(20.5, 19.5, 20.6, 20.5)])
    assert look((1.0 + 0j, 0j), plan=across) == 0.0


# Millimetres, and not on the edge of what is near: adding AT would move them over it.
METRES = st.integers(-3500, 3500).map(lambda millimetres: millimetres / 1000.0)
PLACES = st.tuples(METRES, METRES, st.floats(-1.5, 1.5)).filter(
    lambda person: abs(math.hypot(person[0], person[1]) - 4.0) > 1e-6
)


@given(st.lists(PLACES, max_size=12), st.floats(0.0, 1.6), st.floats(0.2, 1.8))
@settings(max_examples=150, deadline=None)
def test_the_course_is_the_cheapest_of_fifteen(others, now, preferred):
    people = [(complex(x, y), complex(v, 0.0)) for x, y, v in others]
    speed = min(preferred, now + 0.4)
    far = min(4.0 * speed, 12.0)
    turns = np.array([0.0, *(sign * 0.8 * (k / 6) ** 2 for k in range(1, 8) for sign in (-1, 1))])
    costs = []
    for turn in turns:
        course, on = cmath.exp(1j * turn), far
        for place, v in people:
            if place.real <= 0.0 or abs(place) > 4.0:
                continue
            along, aside = (place / course).real, abs((place / course).imag)
            share = min(max(2.0 * (1.0 - aside / WIDTH), 0.0), 1.0)
            theirs = max((v / course).real, 0.0) * far / speed
            if along > 0.0:
                on = min(on, far - share * max(far - max(along - 0.4, 0.0) - theirs, 0.0))
        lost = speed * (1.0 - math.cos(turn) * on / far)
        costs.append(2.0 * speed * math.sin(abs(turn) / 2.0) + HASTE * lost)
    found = look(*people, velocity=complex(now, 0.0), speed=preferred)
    least = np.abs(turns - found).argmin()
    assert turns[least] == pytest.approx(found, abs=1e-9)
    assert costs[least] == pytest.approx(min(costs), abs=1e-9)


@pytest.mark.parametrize(
    ("numbers", "text"),
    [
        ({"haste": -1.0}, "haste"),
        ({"width": 0.0}, "width"),
    ],
)
def test_numbers_out_of_range(numbers, text):
    with pytest.raises(ModelError, match=f"course_choice: {text}"):
        ChooseCourse(**numbers)
