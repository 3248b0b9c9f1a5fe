"""Outlines with many vertices: steps of a raster, jitter, waves."""

import time

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import Polygon, affinity, box

from mesa_mobility import Exit, FloorPlan, Gate, PedestrianModel
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan import Router
from mesa_mobility.floorplan.floor.outline import GRID, simplified
from mesa_mobility.floorplan.walls.narrow_gaps import closed_gaps
from mesa_mobility.floorplan.walls.smooth_floor import smooth_floor
from tests.fixtures.plans.rough_outlines import rough_plan, walk_out


def _jittered(n: int, seed: int = 0, jitter: float = 0.001) -> Polygon:
    """A room of 12 m by 6 m, its lower wall with n vertices up to ``jitter`` off its line."""
    rng = np.random.default_rng(seed)
    x = np.linspace(0, 12, n + 2)[1:-1]
    low = zip(x, rng.uniform(-jitter, jitter, n), strict=True)
    return Polygon([(0, 0), *low, (12, 0), (12, 6), (0, 6)])


def _stairs(steps: int, size: float, width: float) -> tuple[Polygon, Exit]:
    """A diagonal lane between steps of a raster; its exit is the slanting line at its end."""
    corners = [(i * size, j * size) for i in range(steps + 1) for j in (i - 1, i) if j >= 0]
    low = np.array(corners)
    across = round(width / np.sqrt(2) / size) * size
    high = low[:, ::-1] + (-across, across)
    end = Exit("end", tuple(low[-1]), tuple(high[-1]))
    return Polygon(np.concatenate([low, high[::-1]])), end


def _turned(floor: Polygon, end: Exit, angle: float) -> FloorPlan:
    line = affinity.rotate(end.line, angle, origin=(0, 0))
    a, b = line.coords
    return FloorPlan(affinity.rotate(floor, angle, origin=(0, 0)), exits=[Exit("end", a, b)])


def _prepare(plan: FloorPlan) -> None:
    """A model with 50 people who have decided once."""
    model = PedestrianModel(plan, rng=1)
    model.add_pedestrians(plan.random_points(50, model.rng, spacing=0.5, clearance=0.25))
    model.step()


