"""The points at which people cross a gate or exit."""

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import inlined, internal
from mesa_mobility.floorplan.routing.route_graph import Ways, in_view, side
from mesa_mobility.floorplan.routing.route_nodes import CORNER
from mesa_mobility.floorplan.walls.sight import Sight

# People aim this far inside the outermost places of an opening, or at its middle (metres).
# A recorded step ends some centimetres from where it was meant to: beside the jamb is too late.
_AMPLE = 0.25

# Points of an opening that are tried if its near end is hidden, and how much longer than by the
# corner before it the route through such a point may be.
_PLACES = 8
_DETOUR = 1.1


@internal()
def place(
    sight: Sight, ways: Ways, x: float, y: float, node: int, after: int, own: float
) -> tuple[float, float, float]:
    """The point to go to at a node, and the least distance to the line there (metres).

    It is the node itself, or the nearest point of its opening that serves as well, clear of the
    jambs if possible. At the end of a route `after` is -1.
    """
    qx, qy = ways.xy[node]
    away = np.hypot(qx - x, qy - y)
    if ways.kind[node] == CORNER:
        return qx, qy, away
    ends = ways.ends[ways.opening[node]]
    if nearest_serves(sight, ways, x, y, node, after, ways.view_clearance, own):
        qx, qy = nearest(ends, x, y)
        away = np.hypot(qx - x, qy - y)
        ax, ay = nearest(_clear_of_jambs(ends), x, y)
        # No farther aside than the line is away, or people just before it would walk along it.
        share = min(1.0, away / max(np.hypot(ax - qx, ay - qy), 1e-9))
        ax, ay = qx + share * (ax - qx), qy + share * (ay - qy)
        if _serves(sight, ways, (x, y), node, after, (ax, ay), ways.view_clearance, own):
            return ax, ay, away
    return qx, qy, away


@internal()
def straight_on(
    sight: Sight,
    ways: Ways,
    person: tuple[float, float],
    node: int,
    point: tuple[float, float],
    after: NDArray[np.int64],
    own: float,
) -> tuple[float, float]:
    """Where people cross a gate from which the route goes on on another sheet.

    It is on the straight line to the opening to which they go next, as if both sheets were one
    floor. A `point` in the gate is taken where that line is not free, before a corner, which people
    pass abreast, and at all other openings.
    """
    (x, y), other = person, ways.linked[node]
    if other < 0 or after[other] < 0:
        return point
    then = after[other]
    if ways.kind[then] == CORNER:
        return point
    dx, dy = ways.xy[other, 0] - ways.xy[node, 0], ways.xy[other, 1] - ways.xy[node, 1]
    rx, ry, _ = place(sight, ways, point[0] + dx, point[1] + dy, then, after[then], np.inf)
    before, behind = -side(ways, node, x, y), side(ways, other, rx, ry)
    if before <= 0.0 or behind <= 0.0:
        return point
    share = before / (before + behind)
    ends = ways.ends[ways.opening[node]]
    qx, qy = nearest(ends, x + share * (rx - dx - x), y + share * (ry - dy - y))
    if in_view(sight, ways, x, y, node, qx, qy, ways.view_clearance, own) and in_view(
        sight, ways, qx + dx, qy + dy, then, rx, ry, ways.view_clearance, np.inf
    ):
        return qx, qy
    return point


@internal()
def _clear_of_jambs(ends: NDArray[np.float64]) -> tuple[float, float, float, float]:
    ax, ay, bx, by = ends
    share = min(0.5, _AMPLE / max(np.hypot(bx - ax, by - ay), 1e-9))
    dx = share * (bx - ax)
    dy = share * (by - ay)
    return ax + dx, ay + dy, bx - dx, by - dy


@inlined()
def opening_behind(
    sight: Sight,
    ways: Ways,
    x: float,
    y: float,
    corner: int,
    to_go: NDArray[np.float64],
    after: NDArray[np.int64],
    own: float,
) -> tuple[int, float, float]:
    """The opening to which a route leads by `corner`, and a point in it that is in view.

    Beside a door the jamb hides its near end, so that the shortest route bends at the jamb.
    People who see the rest of the door walk through that: a target at the jamb would
    have them slow down before it. The node is -1 if no point is in view, or only
    points so far along the opening that the route by the corner is much shorter.
    """
    node = after[corner]
    if node < 0 or ways.kind[node] == CORNER:
        return -1, x, y
    by_corner = np.hypot(ways.xy[corner, 0] - x, ways.xy[corner, 1] - y) + to_go[corner]
    ends = _clear_of_jambs(ways.ends[ways.opening[node]])
    ax, ay, bx, by = ends
    nx, ny = nearest(ends, x, y)
    if np.hypot(ax - nx, ay - ny) > np.hypot(bx - nx, by - ny):
        bx, by = ax, ay
    for k in range(_PLACES + 1):
        qx = nx + k / _PLACES * (bx - nx)
        qy = ny + k / _PLACES * (by - ny)
        way = np.hypot(qx - x, qy - y)
        if after[node] >= 0:
            way += np.hypot(ways.xy[node, 0] - qx, ways.xy[node, 1] - qy) + to_go[node]
        else:
            way += to_go[node]
        if way > _DETOUR * by_corner:
            break
        if _serves(sight, ways, (x, y), node, after[node], (qx, qy), ways.view_clearance, own):
            return node, qx, qy
    return -1, x, y


@internal()
def nearest(ends: tuple[float, float, float, float], x: float, y: float) -> tuple[float, float]:
    """The point nearest to (x, y) on the segment between two ends."""
    ax, ay, bx, by = ends
    length2 = (bx - ax) ** 2 + (by - ay) ** 2
    t = 0.0
    if length2 > 0.0:
        t = min(1.0, max(0.0, ((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / length2))
    return ax + t * (bx - ax), ay + t * (by - ay)


@internal()
def nearest_serves(
    sight: Sight,
    ways: Ways,
    x: float,
    y: float,
    node: int,
    after: int,
    clearance: float,
    own: float,
) -> bool:
    """Whether the nearest point in the opening of `node` serves as well as the node."""
    qx, qy = nearest(ways.ends[ways.opening[node]], x, y)
    return _serves(sight, ways, (x, y), node, after, (qx, qy), clearance, own)


@internal()
def _serves(
    sight: Sight,
    ways: Ways,
    person: tuple[float, float],
    node: int,
    after: int,
    point: tuple[float, float],
    clearance: float,
    own: float,
) -> bool:
    """Whether a point in the opening of `node` serves a person as well as the node.

    It must be in view and, in a gate on the way, have the node `after` in view; otherwise
    people would turn back once they are through.
    """
    (x, y), (qx, qy) = person, point
    if not in_view(sight, ways, x, y, node, qx, qy, clearance, own):
        return False
    if after < 0:
        return True
    ax, ay = ways.xy[after]
    return in_view(sight, ways, qx, qy, after, ax, ay, ways.view_clearance, np.inf)
