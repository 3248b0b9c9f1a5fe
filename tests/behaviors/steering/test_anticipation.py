"""People who walk turn aside early for those whom they would come too near."""

import cmath
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mesa_mobility.behaviors.steering.anticipation import Anticipation, turn_aside
from shapely import box

from mesa_mobility import Exit, FloorPlan, PedestrianModel, PedestrianType
from mesa_mobility.crowd.state.records import Crowd
from mesa_mobility.crowd.state.view import CrowdView
from mesa_mobility.errors import ModelError
from tests.fixtures.maps import shipped_map
from tests.fixtures.oracles.counting import overlaps
from tests.fixtures.scenes import model_of

HALL = FloorPlan(
    box(0.0, 0.0, 40.0, 40.0),
    exits=[Exit("east", (40.0, 0.0), (40.0, 40.0)), Exit("west", (0.0, 0.0), (0.0, 40.0))],
)
AT = complex(20.0, 20.0)
SPEED = 1.4


def look(*others, plan=HALL, velocity=SPEED + 0j, target=AT + 12.0, speed=SPEED, waits=()):
    """(angle, share): what becomes of the target and the speed of somebody at ``AT``.

    ``others`` are (place from there, velocity, way to the target), complex, in metres and m/s.
    """
    everybody = [(AT, velocity, target - AT), *((AT + a, v, way) for a, v, way in others)]
    crowd = Crowd(len(everybody))
    places, velocities, ways = (np.array(each) for each in zip(*everybody, strict=True))
    crowd.x[:], crowd.y[:] = places.real, places.imag
    crowd.vx[:], crowd.vy[:] = velocities.real, velocities.imag
    crowd.target_x[:], crowd.target_y[:] = (places + ways).real, (places + ways).imag
    crowd.core[:], crowd.agenda["waits_until"] = 0.14, 0
    crowd.agenda["waits_until"][list(waits)] = 1000
    wanted = np.array([[target.real, target.imag]])
    points, speeds = turn_aside(
        np.array([0]),
        CrowdView(np.arange(len(places)), crowd).grid,
        10,
        crowd,
        plan,
        wanted,
        np.array([speed]),
    )
    assert wanted.tolist() == [[target.real, target.imag]]
    found = complex(*points[0]) - AT
    assert abs(found) == pytest.approx(abs(target - AT))
    return cmath.phase(found / (target - AT)) if found else 0.0, speeds[0] / speed


@pytest.mark.parametrize(("kind", "room"), [("able_bodied", 0.5), ("wheelchair_manual", 0.85)])
def test_people_who_meet_keep_as_much_room_between_wide_bodies(kind, room):
    # Some 0.4 m: between cores of 0.14 m each, and between those of 0.35 m.
    types, least = [PedestrianType.named(kind)], []
    for seed in range(1, 4):
        model = PedestrianModel(HALL, pedestrian_types=types, rng=seed)
        one, other = (
            *model.add_pedestrians([(15.0, 20.0)], exits=["east"], preferred_speeds=0.9),
            *model.add_pedestrians(
                [(25.0, 20.1)], exits=["west"], headings=[math.pi], preferred_speeds=0.9
            ),
        )
        least.append(math.inf)
        while model.elapsed < 10.0:
            model.step()
            least[-1] = min(least[-1], np.hypot(*(one.position - other.position)))
    assert min(least) > room


def test_alone_nothing_changes():
    assert look() == (0.0, 1.0)


@pytest.mark.parametrize("away", [4.0, 6.0, 8.5])
def test_of_two_who_meet_head_on_both_keep_to_the_right(away):
    angle, share = look((away, -SPEED, -12.0))
    assert angle < -math.radians(5.0)
    assert share == 1.0


@pytest.mark.parametrize("aside", [0.3, -0.3])
def test_somebody_in_the_way_on_one_side_is_passed_on_the_other(aside):
    # Stands 4 m ahead: LEFT weighs less than 0.3 m of the way.
    angle, _ = look((4.0 + aside * 1j, 0.0, 0.0))
    assert np.sign(angle) == -np.sign(aside)


@pytest.mark.parametrize(
    "other",
    [
        (4.0 + 0.8j, -SPEED, -12.0),  # passes 0.8 m away
        (9.5 + 0j, -SPEED, -12.0),  # too far
        (-1.0 + 0j, 3.0, 12.0),  # behind
        (2.0 + 0j, 0.6, 12.0),  # 0.8 m/s slower, on the same way
        (2.0 + 0j, 0.2, 12.0),  # in a queue
        (1.0 + 2.0j, -0.2j, -12.0j),  # in a queue across
        (2.0 + 0j, SPEED, -12.0),  # as fast
    ],
)
def test_who_does_not_count(other):
    assert look(other) == (0.0, 1.0)


def test_people_who_wait_count_even_where_their_way_is_the_same():
    queued = (4.0 + 0.1j, 0.0, 12.0)
    assert look(queued) == (0.0, 1.0)
    assert look(queued, waits=[1])[0] < 0.0


def test_somebody_who_stands_or_has_arrived_sets_nothing_aside():
    coming = (4.0 + 0j, -SPEED, -12.0)
    assert look(coming, velocity=0j) == (0.0, 1.0)
    assert look(coming, target=AT) == (0.0, 1.0)
    assert look(coming, speed=1e-9)[0] == pytest.approx(look(coming, speed=1e-9)[0])


