import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely import Polygon, box

from mesa_mobility.verification.voronoi import individual_densities


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
