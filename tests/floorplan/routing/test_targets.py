from math import hypot

import numpy as np
import pytest
import shapely
from shapely import LineString, Point, box

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan import Exit, FloorPlan, Gate, Router


def target(plan: FloorPlan, place: tuple[float, float]) -> tuple[float, float]:
    return tuple(Router(plan).targets([place], [0]).points[0])


def aslant(dx: float, dy: float) -> tuple[float, float]:
    """Behind (4.45, 0) on the way (dx, -dy): 2 m times the squared cosine of the angle."""
    length = 2 * dy**2 / (dx**2 + dy**2)
    return (4.45 + length * dx / hypot(dx, dy), -length * dy / hypot(dx, dy))


@pytest.mark.parametrize(
    ("place", "expected"),
    [
        ((4.5, 4), (4.5, -2)),  # face-on: 2 m behind the line
        # The places aimed through are 0.2 m clear of the jambs and 0.25 m more: 4.45 to 4.55.
        ((4.3, 1), aslant(0.15, 1)),
        ((1.5, 3), aslant(2.95, 3)),
        ((4.3, 0.1), (4.4 + 0.5**0.5, -(0.5**0.5))),  # no farther aside than the line is away
        ((4.3, 0.01), (4.31, -2)),
        ((4.5, 0), (4.5, -2)),  # in the line itself
        ((4.5, -0.02), (4.5, -2)),  # a little past it
    ],
)
def test_an_exit_is_aimed_at_from_behind(plans, place: tuple, expected: tuple) -> None:
    assert target(plans["room"](), place) == pytest.approx(expected, abs=0.02)
    assert Router(plans["room"]()).targets([place], [0]).gates.tolist() == [0]


def passes(start, end, corner) -> float:
    """Metres by which the straight way between two points passes a corner."""
    return float(LineString([start, end]).distance(Point(corner)))


def test_along_the_wall_the_jamb_comes_first(plans) -> None:
    found = Router(plans["room"]()).targets([(1, 0.3)], [0])
    assert found.gates.tolist() == [-1]
    x, y = found.points[0]
    # Past the route's corner (4.2, 0.2), and nearer to the jamb at (4, 0).
    assert x > 4.2
    assert 0.156 <= passes((1, 0.3), (x, y), (4, 0)) < hypot(0.2, 0.2)


@pytest.mark.parametrize("place", [(1.5, 1.5), (2.5, 2.5), (7.5, 1.5), (6.0, 7.0), (3.0, 1.0)])
def test_a_door_that_the_jamb_hides_in_part_is_aimed_through(plans, place: tuple) -> None:
    # The near end of the door, from 4.2 to 4.8, is hidden at a body's clearance, the far end not.
    found = target(plans["room"](), place)
    assert found[1] < 0
    assert LineString([place, found]).crosses(LineString([(4.13, 0), (4.87, 0)]))


def test_targets_past_a_corner_have_the_way_on_in_view(plans) -> None:
    found = Router(plans["l_corridor"]()).targets([(1, 1)], [0])
    x, y = found.points[0]
    # 1 m past the way on from the route's corner (10.2, 1.8), and nearer to the wall's at (10, 2).
    assert (x - 10.2) * hypot(x - 1, y - 1) == pytest.approx(x - 1, abs=1e-3)
    assert 0.156 <= passes((1, 1), (x, y), (10, 2)) < hypot(0.2, 0.2)


def test_a_gate_on_the_way_is_aimed_through(plans) -> None:
    found = Router(plans["two_rooms_turning_back"]()).targets([(3, 2.5)], [0])
    assert found.gates.tolist() == [0]
    # Straight on; the wall at x = 8 is nearer than 2 m, so 0.156 m before it.
    assert found.points[0] == pytest.approx((8 - 0.156, 2.5))


