"""Maps of density, usage and speed, beside PedPy's and plain counts."""

import numpy as np
import pedpy
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from mesa_mobility import Exit, FloorPlan
from mesa_mobility.errors import ResultsError
from mesa_mobility.results import (
    Grid,
    Trajectories,
    level_of_service,
    maps,
    maps_by_type,
    plot_map,
    service_limits,
    voronoi_density,
)
from tests.fixtures.buildings import two_storeys
from tests.results.measures.test_storeys import PEOPLE, tracks_of

FREE = shapely.box(0, 0, 4, 2)


@pytest.fixture
def floor():
    return FloorPlan(FREE, exits=[Exit("out", (4, 0.5), (4, 1.5))])


def test_published_limits_of_the_levels_of_service():
    # Metres squared a person, as the metric tables of the field round them.
    for kind, space in (
        ("walkway", [3.25, 2.32, 1.39, 0.93, 0.46]),
        ("stairs", [1.86, 1.39, 0.93, 0.65, 0.37]),
        ("queue", [1.21, 0.93, 0.65, 0.28, 0.19]),
    ):
        assert (1 / service_limits(kind)).tolist() == pytest.approx(space, abs=0.0051)
    letters = level_of_service([0.0, 0.3, 0.4, 0.7, 1.0, 2.1, 2.2, np.nan])
    assert letters.tolist() == ["A", "A", "B", "C", "D", "E", "F", ""]
    assert level_of_service([1.0], "queue").tolist() == ["B"]
    with pytest.raises(ResultsError, match="of 'lift', expected one of walkway, stairs, queue"):
        service_limits("lift")


def test_two_people_halve_a_floor(walk, floor):
    # At x = 1 and 2 of 4 m the border is at 1.5: 3 and 5 m2.
    tracks = walk({0: (0, [(1, 1)] * 3), 1: (0, [(2, 1)] * 3)}, frame_rate=1.0)
    found = maps(tracks, floor, cell=1.0, dense=0.3)[0]
    row = [1 / 3, (1 / 3 + 1 / 5) / 2, 1 / 5, 1 / 5]
    np.testing.assert_allclose(found.density_max, [row, row])
    np.testing.assert_allclose(found.density_mean, [row, row])
    assert found.dense_s.tolist() == [[3.0, 0.0, 0.0, 0.0]] * 2
    assert found.people.tolist() == [[0, 0, 0, 0], [0, 1, 1, 0]]
    assert found.person_s.tolist() == [[0, 0, 0, 0], [0, 3, 3, 0]]


def test_densities_of_types_sum_up_to_that_of_all(leaving):
    plan, tracks = leaving
    people = len(tracks.radii)
    kinds = np.where(np.arange(people) % 3 == 0, "child", "adult")
    mixed = Trajectories(
        tracks.frame,
        tracks.person,
        tracks.x,
        tracks.y,
        tracks.heading,
        inside_at_end=tracks.remaining,
        person_data={"type": kinds},
    )
    found = maps_by_type(mixed, plan, every=2.0)
    assert list(found) == ["all", "adult", "child"]
    every, adult, child = (each[0] for each in found.values())
    np.testing.assert_allclose(adult.density_mean + child.density_mean, every.density_mean)
    np.testing.assert_array_equal(adult.people + child.people, every.people)
    assert every.people.max() > child.people.max() > 0


def test_densities_of_a_run_are_pedpys(leaving):
    plan, tracks = leaving
    time, cell = 4.0, 0.5
    found = maps(tracks, plan, cell=cell, start=time, end=time)[0]
    data = tracks.to_pedpy()
    rows = data.data[data.data.frame == round(30 * time)]
    rows = rows[shapely.contains_xy(plan.free, rows.x, rows.y)]
    once = pedpy.TrajectoryData(data=rows[["id", "frame", "x", "y"]], frame_rate=30.0)
    area = pedpy.WalkableArea(plan.free)
    cells = pedpy.compute_individual_voronoi_polygons(traj_data=once, walkable_area=area)
    # The lowest version of PedPy wants the cells' parts, and data in the order that they have.
    grid, _, _ = pedpy.get_grid_cells(walkable_area=area, grid_size=cell)
    parts, ordered = pedpy.compute_grid_cell_polygon_intersection_area(data=cells, grid_cells=grid)
    [theirs] = pedpy.compute_density_profile(
        data=ordered,
        walkable_area=area,
        grid_size=cell,
        density_method=pedpy.DensityMethod.VORONOI,
        grid_intersections_area=parts,
    )
    # PedPy's rows begin with the greatest y, and it divides by the whole cell.
    ours = found.density_max * found.grid.share
    assert ours.shape == theirs.shape
    np.testing.assert_allclose(np.nan_to_num(ours), theirs[::-1], atol=1e-9)
    assert ours[np.isfinite(ours)].max() > 1.0


