"""The route graph for compiled functions: edges between nodes in view."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import internal, kept
from mesa_mobility.floorplan.routing.route_nodes import EXIT, GATE
from mesa_mobility.floorplan.walls.line_of_sight import clear_line
from mesa_mobility.floorplan.walls.sight import Sight

# People this near to a gate's line stand in it and count as past it (metres).
IN_LINE = 0.01


class Ways(NamedTuple):
    """A route graph for compiled functions; see `Nodes` for the node arrays.

    For every gate and exit, in the order of `FloorPlan.openings()`: `lines`
    (openings, 4) its line, `ends` (openings, 4) the line from its first to its last node,
    `passable` (openings,) whether it has nodes, `curtains` (openings,) its number
    among the walls of the sight, -1 for gates. `flight_corners` are the corners beside flights of
    stairs, in order. `linked` (nodes,) are the nodes of gates of seams at which routes go on on
    another sheet, -1 for all others.
    """

    kind: NDArray[np.int64]
    xy: NDArray[np.float64]
    opening: NDArray[np.int64]
    only: NDArray[np.int64]
    normal: NDArray[np.float64]
    lines: NDArray[np.float64]
    ends: NDArray[np.float64]
    passable: NDArray[np.bool_]
    curtains: NDArray[np.int64]
    flight_corners: NDArray[np.int64]
    linked: NDArray[np.int64]
    view_clearance: float
    beyond: float


@internal()
def side(ways: Ways, node: int, x: float, y: float) -> float:
    """Distance of (x, y) past the line of a gate or exit node, in its crossing direction."""
    return (x - ways.xy[node, 0]) * ways.normal[node, 0] + (y - ways.xy[node, 1]) * ways.normal[
        node, 1
    ]


@internal()
def _curtain(ways: Ways, node: int) -> int:
    return ways.curtains[ways.opening[node]] if ways.kind[node] == EXIT else -1


@kept()
def edges_in_view(sight: Sight, ways: Ways, clearance: float) -> NDArray[np.int64]:
    """All directed edges between nodes in view of each other, as (k, 2) start and end nodes."""
    n = len(ways.kind)
    edges = [(0, 0) for _ in range(0)]
    for i in range(n):
        # Ends of routes, and nodes that lead to one exit only, are pairs of the others.
        if ways.kind[i] == EXIT or ways.only[i] >= 0:
            continue
        for j in range(n):
            # One view serves both directions.
            through = ways.kind[j] != EXIT and ways.only[j] < 0
            if i == j or (through and j < i):
                continue
            there = _may_follow(ways, i, j)
            back = through and _may_follow(ways, j, i)
            if (there or back) and _in_view(sight, ways, i, j, clearance):
                if there:
                    edges.append((i, j))
                if back:
                    edges.append((j, i))
    for j in range(n):
        if ways.kind[j] == EXIT:
            for i in range(n):
                own = ways.only[i] == ways.opening[j] and _may_follow(ways, i, j)
                if own and _in_view(sight, ways, i, j, clearance):
                    edges.append((i, j))
    found = np.empty((len(edges), 2), dtype=np.int64)
    for k, (i, j) in enumerate(edges):
        found[k, 0], found[k, 1] = i, j
    return found


@internal()
def _in_view(sight: Sight, ways: Ways, i: int, j: int, clearance: float) -> bool:
    ax, ay = ways.xy[i]
    bx, by = ways.xy[j]
    return clear_line(sight, ax, ay, bx, by, clearance, np.inf, _curtain(ways, j))


@internal()
def _may_follow(ways: Ways, i: int, j: int) -> bool:
    """Whether the directions of their gates let j follow i."""
    if ways.kind[i] == GATE and side(ways, i, ways.xy[j, 0], ways.xy[j, 1]) < IN_LINE:
        return False
    if ways.kind[j] == GATE or ways.kind[j] == EXIT:
        return side(ways, j, ways.xy[i, 0], ways.xy[i, 1]) < -IN_LINE
    return True


@internal()
def in_view(
    sight: Sight,
    ways: Ways,
    x: float,
    y: float,
    node: int,
    qx: float,
    qy: float,
    clearance: float,
    own: float,
) -> bool:
    """Whether (qx, qy), the position of a node or another point in its opening, is in view."""
    return clear_line(sight, x, y, qx, qy, clearance, own, _curtain(ways, node))
