"""The floor plan: a layout, the obstacles on it, and what is closed."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterable, Mapping
from copy import copy
from pathlib import Path
from typing import TYPE_CHECKING, Any

from shapely import Polygon

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan import occupants, reachability, sampling
from mesa_mobility.floorplan.floor.checks import one_line, read_polygon
from mesa_mobility.floorplan.floor.extent import warn_of_other_units
from mesa_mobility.floorplan.floor.floor import Floor
from mesa_mobility.floorplan.floor.free_area import FreeArea
from mesa_mobility.floorplan.floor.openings import Exit, Gate
from mesa_mobility.floorplan.floor.outline import SIMPLIFY
from mesa_mobility.floorplan.floor.room import Room
from mesa_mobility.floorplan.floor.seams import Seam
from mesa_mobility.floorplan.floor.shafts import Shaft
from mesa_mobility.floorplan.floor.wall_index import WallIndex
from mesa_mobility.floorplan.floor.zones import SpeedZone
from mesa_mobility.floorplan.formats import geojson
from mesa_mobility.floorplan.formats.assembling.drawn import completed
from mesa_mobility.floorplan.formats.content import Content
from mesa_mobility.floorplan.formats.plan_format import PLANS
from mesa_mobility.floorplan.formats.storeys import Storeys
from mesa_mobility.floorplan.rooms.finding import rooms_of
from mesa_mobility.floorplan.routing.router import Router
from mesa_mobility.plugins.formats import READ, WRITE
from mesa_mobility.schema import Flag, Kind, Object, Several, Text, Whole, check

if TYPE_CHECKING:
    import networkx as nx


class FloorPlan(Floor):
    """A walkable polygon with exits, gates and obstacles.

    Warns, with the extent, of coordinates that look like millimetres or degrees.

    Args:
        walkable: one connected polygon, holes allowed; shapely or WKT, metres.
        exits: lines on the edge of the walkable area (within 1 cm); at least one, unless there are
            gates between which people walk to and fro or round.
        gates: doors, and other lines to cross, inside the walkable area.
        obstacles: polygons (shapely or WKT) to subtract; their ids are 0, 1, 2, ...
        zones: parts of the floor where people walk more slowly.
        name: for titles and files.
        cut_off: whether obstacles may cut pieces off from every exit.
        simplify: metres by which walls may recede where that leaves out vertices, at most 0.1;
            0 keeps every vertex. The floor only grows, so no gap gets narrower; along exits and
            gates, and in `walkable` and `obstacles`, nothing changes.
        seams: where people change from one sheet of the plan to another. With them the walkable
            area may be several polygons, and pieces may be without an exit.
        shafts: lifts between sheets, with the same consequences.
        rooms: named areas of the floor, of level 0; by default they are found between the gates.

    Raises:
        FloorPlanError: geometry that is empty, not valid, not finite or in several pieces; a
            walkable area of more than 20 km or less than 0.2 m; an exit off the edge; a gate or a
            zone outside; a name used twice; a room without floor; free area without an exit that
            may not be cut off.

    Attributes:
        version: grows by one with every change of obstacles, gates or exits.

    Examples:
        >>> from mesa_mobility import Exit, FloorPlan
        >>> plan = FloorPlan(
        ...     "POLYGON ((0 0, 6 0, 6 4, 0 4, 0 0))",
        ...     exits=[Exit("door", (6, 1.5), (6, 2.5))],
        ...     obstacles=["POLYGON ((2 1, 3 1, 3 3, 2 3, 2 1))"],
        ... )
        >>> plan.area
        22.0
        >>> plan.contains([(1, 2), (2.5, 2)])
        array([ True, False])
        >>> plan.close_gate("door")
        >>> plan.is_open("door"), plan.version
        (False, 1)
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
        cut_off: bool = False,
        simplify: float = SIMPLIFY,
        seams: Iterable[Seam] = (),
        shafts: Iterable[Shaft] = (),
        rooms: Iterable[Room] = (),
    ) -> None:
        super().__init__(walkable, exits, gates, zones, name, simplify, seams, shafts, rooms)
        self.version = 0
        self._rooms: tuple[FreeArea, tuple[Room, ...]] | None = None
        polygons = {
            i: read_polygon(obstacle, f"obstacle {i}") for i, obstacle in enumerate(obstacles)
        }
        self._next_obstacle = len(polygons)
        self._wall_index = WallIndex(())
        self._router: Router | None = None
        self._take(FreeArea(self, polygons, cut_off))
        warn_of_other_units(self.walkable, self.openings())

    def __repr__(self) -> str:
        named = f" {self.name!r}" if self.name else ""
        exits, gates = len(self.exits), len(self.gates)
        return f"<FloorPlan{named}: {self.area:.0f} m2, exits: {exits}, gates: {gates}>"

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
    ) -> FloorPlan:
        """A floor plan whose walkable area is given as the WKT of a POLYGON, in metres."""
        return cls(wkt, exits=exits, gates=gates, obstacles=obstacles, zones=zones, name=name)

    @classmethod
    def from_geojson(cls, source: str | os.PathLike[str] | dict[str, Any]) -> FloorPlan:
        """Read a plan from a GeoJSON file, or from the FeatureCollection itself.

        See `to_geojson` for what it holds. Raises FloorPlanError naming the file
        and the feature.
        """
        where = geojson.label(source)
        return cls.of_content(geojson.read(source), where, None, None)

    @classmethod
    def from_dxf(
        cls,
        path: str | os.PathLike[str],
        *,
        layers: Mapping[str, str] | None = None,
        unit: str | None = None,
    ) -> FloorPlan:
        """Read a plan from a CAD drawing in DXF. Needs the extra `cad`.

        Outlines on layers of areas are closed polylines, circles, or lines and arcs that meet; one
        inside another is a hole. Gates and exits are single lines. Blocks are resolved.

        Args:
            path: the file.
            layers: layer -> "walkable", "obstacle", "gate" or "exit", which a name may follow:
                `{"A-FLOR": "walkable", "A-DOOR": "exit street"}`. By default layers whose names are
                such texts count. Several lines of one layer are numbered.
            unit: "mm", "cm", "dm", "m", "km", "in", "ft" or "yd", where the drawing does not say
                its own or says a wrong one.

        Raises:
            FloorPlanError: no DXF, no unit, no such layer, an open outline, or no floor plan.
            MobilityError: ezdxf is not installed.
        """
        from mesa_mobility.floorplan.formats import dxf

        return cls._of(completed(dxf.read(path, layers, unit), None), str(path))

    @classmethod
    def from_file(
        cls,
        path: str | os.PathLike[str],
        *,
        exits: str | None = None,
        level: str | None = None,
        **options: Any,
    ) -> FloorPlan:
        """Read a plan from a file, in the format that the end of its name says.

        `mesa-mobility formats` lists the formats; other packages may add some. Warns of what the
        reader has changed or left out.

        Args:
            path: the file.
            exits: of a file that has none: "longest", a door of 1.2 m in the middle of the longest
                straight outer edge; lines "x1 y1, x2 y2" with semicolons between them, within 1.2 m
                of the edge; or a file of such lines.
            level: number or name of the level, of a file that has several; by default 0, or the
                lowest.
            options: those of the format, such as ``unit="mm"`` of a DXF.

        Raises:
            FloorPlanError: no format reads such a file, it cannot be read, or is no floor plan; or
                the format does not take an option.
            MobilityError: a DXF, and ezdxf is not installed.
        """
        chosen: Any = PLANS.of(path, READ)
        options = PLANS.chosen_options(chosen, READ, options)
        # Outlines of other programs may be such that the geometry library gives up.
        with one_line(str(path)):
            return cls.of_content(chosen.read(Path(path), **options), str(path), exits, level)

    @classmethod
    def of_content(
        cls, found: Content | Storeys, where: str, exits: str | None, level: str | None
    ) -> FloorPlan:
        """The plan of what a format has read; see `from_file`. `where` names the file in errors."""
        if isinstance(found, Storeys):
            found = found.content(level, where)
        elif level is not None:
            raise FloorPlanError(f"{where}: has no levels, expected no level")
        return cls._of(completed(found, exits), where)

    def to_file(self, path: str | os.PathLike[str], **options: Any) -> None:
        """Write the plan to a file, in the format that the end of its name says.

        Args:
            path: the file.
            options: those of the format.

        Raises:
            FloorPlanError: no format writes such a file, it cannot be written, or the format does
                not take an option.
        """
        chosen: Any = PLANS.of(path, WRITE)
        options = PLANS.chosen_options(chosen, WRITE, options)
        chosen.write(self, Path(path), **options)

    @classmethod
    def _of(cls, content: Content, where: str) -> FloorPlan:
        """The plan of a file's content; `where` names the file in errors."""
        for note in content.notes:
            warnings.warn(f"{where}: {note}", stacklevel=3)
        if content.people:
            warnings.warn(
                f"{where}: left out people of {len({each.name for each in content.people})} "
                "sources: this is the floor "
                f"plan alone; `mesa-mobility run {where}` has them walk",
                stacklevel=3,
            )
        if not content.exits and not content.gates:
            raise FloorPlanError(
                f"{where}: the floor plan has no exit, and no gate that people could go to: "
                "--exits longest makes one, --exit 'x1 y1, x2 y2' another"
            )
        try:
            plan = cls(
                content.walkable,
                exits=content.exits,
                gates=content.gates,
                obstacles=content.obstacles,
                zones=content.zones,
                name=content.name,
                cut_off=content.cut_off,
                simplify=content.simplify,
                rooms=content.rooms,
            )
        except FloorPlanError as error:
            raise FloorPlanError(f"{where}: {error}") from None
        for closed in content.closed:
            plan.close_gate(closed)
        plan.version = 0
        return plan

    # Functions of a plan are methods as they are.
    to_geojson = geojson.feature_collection
    write_geojson = geojson.write

    @property
    def rooms(self) -> tuple[Room, ...]:
        """The rooms, each with its name, use, area and doors.

        They are those with which the plan was made, or else are found between its gates, open or
        closed, and named ``room 1``, ``room 2`` and so on, the largest first. Rooms that are found
        follow obstacles that separate them.

        Raises:
            FloorPlanError: the plan has several sheets; rooms are those of its building.
        """
        if self.in_sheets:
            raise FloorPlanError(
                "a plan of several sheets has no rooms of its own, expected those of its building"
            )
        if self._rooms is None or self._rooms[0] is not self._area:
            self._rooms = self._area, rooms_of(self)
        return self._rooms[1]

    @property
    def route_graph(self) -> nx.DiGraph:
        """The routes of adults as a graph, up to date with obstacles and doors.

        Nodes are corners and places in gates and exits, with ``kind``, ``position`` (x, y in
        metres), ``opening`` (name) and ``direction``; edges have their length in metres as
        ``weight``.
        """
        if self._router is None:
            self._router = Router(self)
        return self._router.graph

    def close_gate(self, name: str) -> None:
        """Make the gate or exit of this name a wall."""
        if self.is_open(name):
            self._change(self._area.with_closed(self._area.closed | {name}))

    def open_gate(self, name: str) -> None:
        """Open the gate or exit of this name again."""
        if not self.is_open(name):
            self._change(self._area.with_closed(self._area.closed - {name}))

    def add_obstacle(self, polygon: Polygon | str, *, cut_off: bool = False) -> int:
        """Put an obstacle (shapely or WKT, metres) in the way and return its id.

        Raises FloorPlanError, and leaves the plan unchanged, if the polygon is not valid, would
        touch somebody in any model of the plan (`occupants` says why), or would cut a piece of the
        free area off from every exit. With `cut_off` pieces may be cut off, now and later: people
        there have no way to go, and stay.
        """
        number = self._next_obstacle
        name = f"obstacle {number}"
        obstacle = read_polygon(polygon, name)
        area = self._area.with_obstacles({**self._area.obstacles, number: obstacle}, cut_off)
        occupants.check_vacant(self, obstacle, name, area.geometry)
        self._next_obstacle += 1
        self._change(area)
        return number

    def remove_obstacle(self, obstacle: int) -> None:
        """Remove the obstacle with this id; FloorPlanError if there is none."""
        obstacles = self.obstacles
        if obstacle not in obstacles:
            raise FloorPlanError(f"there is no obstacle {obstacle}; there are {list(obstacles)}")
        del obstacles[obstacle]
        self._change(self._area.with_obstacles(obstacles))

    def altered(
        self, *, obstacles: Iterable[Polygon] = (), closed: Iterable[str] | None = None
    ) -> FloorPlan:
        """A plan of its own, without people, that differs from this one as it is now.

        Args:
            obstacles: further ones, which may cut pieces off from every exit.
            closed: names of the gates and exits that are closed; by default the same.

        Raises:
            FloorPlanError: the obstacles leave no walkable area.
        """
        more = dict(enumerate(obstacles, self._next_obstacle))
        area = self._area
        if more:
            area = area.with_obstacles({**area.obstacles, **more}, cut_off=True)
        if closed is not None:
            area = area.with_closed(self.gate(name).name for name in closed)
        plan = copy(self)
        plan.version, plan._router, plan._wall_index = 0, None, WallIndex(())
        plan._next_obstacle += len(more)
        plan._take(area)
        return plan

    check_reachable = reachability.check_reachable
    random_points = sampling.random_points

    @staticmethod
    def members() -> dict[str, Kind]:
        """Names of the members of ``state``."""
        return {
            "obstacles": Several(Whole(), dict, values=Object(Polygon)),
            "next_obstacle": Whole(),
            "closed": Several(Text("openings")),
            "cut_off": Flag(),
        }

    def state(self) -> dict[str, Any]:
        """All that changes while models run: obstacles, the next one's id, and what is closed."""
        return {
            "obstacles": self.obstacles,
            "next_obstacle": self._next_obstacle,
            "closed": sorted(self._area.closed),
            "cut_off": self.cut_off,
        }

    def restore(self, state: Mapping[str, Any]) -> None:
        """Take over what ``state`` of a plan with the same floor, exits and gates has given.

        People who stand on an obstacle are not looked for.
        """
        if state == self.state():
            return
        least = max(state["obstacles"], default=-1) + 1
        check(state["next_obstacle"], Whole(least), "next_obstacle")
        obstacles = {
            number: read_polygon(each, f"obstacle {number}")
            for number, each in state["obstacles"].items()
        }
        area = self._area.with_obstacles(obstacles, state["cut_off"])
        area = area.with_closed(state["closed"])
        self._next_obstacle = state["next_obstacle"]
        self._change(area)

    def _change(self, area: FreeArea) -> None:
        self._take(area)
        self.version += 1
