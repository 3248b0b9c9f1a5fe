import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import box

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan import CellTable, Exit, FloorPlan, WallIndex

coordinate = st.one_of(st.integers(-6, 6).map(float), st.floats(-20, 20).map(lambda v: round(v, 6)))
segments = st.lists(
    st.tuples(coordinate, coordinate, coordinate, coordinate), min_size=1, max_size=12
)


def of_cell(table: CellTable, i: int, j: int) -> list[int]:
    k = j * table.nx + i
    return table.indices[table.offsets[k] : table.offsets[k + 1]].tolist()


def cell_box(table: CellTable, i: int, j: int) -> shapely.Polygon:
    x, y, side = table.x0 + i * table.cell_size, table.y0 + j * table.cell_size, table.cell_size
    return box(x, y, x + side, y + side)


def test_near_finds_bounding_boxes() -> None:
    index = WallIndex([[0, 0, 4, 0], [4, 0, 4, 4], [10, 10, 12, 12]])
    assert index.near(-1, -1, 1, 1).tolist() == [0]
    assert index.near(3, -1, 5, 1).tolist() == [0, 1]
    assert index.near(11.5, 10, 12, 10.5).tolist() == [2]  # in its box, off the line
    assert index.near(20, 20, 30, 30).tolist() == []


def test_segments_come_and_go() -> None:
    index = WallIndex([[0, 0, 4, 0], [4, 0, 4, 4], [4, 4, 0, 4]])
    index.remove([1])
    assert len(index) == 2
    assert np.isnan(index.segments[1]).all()
    assert index.near(-9, -9, 9, 9).tolist() == [0, 2]
    # The free number is used again before new ones.
    assert index.add([[7, 7, 8, 8], [1, 1, 2, 2]]).tolist() == [1, 3]
    assert index.near(-9, -9, 9, 9).tolist() == [0, 1, 2, 3]
    assert index.segments[1].tolist() == [7, 7, 8, 8]
    index.remove([0, 1, 2, 3])
    assert len(index) == 0
    assert index.near(-9, -9, 9, 9).tolist() == []


def test_an_index_without_walls() -> None:
    index = WallIndex([])
    assert index.near(0, 0, 1, 1).tolist() == []
    table = index.cell_table(1.0, 0.5)
    assert (table.nx, table.ny, table.offsets.tolist()) == (1, 1, [0, 0])
    assert index.add([[0, 0, 1, 1]]).tolist() == [0]


def test_replace_keeps_the_numbers_of_what_stays() -> None:
    index = WallIndex([[0, 0, 4, 0], [4, 0, 4, 4], [4, 4, 0, 4]])
    index.replace([[4, 4, 0, 4], [9, 9, 8, 8], [0, 0, 4, 0], [5, 5, 6, 6]])
    assert index.segments.tolist() == [[0, 0, 4, 0], [9, 9, 8, 8], [4, 4, 0, 4], [5, 5, 6, 6]]


@pytest.mark.parametrize(
    ("bad", "says"),
    [
        ([[0, 0, 1]], r"rows of x1, y1, x2, y2, found shape \(1, 3\)"),
        ([[0, 0, 1, 1], [0, np.nan, 1, 1]], "wall segment 1 must be finite"),
        (np.zeros((2, 2, 2)), "rows of x1, y1, x2, y2"),
    ],
)
def test_bad_segments(bad: object, says: str) -> None:
    with pytest.raises(FloorPlanError, match=says):
        WallIndex(bad)


@pytest.mark.parametrize("missing", [-1, 1, 7])
def test_removing_what_is_not_there(missing: int) -> None:
    index = WallIndex([[0, 0, 4, 0], [4, 0, 4, 4]])
    index.remove([1])
    with pytest.raises(FloorPlanError, match=f"no wall segment {missing} to remove"):
        index.remove([0, missing])
    assert index.near(-9, -9, 9, 9).tolist() == [0]


