"""Edges of the route graph that lead from one sheet of a floor plan to another."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from mesa_mobility.floorplan.floor.openings import Opening
from mesa_mobility.floorplan.floor.seams import Link
from mesa_mobility.floorplan.routing.route_nodes import Nodes

_APART = 0.01
"""Most metres between a node of a gate and the same node of a gate on another sheet."""

_LEAST = 1e-9
"""Length of such an edge, metres: a sparse matrix has no edges of length 0."""


def sheet_links(
    links: Sequence[Link], openings: Sequence[Opening], nodes: Nodes
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]:
    """Edges from gates on one sheet to gates on another.

    Args:
        links: those of the seams and lifts of a floor plan.
        openings: its gates and exits.
        nodes: the nodes of its route graph.

    Returns:
        (k,) nodes that they leave, (k,) nodes to which they lead, and their (k,) lengths, metres.
    """
    numbers = {opening.name: number for number, opening in enumerate(openings)}
    leaving, arriving = [np.empty(0, np.int64)], [np.empty(0, np.int64)]
    lengths = [np.empty(0)]
    for link in links:
        own, other = (
            np.flatnonzero((nodes.opening == numbers[name]) & (nodes.normal @ direction > 0.5))
            for name, direction in ((link.leaving, link.out), (link.arriving, link.on))
        )
        if len(own) and len(other):
            away, nearest = cKDTree(nodes.xy[other]).query(nodes.xy[own] + link.shift)
            own, other = own[away <= _APART], other[nearest[away <= _APART]]
            leaving.append(own)
            arriving.append(other)
            lengths.append(np.full(len(own), max(link.length, _LEAST)))
    return np.concatenate(leaving), np.concatenate(arriving), np.concatenate(lengths)
