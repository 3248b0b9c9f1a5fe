"""Places in a building: from the plane, in which it is simulated, to true coordinates, and back."""

from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray

from mesa_mobility.buildings.connections.flights import Flight
from mesa_mobility.buildings.connections.lift import Lift
from mesa_mobility.buildings.connections.lines import middle_of
from mesa_mobility.buildings.level import sheet_of
from mesa_mobility.buildings.sheets import BEYOND, Sheet
from mesa_mobility.errors import FloorPlanError

ON_STAIRS = -32_768
"""The level of people on flights and landings."""

_OFF = 0.01
"""Most metres by which a place may be off a floor: above it, below it or beside it."""

_ROUNDING = 1e-6
"""Metres."""


class Places:
    """The lookup of places.

    Args:
        sheets: the sheets of a building.
        flights: its flights.
        owners: for the name of each flight and landing, the number of its stairs.
        lifts: its lifts.
    """

    def __init__(
        self,
        sheets: Mapping[str, Sheet],
        flights: Sequence[Flight],
        owners: Mapping[str, int],
        lifts: Sequence[Lift],
    ) -> None:
        self._sheets, self._owners = list(sheets.values()), dict(owners)
        self._lifts = tuple(lifts)
        self._number = {sheet.name: number for number, sheet in enumerate(self._sheets)}
        self._flights = tuple(flights)
        bounds = [sheet.in_plane(sheet.area).bounds for sheet in self._sheets]
        self._between = np.array([(a[2] + b[0]) / 2.0 for a, b in pairwise(bounds)])
        self._shifts = np.array([sheet.shift for sheet in self._sheets])
        self._elevations = np.array([sheet.elevation for sheet in self._sheets])
        self._levels = np.array(
            [ON_STAIRS if each.level is None else each.level for each in self._sheets], np.int16
        )

    def true(self, points: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.int16]]:
        """(n, 3) true places in metres, and (n,) levels, of (n, 2) points in the plane."""
        xy = np.asarray(points, dtype=np.float64).reshape(-1, 2)
        sheet = np.searchsorted(self._between, xy[:, 0], side="right")
        places = np.column_stack([xy - self._shifts[sheet], self._elevations[sheet]])
        levels = self._levels[sheet]
        for flight in self._flights:
            upper, lower = self._number[flight.upper], self._number[flight.lower]
            own = np.flatnonzero((sheet == upper) | (sheet == lower))
            down, aside = place_on(flight, places[own, :2])
            drawn = (aside <= flight.width / 2.0) & (down > 0.0) & (down < flight.going)
            places[own[drawn], 2] = height_on(flight, down[drawn])
            levels[own[drawn]] = ON_STAIRS
            # Beyond the flight, the copied end of a strip is on the other sheet's floor.
            for past, here, there in ((down - flight.going, upper, lower), (-down, lower, upper)):
                ends = (past >= 0.0) & (past <= BEYOND + _ROUNDING)
                over = own[ends & (aside <= flight.width / 2.0) & (sheet[own] == here)]
                over = over[self._copied(flight, here, places[over, :2])]
                places[over, 2], levels[over] = self._elevations[there], self._levels[there]
        return places, levels

    def plane(self, places: ArrayLike) -> NDArray[np.float64]:
        """(n, 2) points in the plane of (n, 3) true places, metres.

        Those in the car of a lift are on its drawing at the nearest level at which it stops.

        Raises:
            FloorPlanError: a place that is on no level, landing or flight, and in no lift.
        """
        xyz = np.asarray(places, dtype=np.float64).reshape(-1, 3)
        sheet = np.full(len(xyz), -1, dtype=np.int64)
        nearest = np.full(len(xyz), np.inf)
        points = shapely.points(xyz[:, :2])
        for number, each in enumerate(self._sheets):
            level = np.flatnonzero(np.abs(xyz[:, 2] - each.elevation) <= _OFF)
            away = shapely.distance(each.floor, points[level])
            nearer = away < nearest[level]
            sheet[level[nearer]], nearest[level[nearer]] = number, away[nearer]
        for flight in self._flights:
            on, down = _at(flight, xyz)
            lower, upper = self._number[flight.lower], self._number[flight.upper]
            sheet[on] = np.where(down[on] >= flight.going / 2.0, lower, upper)
            nearest[on] = 0.0
        for lift in self._lifts:
            off = np.flatnonzero((sheet < 0) | (nearest > _OFF))
            stops = np.array([self._number[sheet_of(number)] for number in lift.numbers])
            heights = self._elevations[stops]
            off = off[(xyz[off, 2] >= heights.min() - _OFF) & (xyz[off, 2] <= heights.max() + _OFF)]
            riding = off[shapely.distance(lift.car, points[off]) <= _OFF]
            away = np.abs(xyz[riding, 2][:, None] - heights)
            sheet[riding] = stops[np.argmin(away, axis=1)]
        if (sheet < 0).any():
            lost = xyz[np.argmax(sheet < 0)].tolist()
            levels = np.flatnonzero(self._levels != ON_STAIRS)
            near = levels[np.argmin(np.abs(self._elevations[levels] - lost[2]))]
            raise FloorPlanError(
                f"({', '.join(f'{each:.2f}' for each in lost)}): expected a place on a level, a "
                "landing or a flight of stairs, or in a lift; the nearest level is "
                f"{self._levels[near]}, at {self._elevations[near]:g} m"
            )
        return xyz[:, :2] + self._shifts[sheet]

    def stairs(self, places: ArrayLike) -> NDArray[np.int16]:
        """(n,) numbers of the stairs on which (n, 3) true places are; -1 for other places."""
        xyz = np.asarray(places, dtype=np.float64).reshape(-1, 3)
        found = np.full(len(xyz), -1, dtype=np.int16)
        for landing in (each for each in self._sheets if each.level is None):
            near = np.flatnonzero(np.abs(xyz[:, 2] - landing.elevation) <= _OFF)
            away = shapely.distance(landing.floor, shapely.points(xyz[near, :2]))
            found[near[away <= _OFF]] = self._owners[landing.name]
        for flight in self._flights:
            on, _ = _at(flight, xyz, _OFF)
            found[on] = self._owners[flight.name]
        return found

    def lifts(self, places: ArrayLike) -> NDArray[np.int16]:
        """(n,) numbers of the lifts in which (n, 3) true places are; -1 for other places."""
        xyz = np.asarray(places, dtype=np.float64).reshape(-1, 3)
        found = np.full(len(xyz), -1, dtype=np.int16)
        for number, lift in enumerate(self._lifts):
            stops = self._elevations[[self._number[sheet_of(each)] for each in lift.numbers]]
            beyond = np.maximum(stops.min() - xyz[:, 2], xyz[:, 2] - stops.max())
            between = np.flatnonzero(beyond <= _OFF)
            inside = shapely.contains_xy(lift.shape, *xyz[between, :2].T)
            found[between[inside]] = number
        return found

    def _copied(self, flight: Flight, sheet: int, xy: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Whether places beyond a flight, on a sheet, are on its strip and not on the floor."""
        floor = self._sheets[sheet].floor
        return ~shapely.intersects_xy(floor, xy[:, 0], xy[:, 1]) & shapely.intersects_xy(
            self._sheets[sheet].area, xy[:, 0], xy[:, 1]
        )


def place_on(
    flight: Flight, xy: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Metres down from the head of a flight, and metres from its middle line, of (n, 2) places."""
    away, down = xy - middle_of(flight.head), flight.down
    return away @ down, np.abs(away @ np.array([-down[1], down[0]]))


def _at(
    flight: Flight, xyz: NDArray[np.float64], beside: float = 0.0
) -> tuple[NDArray[np.bool_], NDArray[np.float64]]:
    """Whether (n, 3) true places are on a flight, and metres down from its head.

    Args:
        flight: the flight.
        xyz: (n, 3) metres.
        beside: metres by which places may be beyond its edges in plan.
    """
    down, aside = place_on(flight, xyz[:, :2])
    on = (down > -beside) & (down < flight.going + beside) & (aside <= flight.width / 2.0 + beside)
    on &= np.abs(height_on(flight, down) - xyz[:, 2]) <= _OFF
    return on, down


def height_on(flight: Flight, down: NDArray[np.float64]) -> NDArray[np.float64]:
    """Elevation of places on a flight, as on a ramp."""
    share = down / flight.going
    height: NDArray[np.float64] = flight.top + share * (flight.bottom - flight.top)
    return height
