"""Compiled search for the target of each person."""

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import inlined, internal, kept
from mesa_mobility.compiled.simd import AT_ONCE, place_of_least
from mesa_mobility.floorplan.routing.opening_points import (
    nearest,
    nearest_serves,
    opening_behind,
    place,
)
from mesa_mobility.floorplan.routing.route_graph import IN_LINE, Ways, in_view, side
from mesa_mobility.floorplan.routing.route_nodes import CORNER, EXIT, GATE
from mesa_mobility.floorplan.routing.target_cache import keep, recall
from mesa_mobility.floorplan.routing.visibility_cache import (
    Views,
    has_room,
    is_known,
    nodes_maybe_in_view,
)
from mesa_mobility.floorplan.walls.geometry import segments_cross
from mesa_mobility.floorplan.walls.line_of_sight import clear_line, free_length, unwalled
from mesa_mobility.floorplan.walls.sight import NO_WALL, Sight
from mesa_mobility.floorplan.walls.wall_distances import wall_distance

# A target behind a gate lies at least this far behind it, however near the next wall is (metres).
_LEAST_BEYOND = 0.3

# Somebody this near to the point where the route crosses a gate aims at the node after it, or a
# step straight through could end where that node is out of view again (metres).
_THROUGH = 0.05

# Nodes tried in order of length before the nodes that may be in view are computed.
_TRIES = np.int64(3)

# How far past a corner people may aim, as shares of the distance beyond a gate; the first that
# keeps the next node in view is taken.
_PAST_CORNER = (0.5, 0.25, 0.125)


UNSEEN = -2
"""Gate of a person whose target is not known yet."""

ALL_FOUND, SOME_UNSEEN, NO_TABLE = 0, 1, 2
"""Results of `aim`: everybody has a target; some are left `UNSEEN`; all are, for lack of distances
to a destination."""


@kept(nogil=True)
def aim(
    sight: Sight,
    ways: Ways,
    views: Views,
    cache: NDArray[np.void],
    positions: NDArray[np.float64],
    destinations: NDArray[np.int64],
    distances: NDArray[np.float64],
    follow: NDArray[np.int64],
    learn: bool,
    points: NDArray[np.float64],
    gates: NDArray[np.int64],
    lengths: NDArray[np.float64],
    corners: NDArray[np.int64],
) -> int:
    """Write targets (n, 2), gates (n,), route lengths (n,) and corners (n, 2) of the `UNSEEN`.

    See `Router.targets`. For every destination and node, `distances` is the route length in metres
    and `follow` the next node of the route (-1 where it ends). A thread that may
    `learn` computes new views and caches targets in `cache`; no other thread may read them at the
    time. Without `learn`, or without room for views, people who need a view are left `UNSEEN`.
    Returns one of the results above.
    """
    for number in destinations:
        if not 0 <= number < len(distances):
            return NO_TABLE
    outcome = ALL_FOUND
    nodes = len(ways.kind)
    keys = np.empty(nodes + AT_ONCE)
    seen = np.empty(nodes, dtype=np.int64)
    everything = np.arange(nodes, dtype=np.int64)
    for person in range(len(positions)):
        x, y = positions[person]
        number = destinations[person]
        if gates[person] != UNSEEN:
            if learn:
                keep(cache, x, y, number, person, points, gates, lengths, corners)
            continue
        if recall(cache, x, y, number, person, points, gates, lengths, corners):
            continue
        to_go = distances[number]
        after = follow[number]
        own = wall_distance(sight, x, y, ways.view_clearance)
        view = ways.view_clearance
        node = -1
        # Computing the view from a square takes long, and serves all people who pass.
        hidden_known = is_known(views, x, y)
        if not hidden_known:
            node = _first_in_view(
                sight, ways, x, y, to_go, after, view, own, everything, keys, _TRIES
            )
        if node < 0 and not (hidden_known or (learn and has_room(views))):
            outcome = SOME_UNSEEN
            continue
        if node < 0:
            maybe = seen[: nodes_maybe_in_view(sight, views, ways.xy, x, y, seen)]
            for clearance in (view, 0.0):
                if node < 0:
                    node = _first_in_view(
                        sight, ways, x, y, to_go, after, clearance, own, maybe, keys, nodes
                    )
            if node < 0:
                node = _nearest_unwalled(sight, ways, x, y, to_go, maybe)
        points[person, 0], points[person, 1] = x, y
        gates[person], lengths[person] = -1, np.inf
        corners[person, 0] = corners[person, 1] = -1
        if node >= 0:
            (
                lengths[person], gates[person], points[person, 0], points[person, 1],
                corner,
            ) = _aim_at(sight, ways, x, y, node, to_go, after, own)  # fmt: skip
            if corner >= 0:
                corners[person, 0] = corner
                corners[person, 1] = after[corner]
        if learn:
            keep(cache, x, y, number, person, points, gates, lengths, corners)
    return outcome


