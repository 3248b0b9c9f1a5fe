"""Headroom: floors and flights of a building that lie too close above each other, or in the shaft
of a lift."""

from collections.abc import Iterable, Mapping
from itertools import combinations

import numpy as np
import shapely
from shapely import Point
from shapely.geometry.base import BaseGeometry

from mesa_mobility.buildings.connections.flights import Flight
from mesa_mobility.buildings.connections.lift import Lift
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

    Two flights that meet on a sheet do not overlap in plan; see ``sheets_of``.

    Raises:
        FloorPlanError: naming both, the place and the metres between.
    """
    floors, flights = list(sheets.values()), tuple(flights)
    for one, other in combinations(floors, 2):
        between = abs(one.elevation - other.elevation)
        if between < HEADROOM_M - _ROUNDING:
            spot = _shared(one.floor, other.floor)
            if spot is not None:
                raise _refusal(one.name, other.name, between, spot)
    for flight in flights:
        for sheet in floors:
            first, last = close_to(flight, sheet.elevation)
            spot = None
            if last - first > _ROUNDING:
                spot = _shared(flight.part(first, last), sheet.floor)
            if spot is not None:
                height = height_on(flight, place_on(flight, np.array([[spot.x, spot.y]]))[0])
                between = float(abs(height[0] - sheet.elevation))
                raise _refusal(f"{flight.what} {flight.name!r}", sheet.name, between, spot)

    for above, below in combinations(flights, 2):
        spot, between = _nearest(above, below)
        if spot is not None and between < HEADROOM_M - _ROUNDING:
            names = [f"{each.what} {each.name!r}" for each in (above, below)]
            raise _refusal(names[0], names[1], between, spot)


def check_shafts(
    sheets: Mapping[str, Sheet], flights: Iterable[Flight], lifts: Iterable[Lift]
) -> None:
    """No landing or flight must lie in the shaft of a lift.

    Levels have no floor there, see ``sheets_of``. A shaft reaches from the lowest of its levels to
    1.5 m above the highest.

    Raises:
        FloorPlanError: naming both, and the place.
    """
    heights = {sheet.level: sheet.elevation for sheet in sheets.values()}
    landings, flights = [each for each in sheets.values() if each.level is None], tuple(flights)
    for lift in lifts:
        stops = [heights[number] for number in lift.numbers]
        low, high = min(stops), max(stops) + HEADROOM_M
        inside = {each.name: each.area for each in landings if low < each.elevation < high}
        for flight in flights:
            fall = (flight.top - flight.bottom) / flight.going
            first = max((flight.top - high) / fall, 0.0)
            last = min((flight.top - low) / fall, flight.going)
            if last - first > _ROUNDING:
                inside[f"{flight.what} {flight.name!r}"] = flight.part(first, last)
        for name, area in inside.items():
            spot = _shared(area, lift.shape)
            if spot is not None:
                raise FloorPlanError(
                    f"lift {lift.name!r}: {name} lies in its shaft at ({spot.x:.2f}, {spot.y:.2f})"
                )


def _nearest(one: Flight, other: Flight) -> tuple[Point | None, float]:
    """Where two flights are nearest above each other, and the metres between; None and infinity
    if they are nowhere above each other.

    What they share in plan is a convex polygon, on which the difference of their heights is linear.
    So it has its least and its greatest value at corners, and any value between on a line of these.
    """
    shared = shapely.intersection(one.part(0.0, one.going), other.part(0.0, other.going))
    if shared.area <= _LEAST_AREA:
        return None, np.inf
    corners = shapely.get_coordinates(shared)
    above, below = (height_on(each, place_on(each, corners)[0]) for each in (one, other))
    between = above - below
    low, high = int(np.argmin(between)), int(np.argmax(between))
    if between[low] < 0.0 < between[high]:
        share = -between[low] / (between[high] - between[low])
        return Point(corners[low] + share * (corners[high] - corners[low])), 0.0
    nearest = int(np.argmin(np.abs(between)))
    return Point(corners[nearest]), float(abs(between[nearest]))


def close_to(flight: Flight, elevation: float) -> tuple[float, float]:
    """Metres below the head of a flight from and up to where it has too little between it and a
    floor at an elevation; the second is not greater where nothing is too close."""
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
