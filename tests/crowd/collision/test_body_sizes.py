"""Bodies of several sizes on one floor: each starts, and finds its way, by its own."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from mesa_mobility.behaviors import QuickestExit
from shapely import Polygon, box, union_all

from mesa_mobility import Exit, FloorPlan, Gate, PedestrianModel, PedestrianType
from mesa_mobility.crowd.insertion.placement import check_beside_walls
from mesa_mobility.crowd.state import environment
from mesa_mobility.crowd.state.clearances import clearance_of
from mesa_mobility.crowd.state.corners import Corners
from mesa_mobility.errors import FloorPlanError, ModelError
from mesa_mobility.floorplan import Router
from tests.fixtures.maps import shipped_map
from tests.fixtures.oracles.counting import track


def neck(width: float) -> FloorPlan:
    """Two rooms of 6 m joined by a neck of 1 m length, with the exit in the second one."""
    low, high = 3.0 - width / 2, 3.0 + width / 2
    floor = union_all([box(0, 0, 6, 6), box(6, low, 7, high), box(7, 0, 13, 6)])
    return FloorPlan(
        floor, exits=[Exit("out", (13, 2), (13, 4))], gates=[Gate("neck", (6.5, low), (6.5, high))]
    )


def mixed(plan: FloorPlan, *cores: float, **keywords) -> PedestrianModel:
    kinds = [
        PedestrianType(mobility_map=shipped_map(), core_radius=core, name=f"{core:g}")
        for core in cores
    ]
    return PedestrianModel(plan, pedestrian_types=kinds, rng=1, record=True, **keywords)


@pytest.mark.parametrize("place", [(0.0, 0.0), (0.0, 3.0), (0.1, 3.0), (5.9, 5.9)])
def test_nobody_starts_in_a_wall(place):
    model = mixed(neck(1.0), 0.14)
    with pytest.raises(ModelError, match=r"pedestrian 1 at .* from a wall, .* its body, 0.14 m"):
        model.add_pedestrians([(3.0, 3.0), place])
    assert model.inside == 0


@pytest.mark.parametrize(("away", "fits"), [(0.13, 0), (0.14, 1), (0.2, 1), (0.26, 2), (0.36, 3)])
def test_each_needs_room_for_its_own_body(away, fits):
    model = mixed(neck(1.0), 0.14, 0.25, 0.35)
    for kind in range(3):
        if kind < fits:
            model.add_pedestrians([(away, 1.0 + 2.0 * kind)], type_index=kind)
        else:
            with pytest.raises(ModelError, match="from a wall"):
                model.add_pedestrians([(away, 1.0 + 2.0 * kind)], type_index=kind)


@settings(deadline=None, max_examples=60)
@given(st.integers(0, 2**31), st.floats(0.05, 0.6))
def test_room_between_walls_is_the_distance_to_them(seed, core):
    rng = np.random.default_rng(seed)
    turn = np.sort(rng.uniform(0, 2 * np.pi, 7))
    away = rng.uniform(1.0, 6.0, 7)
    floor = Polygon(np.column_stack([away * np.cos(turn), away * np.sin(turn)]))
    if not floor.is_valid or floor.buffer(-0.2).geom_type != "Polygon":
        return
    a, b = np.array(floor.exterior.coords[:2])
    if np.hypot(*(b - a)) < 0.5:
        return
    plan = FloorPlan(floor, exits=[Exit("out", a + 0.2 * (b - a), b - 0.2 * (b - a))])
    edge = floor.exterior.difference(plan.exits[0].line.buffer(0.01, cap_style="flat"))
    points = rng.uniform(-6, 6, (40, 2))
    for x, y in points[shapely.contains_xy(floor, *points.T)]:
        room = edge.distance(shapely.Point(x, y))
        if abs(room - core) < 1e-4:
            continue
        if room < core:
            with pytest.raises(ModelError, match="from a wall"):
                check_beside_walls(np.array([[x, y]]), core, plan)
        else:
            check_beside_walls(np.array([[x, y]]), core, plan)


def test_a_larger_body_that_is_listed_closes_no_door_to_others():
    model = mixed(neck(0.6), 0.14, 0.35)
    model.add_pedestrians([(3.0, 3.0)])
    with pytest.raises(FloorPlanError, match="have no way to any exit"):
        model.add_pedestrians([(4.0, 5.0)], type_index=1)
    model.run(max_seconds=30)
    assert model.inside == 0


def test_alone_each_walks_as_if_no_other_type_were_listed():
    paths = []
    for cores in ((0.14,), (0.14, 0.35), (0.35, 0.14)):
        model = mixed(neck(1.0), *cores)
        model.add_pedestrians(
            [(5.5, 0.5)], type_index=cores.index(0.14), preferred_speeds=1.3, headings=1.0
        )
        model.run(max_seconds=30)
        paths.append(track(model.recorder.arrays(), 0))
    assert np.array_equal(paths[0], paths[1])
    assert np.array_equal(paths[0], paths[2])


def test_a_wide_body_is_led_another_way_and_a_narrow_one_is_not():
    # A way of 4 m through a door of 0.6 m, and one of some 12 m round through one of 1 m.
    floor = union_all(
        [box(0, 0, 6, 10), box(6, 1.7, 6.2, 2.3), box(6, 8, 6.2, 9), box(6.2, 0, 12, 10)]
    )
    doors = [Gate("narrow", (6.1, 1.7), (6.1, 2.3)), Gate("wide", (6.1, 8), (6.1, 9))]
    plan = FloorPlan(floor, exits=[Exit("out", (12, 1), (12, 3))], gates=doors)
    model = mixed(plan, 0.14, 0.35)
    small = model.add_pedestrians([(3.0, 2.0)])[0]
    large = model.add_pedestrians([(3.0, 4.0)], type_index=1)[0]
    assert model.crowd.route[small.row] == pytest.approx(9.0, abs=0.2)
    assert model.crowd.route[large.row] > 13.0
    model.run(max_seconds=60)
    assert model.inside == 0
    rows = model.recorder.arrays()
    assert track(rows, small.row)[:, 2].max() < 3.0
    assert track(rows, large.row)[:, 2].max() > 8.0


def test_who_is_too_wide_for_the_way_is_told_what_it_lacks():
    # No door: the passage itself has 0.6 m.
    floor = union_all([box(0, 0, 6, 6), box(6, 2.7, 7, 3.3), box(7, 0, 13, 6)])
    model = mixed(FloorPlan(floor, exits=[Exit("out", (13, 2), (13, 4))]), 0.14, 0.35)
    with pytest.raises(FloorPlanError, match=r"gaps of less than 0.70 m.* 0.35 m radius"):
        model.add_pedestrians([(3.0, 3.0)], type_index=1)
    assert model.inside == 0


def test_routes_are_searched_for_bodies_that_are_there(monkeypatch):
    searched = []

    def router(plan, *, clearance, **given):
        searched.append(clearance)
        return Router(plan, clearance=clearance, **given)

    monkeypatch.setattr(environment, "Router", router)
    model = mixed(neck(1.0), 0.14, 0.25, 0.35)
    model.add_pedestrians([(1.0, 1.0)], type_index=2)
    assert searched == [clearance_of(0.35)]
    model.add_pedestrians([(2.0, 3.0)], route=["neck"])
    model.add_pedestrians([(2.0, 4.0)], route=["neck"], type_index=2)
    assert searched == [clearance_of(0.35), clearance_of(0.14)]
    model.run(max_seconds=60)
    assert model.inside == 0


@pytest.mark.parametrize(
    ("core", "width", "fits"),
    # A body needs its own width, and routes some centimetres more.
    [
        (0.14, 0.28, False),
        (0.14, 0.35, True),
        (0.25, 0.49, False),
        (0.25, 0.55, True),
        (0.35, 0.69, False),
        (0.35, 0.75, True),
        (0.45, 0.89, False),
        (0.45, 0.95, True),
    ],
)
def test_gaps_are_those_that_the_body_fits_through(core, width, fits):
    model = mixed(neck(width), 0.14, core)
    if not fits:
        with pytest.raises(FloorPlanError, match="no way to"):
            model.add_pedestrians([(3.0, 3.0)], type_index=1)
        return
    model.add_pedestrians([(3.0, 3.0)], type_index=1)
    model.run(max_seconds=60)
    assert model.inside == 0


def test_a_journey_leads_only_where_the_body_fits():
    model = mixed(neck(0.6), 0.14, 0.35)
    model.add_pedestrians([(3.0, 3.0)], route=["neck"])
    with pytest.raises(FloorPlanError, match="no way from 'neck' to any exit"):
        model.add_pedestrians([(3.0, 4.0)], route=["neck"], type_index=1)


def test_exits_are_chosen_by_the_ways_of_ones_own_body():
    plan = FloorPlan(
        box(0, 0, 12, 4),
        exits=[Exit("narrow", (0, 1.7), (0, 2.3)), Exit("wide", (12, 1), (12, 3))],
    )
    choice = QuickestExit()
    model = mixed(plan, 0.14, 0.35, target_choice=choice)
    small = model.add_pedestrians([(3.0, 1.0)])
    large = model.add_pedestrians([(3.0, 3.0)], type_index=1)
    rows = np.array([small[0].row, large[0].row])
    assert choice.heading(rows).tolist() == [0, 1]
    model.run(max_seconds=30)
    assert model.inside == 0


def test_corners_around_one_edge_are_shared_by_all_bodies():
    plan = FloorPlan(
        Polygon([(0, 0), (8, 0), (8, 8), (5, 8), (5, 3), (0, 3)]),
        exits=[Exit("out", (5.5, 8), (7.5, 8))],
    )
    routers = [Router(plan, clearance=clearance_of(core)) for core in (0.14, 0.25, 0.35)]
    corners = Corners(routers)
    numbers = np.array(
        [
            corners.numbers(np.array(number), which)
            for which, router in enumerate(routers)
            for number, node in router.graph.nodes(data=True)
            # The one edge that ways bend at is at (5, 3).
            if node["kind"] == "corner" and np.hypot(*(np.array(node["position"]) - (5, 3))) < 1.0
        ]
    )
    assert len(numbers) == 3
    shared = corners.shared(np.column_stack([numbers, numbers]))
    assert (shared == numbers[0]).all()
    assert corners.router_of(numbers).tolist() == [0, 1, 2]
    assert corners.shared(np.array([[-1, -1]])).tolist() == [[-1, -1]]


def test_a_crowd_of_three_sizes_gets_round_a_corner_and_out():
    plan = FloorPlan(
        Polygon([(0, 0), (9, 0), (9, 9), (5, 9), (5, 4), (0, 4)]),
        exits=[Exit("out", (5.5, 9), (8.5, 9))],
    )
    model = mixed(plan, 0.14, 0.25, 0.35)
    places = plan.random_points(24, model.rng, within=box(0, 0, 4, 4), spacing=0.75, clearance=0.4)
    for kind in range(3):
        model.add_pedestrians(places[kind::3], type_index=kind)
    model.run(max_seconds=90)
    assert model.inside == 0
    rows = model.recorder.arrays()
    points = shapely.points(rows["x"], rows["y"])
    walls = shapely.union_all(shapely.linestrings(plan.walls.reshape(-1, 2, 2)))
    # Results are exact to the engine's margin of a tenth of a millimetre.
    assert (shapely.distance(points, walls) > model.core_radii[rows["person"]]).all()
    for frame in range(0, model.frame, 5):
        here = rows["frame"] == frame
        xy, cores = (
            np.column_stack([rows["x"], rows["y"]])[here],
            model.core_radii[rows["person"][here]],
        )
        gap = np.hypot(*(xy[:, None] - xy[None]).transpose(2, 0, 1)) - cores[:, None] - cores
        np.fill_diagonal(gap, 1.0)
        assert gap.min() > 0.0


@pytest.mark.parametrize("thickness", [0.05, 0.1, 0.15])
def test_an_exit_right_before_another_wall_is_no_way_out_and_says_so(thickness):
    # The other face of the wall would be nearer to a body in the exit than its edge.
    wall = box(6, 1, 6 + thickness, 5)
    floor = Polygon(box(0, 0, 12, 6).exterior.coords, [wall.exterior.coords])
    model = mixed(FloorPlan(floor, exits=[Exit("slit", (6, 2), (6, 4))]), 0.14)
    with pytest.raises(
        FloorPlanError,
        match=r"no way to any exit; .* bodies of 0.14 m radius have no room .* behind 'slit'$",
    ):
        model.add_pedestrians([(5.0, 3.0)])