def test_the_near_jamb_comes_before_a_gate_that_is_not_in_view(plans) -> None:
    found = Router(plans["two_rooms_turning_back"]()).targets([(5.7, 0.5)], [0])
    assert found.gates.tolist() == [-1]
    # Past (5.8, 2.2), and nearer to the door's lower corner at (6, 2).
    x, y = found.points[0]
    assert y > 2.2
    assert 0.156 <= passes((5.7, 0.5), (x, y), (6, 2)) < hypot(0.2, 0.2)


def test_at_a_gate_too_narrow_for_a_body_nobody_aims(plans) -> None:
    wall = [box(5, 0, 5.2, 2), box(5, 2.3, 5.2, 4)]
    exits = [Exit("near", (8, 0), (8, 4)), Exit("far", (0, 0), (0, 4))]
    gates = [Gate("slit", (5.1, 2), (5.1, 2.3))]
    plan = FloorPlan(box(0, 0, 8, 4), exits=exits, gates=gates, obstacles=wall)
    found = Router(plan).targets([(4, 2.15), (5.1, 2.15)], [0, 0])
    assert found.gates[0] == 2
    # A person squeezed in still gets a target.
    assert np.isfinite(found.distances).all()


def test_an_exit_in_view_through_a_gate_is_aimed_at_itself() -> None:
    plan = FloorPlan(
        box(0, 0, 10, 4), exits=[Exit("e", (10, 0), (10, 4))], gates=[Gate("g", (5, 0), (5, 4))]
    )
    found = Router(plan).targets([(2, 2)], [0])
    assert found.gates.tolist() == [1]
    assert found.points[0] == pytest.approx((12, 2))
    assert found.distances[0] == pytest.approx(8)


@pytest.mark.parametrize("place", [(6.1, 2.5), (6.1, 2.2), (6.105, 2.8), (6.15, 2.5), (6.3, 2.5)])
def test_nobody_past_a_gate_turns_back_to_it(plans, place: tuple) -> None:
    plan = plans["two_rooms_turning_back"]()
    found = Router(plan).targets([place], [0])
    assert found.gates[0] != 0
    assert found.points[0, 0] > 6.1
    assert not LineString([place, found.points[0]]).crosses(plan.gate("door").line)


@pytest.mark.parametrize("name", ["room", "two_rooms", "two_rooms_turning_back", "hall", "bend"])
def test_people_cross_the_opening_they_aim_through_straight(plans, places_in, name: str) -> None:
    plan = plans[name]()
    places = places_in(plan, 0.4)
    found = Router(plan).targets(places, np.zeros(len(places), int))
    assert (found.gates >= 0).any()
    lines = np.array([opening.line for opening in plan.openings()])[found.gates]
    ways = shapely.linestrings(np.stack([places, found.points], axis=1))
    assert shapely.crosses(ways, lines)[found.gates >= 0].all()


@pytest.mark.parametrize("name", ["room", "l_corridor", "two_rooms", "hall", "bend"])
def test_no_straight_way_to_a_target_meets_a_wall_before_its_opening(
    plans, places_in, name: str
) -> None:
    plan = plans[name]()
    places = places_in(plan, 0.4)
    found = Router(plan).targets(places, np.zeros(len(places), int))
    ways = shapely.linestrings(np.stack([places, found.points], axis=1))
    walls = shapely.multilinestrings(shapely.linestrings(plan.walls.reshape(-1, 2, 2)))
    inside = shapely.intersection(ways, plan.free)
    assert not shapely.crosses(inside, walls).any()


def test_without_a_way_people_stay_where_they_are(plans) -> None:
    plan = plans["room"]()
    plan.close_gate("south")
    found = Router(plan).targets([(3, 3)], [0])
    assert found.points.tolist() == [[3, 3]]
    assert found.gates.tolist() == [-1]
    assert found.distances.tolist() == [np.inf]


