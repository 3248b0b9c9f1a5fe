"""Each shipped type alone at its own speeds, and a crowd of it through doors."""

import numpy as np
import pytest
from shapely import box, union_all

from mesa_mobility import Exit, FloorPlan, MobilityMap, PedestrianModel, PedestrianType
from mesa_mobility.distributions import Normal
from mesa_mobility.mobility import shipped_map_path
from mesa_mobility.verification.runs import evacuate
from mesa_mobility.verification.scenarios.walks import speeds_walked
from tests.fixtures.maps import ALL_TYPES, SLOWER_TYPES, WHEELCHAIR_TYPES
from tests.fixtures.speeds import exponential_within, normal_within

# Metres; 10 m of room in front of the door, 8 m behind it.
ROOM, WALL, END = 10.0, 0.2, 18.2


def kind_of(name):
    map_ = MobilityMap.load(shipped_map_path(name))
    source = map_.metadata.get("preferred_speed_m_s")
    # Of people who are recorded themselves, a steady walk, and a fifth of that as deviation.
    steady = map_.metadata.get("walking_speed_m_s", {}).get("p75")
    mean, sd = (source["mean"], source["standard_deviation"]) if source else (steady, 0.2 * steady)
    speeds = Normal(mean, sd, max(0.2, mean - sd), mean + sd)
    return PedestrianType(mobility_map=map_, preferred_speed=speeds), mean, sd


def through_a_door(name, people, width, seed):
    kind, _, _ = kind_of(name)
    low, high = (ROOM - width) / 2, (ROOM + width) / 2
    floor = union_all(
        [
            box(0.0, 0.0, ROOM, ROOM),
            box(ROOM, low, ROOM + WALL, high),
            box(ROOM + WALL, 0.0, END, ROOM),
        ]
    )
    plan = FloorPlan(floor, exits=[Exit("end", (END, 0.0), (END, ROOM))])
    model = PedestrianModel(plan, pedestrian_types=[kind], record=True, rng=seed)
    core = kind.core_radius
    places = plan.random_points(
        people,
        model.rng,
        within=box(0.0, 0.0, ROOM - 2.0, ROOM),
        spacing=max(0.5, 2 * core + 0.1),
        clearance=max(0.3, core + 0.05),
    )
    model.add_pedestrians(places)
    return evacuate(model, 600.0).figures()


def in_lanes(kind, people, lane):
    """A model with a lane for each, so many metres wide, and the places where they start."""
    plan = FloorPlan(
        box(-2.0, 0.0, 40.0, people * lane),
        exits=[Exit("end", (40.0, 0.0), (40.0, people * lane))],
    )
    model = PedestrianModel(plan, pedestrian_types=[kind], record=True, rng=1)
    return model, np.column_stack([np.zeros(people), lane * (np.arange(people) + 0.5)])


def assert_safe(figures):
    assert (figures["overlaps"], figures["wall_crossings"], figures["off_floor"]) == (0, 0, 0)


@pytest.mark.slow
@pytest.mark.parametrize("name", ALL_TYPES)
def test_fifty_alone_keep_their_own_speed(name):
    kind, mean, sd = kind_of(name)
    model, places = in_lanes(kind, 50, max(3.0, 4 * kind.core_radius + 1.0))
    speeds = np.linspace(max(0.2, mean - sd), mean + sd, 50)
    model.add_pedestrians(places, headings=np.zeros(50), preferred_speeds=speeds)
    walked = np.array(speeds_walked(evacuate(model, 120.0 / speeds.min()), 50), dtype=float)
    off = np.abs(walked / speeds - 1.0)
    assert off.max() <= 0.05


@pytest.mark.slow
@pytest.mark.parametrize("width", [0.9, 1.0, 1.2])
@pytest.mark.parametrize("name", WHEELCHAIR_TYPES)
def test_twenty_wheelchairs_get_through_a_door_that_lets_one_through_at_a_time(name, width):
    for seed in (1, 2):
        figures = through_a_door(name, 20, width, seed)
        assert figures["left_inside"] == 0, seed
        assert_safe(figures)


@pytest.mark.slow
@pytest.mark.parametrize("name", WHEELCHAIR_TYPES)
def test_one_wheelchair_gets_through_a_door_of_90_centimetres(name):
    figures = through_a_door(name, 1, 0.9, 1)
    assert figures["left_inside"] == 0
    assert_safe(figures)


@pytest.mark.slow
@pytest.mark.parametrize("name", SLOWER_TYPES)
def test_sixty_get_through_a_door_of_90_centimetres(name):
    for seed in (1, 2):
        figures = through_a_door(name, 60, 0.9, seed)
        assert figures["left_inside"] == 0, seed
        assert_safe(figures)


@pytest.mark.slow
@pytest.mark.parametrize(("width", "seed"), [(0.9, 5), (0.9, 9), (1.2, 13), (1.2, 18)])
def test_people_on_crutches_do_not_wedge_each_other_in(width, seed):
    """Two of 0.44 m just fit through 0.9 m: three stood there like the stones of an arch.

    In a door of 1.2 m two stood with a third behind them.
    """
    figures = through_a_door("crutches", 60, width, seed)
    assert figures["left_inside"] == 0
    assert_safe(figures)


@pytest.mark.slow
@pytest.mark.parametrize(("width", "seed"), [(0.9, 30), (1.0, 4)])
def test_people_with_walking_frames_do_not_wedge_each_other_in(width, seed):
    """Two stood at the jambs with a third between and behind them, and a crowd that pressed on."""
    figures = through_a_door("walking_frame", 60, width, seed)
    assert figures["left_inside"] == 0
    assert_safe(figures)


FREE_SPEEDS = {
    # Weidmann (1993), and the same at the Froude number of a child of 1.25 m.
    "able_bodied": (1.34, 0.26),
    "child": (1.13, 0.22),
    # 27 people of 50 to 84 years (BMClab).
    "older_adult": (1.23, 0.20),
    # Boyce, Shields and Silcock (1999).
    "wheelchair_powered": (0.89, 0.22),
    # The steady walk recorded, with the relative deviation of Weidmann's adults.
    "slow": (0.57, 0.11),
    "limping_left": (0.57, 0.11),
    "limping_right": (0.57, 0.11),
}

WIDE = {
    # As before: mean, slowest and fastest. Nearly exponential distributions come nearest to them.
    "cane": (0.81, 0.26, 1.60),
    "crutches": (0.94, 0.63, 1.35),
    "walking_frame": (0.57, 0.10, 1.02),
    "wheelchair_manual": (0.69, 0.13, 1.35),
    "wheelchair_assisted": (1.30, 0.84, 1.98),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", [*FREE_SPEEDS, *WIDE])
def test_free_speeds_are_spread_as_those_of_the_source(name):
    """200 people as they are drawn, alone; Kolmogorov's distance at the level of 5 %."""
    if name in WIDE:
        expected = exponential_within(*WIDE[name])
    else:
        mean, sd = FREE_SPEEDS[name]
        low, high = max(mean - sd * 0.74 / 0.26, 0.05), mean + sd * 0.66 / 0.26
        expected = normal_within(mean, sd, low, high)
    people = 200
    model, places = in_lanes(PedestrianType.named(name), people, 3.0)
    model.add_pedestrians(places, headings=np.zeros(people))
    walked = np.sort(np.array(speeds_walked(evacuate(model, 1000.0), people), dtype=float))
    share = (np.arange(people) + 0.5) / people
    apart = np.abs(share - expected.cdf(walked))
    assert apart.max() < 1.36 / np.sqrt(people)