def test_nobody_turns_aside_for_people_behind_the_target():
    # It is reached after 1.5 m; the other stands 3 m away.
    assert look((3.0 + 0j, 0.0, 0.0), target=AT + 1.5) == (0.0, 1.0)
    assert look((3.0 + 0j, 0.0, 0.0))[0] != 0.0


def test_people_behind_a_wall_do_not_count():
    wall = box(21.0, 15.0, 21.2, 25.0)
    walled = FloorPlan(HALL.walkable, exits=HALL.exits, obstacles=[wall])
    coming = (4.0 + 0j, -SPEED, -12.0)
    assert look(coming, plan=walled) == (0.0, 1.0)
    assert look(coming)[0] < 0.0


def best_course(others, speed):
    """Least cost of any course, and of straight on, by the sentences of the module's heading."""
    full = 1.4**2 - 0.9**2
    counted = []
    for place, velocity in others:
        relative = abs(velocity - speed)
        if place.real > 0.0 and abs(place) <= 9.0 and relative > 0.9:
            weight = 3.0 * min((relative**2 - 0.81) / full, 1.0) * 4.0 / (4.0 + abs(place))
            counted.append((place, velocity, weight))

    def too_near(place, velocity, course):
        times = np.linspace(0.0, 40.0, 40001)
        gaps = abs(place + (velocity - course) * times)
        return gaps.argmin() > 0 and gaps.min() < min(0.65, 0.6 * abs(place))

    comes = any(
        too_near(place, velocity, cmath.rect(share * speed, math.copysign(0.8 * (k / 6) ** 2, k)))
        for place, velocity, _ in counted
        if velocity.real < 0.0
        for k in range(-6, 7)
        for share in (1.0, 0.7)
    )
    left = 0.5 if comes else 0.1

    def cost(angle, share):
        course = cmath.rect(share * speed, angle)
        total = abs(course - speed) + (left if angle > 0.0 else 0.0)
        for place, velocity, weight in counted:
            times = np.linspace(0.0, 4.0, 4001)
            gaps = abs(place + (velocity - course) * times)
            if gaps.argmin() > 0:
                room = min(0.65, 0.6 * abs(place))
                total += weight * max(1.0 - (gaps.min() / room) ** 2, 0.0)
        return total

    return cost


# Abreast and at the limit of what counts, the least rounding decides whether somebody counts.
places = st.complex_numbers(min_magnitude=0.5, max_magnitude=10.0).filter(
    lambda place: abs(place.real) > 1e-9 and abs(abs(place) - 9.0) > 1e-9
)
velocities = st.complex_numbers(min_magnitude=0.6, max_magnitude=2.0)


@given(st.lists(st.tuples(places, velocities), min_size=1, max_size=5))
@settings(deadline=None)
def test_the_course_is_the_cheapest_of_all(others):
    # Whose ways lead elsewhere, whatever their velocities.
    angle, share = look(*((place, velocity, -12.0) for place, velocity in others))
    cost = best_course(others, SPEED)
    # Six turns to each side, denser near straight on: a little is enough for those far away.
    turns = [math.copysign(0.8 * (k / 6.0) ** 2, k) for k in range(-6, 7)]
    courses = [cost(turn, s) for turn in turns for s in (1.0, 0.7)]
    assert cost(angle, share) <= min(courses) + 5e-3


@pytest.mark.parametrize("aside", [-0.2, 0.0, 0.2])
def test_two_people_pass_each_other_with_room(aside):
    # Pelvises of people who meet head-on stay 0.65 to 1.05 m apart; bodies of 0.14 m touch at 0.28.
    model = model_of(HALL, shipped_map(), rng=1)
    model.add_pedestrians([(16.0, 20.0)], exits=["east"])
    model.add_pedestrians([(24.0, 20.0 + aside)], exits=["west"], headings=[math.pi])
    for _ in range(240):
        model.step()
    rows = model.recorder.arrays()
    tracks = [np.column_stack([rows["x"], rows["y"]])[rows["person"] == p] for p in (0, 1)]
    assert np.hypot(*(tracks[0] - tracks[1]).T).min() >= 0.6
    assert overlaps(rows, 0.14) == 0


def test_courses_of_those_who_walk_alone_wander_by_the_angle_that_is_set():
    model = PedestrianModel(HALL, rng=1)
    model.tactics[:] = [Anticipation(wander=0.05)]
    places = [(x, y) for x in range(1, 30, 2) for y in range(1, 40, 2)]
    people = model.add_pedestrians(places, preferred_speeds=1.3, exits=["east"])
    assert all(person.target[1] == pytest.approx(person.position[1]) for person in people)
    model.run(max_seconds=2.0)
    angles = []
    for person in people:
        (x, y), (tx, ty) = person.position, person.target
        angles.append(math.atan2(ty - y, tx - x))
    # Each movement ends off the course by a new angle and makes up for the last one, so it turns by
    # the difference of two. 300 angles: their deviation is within an eighth of that, three sigma.
    # Since people do not walk exactly where they want to, the way from there is a little off, too.
    assert 0.05 * 0.875 < np.std(angles) / math.sqrt(2.0) < 0.05 * 1.3


def test_a_deviation_out_of_range():
    with pytest.raises(ModelError, match="anticipation: wander"):
        Anticipation(wander=2.0)