@pytest.mark.parametrize(("size", "reach"), [(0, 1), (-1, 1), (1, -0.1), (np.nan, 1), (1, np.inf)])
def test_bad_grids(size: float, reach: float) -> None:
    with pytest.raises(FloorPlanError, match="cell_size > 0 and reach >= 0"):
        WallIndex([[0, 0, 1, 1]]).cell_table(size, reach)


@settings(deadline=None)
@given(walls=segments, query=st.tuples(coordinate, coordinate, coordinate, coordinate))
def test_near_misses_nothing(walls: list, query: tuple) -> None:
    xmin, xmax = sorted(query[0::2])
    ymin, ymax = sorted(query[1::2])
    expected = [
        i
        for i, (x1, y1, x2, y2) in enumerate(walls)
        if max(x1, x2) >= xmin
        and min(x1, x2) <= xmax
        and max(y1, y2) >= ymin
        and min(y1, y2) <= ymax
    ]
    assert WallIndex(walls).near(xmin, ymin, xmax, ymax).tolist() == expected


def test_cells_of_one_wall_by_hand() -> None:
    # A wall along y = 0.5 from x = 0.5 to 2.5, reach 0.25: the grid starts at (0.25, 0.25).
    table = WallIndex([[0.5, 0.5, 2.5, 0.5]]).cell_table(1.0, 0.25)
    assert (table.x0, table.y0, table.nx, table.ny, table.cell_size) == (0.25, 0.25, 3, 1, 1.0)
    assert table.offsets.tolist() == [0, 1, 2, 3]
    assert table.indices.tolist() == [0, 0, 0]


def test_removed_walls_are_in_no_cell() -> None:
    index = WallIndex([[0, 0, 3, 0], [0, 2, 3, 2]])
    index.remove([0])
    table = index.cell_table(1.0, 0.1)
    assert set(table.indices.tolist()) == {1}
    assert table.y0 == pytest.approx(1.9)


@pytest.mark.thorough
@settings(deadline=None, max_examples=150)
@given(walls=segments, size=st.floats(0.4, 5), reach=st.floats(0, 3))
def test_cells_hold_exactly_the_walls_within_reach(walls: list, size: float, reach: float) -> None:
    table = WallIndex(walls).cell_table(size, reach)
    assert table.indices.dtype == np.int32
    assert table.offsets.dtype == np.int64
    lines = shapely.linestrings(np.array(walls).reshape(-1, 2, 2))
    for j in range(table.ny):
        for i in range(table.nx):
            away = shapely.distance(cell_box(table, i, j), lines)
            held = set(of_cell(table, i, j))
            # Only where rounding decides may the two differ.
            assert set(np.flatnonzero(away < reach - 1e-9)) <= held
            assert held <= set(np.flatnonzero(away <= reach + 1e-9))
            assert of_cell(table, i, j) == sorted(held)


@settings(deadline=None, max_examples=60)
@given(walls=segments, size=st.floats(0.4, 5), reach=st.floats(0, 3))
def test_nothing_outside_the_grid_is_within_reach(walls: list, size: float, reach: float) -> None:
    table = WallIndex(walls).cell_table(size, reach)
    x, y = np.array(walls)[:, 0::2], np.array(walls)[:, 1::2]
    assert table.x0 <= x.min() - reach + 1e-9
    assert table.y0 <= y.min() - reach + 1e-9
    assert table.x0 + table.nx * size >= x.max() + reach - 1e-9
    assert table.y0 + table.ny * size >= y.max() + reach - 1e-9


def test_a_large_empty_plan_costs_little_but_its_walls() -> None:
    plan = FloorPlan(box(0, 0, 450, 450), exits=[Exit("e", (0, 1), (0, 2))])
    table = WallIndex(plan.walls).cell_table(1.0, 0.5)
    # 4 x 450 m of wall, each in the rows of cells on both sides of it.
    assert 4 * 450 <= len(table.indices) <= 4 * 3 * 452
    slanting = WallIndex([[0, 0, 450, 450]]).cell_table(1.0, 0.5)
    assert len(slanting.indices) <= 5 * 452