def _waves(n: int, length: float, wave: float = 0.6) -> Polygon:
    """A lane with walls that swing 2 cm to and fro, between which it is 4 m wide."""
    x = np.linspace(0, length, n // 2)
    y = 0.02 * np.sin(2 * np.pi * x / wave)
    return Polygon([*zip(x, y, strict=True), *zip(x[::-1], (4 - y)[::-1], strict=True)])


@pytest.mark.parametrize("angle", [0.0, 17.0, 45.0])
def test_a_diagonal_lane_of_steps_is_one_smooth_lane(angle: float) -> None:
    plan = _turned(*_stairs(160, 0.05, 1.0), angle)
    started = time.process_time()
    router = Router(plan)
    # A minute and a half when each step was a corner.
    assert time.process_time() - started < 5.0
    assert len(router.graph) < 20
    assert len(plan.walls) > 300


def test_jitter_is_left_out_and_the_floor_only_grows() -> None:
    given_floor = _jittered(350)
    plan = FloorPlan(given_floor, exits=[Exit("end", (12, 2), (12, 3))])
    assert plan.walkable.equals(given_floor)
    assert len(plan.walls) < 30
    assert given_floor.difference(plan.free).area < 1e-9
    # At most 2 mm deep, over 12 m.
    assert 0.0 < plan.area - given_floor.area < 0.024
    assert shapely.hausdorff_distance(plan.free.boundary, given_floor.boundary, 0.05) <= 0.01


def test_simplify_can_be_turned_off_and_is_kept_in_files() -> None:
    floor, exits = _jittered(40), [Exit("end", (12, 2), (12, 3))]
    plan = FloorPlan(floor, exits=exits, simplify=0)
    assert plan.free.normalize().equals_exact(floor.normalize(), 0.0)
    assert FloorPlan.from_geojson(plan.to_geojson()).simplify == 0.0
    assert FloorPlan.from_geojson(FloorPlan(floor, exits=exits).to_geojson()).simplify == 0.01


@pytest.mark.parametrize("value", [-0.01, 0.2, np.nan, "fine", None, True])
def test_bad_tolerances(value: object) -> None:
    with pytest.raises(FloorPlanError, match="simplify must be"):
        FloorPlan(_jittered(4), exits=[Exit("end", (12, 2), (12, 3))], simplify=value)


def test_an_outline_without_such_vertices_keeps_every_bit() -> None:
    floor = box(0.1, 0.2, 9.3, 7.7).difference(box(3.3, 0.2, 3.4, 5.0)).difference(box(6, 3, 7, 4))
    plan = FloorPlan(floor, exits=[Exit("end", (9.3, 2), (9.3, 3))])
    assert plan.free.normalize().equals_exact(floor.normalize(), 0.0)
    assert smooth_floor(plan).is_exact


def test_along_exits_and_gates_every_vertex_is_kept() -> None:
    x = np.linspace(0, 12, 122)[1:-1]
    low = 0.002 * (-1.0) ** np.arange(len(x))
    floor = Polygon([(0, 0), *zip(x, low, strict=True), (12, 0), (12, 6), (0, 6)])
    plan = FloorPlan(floor, exits=[Exit("end", (5, 0), (6, 0))], gates=[Gate("g", (2, 0), (2, 6))])
    kept = shapely.get_coordinates(plan.free)
    along = (x > 5) & (x < 6)
    assert along.sum() == 10
    assert set(zip(x[along], low[along], strict=True)) <= set(map(tuple, kept.tolist()))
    # The exit is cut out of all of them: no wall lies across it.
    middles = (plan.walls[:, :2] + plan.walls[:, 2:]) / 2
    assert not ((middles[:, 0] > 5) & (middles[:, 0] < 6) & (middles[:, 1] < 1)).any()
    assert abs(middles[:, 0] - 2).min() < 0.15


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 10**6), tolerance=st.floats(0.001, 0.05))
def test_simplified_outlines_contain_what_was_given(seed: int, tolerance: float) -> None:
    rng = np.random.default_rng(seed)
    angles = np.sort(rng.uniform(0, 2 * np.pi, 60))
    radii = rng.uniform(3.0, 3.0 + 4 * tolerance, 60)
    hole = shapely.segmentize(box(-1, -1, 1, 1), 0.2)
    floor = Polygon(np.column_stack([np.cos(angles), np.sin(angles)]) * radii[:, None])
    floor = floor.difference(affinity.rotate(hole, rng.uniform(0, 90)))
    if not isinstance(floor, Polygon) or not floor.is_valid:
        return
    made = simplified(floor, tolerance, [])
    assert made.is_valid
    assert len(made.interiors) == len(floor.interiors)
    assert floor.difference(made).area < 1e-7
    grown = made.difference(floor.buffer(tolerance + 1e-6))
    assert grown.is_empty
    given_vertices = set(map(tuple, shapely.get_coordinates(floor).tolist()))
    assert set(map(tuple, shapely.get_coordinates(made).tolist())) <= given_vertices


def test_a_wall_thinner_than_it_may_recede_stays() -> None:
    x = np.linspace(0, 5, 101)
    wall = 4 + 0.004 * (-1.0) ** np.arange(101)
    # A room with a slit of a wall, 2 to 10 mm thick, from the left.
    ring = [(-1, 0), (9, 0), (9, 8), (-1, 8), (-1, 4.006), (0, 4.006)]
    ring += [*zip(x, np.full(101, 4.006), strict=True), *zip(x[::-1], wall[::-1], strict=True)]
    floor = Polygon([*ring, (-1, 3.996)])
    assert floor.is_valid
    plan = FloorPlan(floor, exits=[Exit("end", (9, 2), (9, 3))])
    assert plan.free.is_valid
    assert not plan.free.contains(shapely.LineString([(2, 3), (2, 5)]))


def test_vertices_a_rounding_error_apart_are_one() -> None:
    floor = Polygon([(0, 0), (8, 0), (8, 5), (4, 5), (4 - 1e-10, 5 + 1e-10), (0, 5)])
    plan = FloorPlan(floor, exits=[Exit("end", (8, 2), (8, 3))], simplify=0)
    steps = plan.walls[:, 2:] - plan.walls[:, :2]
    assert np.hypot(*steps.T).min() >= GRID


