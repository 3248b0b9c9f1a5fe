"""The route graph as compiled functions take it: who follows whom, and what is in view."""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from mesa_mobility.floorplan.nodes import EXIT, GATE
from mesa_mobility.floorplan.sight import Sight, clear_line
from mesa_mobility.jit import lean

# Whoever is this near to a gate's line stands in it and has passed it (metres).
IN_LINE = 0.01


class Ways(NamedTuple):
    """A route graph as the compiled functions take it; see `Nodes` for the node arrays.

    Of every gate and exit, in the order of `FloorPlan.openings()`: `lines`
    (openings, 4) its line, `ends` (openings, 4) the line from its first to its last node,
    `passable` (openings,) whether it has nodes, `curtains` (openings,) its number
    among the walls of the sight, -1 for gates.
    """

    kind: NDArray[np.int64]
    xy: NDArray[np.float64]
    opening: NDArray[np.int64]
    normal: NDArray[np.float64]
    lines: NDArray[np.float64]
    ends: NDArray[np.float64]
    passable: NDArray[np.bool_]
    curtains: NDArray[np.int64]
    view_clearance: float
    beyond: float


@lean()
def side(ways: Ways, node: int, x: float, y: float) -> float:
    """How far (x, y) is past the line of a gate or exit node, in its crossing direction."""
    return (x - ways.xy[node, 0]) * ways.normal[node, 0] + (y - ways.xy[node, 1]) * ways.normal[
        node, 1
    ]


@lean()
def _curtain(ways: Ways, node: int) -> int:
    return ways.curtains[ways.opening[node]] if ways.kind[node] == EXIT else -1


@njit(cache=True)
def edges_in_view(sight: Sight, ways: Ways, clearance: float) -> list[tuple[int, int]]:
    """All directed edges (from, to) between nodes in view of each other, as a list of pairs."""
    n = len(ways.kind)
    edges = [(0, 0) for _ in range(0)]
    for i in range(n):
        if ways.kind[i] == EXIT:
            continue
        for j in range(n):
            # Between nodes that can be walked both ways, one view serves both.
            both = ways.kind[i] != EXIT and ways.kind[j] != EXIT
            if i == j or (both and j < i):
                continue
            there = _may_follow(ways, i, j)
            back = both and _may_follow(ways, j, i)
            if not there and not back:
                continue
            ax, ay = ways.xy[i]
            bx, by = ways.xy[j]
            if clear_line(sight, ax, ay, bx, by, clearance, np.inf, _curtain(ways, j)):
                if there:
                    edges.append((i, j))
                if back:
                    edges.append((j, i))
    return edges


@lean()
def _may_follow(ways: Ways, i: int, j: int) -> bool:
    """Whether j can come after i as far as the directions of their gates go."""
    if ways.kind[i] == GATE and side(ways, i, ways.xy[j, 0], ways.xy[j, 1]) < IN_LINE:
        return False
    if ways.kind[j] == GATE or ways.kind[j] == EXIT:
        return side(ways, j, ways.xy[i, 0], ways.xy[i, 1]) < -IN_LINE
    return True


@lean()
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
    """Whether (qx, qy), the place of a node or another place in the same opening, is in view."""
    return clear_line(sight, x, y, qx, qy, clearance, own, _curtain(ways, node))
