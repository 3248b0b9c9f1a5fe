"""Which points a design has."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mesa_mobility.errors import ModelError
from mesa_mobility.experiments import (
    Grid,
    LatinHypercube,
    MorrisTrajectories,
    SaltelliSamples,
    SobolSequence,
    Table,
)


def test_a_grid_in_its_order():
    grid = Grid({"a": [1, 2], "b": ["x", "y", "z"], "c": 5})
    assert len(grid) == 6
    assert [grid[k] for k in range(6)] == [{"a": a, "b": b, "c": 5} for a in (1, 2) for b in "xyz"]
    assert grid.column_types() == {"a": "int64", "b": "string", "c": "int64"}
    with pytest.raises(IndexError):
        grid[6]


def test_a_grid_of_nothing_is_one_point():
    assert [Grid({})[0], len(Grid({}))] == [{}, 1]


def test_whole_and_broken_numbers_in_one_column():
    assert Grid({"w": [1, 1.5]}).column_types() == {"w": "double"}
    with pytest.raises(ModelError, match="values of the types int and str, expected one type"):
        Grid({"w": [1, "a"]}).column_types()


@pytest.mark.parametrize("points", [1, 7, 32])
def test_a_latin_hypercube_has_one_point_in_each_stratum(points):
    design = LatinHypercube({"w": (0.8, 2.0), "v": (-1.0, 1.0)}, points, seed=3)
    for name, low, high in (("w", 0.8, 2.0), ("v", -1.0, 1.0)):
        values = np.array([design[k][name] for k in range(points)])
        strata = np.floor((values - low) / (high - low) * points)
        assert sorted(strata) == list(range(points))


def test_more_points_of_a_sobol_sequence_leave_the_first_as_they_are():
    bounds = {"w": (0.8, 2.0), "n": (1, 9)}
    few, many = SobolSequence(bounds, 5, seed=1), SobolSequence(bounds, 64, seed=1)
    assert [few[k] for k in range(5)] == [many[k] for k in range(5)]


@given(st.integers(-5, 5), st.integers(1, 4), st.integers(0, 99))
def test_whole_bounds_give_whole_numbers_with_both_ends(low, width, seed):
    design = SobolSequence({"n": (low, low + width), "m": (0, 1)}, 64, seed=seed)
    values = [design[k]["n"] for k in range(64)]
    assert set(values) == set(range(low, low + width + 1))
    assert {type(value) for value in values} == {int}
    assert design.column_types() == {"n": "int64", "m": "int64"}


def test_sizes_of_the_designs_for_sensitivity():
    pytest.importorskip("SALib", reason="needs the extra sensitivity")
    bounds = {"a": (0.0, 1.0), "b": (2.0, 3.0), "c": (1, 5)}
    for design, size in (
        (SaltelliSamples(bounds, samples=16), 16 * 5),
        (MorrisTrajectories(bounds, trajectories=6), 6 * 4),
    ):
        assert len(design) == size == len([design[k] for k in range(len(design))])
        assert all(2.0 <= design[k]["b"] <= 3.0 for k in range(size))


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Grid({"a": []}), "grid: a has no values, expected one or more"),
        (lambda: Grid({"a": [1, 1.0]}), "grid: a has a value twice"),
        (lambda: Table([]), "table: got 0 points, expected 1"),
        (lambda: Table([{"a": 1}, {"b": 1}]), "table: point 2 has b, expected a as the first"),
        (lambda: Table([{"a": 1}, {"a": 1}]), "table: has a point twice"),
        (lambda: LatinHypercube({}, 4), "latin_hypercube: has no parameters"),
        (lambda: LatinHypercube({"a": (1, 1)}, 4), "a is from 1 to 1, expected rising bounds"),
        (lambda: SobolSequence({"a": (1, "b")}, 4), "expected a lowest and a highest number"),
        (lambda: SobolSequence({"a": 3}, 4), "expected a lowest and a highest number"),
        (lambda: SobolSequence({"a": (0, 1)}, 0), "sobol: got 0 points, expected 1 to 10,000,000"),
        (lambda: SaltelliSamples({"a": (0, 1)}, samples=12), "expected a power of two"),
        (lambda: MorrisTrajectories({"a": (0, 1)}, levels=3), "expected an even number"),
    ],
)
def test_designs_that_are_none(make, message):
    with pytest.raises(ModelError, match=message):
        make()


def test_sensitivity_designs_drawn_again_are_the_same() -> None:
    bounds = {"a": (0, 10), "b": (0.0, 1.0)}
    for design, size in (
        (SaltelliSamples, {"samples": 4}),
        (MorrisTrajectories, {"trajectories": 3}),
    ):
        first, again = design(bounds, seed=0, **size), design(bounds, seed=0, **size)
        np.testing.assert_array_equal(first.unit, again.unit)