def test_densities_of_a_run_add_up_to_its_people(leaving):
    plan, tracks = leaving
    for time in (0.0, 3.0, 6.0):
        found = maps(tracks, plan, start=time, end=time)[0]
        people = np.nansum(found.density_max * found.grid.share) * found.grid.cell**2
        assert people == pytest.approx(tracks.inside()[round(30 * time)], abs=1.01)
        # As the mean over the whole floor, which another function computes.
        whole = dict(voronoi_density(tracks, plan.walkable, plan.free, every=3.0))[time]
        assert people == pytest.approx(whole * plan.free.area)


def test_usage_and_speed_as_a_plain_loop_counts_them(leaving):
    plan, tracks = leaving
    found = maps(tracks, plan, cell=1.0)[0]
    rows = tracks.to_pandas()
    last = rows.groupby("person").frame.max()
    inside = rows[rows.frame < last[rows.person].to_numpy()]
    x0, y0 = plan.free.bounds[:2]
    column, row = (inside.x - x0) // 1.0, (inside.y - y0) // 1.0
    people = inside.groupby([row, column]).person.nunique()
    for (r, c), count in people.items():
        assert found.people[int(r), int(c)] == count
    assert found.people.sum() == people.sum()
    assert found.person_s.sum() == pytest.approx(len(inside) / 30)
    places = {(p, f): (x, y) for p, f, x, y in rows[["person", "frame", "x", "y"]].to_numpy()}
    speeds = {}
    for (person, frame), (x, y) in places.items():
        before, after = places.get((person, frame - 15)), places.get((person, frame + 15))
        if frame % 30 == 0 and before and after:
            speed = np.hypot(after[0] - before[0], after[1] - before[1])
            speeds.setdefault((int(y - y0), int(x - x0)), []).append(speed)
    assert np.isfinite(found.speed).sum() == len(speeds) > 10
    for (r, c), values in speeds.items():
        assert found.speed[r, c] == pytest.approx(np.mean(values))


def test_each_level_of_a_building_has_maps(tmp_path):
    tracks, office = tracks_of(PEOPLE), two_storeys()
    found = maps(tracks, office, cell=2.0)
    assert list(found) == [1, 0]
    # Upstairs are people 0 and 2 at first, later 1 and 2; downstairs person 1, later 0.
    assert [each.people.sum() for each in found.values()] == [3, 2]
    plot_map(found, tracks, office, tmp_path / "map.png", what="people")
    assert (tmp_path / "map.png").stat().st_size > 1000


def test_nobody_and_people_on_one_spot(walk, floor):
    nobody = Trajectories([], [], [], [], [], last_frame=30)
    found = maps(nobody, floor, cell=1.0)[0]
    assert (found.density_max.max(), found.people.max()) == (0.0, 0)
    assert np.isnan(found.speed).all()
    twice = walk({0: (0, [(1, 1)] * 2), 1: (0, [(1, 1)] * 2)}, frame_rate=1.0)
    np.testing.assert_allclose(maps(twice, floor, cell=1.0)[0].density_max, 0.25)


@given(
    st.lists(
        st.tuples(st.integers(1, 39), st.integers(1, 19)), min_size=1, max_size=12, unique=True
    ),
    st.sampled_from([0.3, 0.5, 0.7, 5.0]),
)
def test_densities_hold_everybody_in_cells_of_any_size(points, cell):
    grid = Grid(FREE.difference(shapely.box(1.02, 0.52, 1.48, 1.48)), cell)
    places = np.array(points) / 10
    on = shapely.intersects_xy(grid.floor, *places.T).sum()
    [found] = grid.densities(places, np.ones((1, len(places))))
    assert np.nansum(found * grid.share) * cell**2 == pytest.approx(on)


@pytest.mark.parametrize(
    ("given_", "said"),
    [
        ({"cell": 0.0}, "expected more than 0"),
        ({"cell": np.nan}, "expected more than 0"),
        ({"cell": 1e-4}, "at most 1,000,000 cells"),
        ({"start": 3.0}, "expected rising times within the run's 2 s"),
        ({"end": 9.0}, "expected rising times"),
        ({"every": 0.1}, "shorter than a frame"),
    ],
)
def test_maps_that_cannot_be(walk, floor, given_, said):
    tracks = walk({0: (0, [(1, 1)] * 3)}, frame_rate=1.0)
    with pytest.raises(ResultsError, match=said):
        maps(tracks, floor, **given_)


def test_pictures_that_cannot_be(walk, floor, tmp_path):
    tracks = walk({0: (0, [(1, 1)] * 3)}, frame_rate=1.0)
    found = maps(tracks, floor)
    with pytest.raises(ResultsError, match="map 'heat', expected one of density_max"):
        plot_map(found, tracks, floor, tmp_path / "a.png", what="heat")
    with pytest.raises(ResultsError, match="maps of 1 levels for a plan of 2"):
        plot_map(found, tracks, two_storeys(), tmp_path / "a.png")
    assert list(tmp_path.iterdir()) == []
