import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from shapely import Polygon, box

from mesa_mobility.errors import ResultsError
from mesa_mobility.results import density, individual_densities, voronoi_density


def test_cells_of_a_lattice_are_its_squares():
    x, y = np.meshgrid(np.arange(4) + 0.5, np.arange(3) + 0.5)
    points = np.column_stack([x.ravel(), y.ravel()])
    densities = individual_densities(points, box(0, 0, 4, 3))
    assert densities == pytest.approx(np.ones(12))


def test_one_person_has_the_whole_floor_and_two_half_each():
    floor = box(0, 0, 8, 5)
    assert individual_densities(np.array([[1.0, 1.0]]), floor) == pytest.approx([1 / 40])
    # The border lies at x = 3: cells of 15 and 25 m2.
    two = individual_densities(np.array([[2.0, 2.0], [4.0, 2.0]]), floor)
    assert two == pytest.approx([1 / 15, 1 / 25])
    assert len(individual_densities(np.empty((0, 2)), floor)) == 0


def test_a_cell_cut_by_a_wall_is_the_piece_with_the_person():
    # Two rooms 2 m x 4 m with a wall 1 m thick between; a door joins them at the top.
    floor = Polygon([(0, 0), (2, 0), (2, 3), (3, 3), (3, 0), (5, 0), (5, 4), (0, 4)])
    # Border at y = 1: the lower cell is 5 m x 1 m less the wall, and only 2 m2 of it are on the
    # left, where the person is.
    densities = individual_densities(np.array([[1.0, 0.5], [1.0, 1.5]]), floor)
    assert densities[0] == pytest.approx(1 / 2)


@given(st.integers(2, 30), st.integers(0, 2**31))
def test_cells_fill_a_convex_floor(n, seed):
    floor = Polygon([(0, 0), (6, 1), (7, 5), (1, 4)])
    rng = np.random.default_rng(seed)
    # Barycentric points of the two triangles of the floor.
    corners = np.array(floor.exterior.coords)[:-1]
    weights = rng.dirichlet(np.ones(4), n)
    densities = individual_densities(weights @ corners, floor)
    assert (1 / densities).sum() == pytest.approx(floor.area)


def test_density_of_an_area_is_that_of_the_cells_in_it(walk):
    # Two people in 8 m x 2 m: cells of 4 m x 2 m at first, of 6 m x 2 m and 2 m x 2 m later.
    floor = box(0, 0, 8, 2)
    run = walk({0: (0, [(2.0, 1.0), (5.0, 1.0)]), 1: (0, [(6.0, 1.0), (7.0, 1.0)])}, frame_rate=1.0)
    whole, right = box(-1, -1, 9, 3), box(4, 0, 8, 2)
    assert voronoi_density(run, whole, floor) == [[0.0, 2 / 16], [1.0, 2 / 16]]
    found = voronoi_density(run, right, floor)
    # 4 m2 of the right-hand area lie in the cell of 12 m2, the other 4 m2 are all of the other.
    assert [d for _, d in found] == pytest.approx([1 / 8, (4 / 12 + 1) / 8])


def test_density_without_people_or_floor(walk):
    run = walk({0: (0, [(2.0, 1.0)])}, frame_rate=1.0, last_frame=1)
    found = voronoi_density(run, box(0, 0, 4, 2), box(0, 0, 4, 2))
    assert found == [[0.0, 1 / 8], [1.0, 0.0]]
    with pytest.raises(ResultsError, match="no floor"):
        voronoi_density(run, box(5, 0, 6, 2), box(0, 0, 4, 2))


def test_pedpy_finds_the_same(walk):
    pedpy = pytest.importorskip("pedpy")
    rng = np.random.default_rng(5)
    floor, area = box(0, 0, 8, 5), box(2, 1, 5, 4)
    tracks = {k: (0, rng.uniform((0.2, 0.2), (7.8, 4.8), (3, 2)).tolist()) for k in range(15)}
    run = walk(tracks, frame_rate=1.0)
    cells = pedpy.compute_individual_voronoi_polygons(
        traj_data=run.to_pedpy(), walkable_area=pedpy.WalkableArea(floor)
    )
    theirs, _ = pedpy.compute_voronoi_density(
        individual_voronoi_data=cells, measurement_area=pedpy.MeasurementArea(area)
    )
    ours = [density for _, density in voronoi_density(run, area, floor)]
    assert ours == pytest.approx(theirs.sort_values("frame")["density"].tolist(), rel=1e-9)


def test_density_is_people_over_area(walk):
    run = walk(
        {0: (0, [(1, 1), (1, 1)]), 1: (0, [(1.5, 1), (9, 9)]), 2: (0, [(9, 9), (9, 9)])},
        frame_rate=1.0,
    )
    assert density(run, shapely.box(0, 0, 2, 2)) == [[0.0, 0.5], [1.0, 0.25]]


def test_density_needs_an_area(walk):
    with pytest.raises(ResultsError, match="no size"):
        density(walk({0: (0, [(0, 0)])}), shapely.Polygon())
