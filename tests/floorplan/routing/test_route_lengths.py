"""Route lengths worked out by hand: routes keep 0.2 m from corners and the ends of exits."""

from math import hypot, inf

import networkx as nx
import numpy as np
import pytest
from shapely import box

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan import Exit, FloorPlan, Gate, Router

# Exits are reached at places up to 0.5 m apart, and their ends are kept a hair clear of.
CLOSE = 0.01


def length(plan: FloorPlan, place: tuple[float, float], exits: tuple[str, ...] | None = None):
    router = Router(plan)
    return router.targets([place], [router.destination(exits)]).distances[0]


@pytest.mark.parametrize(
    ("place", "expected"),
    [
        ((4.5, 4), 4.0),  # straight down
        ((4.25, 0.001), 0.001),
        ((1.5, 3), hypot(2.7, 2.8) + 0.2),  # straight, it is 0.149 m past the jamb: by (4.2, 0.2)
        ((2, 3), hypot(2.2, 3)),  # to the end of the passable part, (4.2, 0)
        ((9, 7), hypot(4.2, 7)),  # to (4.8, 0)
        ((1, 0.3), hypot(3.2, 0.1) + 0.2),  # along the wall: around (4.2, 0.2)
        ((9.8, 0.2), 5.0 + 0.2),  # along the wall: around (4.8, 0.2)
    ],
)
def test_in_a_room(plans, place: tuple, expected: float) -> None:
    assert length(plans["room"](), place) == pytest.approx(expected, abs=CLOSE)


@pytest.mark.parametrize(
    ("place", "expected"),
    [
        ((11, 5), 5.0),
        ((1, 1), hypot(9.2, 0.8) + 8.2),  # around (10.2, 1.8), then up to (10.2, 10)
        ((8, 0.5), hypot(2.2, 1.3) + 8.2),
        ((11.5, 0.5), 9.5),
    ],
)
def test_in_an_l_corridor(plans, place: tuple, expected: float) -> None:
    assert length(plans["l_corridor"](), place) == pytest.approx(expected, abs=CLOSE)


@pytest.mark.parametrize(
    ("place", "exits", "expected"),
    [
        ((6, 2), None, 6.0),
        ((14, 2), None, 6.0),
        ((6, 2), ("west",), 6.0),
        ((6, 2), ("east",), 14.0),
        ((14, 2), ("east", "west"), 6.0),
    ],
)
def test_to_chosen_exits(plans, place: tuple, exits: tuple, expected: float) -> None:
    assert length(plans["corridor"](), place, exits) == pytest.approx(expected, abs=CLOSE)


def test_another_exit_is_no_way(plans) -> None:
    # From the left leg the side exits lie open towards the right leg: the way is around below,
    # by (1.8, 1.8) and (4.2, 1.8).
    plan = plans["u_corridor"]()
    around = hypot(0.8, 3.7) + 2.4 + 8.2
    assert length(plan, (1, 5.5), ("top",)) == pytest.approx(around, abs=CLOSE)
    assert length(plan, (1, 5.5)) == pytest.approx(1.0, abs=CLOSE)
    # The right exit is reached from its own leg: by (4.2, 1.8) up to its jamb at (4.2, 5.2).
    side = hypot(0.8, 3.7) + 2.4 + 3.4 + 0.2
    assert length(plan, (1, 5.5), ("right",)) == pytest.approx(side, abs=CLOSE)


def test_through_a_door(plans) -> None:
    # Past the lower jamb by (6.4, 2.2), out at (6.5, 0).
    expected = hypot(3.4, 0.3) + hypot(0.1, 2.2)
    assert length(plans["two_rooms_turning_back"](), (3, 2.5)) == pytest.approx(expected, abs=CLOSE)


def test_an_obstacle_lengthens_the_way(plans) -> None:
    plan = plans["corridor"]()
    router = Router(plan)
    east = router.destination(("east",))
    assert router.targets([(5, 1)], [east]).distances[0] == pytest.approx(15, abs=CLOSE)
    wall = plan.add_obstacle(box(10, 0, 10.2, 3))
    # Around (9.8, 3.2), then straight along to x = 20.
    around = hypot(4.8, 2.2) + 10.2
    assert router.targets([(5, 1)], [east]).distances[0] == pytest.approx(around, abs=CLOSE)
    plan.remove_obstacle(wall)
    assert router.targets([(5, 1)], [east]).distances[0] == pytest.approx(15, abs=CLOSE)


