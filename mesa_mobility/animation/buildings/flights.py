"""Meshes of flights, of landings and of the handrails beside them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.animation.meshes import Mesh, bar, joined, post, prism
from mesa_mobility.buildings.connections.flights import BOTH
from mesa_mobility.buildings.places import height_on, place_on

if TYPE_CHECKING:
    from mesa_mobility.buildings import Flight, Landing

RAIL_HEIGHT = 0.9
"""Metres from the edges of the treads to the upper edge of a handrail."""

RAIL = 0.04
"""Thickness of a handrail and of the posts at its ends, metres."""

_SLAB = 0.04
"""Metres by which a step reaches below the one beneath it, and thickness of a landing."""


def flight_mesh(flight: Flight) -> Mesh:
    """The steps of a flight as boxes, one for each tread, each a riser below the one above; the
    slab of a ramp."""
    if not flight.risers:
        ring = np.array(flight.part(0.0, flight.going).exterior.coords)
        vertices, normals, triangles = prism(ring, -_SLAB, _SLAB)
        down, _ = place_on(flight, vertices[:, :2].astype(np.float64))
        vertices[:, 2] += height_on(flight, down)
        return vertices, normals, triangles
    boxes = []
    for number in range(1, flight.risers):
        area = flight.part((number - 1) * flight.tread, number * flight.tread)
        height = flight.top - number * flight.riser
        high = min(flight.riser + _SLAB, height - flight.bottom)
        boxes.append(prism(np.array(area.exterior.coords), height - high, high))
    return joined(boxes)


def landing_mesh(landing: Landing) -> Mesh:
    """The slab of a landing."""
    return prism(np.array(landing.area.exterior.coords), landing.elevation - _SLAB, _SLAB)


def handrails(flight: Flight) -> Iterator[Mesh]:
    """The handrails of a flight beside its clear width, each with a post at either end."""
    left, right = (np.array(end) for end in flight.head)
    beside = 0.5 * RAIL * (left - right) / flight.width
    for side, edge in (("left", left + beside), ("right", right - beside)):
        if flight.handrails in (side, BOTH):
            yield _handrail(flight, edge)


def _handrail(flight: Flight, head: NDArray[np.float64]) -> Mesh:
    """A handrail whose middle line begins at a place beside the upper edge of the flight."""
    down = flight.down
    foot = head + flight.going * down
    high, low = flight.top + RAIL_HEIGHT, flight.bottom + flight.riser + RAIL_HEIGHT
    rail = bar(np.array([*head, high]), np.array([*foot, low]), RAIL)
    half = 0.5 * RAIL * down
    ends = (head + half, flight.top, high), (foot - half, flight.bottom, low)
    posts = [post(at, RAIL, floor, top - RAIL) for at, floor, top in ends]
    return joined([rail, *posts])
