"""The route graph made of its nodes: arrays for compiled functions, a network for Python."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely
from numpy.typing import NDArray

from mesa_mobility.floorplan.floor.boundaries import opening_segments
from mesa_mobility.floorplan.floor.floor import Floor
from mesa_mobility.floorplan.floor.openings import Exit, Gate
from mesa_mobility.floorplan.routing.route_graph import Ways
from mesa_mobility.floorplan.routing.route_nodes import CORNER, VIEW_SHARE, Nodes

if TYPE_CHECKING:
    import networkx as nx

_KIND_NAMES = ("corner", "gate", "exit")

_BESIDE = 1.5
"""A corner of a right angle stands 1.41 clearances from the edge of the wall."""


def ways_of(
    plan: Floor,
    nodes: Nodes,
    links: tuple[NDArray[np.int64], NDArray[np.int64]],
    walls: int,
    clearance: float,
    beyond: float,
) -> Ways:
    """The route graph's nodes and openings, as arrays for compiled functions.

    Args:
        plan: the floor plan.
        nodes: the nodes of the graph.
        links: (k,) nodes from which routes lead to another sheet, and (k,) those to which.
        walls: number of walls of the plan, which the lines of open exits follow in the sight.
        clearance: distance in metres that routes keep from walls.
        beyond: how far behind a gate or exit the target lies, metres.
    """
    openings = plan.openings()
    curtains = np.full(len(openings), -1, dtype=np.int64)
    number_of = {opening.name: number for number, opening in enumerate(openings)}
    for k, opening in enumerate(plan.open_exits()):
        curtains[number_of[opening.name]] = walls + k
    lines = opening_segments(openings)
    ends, passable = lines.copy(), np.zeros(len(openings), dtype=np.bool_)
    for number in np.unique(nodes.opening[nodes.opening >= 0]):
        places = nodes.xy[nodes.opening == number]
        along = np.argsort(((places - lines[number, :2]) ** 2).sum(axis=1), kind="stable")
        ends[number] = *places[along[0]], *places[along[-1]]
        passable[number] = True
    return Ways(
        nodes.kind,
        nodes.xy,
        nodes.opening,
        nodes.only,
        nodes.normal,
        lines,
        ends,
        passable,
        curtains,
        _flight_corners(plan, nodes, clearance),
        _linked(nodes, *links),
        VIEW_SHARE * clearance,
        beyond,
    )


def _linked(
    nodes: Nodes, leaving: NDArray[np.int64], arriving: NDArray[np.int64]
) -> NDArray[np.int64]:
    """(nodes,) the node of the same place on another sheet; -1 for none, and in doors of lifts,
    behind which people turn round."""
    linked = np.full(len(nodes.kind), -1, dtype=np.int64)
    onward = (nodes.normal[leaving] * nodes.normal[arriving]).sum(axis=1) > 0.0
    linked[leaving[onward]] = arriving[onward]
    return linked


def _flight_corners(plan: Floor, nodes: Nodes, clearance: float) -> NDArray[np.int64]:
    """(k,) the corners beside flights of stairs: at newels, and where a flight begins in a wall."""
    corners = np.flatnonzero(nodes.kind == CORNER)
    flights = shapely.union_all([each.polygon for each in plan.zones if each.is_stair])
    near = shapely.dwithin(flights, shapely.points(nodes.xy[corners]), _BESIDE * clearance)
    return corners[near]


def network(
    nodes: Nodes,
    edges: NDArray[np.int64],
    lengths: NDArray[np.float64],
    openings: tuple[Gate | Exit, ...],
) -> nx.DiGraph:
    """The route graph for Python, as ``Router.graph`` describes it.

    Args:
        nodes: its nodes.
        edges: (k, 2) from and to which node.
        lengths: (k,) metres.
        openings: the gates and exits that nodes number.
    """
    import networkx as nx

    graph = nx.DiGraph()
    for i, (x, y) in enumerate(nodes.xy.tolist()):
        number = int(nodes.opening[i])
        graph.add_node(
            i,
            kind=_KIND_NAMES[nodes.kind[i]],
            position=(x, y),
            opening=openings[number].name if number >= 0 else None,
            direction=tuple(nodes.normal[i].tolist()) if number >= 0 else None,
        )
    pairs = zip(*edges.T.tolist(), lengths.tolist(), strict=True)
    graph.add_weighted_edges_from(pairs)
    return graph
