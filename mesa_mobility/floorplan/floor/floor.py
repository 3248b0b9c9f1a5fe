"""A floor at one time: the layout, what stands on it, and what is closed."""

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray
from shapely import Polygon
from shapely.geometry.base import BaseGeometry

from mesa_mobility.floorplan.floor.free_area import FreeArea
from mesa_mobility.floorplan.floor.layout import Layout
from mesa_mobility.floorplan.floor.openings import Exit, Gate, Opening
from mesa_mobility.floorplan.floor.wall_index import WallIndex


class Floor(Layout):
    """A floor plan as it is now, to be asked; `FloorPlan` can change it, too.

    Attributes:
        version: grows by one with every change of obstacles, gates or exits.
    """

    version: int
    _area: FreeArea
    _walls: NDArray[np.float64]
    _wall_index: WallIndex

    @property
    def free(self) -> BaseGeometry:
        """Walkable area minus obstacles, its outline simplified: a Polygon, or a MultiPolygon, an
        exit at each piece."""
        return self._area.geometry

    @property
    def walls(self) -> NDArray[np.float64]:
        """(m, 4) x1, y1, x2, y2 in metres: edge of `free` without open exits, and closed gates."""
        return self._walls.copy()

    @property
    def wall_index(self) -> WallIndex:
        """An R-tree of the walls, in an order of its own, which follows every change."""
        return self._wall_index

    @property
    def obstacles(self) -> dict[int, Polygon]:
        """The obstacles by id."""
        return dict(self._area.obstacles)

    @property
    def area(self) -> float:
        """Free area in square metres."""
        return self._area.geometry.area

    @property
    def cut_off(self) -> bool:
        """Whether obstacles may cut pieces off from every exit."""
        return self._area.cut_off

    def is_open(self, name: str) -> bool:
        """Whether the gate or exit of this name is open."""
        return self.gate(name).name not in self._area.closed

    def contains(self, points: ArrayLike) -> NDArray[np.bool_]:
        """(n,) whether each of the (n, 2) points is in the free area, its edge included."""
        xy = np.asarray(points, dtype=np.float64).reshape(-1, 2)
        return shapely.intersects_xy(self._area.geometry, xy[:, 0], xy[:, 1])

    def open_exits(self) -> tuple[Exit, ...]:
        """The exits that are open now."""
        return self._area.open_ones(self.exits)

    def open_gates(self) -> tuple[Gate, ...]:
        """The gates that are open now."""
        return self._area.open_ones(self.gates)

    def closed_gates(self) -> tuple[Gate, ...]:
        """The gates that are closed now."""
        return self._area.closed_ones(self.gates)

    def closed_openings(self) -> tuple[Opening, ...]:
        """The gates and exits that are closed now."""
        return self._area.closed_ones(self.openings()) if self._area.closed else ()

    def _take(self, area: FreeArea) -> None:
        self._area, self._walls = area, area.walls()
        self._wall_index.replace(self._walls)
