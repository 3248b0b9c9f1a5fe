"""Others make room for a wide person who is held up in an opening."""

from types import SimpleNamespace

import numpy as np
import pytest
from shapely import box

from mesa_mobility import Exit, FloorPlan, MobilityMap, PedestrianModel, PedestrianType
from mesa_mobility.crowd.tactics.giving_way.making_room import steps_aside
from mesa_mobility.crowd.tactics.giving_way.precedence import Precedence
from mesa_mobility.mobility import shipped_map_path
from mesa_mobility.results import check_safety
from mesa_mobility.results.trajectories import Trajectories
from tests.fixtures.maps import shipped_map
from tests.fixtures.scenes import two_rooms


def floor(top):
    """A floor from -10 to 10 m, and to ``top`` upwards."""
    return FloorPlan(
        box(-10.0, -10.0, 10.0, top), exits=[Exit("east", (10.0, -10.0), (10.0, -5.0))]
    )


OPEN = floor(10.0)


def step(plan, place, others=(), stuck=(0.0, 0.0)):
    """Where a body of 0.2 m at ``place`` steps, and whether it can."""
    everybody = np.array([stuck, place, *others])
    ends, can = steps_aside(
        plan, np.array([place]), np.array([0.2]), np.array([stuck]), everybody,
        np.full(len(everybody), 0.2),
    )  # fmt: skip
    return ends[0].tolist(), bool(can[0])


def test_a_step_leads_straight_away():
    assert step(OPEN, (0.4, 0.0)) == ([pytest.approx(0.8), pytest.approx(0.0)], True)


def test_a_step_comes_no_nearer_to_those_who_stand_close():
    """Somebody 0.4 m farther off leaves only the way at right angles; on the left first."""
    ends, can = step(OPEN, (0.4, 0.0), [(0.8, 0.0)])
    assert can
    assert ends == pytest.approx([0.4, 0.4])


def test_a_step_keeps_clear_of_walls():
    """A wall 0.3 m to the left; 0.4 m to the left would be in it."""
    ends, can = step(floor(0.3), (0.4, 0.0), [(0.8, 0.0)])
    assert can
    assert ends == pytest.approx([0.4, -0.4])


def test_who_has_no_room_stays():
    around = [(0.8, 0.0), (0.4, 0.41), (0.4, -0.41)]
    assert step(OPEN, (0.4, 0.0), around) == ([0.4, 0.0], False)


def crowd(plan, kinds, rng=1):
    types = [
        PedestrianType(mobility_map=MobilityMap.load(shipped_map_path(kind)))
        if kind
        else PedestrianType(mobility_map=shipped_map(), name="on_foot", core_radius=0.128)
        for kind in kinds
    ]
    return PedestrianModel(plan, pedestrian_types=types, record=True, rng=rng)


def place(model, people, kind):
    x, y, heading = np.array(people).T
    return model.add_pedestrians(
        np.column_stack([x, y]), headings=np.deg2rad(heading), exits=["east"], type_index=kind
    )


def assert_all_get_out(model, seconds):
    model.run(max_seconds=seconds)
    assert model.inside == 0
    plan = model.floor_plan
    safety = check_safety(Trajectories.of(model), plan.walls, plan.free)
    assert (safety.overlaps, safety.wall_crossings, safety.off_floor) == (0, 0, 0)


# A wheelchair up against a jamb of a door of 0.8 m whose middle is at (10, 4), and the crowd behind
# it, as in a door of 0.9 m where both stayed: x, y in metres, heading in degrees.
CHAIR = (9.743, 4.132, 203)
BEHIND_IT = [
    (9.609, 3.655, 0),
    (9.801, 3.449, 88),
    (9.286, 3.765, 359),
    (9.54, 3.344, 51),
    (9.22, 4.037, 349),
    (9.333, 4.402, 333),
    (9.434, 4.702, 307),
    (9.744, 3.02, 69),
    (9.058, 3.622, 15),
    (9.206, 3.253, 27),
    (9.011, 4.43, 338),
    (9.166, 4.787, 326),
    (8.833, 4.206, 1),
    (9.455, 5.022, 293),
    (9.405, 2.903, 60),
    (8.907, 3.265, 20),
    (8.729, 3.661, 360),
    (9.72, 2.636, 85),
    (9.009, 2.937, 43),
    (8.58, 4.072, 352),
    (8.79, 4.762, 354),
    (8.617, 4.478, 342),
    (9.265, 5.253, 302),
    (8.427, 3.476, 6),
    (8.591, 3.033, 20),
    (8.291, 3.842, 15),
    (8.244, 4.125, 0),
    (8.32, 2.981, 357),
]


