"""The free area for routes, in which walls with many small steps or waves are smoothed.

A diagonal wall drawn as raster steps has a corner at every step. People do not walk around each of
these corners, yet each would be a node of the route graph and an end of many gaps. Computing time
would grow with the square of their number. Between two such corners lies a pocket too small for a
person. Where many pockets follow each other, this module fills them and drops the vertices that
then lie within a centimetre of a straight line.

This floor only decides where routes may bend and where gaps may be. The walls that people see, and
that stop them, stay unchanged.
"""

from typing import NamedTuple
from weakref import WeakKeyDictionary

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from mesa_mobility.floorplan.floor.boundaries import (
    boundary_segments,
    cut_out,
    opening_segments,
    turns,
)
from mesa_mobility.floorplan.floor.boundaries import rings as rings_of
from mesa_mobility.floorplan.floor.checks import EDGE_TOLERANCE, one_line
from mesa_mobility.floorplan.floor.floor import Floor
from mesa_mobility.floorplan.walls.wall_distances import distances_to_walls

ROOM = 0.16
"""Half the width in metres of the narrowest gap that routes of an adult lead through. A pocket is
filled if no place in it is this far from every wall."""

_MOUTH = 1.2
"""Widest pocket that is filled, metres: wider ones are rooms of two people's breadth."""

_MANY = 8
"""Pockets in a row from which on they are filled: fewer are corners of rooms, doors and columns."""

_STRAIGHT = 0.01
"""Vertices this near to a straight line between others are left out, metres."""

CLOSER = 0.04
"""Metres by which a gap of the smooth floor may be narrower than the real one, at each side."""

_FEW = 64
"""Corners of an outline up to which there are never too many."""

_ROUNDS = 8
"""How often pockets are looked for: filled ones may make up wider and shallower ones."""


class SmoothFloor(NamedTuple):
    """The free area without small pockets.

    Attributes:
        floor: polygon or polygons of this floor.
        walls: (m,) walls of this floor as shapely lines.
        tree: of the walls.
        is_exact: whether this floor is the free area itself.
    """

    floor: BaseGeometry
    walls: NDArray[np.object_]
    tree: shapely.STRtree
    is_exact: bool


_CACHE: "WeakKeyDictionary[Floor, tuple[int, SmoothFloor]]" = WeakKeyDictionary()


def smooth_floor(plan: Floor) -> SmoothFloor:
    """The smooth floor of a plan as it is now; kept until the plan changes."""
    found = _CACHE.get(plan)
    if found is None or found[0] != plan.version:
        with one_line("smooth outline"):
            found = (plan.version, _make(plan))
        _CACHE[plan] = found
    return found[1]


def _make(plan: Floor) -> SmoothFloor:
    floor = _filled(plan)
    exact = floor is plan.free
    walls = plan.walls
    if not exact:
        shapely.prepare(floor)
        # Its edge may lie a little farther from an exit than the outline's.
        edge = cut_out(boundary_segments(floor), plan.open_exits(), EDGE_TOLERANCE + _STRAIGHT)
        walls = np.concatenate([edge, opening_segments(plan.closed_gates())])
    lines = shapely.linestrings(walls.reshape(-1, 2, 2))
    return SmoothFloor(floor, lines, shapely.STRtree(lines), exact)


def _filled(plan: Floor) -> BaseGeometry:
    """The free area without pockets that follow each other; itself if there are none."""
    free = floor = plan.free
    openings = shapely.STRtree([each.line for each in plan.openings()])
    ends: set[tuple[float, float]] = set()
    for _ in range(_ROUNDS):
        pockets, mouths = _pockets(floor, ends)
        if len(pockets) == 0:
            break
        # A pocket with an exit or gate in it leads somewhere.
        leads = openings.query(pockets, predicate="dwithin", distance=2 * EDGE_TOLERANCE)[0]
        small = ~_have_room(plan, mouths)
        small[leads] = False
        if not ends:
            small &= _in_row(small, pockets, mouths)
        small &= ~shapely.is_missing(pockets)
        if not small.any():
            break
        ends.update((x, y) for x, y in mouths[small].reshape(-1, 2).tolist())
        left = shapely.difference(floor, shapely.union_all(pockets[small]))
        parts = [part for part in shapely.get_parts(left) if part.geom_type == "Polygon"]
        floor = parts[0] if len(parts) == 1 else shapely.MultiPolygon(parts)
    straight = floor.simplify(_STRAIGHT)
    if floor is not free or 2 * _tips(straight) < _tips(free) > _FEW:
        return straight
    return free


def _tips(floor: BaseGeometry) -> int:
    """Number of corners that stick out into the floor."""
    return sum(int((turns(ring) < 0.0).sum()) for ring in rings_of(floor))


def _have_room(plan: Floor, mouths: NDArray[np.float64]) -> NDArray[np.bool_]:
    """(k,) whether there is a place ``ROOM`` from every wall in (k, 4) mouths of convex pockets.

    If there is none in the mouth, there is none behind it to which a way leads.
    """
    shares = np.linspace(0.05, 0.95, 19)[:, None]
    places = mouths[:, None, :2] + shares * (mouths[:, None, 2:] - mouths[:, None, :2])
    away = distances_to_walls(plan, places.reshape(-1, 2), ROOM)
    return np.asarray((away.reshape(len(mouths), len(shares)) >= ROOM).any(axis=1))


def _in_row(
    small: NDArray[np.bool_], pockets: NDArray[np.object_], mouths: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """(k,) which of (k, 4) mouths, in order along rings, are among many that are ``small``."""
    joined = np.zeros(len(small), dtype=np.bool_)
    joined[1:] = small[1:] & small[:-1] & (mouths[1:, :2] == mouths[:-1, 2:]).all(axis=1)
    row = np.cumsum(~joined)
    among: NDArray[np.bool_] = np.bincount(row, ~shapely.is_missing(pockets))[row] >= _MANY
    return among


def _pockets(
    floor: BaseGeometry, ends: set[tuple[float, float]]
) -> tuple[NDArray[np.object_], NDArray[np.float64]]:
    """Areas between neighbouring corners that stick out into the floor, and their (k, 4) mouths.

    None stands for an area where a straight wall joins two corners. With ``ends``, only those
    between two of these places.
    """
    pockets: list[shapely.Polygon | None] = []
    mouths = []
    for ring in rings_of(floor):
        tips = np.flatnonzero(turns(ring) < 0.0)
        if len(tips) < _MANY and not ends:
            continue
        closed = np.concatenate([ring, ring])
        for tip, after in zip(
            tips.tolist(), np.append(tips[1:], tips[:1] + len(ring)).tolist(), strict=True
        ):
            a, b = closed[tip], closed[after]
            if not 0.0 < np.hypot(*(b - a)) <= _MOUTH:
                continue
            if ends and not (tuple(a.tolist()) in ends and tuple(b.tolist()) in ends):
                continue
            pocket = shapely.Polygon(closed[tip : after + 1]) if after - tip > 1 else None
            if pocket is None or (pocket.is_valid and pocket.area > 0.0):
                pockets.append(pocket)
                mouths.append(np.concatenate([a, b]))
    return np.array(pockets, dtype=object), np.array(mouths).reshape(-1, 4)
