import numpy as np
import pytest
import shapely
from shapely import MultiPolygon, Polygon, box

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan import Exit, FloorPlan, Gate

SOUTH = Exit("south", (4, 0), (5, 0))


def as_set(segments: np.ndarray) -> set[tuple[tuple[float, ...], ...]]:
    """Segments without their direction and order, to the nanometre."""
    return {tuple(sorted(map(tuple, s.reshape(2, 2).round(9).tolist()))) for s in segments}


def test_walls_are_the_edge_without_the_exit(plans) -> None:
    walls = plans["room"]().walls
    assert as_set(walls) == {
        ((0, 0), (4, 0)),
        ((5, 0), (10, 0)),
        ((10, 0), (10, 8)),
        ((0, 8), (10, 8)),
        ((0, 0), (0, 8)),
    }
    assert len(walls) == 5


def test_an_exit_over_a_whole_side_leaves_the_neighbouring_walls_whole(plans) -> None:
    assert as_set(plans["corridor"]().walls) == {((0, 0), (20, 0)), ((0, 4), (20, 4))}


def test_an_exit_drawn_a_little_off_the_edge_cuts_the_wall_below_it() -> None:
    plan = FloorPlan(box(0, 0, 10, 8), exits=[Exit("e", (4, -0.008), (5, 0.008))])
    lengths = np.hypot(*(plan.walls[:, 2:] - plan.walls[:, :2]).T)
    assert lengths.sum() == pytest.approx(36 - 1, abs=1e-3)


def test_an_exit_on_the_edge_of_a_hole() -> None:
    stairs = Polygon(box(0, 0, 10, 10).exterior, [box(4, 4, 6, 6).exterior.coords])
    plan = FloorPlan(stairs, exits=[Exit("stairs", (4.5, 4), (5.5, 4))])
    lengths = np.hypot(*(plan.walls[:, 2:] - plan.walls[:, :2]).T)
    assert lengths.sum() == pytest.approx(40 + 8 - 1)


def test_an_exit_along_several_short_edges_is_cut_out_of_all() -> None:
    walkable = Polygon([(0, 0), (4.3, 0), (4.6, 0), (10, 0), (10, 8), (0, 8)])
    walls = as_set(FloorPlan(walkable, exits=[SOUTH]).walls)
    assert {((0, 0), (4, 0)), ((5, 0), (10, 0))} <= walls
    assert len(walls) == 5


def test_areas_and_bounds(plans) -> None:
    plan = plans["hall"]()
    assert plan.bounds == (0, 0, 15.2, 15)
    # 24 rows of 5.8 m x 0.45 m in 15.2 m x 15 m.
    assert plan.area == pytest.approx(15.2 * 15 - 24 * 5.8 * 0.45)
    assert plan.walkable.area == pytest.approx(15.2 * 15)


def test_points_inside_the_free_area(plans) -> None:
    plan = FloorPlan(box(0, 0, 10, 8), exits=[SOUTH], obstacles=[box(2, 2, 3, 3)])
    points = [(1, 1), (2.5, 2.5), (-1, 1), (0, 4), (4.5, 0), (11, 4)]
    assert plan.contains(points).tolist() == [True, False, False, True, True, False]
    assert plan.contains(np.empty((0, 2))).shape == (0,)


def test_obstacles_come_and_go() -> None:
    plan = FloorPlan(box(0, 0, 10, 8), exits=[SOUTH], obstacles=[box(2, 2, 3, 3)])
    before = as_set(plan.walls)
    second = plan.add_obstacle("POLYGON((6 6, 7 6, 7 7, 6 6))")
    assert (second, plan.version, len(plan.walls)) == (1, 1, 5 + 4 + 3)
    assert plan.area == pytest.approx(80 - 1 - 0.5)
    assert as_set(plan.wall_index.segments) == as_set(plan.walls)
    plan.remove_obstacle(second)
    assert as_set(plan.walls) == before
    assert plan.version == 2
    plan.remove_obstacle(0)
    assert plan.obstacles == {}
    assert plan.area == 80
    assert plan.add_obstacle(box(1, 1, 2, 2)) == 2
    with pytest.raises(FloorPlanError, match=r"there is no obstacle 0; there are \[2\]"):
        plan.remove_obstacle(0)


