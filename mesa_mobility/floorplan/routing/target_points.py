"""The target of a person whose route starts with a known node: behind a gate, past a corner."""

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import inlined, internal
from mesa_mobility.floorplan.floor.geometry import segments_cross
from mesa_mobility.floorplan.routing.opening_points import (
    nearest,
    opening_behind,
    place,
    straight_on,
)
from mesa_mobility.floorplan.routing.route_graph import IN_LINE, Ways, in_view, side
from mesa_mobility.floorplan.routing.route_nodes import CORNER, EXIT, GATE
from mesa_mobility.floorplan.walls.line_of_sight import clear_line, free_length
from mesa_mobility.floorplan.walls.sight import NO_WALL, Sight

# A target behind a gate lies at least this far behind it, however near the next wall is (metres).
_LEAST_BEYOND = 0.3

# Somebody this near to the point where the route crosses a gate aims at the node after it, or a
# step straight through could end where that node is out of view again (metres).
_THROUGH = 0.05

# The way on from a corner is in view up to a point that is found by halving this often: 6 cm.
_HALVINGS = 5

# How far past a corner people may aim, as shares of the distance beyond a gate; the first that
# keeps the next node in view is taken.
_PAST_CORNER = (0.5, 0.25, 0.125)


@internal()
def aim_at(
    sight: Sight,
    ways: Ways,
    x: float,
    y: float,
    node: int,
    to_go: NDArray[np.float64],
    after: NDArray[np.int64],
    own: float,
) -> tuple[float, int, float, float, int]:
    """Route length, gate, target and corner of a person whose route starts with `node`."""
    nx, ny = ways.xy[node]
    length = np.hypot(nx - x, ny - y) + to_go[node]
    corner = -1
    qx, qy, away = place(sight, ways, x, y, node, after[node], own)
    if ways.kind[node] == GATE and after[node] >= 0 and np.hypot(qx - x, qy - y) < _THROUGH:
        node = after[node]
        qx, qy, away = place(sight, ways, x, y, node, after[node], own)
    elif ways.kind[node] == CORNER and after[node] >= 0:
        corner = node
        door, sx, sy = opening_behind(sight, ways, x, y, node, to_go, after, own)
        if door >= 0:
            node, qx, qy, away = door, sx, sy, length
    opening = ways.opening[node]
    if ways.kind[node] == CORNER and after[node] < 0:  # a point, at which the route ends
        px, py = nx, ny
    elif ways.kind[node] == CORNER:
        qx, qy = _way_on(sight, ways, x, y, node, after[node], own)
        px, py = past_corner(sight, ways, x, y, qx, qy, after[node])
    else:
        leaves = ways.kind[node] == EXIT
        if after[node] < 0:  # the end of the route, or of its part on this sheet
            length = min(length, away + to_go[node])
            qx, qy = straight_on(sight, ways, (x, y), node, (qx, qy), after, own)
        px, py = _beyond(
            sight, ways, x, y, qx, qy, ways.normal[node, 0], ways.normal[node, 1], leaves
        )
    gate = _gate_on_the_way(ways, x, y, px, py)
    if gate >= 0 and gate != opening:
        opening = gate
        px, py = _through(sight, ways, x, y, px, py, gate, own)
        corner = -1
    if corner < 0 and len(ways.flight_corners) > 0:
        corner = _flight_corner_passed(ways, x, y, px, py, after)
    return length, opening, px, py, corner


@internal()
def _flight_corner_passed(
    ways: Ways, x: float, y: float, px: float, py: float, after: NDArray[np.int64]
) -> int:
    """The first corner beside a flight that a straight way to (px, py) passes, -1 for none.

    Between the way and the corner there is no room for another person. Without these corners,
    people who see a whole flight from a landing would pass its newel in single file.
    """
    passed = -1
    least = np.hypot(px - x, py - y)
    ux, uy = (px - x) / max(least, 1e-9), (py - y) / max(least, 1e-9)
    for corner in ways.flight_corners:
        dx, dy = ways.xy[corner, 0] - x, ways.xy[corner, 1] - y
        along, aside = dx * ux + dy * uy, abs(dx * uy - dy * ux)
        if after[corner] >= 0 and 0.0 < along < least and aside < 2.0 * ways.view_clearance:
            passed, least = corner, along
    return passed


