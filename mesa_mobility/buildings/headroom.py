"""Headroom: floors and flights of a building that lie too close above each other."""

from collections.abc import Iterable, Mapping
from itertools import combinations

import numpy as np
import shapely
from shapely import Point
from shapely.geometry.base import BaseGeometry

from mesa_mobility.buildings.flights import Flight
from mesa_mobility.buildings.places import height_on, place_on
from mesa_mobility.buildings.sheets import Sheet
from mesa_mobility.errors import FloorPlanError

HEADROOM_M = 1.5
"""Least metres between floors above each other. Two people whose heights differ by less are
taken to be on one floor or flight."""

_LEAST_AREA = 1e-6
"""Square metres of two floors above each other that count."""

_ROUNDING = 1e-9
"""Metres."""


def check_headroom(sheets: Mapping[str, Sheet], flights: Iterable[Flight]) -> None:
    """Levels, landings and flights must not lie above each other with too little between.

    Raises:
        FloorPlanError: naming both, the place and the metres between.
    """
    floors = list(sheets.values())
    for one, other in combinations(floors, 2):
        between = abs(one.elevation - other.elevation)
        if between < HEADROOM_M - _ROUNDING:
            spot = _shared(one.floor, other.floor)
            if spot is not None:
                raise _refusal(one.name, other.name, between, spot)
    for flight in flights:
        for sheet in floors:
            first, last = _close(flight, sheet.elevation)
            spot = None
            if last - first > _ROUNDING:
                spot = _shared(flight.part(first, last), sheet.floor)
            if spot is not None:
                height = height_on(flight, place_on(flight, np.array([[spot.x, spot.y]]))[0])
                between = float(abs(height[0] - sheet.elevation))
                raise _refusal(f"{flight.what} {flight.name!r}", sheet.name, between, spot)


def _close(flight: Flight, elevation: float) -> tuple[float, float]:
    """Metres below the head of a flight from and up to where it has too little between it and a
    floor."""
    fall = (flight.top - flight.bottom) / flight.going
    ends = [(flight.top - elevation + sign * HEADROOM_M) / fall for sign in (-1.0, 1.0)]
    return max(ends[0] + _ROUNDING, 0.0), min(ends[1] - _ROUNDING, flight.going)


def _shared(one: BaseGeometry, other: BaseGeometry) -> Point | None:
    """A place in both of two areas; None if there is none."""
    shared = shapely.intersection(one, other)
    return shared.representative_point() if shared.area > _LEAST_AREA else None


def _refusal(one: str, other: str, between: float, spot: Point) -> FloorPlanError:
    return FloorPlanError(
        f"{one} and {other}: one lies {between:.2f} m above the other at ({spot.x:.2f}, "
        f"{spot.y:.2f}), expected {HEADROOM_M} m or no floor there"
    )