def test_the_wall_index_follows_every_change() -> None:
    plan = FloorPlan(box(0, 0, 10, 8), exits=[SOUTH], gates=[Gate("door", (0, 5), (10, 5))])
    for change in (
        lambda: plan.add_obstacle(box(2, 2, 3, 3)),
        lambda: plan.close_gate("door"),
        lambda: plan.add_obstacle(box(2.5, 2.5, 4, 4)),
        lambda: plan.remove_obstacle(0),
        lambda: plan.open_gate("door"),
        lambda: plan.close_gate("south"),
    ):
        change()
        held = plan.wall_index.segments
        assert as_set(held[~np.isnan(held[:, 0])]) == as_set(plan.walls)
        assert len(plan.wall_index) == len(plan.walls)


def test_closing_a_gate_makes_it_a_wall() -> None:
    plan = FloorPlan(box(0, 0, 10, 8), exits=[SOUTH], gates=[Gate("door", (0, 5), (10, 5))])
    plan.close_gate("door")
    assert ((0, 5), (10, 5)) in as_set(plan.walls)
    assert (plan.version, plan.is_open("door"), plan.open_gates()) == (1, False, ())
    plan.close_gate("door")
    assert plan.version == 1
    plan.open_gate("door")
    assert ((0, 5), (10, 5)) not in as_set(plan.walls)
    assert (plan.version, plan.is_open("door")) == (2, True)


def test_closing_an_exit_makes_the_wall_whole() -> None:
    plan = FloorPlan(box(0, 0, 10, 8), exits=[SOUTH])
    plan.close_gate("south")
    assert as_set(plan.walls) == as_set(
        np.array([[0, 0, 10, 0], [10, 0, 10, 8], [10, 8, 0, 8], [0, 8, 0, 0]], float)
    )
    assert plan.open_exits() == ()


def test_openings_by_name(plans) -> None:
    plan = plans["two_rooms"]()
    assert [o.name for o in plan.openings()] == ["door", "out"]
    assert plan.gate("out") is plan.exits[0]
    with pytest.raises(FloorPlanError, match="no gate or exit 'in'; there are 'door', 'out'"):
        plan.gate("in")
    with pytest.raises(FloorPlanError, match="no gate or exit 'in'"):
        plan.close_gate("in")


def test_walls_are_a_copy(plans) -> None:
    plan = plans["room"]()
    plan.walls[:] = 0
    assert plan.walls.any()


def test_pieces_with_an_exit_each_are_one_plan() -> None:
    plan = FloorPlan(
        box(0, 0, 10, 4),
        exits=[Exit("west", (0, 0), (0, 4)), Exit("east", (10, 0), (10, 4))],
        obstacles=[box(4, 0, 6, 4)],
    )
    assert plan.free.geom_type == "MultiPolygon"
    assert plan.area == 32


def test_pockets_that_hold_nobody_do_not_count() -> None:
    # A gap of 0.15 m is left between the obstacle and the wall.
    plan = FloorPlan(
        box(0, 0, 10, 4), exits=[SOUTH], obstacles=[box(9, 0, 9.85, 4), box(9.8, 0, 10, 0.1)]
    )
    assert plan.area == 36
    assert not plan.contains([(9.9, 2)])[0]


def test_a_piece_cut_off_from_every_exit() -> None:
    with pytest.raises(
        FloorPlanError, match=r"a piece of 16.00 m² around \(8.00, 2.00\) is disconnected"
    ):
        FloorPlan(box(0, 0, 10, 4), exits=[Exit("w", (0, 1), (0, 2))], obstacles=[box(5, 0, 6, 4)])


def test_an_obstacle_that_cuts_people_off_is_not_added() -> None:
    plan = FloorPlan(box(0, 0, 10, 4), exits=[Exit("w", (0, 1), (0, 2))])
    with pytest.raises(FloorPlanError, match="disconnected from every exit"):
        plan.add_obstacle(box(5, 0, 6, 4))
    assert (plan.version, plan.obstacles, plan.area) == (0, {}, 40)
    assert plan.add_obstacle(box(5, 0, 6, 3)) == 0


SQUARE = box(0, 0, 10, 10)
EDGE = [Exit("e", (0, 1), (0, 2))]