@internal()
def _first_in_view(
    sight: Sight,
    ways: Ways,
    x: float,
    y: float,
    to_go: NDArray[np.float64],
    after: NDArray[np.int64],
    clearance: float,
    own: float,
    maybe: NDArray[np.int64],
    keys: NDArray[np.float64],
    tries: int,
) -> int:
    """The node in view with the shortest route through it, -1 if none of the first `tries` is.

    `maybe` lists the nodes to try; `keys` is workspace, with room for `AT_ONCE` more.
    """
    count = len(maybe)
    for k in range(count):
        i = maybe[k]
        keys[k] = np.inf
        if ways.kind[i] == GATE and side(ways, i, x, y) > -IN_LINE:
            continue
        dx = ways.xy[i, 0] - x
        dy = ways.xy[i, 1] - y
        # Of nodes in one line the farther goes first, whatever rounding says.
        keys[k] = np.sqrt(dx * dx + dy * dy) + to_go[i] * (1.0 + 1e-6)
    for k in range(count, count + AT_ONCE):
        keys[k] = np.inf
    for _ in range(min(tries, count)):
        at = place_of_least(keys, count)
        if keys[at] == np.inf:
            break
        keys[at] = np.inf
        i = maybe[at]
        if in_view(sight, ways, x, y, i, ways.xy[i, 0], ways.xy[i, 1], clearance, own):
            return i
        if ways.kind[i] != CORNER and nearest_serves(
            sight, ways, x, y, i, after[i], clearance, own
        ):
            return i
    return -1


@inlined()
def _nearest_unwalled(
    sight: Sight,
    ways: Ways,
    x: float,
    y: float,
    to_go: NDArray[np.float64],
    maybe: NDArray[np.int64],
) -> int:
    """The nearest node with a route and no wall before it, -1 if there is none.

    It is for people in a gap that is too narrow, or pressed against a wall, who have no node in
    view at all.
    """
    least = np.inf
    node = -1
    for i in maybe:
        if in_view(sight, ways, x, y, i, ways.xy[i, 0], ways.xy[i, 1], 0.0, np.inf):
            return -1
        away = np.hypot(ways.xy[i, 0] - x, ways.xy[i, 1] - y)
        if (
            away < least
            and np.isfinite(to_go[i])
            and unwalled(sight, x, y, ways.xy[i, 0], ways.xy[i, 1])
        ):
            least = away
            node = i
    return node


@internal()
def _aim_at(
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
        px, py = past_corner(sight, ways, x, y, ways.xy[node, 0], ways.xy[node, 1], after[node])
    else:
        leaves = ways.kind[node] == EXIT
        if after[node] < 0:
            length = min(length, away)
        px, py = _beyond(
            sight, ways, x, y, qx, qy, ways.normal[node, 0], ways.normal[node, 1], leaves
        )
    gate = _gate_on_the_way(ways, x, y, px, py)
    if gate >= 0 and gate != opening:
        opening = gate
        px, py = _through(sight, ways, x, y, px, py, gate, own)
        corner = -1
    return length, opening, px, py, corner


@internal()
def past_corner(
    sight: Sight, ways: Ways, x: float, y: float, nx: float, ny: float, after: int
) -> tuple[float, float]:
    """The target at corner (nx, ny): straight past it, as far as the next node stays in view.

    Somebody who aimed at the corner itself would slow down to stop on it, since every step beyond
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

    The more oblique the line, the nearer the target: somebody who comes along the wall would get
    closer to a far target by walking past the door. With the square of the cosine, those who come
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