def test_a_closed_gate_is_walked_around(plans) -> None:
    plan = FloorPlan(
        box(0, 0, 20, 4),
        exits=[Exit("east", (20, 0), (20, 4))],
        gates=[Gate("barrier", (10, 1), (10, 3))],
    )
    router = Router(plan)
    assert router.targets([(5, 2)], [0]).distances[0] == pytest.approx(15, abs=CLOSE)
    plan.close_gate("barrier")
    # By (9.8, 3.2) and (10.2, 3.2) around its end.
    around = hypot(4.8, 1.2) + 0.4 + 9.8
    assert router.targets([(5, 2)], [0]).distances[0] == pytest.approx(around, abs=CLOSE)


@pytest.mark.parametrize(("gap", "expected"), [(0.36, 15.0), (0.32, inf)])
def test_gaps_narrower_than_a_body_are_no_way(gap: float, expected: float) -> None:
    wall = [box(10, 0, 10.2, 2 - gap / 2), box(10, 2 + gap / 2, 10.2, 4)]
    exits = [Exit("east", (20, 0), (20, 4)), Exit("west", (0, 0), (0, 4))]
    plan = FloorPlan(box(0, 0, 20, 4), exits=exits, obstacles=wall)
    assert length(plan, (5, 2), ("east",)) == pytest.approx(expected, abs=CLOSE)


def test_around_two_corners_close_together() -> None:
    # The corners (10, 1.85) and (10.25, 2.1) of two blocks leave a slanting gap of 0.354 m.
    blocks = [box(9, 0, 10, 1.85), box(10.25, 2.1, 11, 4)]
    plan = FloorPlan(box(0, 0, 20, 4), exits=[Exit("east", (20, 0), (20, 4))], obstacles=blocks)
    # Above the first block, through the gap, below the second: at most a body's berth longer
    # than straight.
    assert 15.0 <= length(plan, (5, 2)) <= 15.2


def test_close_to_a_wall_the_way_on_is_in_view(plans) -> None:
    # Between two rows, 0.075 m below one and near its end: around (14.2, 10), up the aisle to
    # (15, 14.1), clear of the jamb, and out. Not back through the whole row.
    expected = hypot(0.325, 0.125) + hypot(0.8, 4.1) + 0.2
    assert length(plans["hall"](), (13.875, 10.125)) == pytest.approx(expected, abs=0.02)


def test_a_wider_body_needs_a_wider_gap() -> None:
    wall = [box(10, 0, 10.2, 1.7), box(10, 2.3, 10.2, 4)]
    plan = FloorPlan(box(0, 0, 20, 4), exits=[Exit("east", (20, 0), (20, 4))], obstacles=wall)
    for clearance, reaches in ((0.2, True), (0.34, True), (0.4, False)):
        found = Router(plan, clearance=clearance).targets([(5, 2)], [0]).distances[0]
        assert np.isfinite(found) == reaches


def test_a_closed_door_leaves_no_way(plans) -> None:
    plan = plans["two_rooms"]()
    router = Router(plan)
    plan.close_gate("door")
    shut_in, beyond = router.targets([(3, 3), (9, 3)], [0, 0]).distances
    assert shut_in == inf
    assert beyond < inf
    plan.close_gate("out")
    assert (router.targets([(3, 3), (9, 3)], [0, 0]).distances == inf).all()
    plan.open_gate("out")
    plan.open_gate("door")
    assert np.isfinite(router.targets([(3, 3)], [0]).distances).all()