def test_everybody_has_an_own_destination(plans) -> None:
    router = Router(plans["corridor"]())
    west, east = router.destination(("west",)), router.destination(("east",))
    found = router.targets([(5, 2), (5, 2), (5, 2)], [east, 0, west])
    assert found.points[:, 0].tolist() == pytest.approx([22, -2, -2])
    assert found.gates.tolist() == [1, 0, 0]


def test_nobody_at_all(plans) -> None:
    found = Router(plans["room"]()).targets(np.empty((0, 2)), np.empty(0, int))
    assert (found.points.shape, found.gates.shape, found.distances.shape) == ((0, 2), (0,), (0,))


@pytest.mark.parametrize("name", ["hall", "two_rooms", "bend"])
def test_what_cannot_be_in_view_is_left_out_rightly(plans, places_in, name: str) -> None:
    plan = plans[name]()
    places = places_in(plan, 0.31)
    found = Router(plan).targets(places, np.zeros(len(places), int))
    thorough = Router(plan)
    everything = np.zeros_like(thorough._views.bits)
    for node in range(thorough.graph.number_of_nodes()):
        everything[0, node // 64] |= np.uint64(1) << np.uint64(node % 64)
    thorough._views.row[:] = 1
    thorough._views.bits[:] = everything
    expected = thorough.targets(places, np.zeros(len(places), int))
    assert (found.points == expected.points).all()
    assert (found.distances == expected.distances).all()


def test_squares_get_a_row_of_views_when_somebody_comes_by(plans, places_in) -> None:
    plan = plans["hall"]()
    router = Router(plan)
    places = places_in(plan, 0.31)
    router.targets(places, np.zeros(len(places), int))
    known, views = int(router._views.known[0]), router._views
    assert 64 < known <= len(views.bits)
    assert sorted(views.row[views.row > 0].tolist()) == list(range(1, known + 1))
    assert not views.bits[known:].any()


def test_people_outside_the_plan_do_no_harm(plans) -> None:
    found = Router(plans["room"]()).targets([(-5, -5), (1e6, 3), (np.nan, 1)], [0, 0, 0])
    assert np.isfinite(found.points[:2]).all()


def test_a_gate_to_cross_is_aimed_at_from_behind(plans) -> None:
    plan = plans["two_rooms"]()
    router = Router(plan)
    across = router.crossing("door")
    # From either side, 2 m behind the line at x = 6.1; places aimed through are 0.45 m clear of
    # the jambs at y = 1 and 2.
    found = router.targets([(3, 1.5), (9, 1.5)], [across, across])
    assert found.points == pytest.approx(np.array([(8.1, 1.5), (4.1, 1.5)]))
    assert found.distances == pytest.approx([3.1, 2.9])
    assert found.gates.tolist() == [0, 0]
    # Just before the line, and past it, it is still the gate that is aimed at.
    near = router.targets([(6.07, 1.5), (6.13, 1.5)], [across, across])
    assert near.points[:, 0] == pytest.approx([8.07, 4.13], abs=0.04)


def test_a_gate_round_the_corner_is_reached_by_the_shortest_way() -> None:
    plan = FloorPlan(
        "POLYGON((0 0, 12 0, 12 10, 10 10, 10 2, 0 2, 0 0))",
        exits=[Exit("top", (10, 10), (12, 10))],
        gates=[Gate("g", (10, 6), (12, 6))],
    )
    router = Router(plan)
    found = router.targets([(1, 1)], [router.crossing("g")])
    # By the corner (10.2, 1.8), straight up from there.
    assert found.distances == pytest.approx([hypot(9.2, 0.8) + 4.2], abs=0.01)


def test_only_gates_can_be_crossed_and_only_exits_left_by(plans) -> None:
    router = Router(plans["two_rooms"]())
    with pytest.raises(FloorPlanError, match="'out' is an exit"):
        router.crossing("out")
    with pytest.raises(FloorPlanError, match="'door' is a gate"):
        router.destination(["door"])
