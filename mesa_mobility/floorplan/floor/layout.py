"""The parts of a floor plan that never change: walkable area, exits, gates, zones and rooms."""

from collections.abc import Iterable
from typing import cast

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray
from shapely import Polygon
from shapely.geometry.base import BaseGeometry

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.floor import checks, extent
from mesa_mobility.floorplan.floor.openings import Exit, Gate
from mesa_mobility.floorplan.floor.outline import check_tolerance
from mesa_mobility.floorplan.floor.room import Room, check_rooms
from mesa_mobility.floorplan.floor.seams import Seam, check_seams
from mesa_mobility.floorplan.floor.shafts import Shaft, joints_of
from mesa_mobility.floorplan.floor.zones import SpeedZone, check_zones, speed_factors


class Layout:
    """A walkable area with exits, gates, zones and rooms, checked together.

    Args:
        walkable: one connected polygon, holes allowed; shapely or WKT, metres.
        exits: lines on the edge of the walkable area (within 1 cm).
        gates: lines to cross, inside the walkable area.
        zones: parts of the floor where people walk more slowly.
        name: for titles and files.
        simplify: metres by which walls may recede to have fewer vertices.
        seams: where people change from one piece of the walkable area to another.
        shafts: lifts between pieces of the walkable area.
        rooms: named areas of the floor.

    Raises:
        FloorPlanError: parts that ``FloorPlan`` refuses.
    """

    def __init__(
        self,
        walkable: Polygon | str,
        exits: Iterable[Exit],
        gates: Iterable[Gate],
        zones: Iterable[SpeedZone],
        name: str,
        simplify: float,
        seams: Iterable[Seam] = (),
        shafts: Iterable[Shaft] = (),
        rooms: Iterable[Room] = (),
    ) -> None:
        self.name = name
        self._simplify = check_tolerance(simplify)
        self._seams, self._shafts = tuple(seams), tuple(shafts)
        read = checks.read_area if self.in_sheets else checks.read_polygon
        self._walkable = cast("Polygon", read(walkable, "walkable area"))
        extent.check_extent(self._walkable)
        check_seams(self._walkable, self._seams)
        self._steps = np.concatenate([np.empty((0, 4)), *(each.steps for each in self._seams)])
        self._copied = shapely.union_all([part for each in self._seams for part in each.copies])
        self._exits = tuple(exits)
        self._copies = {
            name: copy for each in self._seams for name, copy in each.copied_gates.items()
        }
        self._owners = {copy.name: name for name, copy in self._copies.items()}
        self._gates = (
            *gates,
            *(gate for each in self._seams for gate in each.gates),
            *(gate for each in self._shafts for gate in each.gates),
        )
        checks.check_exits(self._walkable, self._exits, self._gates)
        checks.check_gates(self._walkable, self._gates)
        self._zones = tuple(zones)
        check_zones(self._walkable, self._zones)
        self._given_rooms = check_rooms(rooms, self._walkable)
        checks.check_names([*self._exits, *self._gates])
        self._openings: tuple[Gate | Exit, ...] = (*self._gates, *self._exits)
        self._named = {opening.name: opening for opening in self._openings}

    @property
    def walkable(self) -> Polygon:
        """The walkable polygon as given, obstacles not subtracted; several polygons if there are
        seams."""
        return self._walkable

    @property
    def simplify(self) -> float:
        """Metres by which walls of the free area may recede to have fewer vertices."""
        return self._simplify

    @property
    def exits(self) -> tuple[Exit, ...]:
        """All exits, open or closed."""
        return self._exits

    @property
    def gates(self) -> tuple[Gate, ...]:
        """All gates, open or closed, those of seams and lifts last."""
        return self._gates

    @property
    def zones(self) -> tuple[SpeedZone, ...]:
        """The zones of reduced speed."""
        return self._zones

    @property
    def given_rooms(self) -> tuple[Room, ...]:
        """The rooms with which the plan was made; none if they are to be found."""
        return self._given_rooms

    @property
    def seams(self) -> tuple[Seam, ...]:
        """The seams, at which people change from one sheet to another.

        A sheet is a part of a building. All sheets are drawn side by side in one plan, each as a
        piece of the walkable area of its own. A plan of one sheet has no seams.
        """
        return self._seams

    @property
    def shafts(self) -> tuple[Shaft, ...]:
        """The lifts between sheets."""
        return self._shafts

    def shafts_for(self, climbs: bool) -> tuple[Shaft, ...]:
        """The lifts of people who use stairs, or of those who do not."""
        return tuple(each for each in self._shafts if each.everybody or not climbs)

    @property
    def in_sheets(self) -> bool:
        """Whether the plan has several sheets."""
        return bool(self._seams or self._shafts)

    @property
    def joints(self) -> list[tuple[tuple[float, float], tuple[float, float]]]:
        """Pairs of places, (x, y) in metres, at which sheets are joined."""
        return [*(each.joint for each in self._seams), *joints_of(self._shafts)]

    @property
    def copied(self) -> BaseGeometry:
        """The parts of the floor that are drawn twice, where they are only a copy (see ``Seam``).

        Empty without seams.
        """
        return self._copied

    @property
    def steps(self) -> NDArray[np.float64]:
        """(s, 4) x1, y1, x2, y2 in metres of the edges at which stairs and escalators begin.

        They are walls for people who use no stairs.
        """
        return self._steps.copy()

    def on_steps(self, points: ArrayLike) -> NDArray[np.bool_]:
        """(n,) whether (n, 2) points, metres, are on stairs or escalators."""
        xy = np.asarray(points, dtype=np.float64).reshape(-1, 2)
        found = np.zeros(len(xy), np.bool_)
        for seam in self._seams:
            found |= seam.on_steps(xy) | seam.on_steps(xy, second=True)
        return found

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """(xmin, ymin, xmax, ymax) of the walkable area in metres."""
        return self._walkable.bounds

    def speed_factors(self, points: ArrayLike) -> NDArray[np.float64]:
        """(n,) factor of people's preferred speeds at (n, 2) points, metres."""
        return speed_factors(self._zones, np.asarray(points, dtype=np.float64).reshape(-1, 2))

    def openings(self) -> tuple[Gate | Exit, ...]:
        """Gates, then exits: the numbering of `Targets.gates`."""
        return self._openings

    def gate(self, name: str) -> Gate | Exit:
        """The gate or exit of this name; raises FloorPlanError if there is none."""
        found = self._named.get(name) if isinstance(name, str) else None
        if found is None:
            names = ", ".join(map(repr, self._named))
            raise FloorPlanError(f"there is no gate or exit {name!r}; there are {names}")
        return found

    def drawings(self, name: str) -> tuple[Gate | Exit, ...]:
        """The gate or exit of this name; for a gate of a seam its drawings on both sheets.

        The drawing on the sheet to which the gate belongs comes first, whichever name is given.
        Raises FloorPlanError if there is none.
        """
        own = self.gate(self._owners.get(name, name))
        return (own, self._copies[own.name]) if own.name in self._copies else (own,)
