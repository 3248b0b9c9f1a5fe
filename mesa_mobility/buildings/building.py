"""A building: levels joined by stairs, ramps, escalators and lifts, laid out in one plane."""

import os
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any, cast

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray
from shapely import Polygon

from mesa_mobility.buildings import geojson
from mesa_mobility.buildings.checks import check_joined, check_names
from mesa_mobility.buildings.connections.escalator import Escalator
from mesa_mobility.buildings.connections.flights import Flight, Landing
from mesa_mobility.buildings.connections.lift import Lift
from mesa_mobility.buildings.connections.ramp import Ramp
from mesa_mobility.buildings.connections.stairs import Stairs
from mesa_mobility.buildings.footing import Footing
from mesa_mobility.buildings.headroom import check_headroom, check_shafts
from mesa_mobility.buildings.level import Level, sheet_of
from mesa_mobility.buildings.places import Places
from mesa_mobility.buildings.plans import plan_of_level, plan_of_sheets
from mesa_mobility.buildings.refuge import Refuge
from mesa_mobility.buildings.sheets import Sheet, sheets_of
from mesa_mobility.buildings.ways import gates_of_way_out
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan import Exit, FloorPlan, Gate, Room
from mesa_mobility.floorplan.floor.checks import read_polygon
from mesa_mobility.floorplan.formats.geojson import label
from mesa_mobility.plugins.registry import did_you_mean