@pytest.mark.parametrize(
    ("walkable", "says"),
    [
        (Polygon(), "walkable area is empty"),
        ("POLYGON EMPTY", "walkable area is empty"),
        ("POLYGON((0 0, 1 1", "the WKT cannot be read"),
        ("", "the WKT cannot be read"),
        ("LINESTRING(0 0, 1 1)", "must be a Polygon, found a LineString"),
        (12, "must be a shapely Polygon or its WKT, found int"),
        (None, "must be a shapely Polygon or its WKT, found NoneType"),
        ("POLYGON((0 0, 4 4, 4 0, 0 4, 0 0))", r"not valid: Self-intersection\[2 2\]"),
        (MultiPolygon([box(0, 0, 1, 1), box(2, 0, 3, 1)]), "one connected polygon, found 2 pieces"),
        ("POLYGON((0 0, nan 1, 1 1, 0 0))", "coordinates that are not finite"),
        ("POLYGON((0 0, inf 1, 1 1, 0 0))", "coordinates that are not finite"),
        (Polygon([(0, 0), (1, 1), (2, 2)]), "walkable area"),
    ],
)
def test_bad_walkable_areas(walkable: object, says: str) -> None:
    with pytest.raises(FloorPlanError, match=says) as error:
        FloorPlan(walkable, exits=EDGE)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("parts", "says"),
    [
        ({"exits": []}, "the floor plan has no exit"),
        ({"exits": [Exit("e", (3, 3), (4, 3))]}, "exit 'e' is not on the edge .* 3.000 m away"),
        ({"exits": [Exit("e", (0, 9), (0, 11))]}, "exit 'e' is not on the edge .* 1.000 m away"),
        ({"exits": [Exit("e", (0.02, 1), (0.02, 2))]}, "exit 'e' is not on the edge .* 0.020 m"),
        ({"exits": [Exit("e", (1, 0), (0, 1))]}, "exit 'e' is not on the edge"),
        ({"exits": [Gate("e", (0, 1), (0, 2))]}, "exits must be Exit objects, found Gate"),
        (
            {"exits": [Exit("a", (0, 1), (0, 3)), Exit("b", (0, 2), (0, 4))]},
            "exits 'a' and 'b' overlap",
        ),
        ({"exits": [*EDGE, Exit("e", (0, 5), (0, 6))]}, "exit name 'e' is used twice"),
        ({"gates": [Gate("e", (3, 3), (4, 3))]}, "gate name 'e' is used twice"),
        ({"gates": [Gate("g", (9, 3), (12, 3))]}, "gate 'g' is not inside .*: 1.99 m of it"),
        ({"gates": [Gate("g", (19, 3), (12, 3))]}, "gate 'g' is not inside .*: 7.00 m of it"),
        ({"gates": [EDGE[0]]}, "gates must be Gate objects, found Exit"),
        ({"obstacles": [box(-1, -1, 11, 11)]}, "the obstacles leave no walkable area"),
        ({"obstacles": [box(1, 1, 2, 2), Polygon()]}, "obstacle 1 is empty"),
        ({"obstacles": ["POLYGON((0 0, 4 4, 4 0, 0 4, 0 0))"]}, "obstacle 0 is not valid"),
        ({"obstacles": [box(-1, 0.5, 1, 2.5)]}, "disconnected from every exit"),
    ],
)
def test_bad_parts(parts: dict, says: str) -> None:
    with pytest.raises(FloorPlanError, match=says) as error:
        FloorPlan(SQUARE, **{"exits": EDGE, **parts})
    assert "\n" not in str(error.value)


def test_neighbouring_exits_may_share_an_end() -> None:
    exits = [Exit("a", (0, 1), (0, 2)), Exit("b", (0, 2), (0, 3))]
    plan = FloorPlan(SQUARE, exits=exits)
    assert np.hypot(*(plan.walls[:, 2:] - plan.walls[:, :2]).T).sum() == pytest.approx(38)


def test_heights_are_dropped() -> None:
    plan = FloorPlan("POLYGON Z((0 0 1, 10 0 1, 10 10 1, 0 10 1, 0 0 1))", exits=EDGE)
    assert shapely.get_coordinate_dimension(plan.walkable) == 2