def test_the_graph_can_be_looked_at(plans) -> None:
    router = Router(plans["l_corridor"]())
    graph = router.graph
    assert isinstance(graph, nx.DiGraph)
    corners = [d["position"] for _, d in graph.nodes(data=True) if d["kind"] == "corner"]
    assert any(np.allclose(c, (10.2, 1.8)) for c in corners)
    for a, b, weight in graph.edges(data="weight"):
        (x, y), (u, v) = graph.nodes[a]["position"], graph.nodes[b]["position"]
        assert weight == pytest.approx(hypot(u - x, v - y))
    distances = router.distances(0)
    exits = [n for n, d in graph.nodes(data=True) if d["opening"] == "top"]
    assert exits
    assert (distances[exits] == 0).all()
    for node in graph:
        ways = [
            nx.dijkstra_path_length(graph, node, e) for e in exits if nx.has_path(graph, node, e)
        ]
        assert distances[node] == pytest.approx(min(ways))


@pytest.mark.parametrize("name", ["two_rooms", "two_rooms_turning_back"])
def test_gates_are_passed_in_their_direction(plans, name: str) -> None:
    graph = Router(plans[name]()).graph
    seen = set()
    for a, b in graph.edges:
        before, after = graph.nodes[a], graph.nodes[b]
        step = np.subtract(after["position"], before["position"])
        for node in (before, after):
            if node["direction"] is not None:
                assert step @ node["direction"] > 0
                seen.add(node["kind"])
    assert seen == {"gate", "exit"}


def test_destinations_are_numbered_once(plans) -> None:
    router = Router(plans["corridor"]())
    assert router.destination() == router.destination(None) == 0
    west = router.destination(("west",))
    assert router.destination(["west"]) == router.destination("west") == west == 1
    both = router.destination(("west", "east"))
    assert router.destination(("east", "west", "east")) == both == 2


@pytest.mark.parametrize(
    ("ask", "says"),
    [
        (lambda r: r.destination(("north",)), "no gate or exit 'north'; there are 'door', 'out'"),
        (lambda r: r.destination(("door",)), "'door' is a gate, a destination needs exits"),
        (lambda r: r.destination(()), "at least one exit name"),
        (lambda r: r.distances(1), "no destination 1; there are 1"),
        (lambda r: r.targets([(1, 1)], [-1]), "no destination -1"),
        (lambda r: r.targets([(1, 1)], [0, 0]), "found 2 for 1"),
    ],
)
def test_bad_questions(plans, ask, says: str) -> None:
    with pytest.raises(FloorPlanError, match=says):
        ask(Router(plans["two_rooms"]()))


@pytest.mark.parametrize("options", [{"clearance": 0}, {"beyond": -1}, {"clearance": np.nan}])
def test_bad_routers(plans, options: dict) -> None:
    with pytest.raises(FloorPlanError, match="a router needs clearance > 0 and beyond > 0"):
        Router(plans["room"](), **options)


def test_exits_side_by_side_cost_no_views_of_each_other() -> None:
    # A wall of 300 exits: each has three places and two ends of walls, which serve it alone.
    exits = [Exit(f"door {k}", (k + 0.1, 0), (k + 0.9, 0)) for k in range(300)]
    router = Router(FloorPlan(box(0, 0, 300, 20), exits=exits))
    assert router.graph.number_of_edges() <= 300 * 2 * 3
    assert router.targets([(150.5, 8)], [0]).distances[0] == pytest.approx(8.0, abs=CLOSE)
    # Along the wall to the next one, around the end of its wall at (150.3, 0.2).
    along = router.targets([(149.98, 0.17)], [router.destination(["door 150"])]).distances[0]
    assert along == pytest.approx(hypot(0.32, 0.03) + 0.2, abs=CLOSE)


def test_ends_of_walls_beside_an_exit_lead_to_it_alone() -> None:
    exits = [Exit("left", (2, 0), (3, 0)), Exit("right", (7, 0), (8, 0))]
    graph = Router(FloorPlan(box(0, 0, 10, 6), exits=exits)).graph
    corners = [node for node, kind in graph.nodes(data="kind") if kind == "corner"]
    assert len(corners) == 4
    for corner in corners:
        left = graph.nodes[corner]["position"][0] < 5
        openings = {graph.nodes[node]["opening"] for node in graph.successors(corner)}
        assert openings == {"left" if left else "right"}
