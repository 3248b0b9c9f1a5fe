"""The part of a floor plan that is free at one time, and its walls."""

from collections.abc import Iterable, Mapping
from copy import copy
from typing import TypeVar

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import Polygon
from shapely.geometry.base import BaseGeometry

from mesa_mobility.floorplan.floor import boundaries, checks
from mesa_mobility.floorplan.floor.layout import Layout
from mesa_mobility.floorplan.floor.openings import Exit, Gate
from mesa_mobility.floorplan.floor.outline import outline_of

Opening = TypeVar("Opening", bound=Gate | Exit)


class FreeArea:
    """The walkable area minus obstacles, with some openings closed. A change gives another one.

    Args:
        layout: the walkable area, and all exits and gates, open at first.
        obstacles: by id.
        cut_off: whether obstacles may cut pieces off from every exit.

    Raises:
        FloorPlanError: a piece of the area has no exit, and may not be cut off.

    Attributes:
        geometry: a Polygon, or a MultiPolygon with an exit at each piece that is not cut off; its
            outline simplified.
        obstacles: by id.
        cut_off: whether they may cut pieces off.
        closed: names of the closed gates and exits.
    """

    def __init__(
        self,
        layout: Layout,
        obstacles: Mapping[int, Polygon],
        cut_off: bool = False,
    ) -> None:
        self._walkable, self._exits, self._gates = layout.walkable, layout.exits, layout.gates
        self._simplify, self._in_sheets = layout.simplify, layout.in_sheets
        self.cut_off = cut_off
        self.closed: frozenset[str] = frozenset()
        self._subtract(obstacles)

    def with_obstacles(self, obstacles: Mapping[int, Polygon], cut_off: bool = False) -> "FreeArea":
        """The area with these obstacles instead; FloorPlanError for a piece without an exit.

        `cut_off` allows such pieces from now on.
        """
        changed = copy(self)
        changed.cut_off |= cut_off
        changed._subtract(obstacles)
        return changed

    def with_closed(self, names: Iterable[str]) -> "FreeArea":
        """The area with these gates and exits closed, and all others open."""
        changed = copy(self)
        changed.closed = frozenset(names)
        return changed

    def open_ones(self, openings: Iterable[Opening]) -> tuple[Opening, ...]:
        """The gates and exits among ``openings`` that are open."""
        return tuple(each for each in openings if each.name not in self.closed)

    def closed_ones(self, openings: Iterable[Opening]) -> tuple[Opening, ...]:
        """The gates and exits among ``openings`` that are closed."""
        return tuple(each for each in openings if each.name in self.closed)

    def walls(self) -> NDArray[np.float64]:
        """(m, 4) x1, y1, x2, y2 in metres: the edge without open exits, and closed gates."""
        edge = boundaries.boundary_segments(self.geometry)
        walls = boundaries.cut_out(edge, self.open_ones(self._exits))
        gates = boundaries.opening_segments(self.closed_ones(self._gates))
        return np.concatenate([walls, gates])

    def _subtract(self, obstacles: Mapping[int, Polygon]) -> None:
        self.obstacles = dict(obstacles)
        with checks.one_line("walkable area and obstacles"):
            pieces = checks.free_area(
                self._walkable,
                list(self.obstacles.values()),
                self._exits,
                self._gates,
                self.cut_off or self._in_sheets,
            )
            self.geometry: BaseGeometry = outline_of(
                pieces, self._simplify, [*self._exits, *self._gates]
            )
        shapely.prepare(self.geometry)
