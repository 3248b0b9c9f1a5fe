"""Indices of wall segments: an R-tree that can change, and a grid for compiled loops."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from rtree.index import Index

from mesa_mobility.compiled.decorators import kept
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.floor.geometry import segment_box_distance2

MOST_CELLS = 1 << 20
"""Most cells of a grid; with a side of 1 m they cover a square kilometre."""


class CellTable(NamedTuple):
    """The wall segments near every cell of a square grid.

    Cell (i, j) covers x0 + i * cell_size <= x <= x0 + (i + 1) * cell_size, and y
    likewise with j. Its walls are `indices[offsets[k]:offsets[k + 1]]`, ascending,
    with k = j * nx + i; they are row numbers of `WallIndex.segments`. A point
    outside the grid has no wall within `reach`. As a named tuple, a table can be
    passed to compiled functions.
    """

    x0: float
    y0: float
    nx: int
    ny: int
    cell_size: float
    offsets: NDArray[np.int64]
    indices: NDArray[np.int32]


@kept()
def _visit_cells(
    segments: NDArray[np.float64],
    cells: tuple[float, float, int, int, float],
    reach: float,
    cursor: NDArray[np.int64],
    indices: NDArray[np.int32],
    fill: bool,
) -> None:
    """Count each cell's walls into `cursor`, or write them to `indices` at `cursor`.

    `cells` are x0, y0, numbers of columns and rows, and the side of a cell.
    """
    x0, y0, nx, ny, cell = cells
    reach2 = reach * reach * (1.0 + 1e-12)
    for wall in range(segments.shape[0]):
        ax, ay, bx, by = segments[wall]
        if np.isnan(ax):
            continue
        first_row = max(0, int(np.floor((min(ay, by) - reach - y0) / cell)))
        last_row = min(ny - 1, int(np.floor((max(ay, by) + reach - y0) / cell)))
        for row in range(first_row, last_row + 1):
            low = y0 + row * cell
            high = low + cell
            # Only the part of the wall within reach of the row counts, so that a
            # long slanting wall costs its length and not its bounding box.
            t0 = 0.0
            t1 = 1.0
            if ay != by:
                ta = (low - reach - ay) / (by - ay)
                tb = (high + reach - ay) / (by - ay)
                t0 = max(0.0, min(ta, tb))
                t1 = min(1.0, max(ta, tb))
            xa = ax + t0 * (bx - ax)
            xb = ax + t1 * (bx - ax)
            # One more cell on each side against rounding; the exact test follows.
            first = max(0, int(np.floor((min(xa, xb) - reach - x0) / cell)) - 1)
            last = min(nx - 1, int(np.floor((max(xa, xb) + reach - x0) / cell)) + 1)
            for column in range(first, last + 1):
                left = x0 + column * cell
                if segment_box_distance2(ax, ay, bx, by, left, low, left + cell, high) <= reach2:
                    k = row * nx + column
                    if fill:
                        indices[cursor[k]] = wall
                    cursor[k] += 1


def as_segments(segments: ArrayLike) -> NDArray[np.float64]:
    """`segments` as an (m, 4) array of finite x1, y1, x2, y2; FloorPlanError otherwise."""
    array = np.array(segments, dtype=np.float64, ndmin=2)
    if array.size == 0:
        array = array.reshape(0, 4)
    if array.ndim != 2 or array.shape[1] != 4:
        raise FloorPlanError(
            f"wall segments must be rows of x1, y1, x2, y2, found shape {array.shape}"
        )
    if not np.isfinite(array).all():
        bad = int(np.flatnonzero(~np.isfinite(array).all(axis=1))[0])
        raise FloorPlanError(f"wall segment {bad} must be finite, found {array[bad].tolist()}")
    return array


def cell_table(segments: NDArray[np.float64], cell_size: float, reach: float) -> CellTable:
    """`WallIndex.cell_table` of (m, 4) segments; rows of NaN are left out."""
    if not (cell_size > 0 and reach >= 0 and np.isfinite([cell_size, reach]).all()):
        raise FloorPlanError(
            f"a cell table needs cell_size > 0 and reach >= 0, found {cell_size} and {reach}"
        )
    present = segments[~np.isnan(segments[:, 0])]
    x0 = y0 = 0.0
    nx = ny = 1
    side = float(cell_size)
    if len(present):
        x, y = present[:, 0::2], present[:, 1::2]
        x0, y0 = float(x.min() - reach), float(y.min() - reach)
        wide, high = float(x.max() + reach - x0), float(y.max() + reach - y0)
        while (wide // side + 1.0) * (high // side + 1.0) > MOST_CELLS:
            side *= 2.0
        nx, ny = int(wide // side) + 1, int(high // side) + 1
    margin = float(reach)
    offsets = np.zeros(nx * ny + 1, dtype=np.int64)
    nowhere = np.empty(0, dtype=np.int32)
    cells = (x0, y0, nx, ny, side)
    _visit_cells(segments, cells, margin, offsets[1:], nowhere, False)
    np.cumsum(offsets, out=offsets)
    indices = np.empty(int(offsets[-1]), dtype=np.int32)
    _visit_cells(segments, cells, margin, offsets[:-1].copy(), indices, True)
    return CellTable(x0, y0, nx, ny, side, offsets, indices)


class WallIndex:
    """An R-tree over wall segments that can be added and removed.

    Args:
        segments: (m, 4) x1, y1, x2, y2 in metres.

    Raises:
        FloorPlanError: segments that are not rows of four finite numbers.
    """

    def __init__(self, segments: ArrayLike) -> None:
        self._segments = as_segments(segments)
        self._removed: list[int] = []
        self._plant()

    def _plant(self) -> None:
        """Build the tree of the present segments."""
        present = np.flatnonzero(~np.isnan(self._segments[:, 0]))
        boxes = self._boxes(self._segments[present])
        entries = ((i, tuple(box), None) for i, box in zip(present.tolist(), boxes, strict=True))
        # An R-tree cannot be loaded in bulk from an empty stream.
        self._tree = Index(entries) if len(present) else Index()

    def __getstate__(self) -> tuple[NDArray[np.float64], list[int]]:
        return self._segments, self._removed

    def __setstate__(self, state: tuple[NDArray[np.float64], list[int]]) -> None:
        self._segments, self._removed = state
        self._plant()

    @property
    def segments(self) -> NDArray[np.float64]:
        """(m, 4) segments by index; removed ones are rows of NaN."""
        return self._segments

    def __len__(self) -> int:
        return len(self._segments) - len(self._removed)

    def near(self, xmin: float, ymin: float, xmax: float, ymax: float) -> NDArray[np.int64]:
        """Indices, ascending, of the segments whose bounding box meets the given box (metres)."""
        return np.array(sorted(self._tree.intersection((xmin, ymin, xmax, ymax))), dtype=np.int64)

    def add(self, segments: ArrayLike) -> NDArray[np.int64]:
        """Add (k, 4) segments and return their indices; those of removed ones are reused."""
        rows = as_segments(segments)
        reused = sorted(self._removed)[: len(rows)]
        self._removed = sorted(self._removed)[len(reused) :]
        fresh = len(rows) - len(reused)
        start = len(self._segments)
        ids = np.array([*reused, *range(start, start + fresh)], dtype=np.int64)
        self._segments = np.concatenate([self._segments, np.full((fresh, 4), np.nan)])
        self._segments[ids] = rows
        if len(rows) > len(self) // 2:  # a new tree takes less time
            self._plant()
        else:
            for i, box in zip(ids.tolist(), self._boxes(rows), strict=True):
                self._tree.insert(i, tuple(box))
        return ids

    def remove(self, indices: ArrayLike) -> None:
        """Remove the segments with these indices; FloorPlanError for an unknown one."""
        ids = np.unique(np.asarray(indices, dtype=np.int64))
        for i in ids.tolist():
            if not 0 <= i < len(self._segments) or np.isnan(self._segments[i, 0]):
                raise FloorPlanError(f"there is no wall segment {i} to remove")
        boxes = self._boxes(self._segments[ids])
        for i, box in zip(ids.tolist(), boxes, strict=True):
            self._tree.delete(i, tuple(box))
        # The array may be in use by a caller: change a copy.
        self._segments = self._segments.copy()
        self._segments[ids] = np.nan
        self._removed.extend(ids.tolist())

    def replace(self, segments: ArrayLike) -> None:
        """Hold exactly these (m, 4) segments; those held already keep their indices."""
        wanted = {tuple(row): None for row in as_segments(segments).tolist()}
        gone = []
        for i in np.flatnonzero(~np.isnan(self._segments[:, 0])).tolist():
            row = tuple(self._segments[i].tolist())
            if row in wanted:
                del wanted[row]
            else:
                gone.append(i)
        self.remove(gone)
        self.add(list(wanted))

    def cell_table(self, cell_size: float, reach: float) -> CellTable:
        """List, for every grid cell, the segments within `reach` of any of its points.

        Args:
            cell_size: side of a cell in metres, above 0. Where that would make more than
                `MOST_CELLS`, it is doubled until it does not: memory grows with walls, not area.
            reach: distance in metres, at least 0. The grid covers all segments and this margin.
        """
        return cell_table(self._segments, cell_size, reach)

    @staticmethod
    def _boxes(rows: NDArray[np.float64]) -> NDArray[np.float64]:
        low = np.minimum(rows[:, :2], rows[:, 2:])
        return np.concatenate([low, np.maximum(rows[:, :2], rows[:, 2:])], axis=1)