@pytest.mark.parametrize(("width", "closed"), [(0.36, False), (0.30, True)])
def test_gaps_in_rough_walls_are_as_wide_as_walls_leave_them(width: float, closed: bool) -> None:
    # Teeth 10 cm apart and 8 cm deep on both sides of a gap, opposite each other at their tips.
    x = np.arange(0, 2.0, 0.1)
    low = np.ravel(np.column_stack([x, x + 0.05])), np.ravel(np.column_stack([0 * x, 0 * x - 0.08]))
    lower = np.column_stack(low)
    upper = lower * (1, -1) + (0, width)
    floor = box(-3, -3, 5, 3)
    solid = Polygon([(-0.1, -1), *lower, (2.0, -1)]), Polygon([(-0.1, 1), *upper, (2.0, 1)])
    floor = floor.difference(shapely.union_all([*solid, box(-0.1, -3, 2, -1), box(-0.1, 1, 2, 3)]))
    plan = FloorPlan(floor, exits=[Exit("end", (5, -1), (5, 1))])
    assert not smooth_floor(plan).is_exact
    # Across the gap, not into the last tooth.
    across = [y for y in closed_gaps(plan, 0.34)[:, [1, 3]] if min(y) < width / 2 < max(y)]
    assert (len(across) > 0) == closed
    route = Router(plan).targets([(-2, 0)], [0]).distances
    assert np.isfinite(route[0]) != closed


@pytest.mark.thorough
@pytest.mark.parametrize("angle", [0.0, 33.0])
def test_five_thousand_vertices_are_prepared_in_seconds(angle: float) -> None:
    floor, end = _stairs(1250, 0.1, 3.0)
    _prepare(FloorPlan(box(0, 0, 8, 5), exits=[Exit("end", (8, 2), (8, 3))]))  # compiles
    plans = [
        lambda: FloorPlan(_jittered(5000), exits=[Exit("end", (12, 2), (12, 3))], simplify=0),
        lambda: _turned(floor, end, angle),
        lambda: FloorPlan(_waves(5000, 60.0), exits=[Exit("end", (60, 0), (60, 4))], simplify=0),
    ]
    for make in plans:
        started = time.process_time()
        plan = make()
        assert len(plan.walls) > 4000
        _prepare(plan)
        assert time.process_time() - started < 5.0


def test_an_area_to_stand_in_as_wkt() -> None:
    plan = FloorPlan(box(0, 0, 8, 5), exits=[Exit("end", (8, 2), (8, 3))])
    rng = np.random.default_rng(0)
    text = "POLYGON ((1 1, 3 1, 3 3, 1 3, 1 1))"
    points = plan.random_points(5, rng, within=text, spacing=0.5, clearance=0.3)
    assert ((points > 1) & (points < 3)).all()
    again = np.random.default_rng(0)
    same = plan.random_points(5, again, within=box(1, 1, 3, 3), spacing=0.5, clearance=0.3)
    assert len(same) == 5
    two = shapely.MultiPolygon([box(1, 1, 2, 2), box(5, 1, 6, 2)])
    both = plan.random_points(6, rng, within=two.wkt, spacing=0.4, clearance=0.3)
    assert shapely.intersects_xy(two, both[:, 0], both[:, 1]).all()


@pytest.mark.parametrize(
    ("within", "says"),
    [
        ("POLYGON ((1 1, 3 1", "within: the WKT cannot be read"),
        ("POINT (1 1)", "within must be a Polygon, found a Point"),
        ("the hall", "within: the WKT cannot be read"),
        ("POLYGON ((0 0, 2 2, 2 0, 0 2, 0 0))", "within is not valid"),
        ((1, 2, 3, 4), "within must be a shapely Polygon or its WKT, found tuple"),
    ],
)
def test_areas_that_nobody_can_stand_in(within: object, says: str) -> None:
    plan = FloorPlan(box(0, 0, 8, 5), exits=[Exit("end", (8, 2), (8, 3))])
    with pytest.raises(FloorPlanError, match=says):
        plan.random_points(2, np.random.default_rng(0), within=within, spacing=0.5, clearance=0.3)


@pytest.mark.thorough
@pytest.mark.parametrize("seed", range(12))
def test_people_leave_plans_with_rough_outlines(seed: int) -> None:
    assert walk_out(rough_plan(seed), seed) == 0


@pytest.mark.slow
def test_people_leave_many_plans_with_rough_outlines() -> None:
    left = {seed: walk_out(rough_plan(seed), seed) for seed in range(12, 200)}
    assert not {seed: inside for seed, inside in left.items() if inside}
