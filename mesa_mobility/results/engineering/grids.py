"""Square cells of a floor, and densities in them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from mesa_mobility.errors import ResultsError
from mesa_mobility.results.measures.density import voronoi_cells

FloatArray = NDArray[np.float64]

MOST_CELLS = 1_000_000

_NO_FLOOR = 1e-9
"""Share of a cell below which it has no floor."""


@dataclass(frozen=True, eq=False)
class Grid:
    """Square cells that cover a floor, from its least x and y on.

    Args:
        floor: the free floor.
        cell: side of a cell, metres.

    Raises:
        ResultsError: a side that is not positive, or more than a million cells.
    """

    floor: BaseGeometry
    cell: float

    def __post_init__(self) -> None:
        x0, y0, x1, y1 = self.floor.bounds
        if not 0.0 < self.cell < np.inf:
            raise ResultsError(f"map: cells of {self.cell} m, expected more than 0")
        if (x1 - x0 + self.cell) * (y1 - y0 + self.cell) > MOST_CELLS * self.cell**2:
            raise ResultsError(
                f"map: cells of {self.cell:g} m on a floor of {x1 - x0:.0f} m by {y1 - y0:.0f} m, "
                f"expected at most {MOST_CELLS:,} cells"
            )

    @cached_property
    def x(self) -> FloatArray:
        """(columns + 1,) edges, metres."""
        return _edges(self.floor.bounds[0], self.floor.bounds[2], self.cell)

    @cached_property
    def y(self) -> FloatArray:
        """(rows + 1,) edges, metres."""
        return _edges(self.floor.bounds[1], self.floor.bounds[3], self.cell)

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return len(self.y) - 1, len(self.x) - 1

    @cached_property
    def share(self) -> FloatArray:
        """(rows, columns) share of each cell that is floor."""
        shapely.prepare(self.floor)
        areas = np.full(len(self._squares), self.cell**2)
        cut = ~shapely.contains_properly(self.floor, self._squares)
        areas[cut] = shapely.area(shapely.intersection(self._squares[cut], self.floor))
        share: FloatArray = (areas / self.cell**2).reshape(self.shape)
        return share

    def cells_at(self, x: FloatArray, y: FloatArray) -> NDArray[np.int64]:
        """(n,) which cell each place is in, counted row by row; -1 off the grid."""
        column = np.floor((x - self.x[0]) / self.cell).astype(np.int64)
        row = np.floor((y - self.y[0]) / self.cell).astype(np.int64)
        rows, columns = self.shape
        on = (column >= 0) & (column < columns) & (row >= 0) & (row < rows)
        return np.where(on, row * columns + column, -1)

    def densities(self, points: FloatArray, weights: FloatArray) -> FloatArray:
        """Voronoi densities in each cell, persons/m2.

        The mean over the floor in the cell of 1 / A_i, with the areas A_i of the parts of the floor
        that are nearest to each person (see `voronoi_density`).

        Args:
            points: (n, 2) places of people, metres; those off the floor are left out.
            weights: (groups, n) 1 for people who count in a group, 0 for others.

        Returns:
            (groups, rows, columns), nan where a cell has no floor.
        """
        on = shapely.intersects_xy(self.floor, points[:, 0], points[:, 1])
        # Those on one spot, as measured people may be, share a cell.
        places, owner = np.unique(points[on], axis=0, return_inverse=True)
        result = np.zeros((len(weights), self.share.size))
        if len(places):
            shapes = voronoi_cells(places, self.floor)
            number, cell, parts = self._parts(shapes)
            for group, weight in zip(result, weights[:, on], strict=True):
                people = np.bincount(owner.ravel(), weights=weight, minlength=len(places))
                shares = parts * (people / shapely.area(shapes))[number]
                group += np.bincount(cell, weights=shares, minlength=len(group))
        floor = np.where(self.share > _NO_FLOOR, self.share, np.nan) * self.cell**2
        found: FloatArray = result.reshape(len(weights), *self.shape) / floor
        return found

    def _parts(
        self, shapes: NDArray[np.object_]
    ) -> tuple[NDArray[np.int64], NDArray[np.int64], FloatArray]:
        """Which shape overlaps which cell, (k,) each, and the (k,) common areas, m2."""
        shapely.prepare(shapes)
        number, found = self._tree.query(shapes, predicate="intersects")
        cell = self._with_floor[found]
        # Most cells are whole in a shape: to cut all of them takes five times as long.
        parts = np.full(len(cell), self.cell**2)
        cut = ~shapely.contains_properly(shapes[number], self._squares[cell])
        shape, square = shapes[number[cut]], self._squares[cell[cut]]
        parts[cut] = shapely.area(shapely.intersection(shape, square))
        return number, cell, parts

    @cached_property
    def _squares(self) -> NDArray[np.object_]:
        y, x = np.meshgrid(self.y[:-1], self.x[:-1], indexing="ij")
        squares: NDArray[np.object_] = shapely.box(
            x.ravel(), y.ravel(), x.ravel() + self.cell, y.ravel() + self.cell
        )
        return squares

    @cached_property
    def _with_floor(self) -> NDArray[np.int64]:
        return np.flatnonzero(self.share.ravel() > _NO_FLOOR)

    @cached_property
    def _tree(self) -> shapely.STRtree:
        return shapely.STRtree(self._squares[self._with_floor])


def _edges(low: float, high: float, cell: float) -> FloatArray:
    # 3.6 / 0.4 is a little more than 9 to a computer.
    edges: FloatArray = low + cell * np.arange(np.ceil((high - low) / cell - 1e-9) + 1)
    return edges
