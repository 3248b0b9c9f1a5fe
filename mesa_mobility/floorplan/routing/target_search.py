"""Compiled search for the node that each person aims at first."""

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import inlined, internal, kept
from mesa_mobility.compiled.simd import AT_ONCE, place_of_least
from mesa_mobility.floorplan.routing.opening_points import nearest_serves
from mesa_mobility.floorplan.routing.route_graph import IN_LINE, Ways, in_view, side
from mesa_mobility.floorplan.routing.route_nodes import CORNER, GATE
from mesa_mobility.floorplan.routing.target_cache import Found, keep, recall
from mesa_mobility.floorplan.routing.target_points import aim_at
from mesa_mobility.floorplan.routing.visibility_cache import (
    Views,
    has_room,
    is_known,
    nodes_maybe_in_view,
)
from mesa_mobility.floorplan.walls.line_of_sight import unwalled
from mesa_mobility.floorplan.walls.sight import Sight
from mesa_mobility.floorplan.walls.wall_distances import wall_distance

# Nodes tried in order of length before the nodes that may be in view are computed.
_TRIES = np.int64(3)

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
    table: tuple[NDArray[np.float64], NDArray[np.int64]],
    learn: bool,
    found: Found,
) -> int:
    """Write the targets of people at (n, 2) `positions` whose gate is `UNSEEN` to `found`.

    See `Router.targets`. For every destination and node, `table` has the route length in metres
    and the next node of the route (-1 where it ends). A thread that may
    `learn` computes new views and caches targets in `cache`; no other thread may read them at the
    time. Without `learn`, or without room for views, people who need a view are left `UNSEEN`.
    Returns one of the results above.
    """
    distances, follow = table
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
        if found.gates[person] != UNSEEN:
            if learn:
                keep(cache, x, y, number, person, found)
            continue
        if recall(cache, x, y, number, person, found):
            continue
        to_go = distances[number]
        after = follow[number]
        routes = (to_go, after)
        own = wall_distance(sight, x, y, ways.view_clearance)
        view = ways.view_clearance
        node = -1
        # Computing the view from a square takes long, and serves all people who pass.
        hidden_known = is_known(views, x, y)
        if not hidden_known:
            node = _first_in_view(sight, ways, (x, y, own), routes, view, everything, keys, _TRIES)
        if node < 0 and not (hidden_known or (learn and has_room(views))):
            outcome = SOME_UNSEEN
            continue
        if node < 0:
            maybe = seen[: nodes_maybe_in_view(sight, views, ways.xy, x, y, seen)]
            for clearance in (view, 0.0):
                if node < 0:
                    node = _first_in_view(
                        sight, ways, (x, y, own), routes, clearance, maybe, keys, nodes
                    )
            if node < 0:
                node = _nearest_unwalled(sight, ways, x, y, to_go, maybe)
        found.points[person, 0], found.points[person, 1] = x, y
        found.gates[person], found.lengths[person] = -1, np.inf
        found.corners[person, 0] = found.corners[person, 1] = -1
        if node >= 0:
            (
                found.lengths[person],
                found.gates[person],
                found.points[person, 0],
                found.points[person, 1],
                corner,
            ) = aim_at(sight, ways, x, y, node, to_go, after, own)
            if corner >= 0:
                found.corners[person, 0] = corner
                found.corners[person, 1] = after[corner]
        if learn:
            keep(cache, x, y, number, person, found)
    return outcome


@internal()
def _first_in_view(
    sight: Sight,
    ways: Ways,
    person: tuple[float, float, float],
    routes: tuple[NDArray[np.float64], NDArray[np.int64]],
    clearance: float,
    maybe: NDArray[np.int64],
    keys: NDArray[np.float64],
    tries: int,
) -> int:
    """The node in view with the shortest route through it, -1 if none of the first `tries` is.

    A `person` is x, y and the distance to the nearest wall; `routes` are the length and the next
    node from every node.
    `maybe` lists the nodes to try; `keys` is workspace, with room for `AT_ONCE` more.
    """
    (x, y, own), (to_go, after) = person, routes
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