class Building:
    """Levels that stairs, ramps, escalators and lifts join.

    People are simulated in a plane, in which the levels and landings lie side by side as sheets.
    Each flight of stairs is drawn on both sheets that it joins, up to 0.3 m beyond its end. At its
    middle people change from one drawing to the other. So routes, collision tests and behaviours
    need not know of levels. `true_places` and `plane_places` lead from the plane to true
    coordinates and back.

    On a flight, people walk as in a speed zone: at a share of the speed of a level floor, after the
    SFPE Handbook, and more slowly up than down (`Flight.factor`, `Flight.uphill`). On stairs
    they keep a tread and a half more than elsewhere to those ahead, and take recorded steps as long
    as the treads, if their type has maps for stairs (`PedestrianType.up`, `PedestrianType.down`).
    Escalators carry them. People who use no stairs use ramps and lifts.

    On a flight shorter than 2.7 m in plan, twice the longest step, people see less far and walk
    more slowly. The flights of many dog-legs are shorter. The place of a flight is taken from the
    floor of both levels that it joins, with 0.35 m beyond its far end and 5 cm on either side. A
    level has no floor in the shaft of a lift that passes it.

    Args:
        levels: at least one.
        stairs: the stairs, ramps and escalators that join them.
        lifts: the lifts.
        name: for titles and files.

    Raises:
        FloorPlanError: levels, stairs, ramps, escalators or lifts of one number or name; a gate or
            an exit with the name of one of them; stairs, ramps or escalators that lead nowhere, do
            not fit their rise, have no floor before them, or overlap an obstacle, an opening, a
            refuge, each other or a lift; refuges that overlap each other or a lift; levels from
            which nothing leads to an exit; floors less than 1.5 m above each other; stairs in the
            shaft of a lift; or what `FloorPlan` refuses.

    Attributes:
        levels: the levels, in the order given.
        stairs: the stairs, ramps and escalators, in the order given.
        lifts: the lifts, in the order given.
        flights: the flights of all stairs, the ramps and the escalators.
        landings: the landings of all stairs.
        floor_plan: all sheets in one plane, which models use.
        footing: what carries bodies and feet on the stairs, for pictures.

    Examples:
        >>> from mesa_mobility import Building, Exit, Level, Stairs
        >>> hall = "POLYGON ((0 0, 20 0, 20 6, 0 6, 0 0))"
        >>> ground = Level(0, hall, exits=[Exit("street", (0, 2), (0, 4))])
        >>> first = Level(1, hall, elevation=3.06)
        >>> main = Stairs.straight(
        ...     "main", first, ground, head=((12, 5), (12, 3)), risers=18, tread=0.29
        ... )
        >>> office = Building([ground, first], [main])
        >>> places, levels = office.true_places(office.places([(1.0, 1.0)], level=1))
        >>> places.tolist(), levels.tolist()
        ([[1.0, 1.0, 3.06]], [1])
    """

    def __init__(
        self,
        levels: Sequence[Level],
        stairs: Sequence[Stairs | Ramp | Escalator] = (),
        *,
        lifts: Sequence[Lift] = (),
        name: str = "",
    ) -> None:
        self.levels, self.stairs, self.lifts = tuple(levels), tuple(stairs), tuple(lifts)
        self.name = name
        check_names(self.levels, self.stairs, self.lifts)
        flights: list[Flight] = []
        landings: list[Landing] = []
        self._owners: dict[str, int] = {}
        for number, each in enumerate(self.stairs):
            try:
                upper, lower = self.level(each.upper), self.level(each.lower)
            except FloorPlanError as error:
                raise FloorPlanError(f"{each.kind} {each.name!r}: {error}") from None
            more, between = each.parts(upper.elevation, lower.elevation)
            flights += more
            landings += between
            names = [flight.name for flight in more] + [landing.name for landing in between]
            self._owners |= dict.fromkeys(names, number)
        self.flights, self.landings = tuple(flights), tuple(landings)
        for lift in self.lifts:
            for number in lift.numbers:
                try:
                    self.level(number)
                except FloorPlanError as error:
                    raise FloorPlanError(f"lift {lift.name!r}: {error}") from None
        self._sheets = sheets_of(self.levels, flights, landings, self.lifts)
        check_joined(self.levels, self.stairs, self.lifts)
        check_headroom(self._sheets, flights)
        check_shafts(self._sheets, flights, self.lifts)
        self._places = Places(self._sheets, flights, self._owners, self.lifts)
        self.footing = Footing(flights)
        self.floor_plan = plan_of_sheets(self.levels, self.flights, self.lifts, self._sheets, name)

    def __repr__(self) -> str:
        named = f" {self.name!r}" if self.name else ""
        return f"<Building{named}: levels: {len(self.levels)}, stairs: {len(self.stairs)}>"

    @classmethod
    def from_geojson(cls, source: "str | os.PathLike[str] | dict[str, Any]") -> "Building":
        """Read a building from a GeoJSON file, or from the FeatureCollection itself.

        A floor plan is a building of one level. See `to_geojson` for what it holds. Raises
        FloorPlanError naming the file and the feature.
        """
        where, parts = label(source), geojson.read(source)
        try:
            building = cls(parts.levels, parts.stairs, lifts=parts.lifts, name=parts.name)
        except FloorPlanError as error:
            raise FloorPlanError(f"{where}: {error}") from None
        for closed in parts.closed:
            try:
                building.floor_plan.close_gate(closed)
            except FloorPlanError as error:
                raise FloorPlanError(f"{where}: {error}") from None
        building.floor_plan.version = 0
        return building

    def to_geojson(self) -> dict[str, Any]:
        """The building as a GeoJSON FeatureCollection, in its own coordinates, metres.

        Features are those of a floor plan, each with the number of its `level`; walkable areas have
        an `elevation`. A feature of the kind `stairs` is their upper edge, the end on the left of a
        person who walks down first. It has `from` and `to`, the numbers of the upper and the lower
        level, `risers`, `tread` and `type`: straight, dog_leg or flights. A dog-leg also has `turn`
        and `well`, stairs of several flights have `flights` and `turns`, and both have `landing` if
        it was given. Stairs without handrails on both sides have `handrails`. A feature of the kind
        `ramp` is its upper edge, with `from`, `to`, `length` and `factor`. One of the kind
        `escalator` has no `factor`, but the other arguments of `Escalator`. A feature of the kind
        `lift` is the door, with the numbers of its `levels` and the other arguments of `Lift`. One
        of the kind `refuge` is an area. Stairs, ramps, escalators and lifts have a list `closed` of
        the names of their gates that are closed. A building of level 0 alone, at elevation 0 and
        without refuges, is written as its floor plan.
        """
        first, plan = self.levels[0], self.floor_plan
        plain = first.number == 0 and first.elevation == 0.0 and not first.refuges
        if len(self.levels) == 1 and plain:
            return plan.to_geojson()
        closed = [each.name for each in plan.openings() if not plan.is_open(each.name)]
        gates = {name: [gate.name for gate in own] for name, own in self.gates.items()}
        return geojson.feature_collection(
            geojson.Parts(self.levels, self.stairs, self.lifts, self.name, closed, gates)
        )

    def write_geojson(self, path: "str | os.PathLike[str]") -> None:
        """Write `to_geojson` to a file, complete or not at all."""
        geojson.write(self.to_geojson(), path)

    def level(self, number: int) -> Level:
        """The level of this number; a FloorPlanError lists the known numbers."""
        for level in self.levels:
            if level.number == number:
                return level
        known = ", ".join(str(each.number) for each in self.levels)
        raise FloorPlanError(f"there is no level {number!r:.60}; there are {known}")

    def exits(self, level: int) -> tuple[str, ...]:
        """Names of the exits on a level."""
        return tuple(each.name for each in self.level(level).exits)

    @cached_property
    def gates(self) -> dict[str, tuple[Gate, ...]]:
        """The gates in the plane of each stair, ramp, escalator and lift, by its name."""
        found: dict[str, tuple[Gate, ...]] = {}
        for flight, seam in zip(self.flights, self.floor_plan.seams, strict=True):
            name = self.stairs[self._owners[flight.name]].name
            found[name] = (*found.get(name, ()), *seam.gates)
        return found | {shaft.name: shaft.gates for shaft in self.floor_plan.shafts}

    def close(self, name: str) -> None:
        """Close the stairs, ramp, escalator or lift of this name, or a gate or exit.

        All gates of stairs, a ramp, an escalator or a lift become walls.

        Raises:
            FloorPlanError: no such name.
        """
        for gate in self._gates_of(name):
            self.floor_plan.close_gate(gate.name)

    def open(self, name: str) -> None:
        """Open what has this name again; see `close`."""
        for gate in self._gates_of(name):
            self.floor_plan.open_gate(gate.name)

    def is_open(self, name: str) -> bool:
        """Whether what has this name is open; stairs are if all of their gates are; see `close`."""
        return all(self.floor_plan.is_open(gate.name) for gate in self._gates_of(name))

    def way_out(self, came: Sequence[str], level: int, *, climbs: bool = True) -> tuple[str, ...]:
        """Names of the gates by which people leave as they came in, for a route.

        The way in began at an exit. People leave by the part of it between their level and that of
        the exit. There are no gates if they are elsewhere, or cannot go back that way, such as
        people in wheelchairs over stairs, or anybody on an escalator.

        Args:
            came: names of stairs, ramps, escalators and lifts, and of gates between them, from the
                exit on. The exit itself may come first. It must if the first stairs, ramp,
                escalator or lift joins several levels with exits. Names of gates alone are given
                back in reverse order.
            level: number of the level where people are.
            climbs: whether they use stairs (`PedestrianType.climbs`).

        Raises:
            FloorPlanError: no such name, no such level, an exit behind the first name, or a way
                that may begin on several levels.
        """
        for name in came:
            self._gates_of(name)
        joints = {each.name: each for each in (*self.stairs, *self.lifts)}
        exits = {each.name: level.number for level in self.levels for each in level.exits}
        number = self.level(level).number
        return gates_of_way_out(came, number, climbs, joints, self.gates, exits)

    def _gates_of(self, name: str) -> tuple[Gate | Exit, ...]:
        known = self.gates
        if name in known:
            return known[name]
        openings = {each.name: each for each in self.floor_plan.openings()}
        if name in openings:
            return (openings[name],)
        names = [*known, *(each.name for level in self.levels for each in level.exits)]
        raise FloorPlanError(
            f"there are no stairs, ramp, escalator, lift, gate or exit {name!r}"
            f"{did_you_mean(str(name), {**known, **openings})}; there are "
            f"{', '.join(map(repr, names))}, and gates"
        )

    @cached_property
    def rooms(self) -> tuple[Room, ...]:
        """The rooms of all levels, each with its level, name, use, area and doors.

        They are those of the levels, or else are found between the gates of a level, as
        `FloorPlan.rooms` are. Rooms of one name on several levels are called ``level 1 hall``.
        Their doors include flights, lifts, ramps and escalators that begin there.
        """
        found: list[Room] = []
        for level in self.levels:
            known = {each.name: each for each in self.floor_plan_of(level.number).rooms}
            # What stairs take of a room may be all of it.
            for each in level.rooms or known.values():
                doors = known[each.name].doors if each.name in known else ()
                found.append(replace(each, level=level.number, doors=doors))
        names = Counter(each.name for each in found)
        return tuple(
            replace(each, name=f"level {each.level} {each.name}") if names[each.name] > 1 else each
            for each in found
        )

    @property
    def refuges(self) -> tuple[Refuge, ...]:
        """The refuges of all levels, as drawn in the plane."""
        return tuple(
            Refuge(each.name, cast("Polygon", self._sheet(level.number).in_plane(each.shape)))
            for level in self.levels
            for each in level.refuges
        )

    @property
    def sheets(self) -> tuple[Sheet, ...]:
        """Levels and landings as drawn in the plane, from the left."""
        return tuple(self._sheets.values())

    def true_places(self, points: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.int16]]:
        """True places of points in the plane.

        Args:
            points: (n, 2) metres.

        Returns:
            (n, 3) x, y and z in metres, and the (n,) numbers of the levels; `ON_STAIRS` for places
            on flights and landings.
        """
        return self._places.true(points)

    def plane_places(self, places: ArrayLike) -> NDArray[np.float64]:
        """(n, 2) points in the plane of (n, 3) true places, metres.

        Places in the car of a lift, at any height, are on its drawing at the nearest of its levels.

        Raises:
            FloorPlanError: a place more than a centimetre above or below any floor, in no lift.
        """
        return self._places.plane(places)

    def stairs_at(self, places: ArrayLike) -> NDArray[np.int16]:
        """The stairs on which true places are, to a centimetre.

        Args:
            places: (n, 3) x, y and z, metres.

        Returns:
            (n,) indices in `stairs`; -1 for places that are on no flight or landing.
        """
        return self._places.stairs(places)

    def lifts_at(self, places: ArrayLike) -> NDArray[np.int16]:
        """The lifts in which true places are: behind the line of the door, at any height.

        Args:
            places: (n, 3) x, y and z, metres.

        Returns:
            (n,) indices in `lifts`; -1 for places that are in no lift.
        """
        return self._places.lifts(places)

    def shapes_of(self, stairs: Stairs | Ramp | Escalator) -> list[Polygon]:
        """The flights and landings of stairs, or a ramp, in plan, in the building's coordinates."""
        number = self.stairs.index(stairs)
        flights = [each for each in self.flights if self._owners[each.name] == number]
        landings = [each for each in self.landings if self._owners[each.name] == number]
        return [*(each.part(0.0, each.going) for each in flights), *(e.area for e in landings)]

    def places(self, points: ArrayLike, level: int) -> NDArray[np.float64]:
        """(n, 2) points in the plane of (n, 2) places on a level, metres."""
        xy = np.asarray(points, dtype=np.float64).reshape(-1, 2)
        shifted: NDArray[np.float64] = xy + self._sheet(level).shift
        return shifted

    def random_points(
        self,
        n: int,
        rng: np.random.Generator,
        *,
        level: int | None = None,
        within: Polygon | str | None = None,
        spacing: float,
        clearance: float,
        avoid: ArrayLike = (),
    ) -> NDArray[np.float64]:
        """(n, 2) random points in the plane, in metres, with room for people to stand.

        They are on levels, never on stairs. See `FloorPlan.random_points`.

        Args:
            n: how many.
            rng: where they come from.
            level: number of the level on which they are; by default on all.
            within: the area of these levels in which they lie (shapely or WKT), in the building's
                coordinates; by default all.
            spacing: least distance of the points to each other, metres.
            clearance: least distance to walls and exits, metres.
            avoid: (k, 2) further points in the plane from which they keep the spacing, metres.

        Raises:
            FloorPlanError: there is room for fewer than n points, or no such level.
        """
        chosen = self.levels if level is None else [self.level(level)]
        floors = [self._sheet(each.number) for each in chosen]
        area = None if within is None else read_polygon(within, "within")
        parts = [
            part
            for each in floors
            for part in shapely.get_parts(
                each.in_plane(each.floor if area is None else each.floor.intersection(area))
            )
            if part.geom_type == "Polygon"
        ]
        return self.floor_plan.random_points(
            n,
            rng,
            within=shapely.MultiPolygon(parts),
            spacing=spacing,
            clearance=clearance,
            avoid=avoid,
        )

    def floor_plan_of(self, level: int) -> FloorPlan:
        """The floor of one level as a plan of its own, in the building's coordinates.

        Stairs and lifts are not part of it: people leave by the end of a flight or the door of a
        lift as by an exit, which has the name of the flight or the lift.
        """
        sheet = self._sheet(level)
        return plan_of_level(self.level(level), sheet, self.flights, self.lifts, self.name)

    def _sheet(self, level: int) -> Sheet:
        return self._sheets[sheet_of(self.level(level).number)]
