"""Buildings: sheets in the plane, places and their true coordinates."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from shapely import box

from mesa_mobility import Building, Exit, FloorPlan, Level, Stairs
from mesa_mobility.buildings import ON_STAIRS
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan import Gate, Router
from tests.fixtures.buildings import HALL, RISE, two_storeys, with_refuge_and_lift

OFFICE = two_storeys()

GROUND = Level(0, HALL, exits=[Exit("west", (0, 3), (0, 5))])
FIRST = Level(1, HALL, RISE)
HEAD = ((8, 5), (8, 3))


def stairs(name="main", upper=1, lower=0, head=HEAD, risers=18):
    return Stairs.straight(name, upper, lower, head, risers=risers)


def test_levels_and_landings_are_sheets_apart_from_each_other():
    parts = shapely.get_parts(OFFICE.floor_plan.walkable)
    assert len(parts) == 3  # two levels and a landing
    for k, part in enumerate(parts):
        for other in parts[:k]:
            assert part.distance(other) >= 20.0 - 1e-9
    assert len(OFFICE.flights) == 3
    assert [seam.name for seam in OFFICE.floor_plan.seams] == ["south", "north 2", "north 1"]
    assert OFFICE.exits(0) == ("west", "east")
    assert OFFICE.exits(1) == ()


def test_the_first_level_keeps_its_coordinates():
    assert OFFICE.places([(3.0, 4.0)], level=0).tolist() == [[3.0, 4.0]]
    assert {each.a for each in OFFICE.floor_plan.exits} == {(0.0, 3.0), (24.0, 3.0)}


def test_a_flight_is_drawn_on_both_sheets_up_to_0_3_m_beyond_its_end():
    floor = OFFICE.floor_plan.free
    # South: head at x = 8, going 17 * 0.29 = 4.93 m towards +x.
    below = floor.intersection(box(7.0, 0.0, 12.93, 1.2))
    assert (
        below.symmetric_difference(box(7.7, 0.0, 12.93, 1.2))
        .intersection(box(7.66, 0.0, 12.9, 1.2))
        .area
        < 1e-6
    )
    dx = OFFICE.places([(0.0, 0.0)], level=1)[0, 0]
    above = floor.intersection(box(8.0 + dx, 0.0, 13.27 + dx, 1.2))
    assert above.symmetric_difference(box(8.0 + dx, 0.0, 13.23 + dx, 1.2)).area < 1e-6


def test_heights_on_flights_rise_evenly():
    dx = OFFICE.places([(0.0, 0.0)], level=1)[0, 0]
    points = [(12.92, 0.6), (12.0, 0.6), (10.465, 0.6), (9.0 + dx, 0.6), (8.01 + dx, 0.6)]
    places, levels = OFFICE.true_places(points)
    assert np.allclose(places[:, 0], [12.92, 12.0, 10.465, 9.0, 8.01], atol=1e-9)
    assert np.allclose(places[:, 2], [RISE * (12.93 - x) / 4.93 for x in places[:, 0]])
    assert (levels == ON_STAIRS).all()


def test_both_drawings_of_a_place_on_a_flight_are_one_place():
    for seam in OFFICE.floor_plan.seams:
        along = np.linspace(-seam.depth + 1e-3, seam.depth - 1e-3, 101)
        here = np.array(seam.centre) + along[:, None] * seam.direction
        (first, level), (second, other) = (
            OFFICE.true_places(points) for points in (here, here + seam.shift)
        )
        assert np.allclose(first, second, atol=1e-9)
        assert (level == other).all()


def test_flights_in_one_line_along_a_wall_are_told_apart():
    """Stairs down from the first and from the second level, one behind the other on the former."""
    levels = [GROUND, FIRST, Level(2, HALL, 2 * RISE)]
    lower, upper = ((3, 1.2), (3, 0)), ((12, 1.2), (12, 0))
    office = Building(
        levels, [stairs("lower", head=lower), stairs("upper", upper=2, lower=1, head=upper)]
    )
    down = np.linspace(0.05, 4.88, 20)
    for level, left, top in ((0, 3, 1), (1, 3, 1), (1, 12, 2), (2, 12, 2)):
        points = office.places(np.column_stack([left + down, np.full(20, 0.6)]), level)
        places, numbers = office.true_places(points)
        assert np.allclose(places[:, 0], left + down)
        assert np.allclose(places[:, 2], RISE * (top - down / 4.93))
        assert (numbers == ON_STAIRS).all()


levels_of = st.sampled_from([0, 1])


@given(level=levels_of, x=st.floats(0.0, 24.0), y=st.floats(1.5, 5.0))
def test_places_on_a_level_come_back_from_the_plane(level, x, y):
    points = OFFICE.places([(x, y)], level)
    places, levels = OFFICE.true_places(points)
    assert np.allclose(places, [[x, y, level * RISE]], atol=1e-9)
    assert levels.tolist() == [level]
    assert np.allclose(OFFICE.plane_places(places), points, atol=1e-9)
    assert bool(OFFICE.floor_plan.contains(points)[0])


@given(
    number=st.integers(0, 2),
    share=st.floats(0.01, 0.99).filter(lambda share: abs(share - 0.5) > 1e-6),
    aside=st.floats(-0.59, 0.59),
)
def test_places_on_a_flight_come_back_from_the_plane(number, share, aside):
    flight = OFFICE.flights[number]
    middle, down = np.array(flight.head).mean(axis=0), flight.down
    xy = middle + share * flight.going * down + aside * np.array([-down[1], down[0]])
    z = flight.top + share * (flight.bottom - flight.top)
    points = OFFICE.plane_places([[*xy, z]])
    places, levels = OFFICE.true_places(points)
    assert np.allclose(places, [[*xy, z]], atol=1e-9)
    assert levels.tolist() == [ON_STAIRS]
    # It is drawn on the sheet to which that half of the flight belongs.
    assert not shapely.intersects_xy(OFFICE.floor_plan.copied, *points[0])
    assert bool(OFFICE.floor_plan.contains(points)[0])


def test_a_place_between_floors_is_refused():
    with pytest.raises(FloorPlanError, match=r"\(3\.00, 4\.00, 1\.00\): expected a place on"):
        OFFICE.plane_places([(3.0, 4.0, 1.0)])


def test_random_points_are_on_levels_and_never_on_stairs():
    rng = np.random.default_rng(3)
    for level in (0, 1):
        points = OFFICE.random_points(120, rng, level=level, spacing=0.6, clearance=0.25)
        places, levels = OFFICE.true_places(points)
        assert (levels == level).all()
        assert (places[:, 2] == level * RISE).all()
    _, levels = OFFICE.true_places(OFFICE.random_points(200, rng, spacing=0.6, clearance=0.25))
    assert set(levels.tolist()) == {0, 1}


def test_routes_lead_down_the_nearer_stairs():
    """By hand: straight lines down the middle of the straight stair, longer by its extra length."""
    plan = Building([GROUND, FIRST], [stairs()]).floor_plan
    office = Building([GROUND, FIRST], [stairs()])
    [flight] = office.flights
    start = office.places([(4.0, 4.0)], level=1)
    found = Router(plan).targets(start, [0]).distances[0]
    # The mean of the longer ways down and up; people walk up at 0.8 of the speed down.
    extra = flight.going * (0.5 * (1.0 + 1.0 / 0.8) / flight.factor - 1.0)
    # From x = 4 to the head at 8, down to the foot, and back round it to the exit at x = 0.
    foot = 8.0 + flight.going
    around = np.hypot(0.25, 1.0) + foot - 8.0 + 0.3
    assert 4.0 + flight.going + extra < found < 4.0 + flight.going + extra + foot + around
    # Of two stairs in opposite corners people take the nearer one.
    below = OFFICE.floor_plan
    points = OFFICE.places([(1.0, 2.0), (23.0, 5.0)], level=1)
    to_go = Router(below).targets(points, [0, 0])
    places, _ = OFFICE.true_places(to_go.points)
    assert places[0, 0] > 1.0
    assert places[1, 0] < 23.0
    assert np.isfinite(to_go.distances).all()


def test_a_building_of_one_level_is_its_floor_plan():
    exits, zones = [Exit("out", (0, 3), (0, 5))], ["POLYGON ((5 1, 6 1, 6 2, 5 2, 5 1))"]
    building = Building([Level(0, HALL, exits=exits, obstacles=zones)], name="hall")
    plan = FloorPlan(HALL, exits=exits, obstacles=zones, name="hall")
    assert building.floor_plan.to_geojson() == plan.to_geojson()
    assert building.to_geojson() == plan.to_geojson()
    assert (building.floor_plan.walls == plan.walls).all()


def test_a_level_alone_is_a_plan_without_stairs():
    plan = OFFICE.floor_plan_of(1)
    assert plan.contains([(3.0, 4.0), (10.0, 0.6), (16.0, 7.5)]).tolist() == [True, False, False]
    assert [(each.name, each.a) for each in plan.exits] == [
        ("south", (8, 1.2)),
        ("north 2", (14, 8)),
    ]


def test_a_spike_of_the_outline_without_width_is_no_floor():
    # Along x = 24, from y = 6 to 8: 4e-15 m wide.
    beside = 24.0 - 4e-15
    spike = f"POLYGON ((24 8, 24 0, 0 0, 0 8, 20 8, 20 6, {beside} 6, {beside} 8, 24 8))"
    cut = Building([GROUND, Level(1, spike, RISE)], [stairs()])
    floors = [sheet.floor.area for sheet in cut.sheets]
    # Without 4 m by 2 m of the whole.
    whole = Building([GROUND, FIRST], [stairs()]).sheets
    assert floors == pytest.approx([whole[0].floor.area, whole[1].floor.area - 8.0])


@pytest.mark.parametrize(
    ("levels", "given", "said"),
    [
        ([], [], "at least one level"),
        ([GROUND, GROUND], [], "level 0 is there twice"),
        (
            [replace(GROUND, gates=[Gate("main", (20, 0), (20, 8))]), FIRST],
            [stairs()],
            "level 0: gate 'main' has the name of stairs, a ramp, an escalator or a lift, expected",
        ),
        (
            [GROUND, replace(FIRST, exits=[Exit("main", (24, 3), (24, 5))])],
            [stairs()],
            "level 1: exit 'main' has the name of stairs",
        ),
        (
            [GROUND, FIRST],
            [stairs(), stairs()],
            "escalator or lift 'main' is there twice",
        ),
        ([GROUND, FIRST], [stairs(upper=3)], "stairs 'main': there is no level 3; there are 0, 1"),
        (
            [GROUND, FIRST],
            [],
            "level 1: no stairs, ramp, escalator or lift lead from there to a level with",
        ),
        ([GROUND, FIRST], [stairs(risers=12)], "12 risers for a rise of 3.06 m are 0.255 m each"),
        ([GROUND, FIRST], [stairs(upper=0, lower=1)], "-0.170 m each"),
        (
            [GROUND, FIRST],
            [stairs(head=((20, 5), (20, 3)))],
            r"'main' on level 0: no floor at \(2\d\.\d\d, \d\.\d\d\), expected 0.5 m of free",
        ),
        (
            [GROUND, FIRST],
            [stairs(), stairs("other", head=((9, 4), (9, 2)))],
            "overlap on the plan of level 0|no floor at",
        ),
        (
            [GROUND, Level(1, HALL, RISE, obstacles=[box(9, 3.5, 10, 4.5)])],
            [stairs()],
            r"'main' on level 1: obstacle 0 is in their way at \(9\.50, 4\.00\)",
        ),
        (
            [GROUND, Level(1, HALL, RISE, obstacles=[box(7.6, 3.5, 7.9, 4.5)])],
            [stairs()],
            r"'main' on level 1: no floor at \(7\.\d\d, \d\.\d\d\)",
        ),
        ([GROUND, "first"], [], "has Level objects, found str"),
    ],
)
def test_what_is_wrong_is_said_in_one_line_with_its_place(levels, given, said):
    with pytest.raises(FloorPlanError, match=said) as error:
        Building(levels, given)
    assert "\n" not in str(error.value)


def test_stairs_and_lifts_are_closed_and_opened_as_a_whole():
    building = with_refuge_and_lift()
    plan = building.floor_plan
    for name, gates in (("south", 4), ("lift", 2)):
        assert building.is_open(name)
        building.close(name)
        assert not building.is_open(name)
        assert len(plan.closed_gates()) == gates
        # One gate is not the whole.
        plan.open_gate(building.gates[name][0].name)
        assert not building.is_open(name)
        building.open(name)
        assert building.is_open(name)
        assert plan.closed_gates() == ()
    for call in (building.close, building.open, building.is_open):
        with pytest.raises(FloorPlanError) as said:
            call("soth")
        assert str(said.value) == (
            "there are no stairs, ramp, escalator, lift, gate or exit 'soth', did you mean "
            "'south'?; there are 'south', 'lift', 'west', and gates"
        )
    exit_ = building.floor_plan.exits[0].name
    for name in (exit_, "lift at level 1"):
        building.close(name)
        assert not building.is_open(name)
        assert len(plan.closed_openings()) == 1
        building.open(name)
