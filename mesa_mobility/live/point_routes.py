"""Routes to places that somebody names while a model runs.

The routes between the corners, gates and exits of a plan are searched for once. A place is joined
to them by the views that it has of them, so another one costs little, however many there are.

A ``Router`` leads to points too, and this module takes corners, gates and their views from one. But
a router keeps each point for good, as a node by which other routes may lead, and looks for all
views anew with each: right for the places of routes, which are few and known early. Places named by
hand come one after the other, and with 80 of them a step of the doorway took 0.33 s.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

from mesa_mobility.floorplan import FloorPlan, Router, lines_of_sight
from mesa_mobility.floorplan.routing.route_nodes import VIEW_SHARE

_PAST = (0.4, 0.2)
"""Metres past a corner or gate at which people aim: the first that is in view from it."""


KEPT = 1000
"""Places whose routes are kept; they are searched for again after more of them."""


class _Nodes(NamedTuple):
    """Places where routes bend.

    Lines lead both ways between nodes in view of each other, and from sheet to sheet of a building
    as people walk or ride.

    Attributes:
        xy: (n, 2) metres.
        gate: (n,) number of the gate at which each is, in ``FloorPlan.openings()``; -1 for corners.
        start: (m,) first node of each line.
        end: (m,) last node of each line.
        length: (m,) as which each line counts, metres.
    """

    xy: NDArray[np.float64]
    gate: NDArray[np.int64]
    start: NDArray[np.int64]
    end: NDArray[np.int64]
    length: NDArray[np.float64]


class Aims(NamedTuple):
    """Where n people aim who go to a place.

    Attributes:
        points: (n, 2) metres; a person without a way gets their own position.
        gates: (n,) the gate aimed through, as its number in ``FloorPlan.openings()``; -1 for none.
        lengths: (n,) of the routes, metres; inf where there is none.
    """

    points: NDArray[np.float64]
    gates: NDArray[np.int64]
    lengths: NDArray[np.float64]


class PointRoutes:
    """Shortest routes to places on a floor plan, up to date with its doors and obstacles.

    Args:
        plan: the floor plan.
        clearance: distance that routes keep from walls, metres.
        climbs: whether routes are for people who use stairs; see ``Router``.
    """

    def __init__(self, plan: FloorPlan, clearance: float, *, climbs: bool = True) -> None:
        self._plan = plan
        self._clearance, self._climbs = clearance, climbs
        self._version = -1
        self._nodes: _Nodes
        self._lengths: dict[tuple[float, float], NDArray[np.float64]] = {}

    def targets(self, positions: NDArray[np.float64], place: tuple[float, float]) -> Aims:
        """Where people aim who go to a place.

        Args:
            positions: (n, 2) metres.
            place: metres.
        """
        to_go = self._lengths_to(place)
        points, lengths = positions.copy(), np.full(len(positions), np.inf)
        gates = np.full(len(positions), -1)
        direct = self._sees(positions, np.broadcast_to(place, positions.shape))
        points[direct] = place
        lengths[direct] = _away(positions[direct], np.array(place))
        rest = np.flatnonzero(~direct)
        # People who would go on from one place, such as the door of a lift, have one way.
        starts, numbers = np.unique(positions[rest], axis=0, return_inverse=True)
        for number, start in enumerate(starts):
            own = rest[numbers.reshape(-1) == number]
            points[own], gates[own], lengths[own] = self._by_node(start, to_go)
        return Aims(points, gates, lengths)

    def _by_node(
        self, position: NDArray[np.float64], to_go: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], int, float]:
        """Target, gate and length of a route that bends."""
        xy = self._nodes.xy
        usable = np.flatnonzero(np.isfinite(to_go))
        through = _away(xy[usable], position) + to_go[usable]
        order = usable[np.argsort(through, kind="stable")]
        start = np.broadcast_to(position, (len(order), 2))
        for clearance in (VIEW_SHARE * self._clearance, 0.0):
            seen = lines_of_sight(self._plan, start, xy[order], clearance)
            if seen.any():
                node = int(order[np.argmax(seen)])
                gate, length = int(self._nodes.gate[node]), float(through[usable == node][0])
                return self._past(position, node), gate, length
        return position, -1, np.inf

    def _past(self, position: NDArray[np.float64], node: int) -> NDArray[np.float64]:
        """A target past a corner or gate; at the corner itself people would slow down."""
        xy = self._nodes.xy[node]
        on = (xy - position) / max(float(_away(xy, position)), 1e-9)
        beyond = xy + np.array(_PAST)[:, None] * on
        clear = self._sees(np.broadcast_to(xy, beyond.shape), beyond)
        target: NDArray[np.float64] = beyond[np.argmax(clear)] if clear.any() else xy
        return target

    def _lengths_to(self, place: tuple[float, float]) -> NDArray[np.float64]:
        """(nodes,) length of the route from each node to a place, metres."""
        if self._version != self._plan.version:
            self._version = self._plan.version
            self._nodes = self._look_up()
            self._lengths.clear()
        if place not in self._lengths:
            if len(self._lengths) >= KEPT:
                self._lengths.clear()
            self._lengths[place] = self._search(place)
        return self._lengths[place]

    def _search(self, place: tuple[float, float]) -> NDArray[np.float64]:
        xy, _, start, end, length = self._nodes
        if len(xy) == 0:
            return np.empty(0)
        last = np.flatnonzero(self._sees(xy, np.broadcast_to(place, xy.shape)))
        lines = np.maximum(_away(xy[last], np.array(place)), 1e-9)
        # The place is one more node, from which all routes are followed.
        n = len(xy)
        begin, to = np.concatenate([end, np.full(len(last), n)]), np.concatenate([start, last])
        joined = csr_matrix((np.concatenate([length, lines]), (begin, to)), shape=(n + 1, n + 1))
        found: NDArray[np.float64] = dijkstra(joined, indices=n)[:n]
        return found

    def _look_up(self) -> _Nodes:
        """The nodes but exits, by which nobody is to leave on the way."""
        plan = self._plan
        graph = Router(plan, clearance=self._clearance, climbs=self._climbs).graph
        kept = [node for node, kind in graph.nodes(data="kind") if kind != "exit"]
        at = {node: k for k, node in enumerate(kept)}
        xy = np.array([graph.nodes[n]["position"] for n in kept]).reshape(-1, 2)
        names = [graph.nodes[n]["opening"] for n in kept]
        numbers = {opening.name: number for number, opening in enumerate(plan.openings())}
        gates = np.array([numbers.get(name, -1) for name in names], dtype=np.int64)
        links = [link for seam in plan.seams for link in seam.links]
        links += [link for shaft in plan.shafts for link in shaft.links]
        across = {(link.leaving, link.arriving) for link in links}
        # A gate's nodes lead one way each; together they are crossed both ways.
        lengths: dict[tuple[int, int], float] = {}
        for one, other, length in graph.edges(data="weight"):
            if one in at and other in at:
                a, b = at[one], at[other]
                lengths[a, b] = length
                if (names[a], names[b]) not in across:
                    lengths[b, a] = length
        edges = sorted(lengths)
        start, end = np.array(edges, dtype=np.int64).reshape(-1, 2).T
        length = np.array([lengths[edge] for edge in edges], dtype=np.float64)
        return _Nodes(xy, gates, start, end, np.maximum(length, 1e-9))

    def _sees(self, one: NDArray[np.float64], other: NDArray[np.float64]) -> NDArray[np.bool_]:
        return lines_of_sight(self._plan, one, other, VIEW_SHARE * self._clearance)


def _away(one: NDArray[np.float64], other: NDArray[np.float64]) -> NDArray[np.float64]:
    distances: NDArray[np.float64] = np.hypot(one[..., 0] - other[0], one[..., 1] - other[1])
    return distances