@internal()
def _way_on(
    sight: Sight, ways: Ways, x: float, y: float, corner: int, after: int, own: float
) -> tuple[float, float]:
    """The farthest point in view on the way on from a corner, the corner itself if there is none.

    At the corner of a narrow way there is no room straight past it. With the corner itself as
    target, people would stop there, since every step leads away from it.
    """
    nx, ny = ways.xy[corner]
    dx, dy = ways.xy[after, 0] - nx, ways.xy[after, 1] - ny
    seen, step = 0.0, min(1.0, ways.beyond / max(np.hypot(dx, dy), 1e-9))
    for _ in range(_HALVINGS):
        step /= 2.0
        share = seen + step
        if clear_line(
            sight, x, y, nx + share * dx, ny + share * dy, ways.view_clearance, own, NO_WALL
        ):
            seen = share
    return nx + seen * dx, ny + seen * dy


@internal()
def past_corner(
    sight: Sight, ways: Ways, x: float, y: float, nx: float, ny: float, after: int
) -> tuple[float, float]:
    """The target at corner (nx, ny): straight past it, as far as the next node stays in view.

    With the corner itself as target, people would slow down to stop on it, since every step beyond
    leads away from it.
    """
    clearance = ways.view_clearance
    away = np.hypot(nx - x, ny - y)
    if away < 1e-6:
        return nx, ny
    for share in _PAST_CORNER:
        px = nx + share * ways.beyond * (nx - x) / away
        py = ny + share * ways.beyond * (ny - y) / away
        if ways.kind[after] != CORNER and side(ways, after, px, py) > -IN_LINE:
            continue
        if clear_line(sight, nx, ny, px, py, clearance, np.inf, NO_WALL) and in_view(
            sight, ways, px, py, after, ways.xy[after, 0], ways.xy[after, 1], clearance, np.inf
        ):
            return px, py
    return nx, ny


@internal()
def _beyond(
    sight: Sight,
    ways: Ways,
    x: float,
    y: float,
    qx: float,
    qy: float,
    normal_x: float,
    normal_y: float,
    leaves: bool,
) -> tuple[float, float]:
    """The target behind point q of an opening, on the straight line there.

    The more oblique the line, the nearer the target: on the way along a wall, walking past the door
    would lead closer to a far target. With the square of the cosine, those who come
    from the front have the full distance.
    """
    away = np.hypot(qx - x, qy - y)
    ux, uy = normal_x, normal_y
    if away > 0.05 and (qx - x) * ux + (qy - y) * uy > 0.0:
        ux, uy = (qx - x) / away, (qy - y) / away
    along = max(0.0, ux * normal_x + uy * normal_y)
    length = max(_LEAST_BEYOND, ways.beyond * along * along)
    if not leaves:
        seen = free_length(sight, qx, qy, qx + length * ux, qy + length * uy)
        if seen < length:
            length = max(_LEAST_BEYOND, seen - ways.view_clearance)
    return qx + length * ux, qy + length * uy


@inlined()
def _gate_on_the_way(ways: Ways, x: float, y: float, px: float, py: float) -> int:
    """The first gate that the line to a target crosses just before it, -1 for none."""
    first = -1
    nearest = np.inf
    way = np.hypot(px - x, py - y)
    for gate in range(len(ways.passable)):
        if not ways.passable[gate] or ways.curtains[gate] >= 0:
            continue
        ax, ay, bx, by = ways.lines[gate]
        if not segments_cross(x, y, px, py, ax, ay, bx, by):
            continue
        width = np.hypot(bx - ax, by - ay)
        before = abs((x - ax) * (by - ay) - (y - ay) * (bx - ax)) / width
        behind = abs((px - ax) * (by - ay) - (py - ay) * (bx - ax)) / width
        to_gate = way * before / (before + behind)
        if before > _THROUGH and way - to_gate < ways.beyond and to_gate < nearest:
            nearest = to_gate
            first = gate
    return first


@inlined()
def _through(
    sight: Sight, ways: Ways, x: float, y: float, px: float, py: float, gate: int, own: float
) -> tuple[float, float]:
    """Target behind a gate that lies on the straight line to (px, py)."""
    ax, ay, bx, by = ways.lines[gate]
    width = np.hypot(bx - ax, by - ay)
    normal_x, normal_y = -(by - ay) / width, (bx - ax) / width
    ahead = (px - x) * normal_x + (py - y) * normal_y
    if ahead < 0.0:
        normal_x, normal_y = -normal_x, -normal_y
    qx, qy = nearest(ways.ends[gate], x, y)
    if not (
        clear_line(sight, x, y, qx, qy, ways.view_clearance, own, NO_WALL)
        and clear_line(sight, qx, qy, px, py, ways.view_clearance, np.inf, NO_WALL)
    ):
        share = ((ax - x) * normal_x + (ay - y) * normal_y) / abs(ahead)
        qx = x + share * (px - x)
        qy = y + share * (py - y)
    return _beyond(sight, ways, x, y, qx, qy, normal_x, normal_y, np.bool_(False))