@pytest.mark.thorough
def test_people_on_foot_let_a_wheelchair_back_that_stands_askew_in_a_door():
    """It faces away from the door and cannot shift sideways; it has to go back into the crowd."""
    model = crowd(two_rooms(0.8, 0.4), ["wheelchair_manual", None])
    place(model, [CHAIR], 0)
    place(model, BEHIND_IT, 1)
    assert_all_get_out(model, 90)


# The same of people on crutches beside a door of 1 m: the first stands against the wall.
AT_THE_WALL = [
    (9.779, 4.717, 264), (9.337, 4.721, 312), (9.685, 5.149, 273), (9.25, 5.221, 296),
    (8.937, 4.907, 321), (8.543, 4.711, 343), (8.473, 5.146, 323), (8.1, 4.703, 346),
    (7.905, 5.147, 339), (7.67, 4.26, 350),
]  # fmt: skip


@pytest.mark.thorough
def test_one_on_crutches_beside_a_wall_gets_loose():
    """One wedged in between the wall and another, who has room on the side that is no way out."""
    model = crowd(two_rooms(1.0, 0.2), ["crutches"], rng=3)
    place(model, AT_THE_WALL, 0)
    assert_all_get_out(model, 60)


# People on crutches like the stones of an arch: two at the door's edge and one behind them.
ARCH = [
    (9.778, 4.686, 264), (9.389, 4.478, 351), (8.965, 4.355, 357), (9.444, 4.973, 313),
    (9.002, 4.979, 318), (8.524, 4.384, 3), (9.374, 5.409, 284), (8.577, 4.865, 334),
    (8.721, 5.318, 350), (9.472, 5.839, 279), (9.007, 5.653, 305), (8.141, 4.933, 346),
]  # fmt: skip


@pytest.mark.thorough
def test_three_on_crutches_make_no_arch_in_a_door_of_120_centimetres():
    model = crowd(two_rooms(1.2, 0.2), ["crutches"])
    place(model, ARCH, 0)
    assert_all_get_out(model, 60)


def heeded(waits_until=0, speed=1.33, chair=9.5, core=0.15):
    """Target and speed of somebody behind a wheelchair, 5 s after it came to a door.

    The wheelchair at (``chair``, 4.0) does not move; the other is 0.9 m behind it.
    """
    agenda = {
        "since": np.zeros(2), "speed": np.array([1.0, 1.33]), "waits_until": np.zeros(2, np.int32)
    }  # fmt: skip
    people = SimpleNamespace(
        core=np.array([0.35, core]), x=np.array([chair, chair - 0.9]), y=np.array([4.0, 4.0]),
        type_index=np.array([0, 1]), agenda=agenda,
    )  # fmt: skip
    who, beyond = np.array([0, 1]), np.array([[12.0, 4.0], [12.0, 4.0]])
    precedence = Precedence(two_rooms(1.0, 0.2), 0.35)
    precedence.heed(who, who, 0, people, beyond, np.array([1.0, speed]))
    agenda["waits_until"][0] = waits_until
    points, speeds = precedence.heed(who, who, 150, people, beyond, np.array([1.0, speed]))
    return points[1].tolist(), speeds[1]


def test_whoever_is_behind_somebody_held_up_goes_back():
    assert heeded() == ([pytest.approx(8.2), 4.0], pytest.approx(0.8))


def test_before_a_door_wide_people_go_back_and_people_on_foot_queue():
    """Half a door of 1 m and a wide body before its middle, 1.2 m, a wheelchair is not in it."""
    assert heeded(chair=8.5) == ([12.0, 4.0], 1.33)
    assert heeded(chair=8.5, core=0.35) == ([pytest.approx(7.2), 4.0], pytest.approx(0.8))


def test_nobody_makes_room_for_somebody_who_waits():
    """At 5 s, frame 150, the wheelchair waits until frame 1,200."""
    assert heeded(waits_until=1200) == ([12.0, 4.0], 1.33)


def test_who_makes_room_is_no_faster_than_a_speed_zone_allows():
    assert heeded(speed=0.2) == ([pytest.approx(8.2), 4.0], 0.2)


def test_who_is_to_stand_by_a_speed_rule_does_not_make_room():
    assert heeded(speed=0.0) == ([12.0, 4.0], 0.0)


def test_people_on_foot_pass_a_wheelchair_that_waits_beside_a_door():
    """All 12 are through after 14 s without the wheelchair; it waits for 40 s."""
    model = crowd(two_rooms(1.0, 0.2), ["wheelchair_manual", None])
    [chair] = place(model, [(9.55, 5.0, 0.0)], 0)
    chair.wait(40.0)
    place(model, [(x, y, 0.0) for x in (4.5, 3.7) for y in (1.5, 2.5, 3.5, 4.5, 5.5, 6.5)], 1)
    model.run(max_seconds=20)
    assert (model.crowd.x[1:][model.crowd.active[1:]] < 10.0).sum() == 0
