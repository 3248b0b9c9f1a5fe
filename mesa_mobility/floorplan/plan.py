"""The floor plan: where people can walk, what is in the way and where they leave."""

import os
from collections.abc import Iterable
from typing import Any

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray
from shapely import Polygon
from shapely.geometry.base import BaseGeometry

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan import checks, edges, geojson, placement, reach
from mesa_mobility.floorplan.openings import Exit, Gate
from mesa_mobility.floorplan.walls import WallIndex
from mesa_mobility.floorplan.zones import SpeedZone, check_zones, speed_factors


class FloorPlan:
    """A walkable polygon with exits, gates and obstacles.

    Parameters
    ----------
    walkable
        One connected polygon, holes allowed; shapely or WKT, metres.
    exits
        Lines on the edge of the walkable area (within 1 cm); at least one, unless there are
        gates for people to walk to and fro or round between.
    gates
        Doors, and other lines to cross, inside the walkable area.
    obstacles
        Polygons (shapely or WKT) to subtract; their ids are 0, 1, 2, ...
    zones
        Parts of the floor where people walk more slowly.
    name
        For titles and files.

    Raises
    ------
    FloorPlanError
        Geometry that is empty, not valid, not finite or in several pieces; an exit
        off the edge; a gate or a zone outside; a name used twice; free area without an exit.

    Attributes
    ----------
    version
        Grows by one with every change of obstacles, gates or exits.
    """

    def __init__(
        self,
        walkable: Polygon | str,
        *,
        exits: Iterable[Exit] = (),
        gates: Iterable[Gate] = (),
        obstacles: Iterable[Polygon | str] = (),
        zones: Iterable[SpeedZone] = (),
        name: str = "",
    ) -> None:
        self.name = name
        self.version = 0
        self._walkable = checks.read_polygon(walkable, "walkable area")
        self._exits = tuple(exits)
        self._gates = tuple(gates)
        self._closed: set[str] = set()
        self._obstacles: dict[int, Polygon] = {
            i: checks.read_polygon(obstacle, f"obstacle {i}")
            for i, obstacle in enumerate(obstacles)
        }
        self._next_obstacle = len(self._obstacles)
        checks.check_exits(self._walkable, self._exits, self._gates)
        checks.check_gates(self._walkable, self._gates)
        self._zones = tuple(zones)
        check_zones(self._walkable, self._zones)
        checks.check_names([*self._exits, *self._gates])
        self._wall_index = WallIndex(())
        self._set_free(self._obstacles)
        self._set_walls()

    @classmethod
    def from_wkt(
        cls,
        wkt: str,
        *,
        exits: Iterable[Exit] = (),
        gates: Iterable[Gate] = (),
        obstacles: Iterable[Polygon | str] = (),
        zones: Iterable[SpeedZone] = (),
        name: str = "",
    ) -> "FloorPlan":
        """A floor plan whose walkable area is given as the WKT of a POLYGON, in metres."""
        return cls(wkt, exits=exits, gates=gates, obstacles=obstacles, zones=zones, name=name)

    @classmethod
    def from_geojson(cls, source: "str | os.PathLike[str] | dict[str, Any]") -> "FloorPlan":
        """Read a plan from a GeoJSON file, or from the FeatureCollection itself.

        See `to_geojson` for what it holds. Raises FloorPlanError naming the file
        and the feature.
        """
        content = geojson.read(source)
        try:
            plan = cls(
                content.walkable,
                exits=content.exits,
                gates=content.gates,
                obstacles=content.obstacles,
                zones=content.zones,
                name=content.name,
            )
        except FloorPlanError as error:
            raise FloorPlanError(f"{geojson.label(source)}: {error}") from None
        for closed in content.closed:
            plan.close_gate(closed)
        plan.version = 0
        return plan

    def to_geojson(self) -> dict[str, Any]:
        """The plan as a GeoJSON FeatureCollection, coordinates in metres.

        Every feature has the properties `kind` (walkable, obstacle, gate, exit or zone)
        and `name`; a closed gate or exit has `closed` true, a zone its `factor`.
        Reading it back gives the same coordinates to the last bit; obstacle ids count from 0 again.
        """
        return geojson.feature_collection(self)

    def write_geojson(self, path: "str | os.PathLike[str]") -> None:
        """Write `to_geojson` to a file, complete or not at all."""
        geojson.write(self.to_geojson(), path)

    @property
    def walkable(self) -> Polygon:
        """The walkable polygon as given, obstacles not subtracted."""
        return self._walkable

    @property
    def free(self) -> BaseGeometry:
        """Walkable area minus obstacles: a Polygon, or a MultiPolygon, an exit at each piece."""
        return self._free

    @property
    def walls(self) -> NDArray[np.float64]:
        """(m, 4) x1, y1, x2, y2 in metres: the edge of `free` less open exits, and closed gates."""
        return self._walls.copy()

    @property
    def wall_index(self) -> WallIndex:
        """An R-tree of the walls, which follows every change; it has its own order of them."""
        return self._wall_index

    @property
    def exits(self) -> tuple[Exit, ...]:
        """All exits, open or closed."""
        return self._exits

    @property
    def gates(self) -> tuple[Gate, ...]:
        """All gates, open or closed."""
        return self._gates

    @property
    def obstacles(self) -> dict[int, Polygon]:
        """The obstacles by id."""
        return dict(self._obstacles)

    @property
    def zones(self) -> tuple[SpeedZone, ...]:
        """The zones of reduced speed."""
        return self._zones

    def speed_factors(self, points: ArrayLike) -> NDArray[np.float64]:
        """(n,) share of their preferred speed at which people walk at (n, 2) points, metres."""
        return speed_factors(self._zones, np.asarray(points, dtype=np.float64).reshape(-1, 2))

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """(xmin, ymin, xmax, ymax) of the walkable area in metres."""
        return self._walkable.bounds

    @property
    def area(self) -> float:
        """Free area in square metres."""
        return self._free.area

    def openings(self) -> tuple[Gate | Exit, ...]:
        """Gates, then exits: the order in which `Targets.gates` counts them."""
        return (*self._gates, *self._exits)

    def gate(self, name: str) -> Gate | Exit:
        """The gate or exit of this name; FloorPlanError lists the names there are."""
        for opening in self.openings():
            if opening.name == name:
                return opening
        names = ", ".join(repr(opening.name) for opening in self.openings())
        raise FloorPlanError(f"there is no gate or exit {name!r}; there are {names}")

    def is_open(self, name: str) -> bool:
        """Whether the gate or exit of this name is open."""
        return self.gate(name).name not in self._closed

    def close_gate(self, name: str) -> None:
        """Make the gate or exit of this name a wall."""
        if self.is_open(name):
            self._closed.add(name)
            self._changed()

    def open_gate(self, name: str) -> None:
        """Open the gate or exit of this name again."""
        if not self.is_open(name):
            self._closed.discard(name)
            self._changed()

    def add_obstacle(self, polygon: Polygon | str) -> int:
        """Put an obstacle (shapely or WKT, metres) in the way and return its id.

        Raises FloorPlanError, the plan unchanged, where the polygon is not valid or
        would cut a piece of the free area off from every exit.
        """
        number = self._next_obstacle
        self._set_free(
            {**self._obstacles, number: checks.read_polygon(polygon, f"obstacle {number}")}
        )
        self._next_obstacle += 1
        self._changed()
        return number

    def remove_obstacle(self, obstacle: int) -> None:
        """Take away the obstacle with this id; FloorPlanError where there is none."""
        if obstacle not in self._obstacles:
            raise FloorPlanError(
                f"there is no obstacle {obstacle}; there are {list(self._obstacles)}"
            )
        self._set_free({i: p for i, p in self._obstacles.items() if i != obstacle})
        self._changed()

    def contains(self, points: ArrayLike) -> NDArray[np.bool_]:
        """(n,) whether each of the (n, 2) points is in the free area, its edge included."""
        xy = np.asarray(points, dtype=np.float64).reshape(-1, 2)
        return shapely.intersects_xy(self._free, xy[:, 0], xy[:, 1])

    def open_exits(self) -> tuple[Exit, ...]:
        """The exits that are open now."""
        return tuple(e for e in self._exits if e.name not in self._closed)

    def open_gates(self) -> tuple[Gate, ...]:
        """The gates that are open now."""
        return tuple(g for g in self._gates if g.name not in self._closed)

    def closed_gates(self) -> tuple[Gate, ...]:
        """The gates that are closed now."""
        return tuple(g for g in self._gates if g.name in self._closed)

    def check_reachable(self, points: ArrayLike, clearance: float) -> None:
        """Raise FloorPlanError where a body of radius `clearance` metres cannot reach an open exit.

        `points` is (n, 2) in metres.
        """
        reach.check_reachable(self, points, clearance)

    def random_points(
        self,
        n: int,
        rng: np.random.Generator,
        *,
        within: Polygon | None = None,
        spacing: float,
        clearance: float,
        avoid: ArrayLike = (),
    ) -> NDArray[np.float64]:
        """(n, 2) random points in metres with room for people to stand.

        Every point is at least `clearance` from walls and exits and at least `spacing` from
        the other points and from the (k, 2) points of `avoid`. The points are the
        same for the same state of `rng`. Points thrown one by one (random sequential
        placement) are tried first, a shaken hexagonal lattice where that fills up.

        Raises
        ------
        FloorPlanError
            There is room for fewer than n, saying for how many.
        """
        return placement.random_points(
            self, n, rng, within=within, spacing=spacing, clearance=clearance, avoid=avoid
        )

    def _set_free(self, obstacles: dict[int, Polygon]) -> None:
        self._free = checks.free_area(
            self._walkable, list(obstacles.values()), self._exits, self._gates
        )
        self._obstacles = obstacles
        shapely.prepare(self._free)

    def _set_walls(self) -> None:
        edge = edges.cut_out(edges.boundary_segments(self._free), self.open_exits())
        self._walls = np.concatenate([edge, edges.opening_segments(self.closed_gates())])
        self._wall_index.replace(self._walls)

    def _changed(self) -> None:
        self._set_walls()
        self.version += 1
