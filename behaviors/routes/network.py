"""The gates and exits of a floor plan, and the ways between them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from mesa_mobility.behaviors.exits.quickest_exit import people_a_second
from numpy.typing import NDArray

from mesa_mobility import FloorPlan
from mesa_mobility.floorplan import lines_of_sight

if TYPE_CHECKING:
    import networkx as nx

# Metres by which a way through a gate may be longer for the gate still to lie on it.
_ON_THE_WAY = 0.1

# Metres from walls at which people see along them.
_CLEAR = 0.1

# Metres by which somebody must stand before a gate to cross it.
_BEFORE = 0.01


class Network:
    """Lengths between gates and exits, each gate once for either direction in which it is crossed.

    Args:
        graph: the route graph of the plan as it is now.
        plan: the floor plan.

    Attributes:
        graph: the route graph.
        names: (g,) of the gates and exits.
        flows: (g,) people a second who pass each.
        middles: (g, 2) their middles, metres.
        number: (o,) which of these each opening is: a gate in one direction, or an exit.
    """

    def __init__(self, graph: nx.DiGraph, plan: FloorPlan) -> None:
        import networkx as nx

        self.graph = graph
        self._plan = plan
        openings: dict[tuple[str, tuple[float, float]], list[int]] = {}
        for node, data in graph.nodes(data=True):
            if data["opening"]:
                openings.setdefault((data["opening"], data["direction"]), []).append(node)
        self.names = list(dict.fromkeys(name for name, _ in openings))
        known = [plan.gate(name) for name in self.names]
        self.flows = people_a_second([each.length for each in known])
        self.middles = np.array([np.add(each.a, each.b) / 2.0 for each in known]).reshape(-1, 2)
        self.number = np.array([self.names.index(name) for name, _ in openings], dtype=np.int64)
        exits = {each.name for each in plan.exits}
        self._leaves = np.array([name in exits for name, _ in openings], dtype=np.bool_)
        self._places = np.array([xy for _, xy in graph.nodes(data="position")]).reshape(-1, 2)
        self._ahead = np.array(
            [way or (0.0, 0.0) for _, way in graph.nodes(data="direction")]
        ).reshape(-1, 2)
        self._from_nodes = np.full((len(graph), len(openings)), np.inf)
        backwards = graph.reverse(copy=False)
        for number, nodes in enumerate(openings.values()):
            for node, length in nx.multi_source_dijkstra_path_length(backwards, set(nodes)).items():
                self._from_nodes[node, number] = length
        self._lengths = np.array(
            [self._from_nodes[nodes].min(axis=0) for nodes in openings.values()]
        ).reshape(len(openings), len(openings))
        np.fill_diagonal(self._lengths, np.inf)
        self._lengths[self._leaves] = np.inf
        self._lengths = self._next_alone(self._lengths)

    def _next_alone(self, lengths: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n, o) the same lengths, but inf for openings behind another one on the way."""
        through = np.full(lengths.shape, np.inf)
        for number, onward in enumerate(self._lengths):
            through = np.minimum(through, lengths[:, number, None] + onward)
        return np.where(through <= lengths + _ON_THE_WAY, np.inf, lengths)

    def distances(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """(k, o) metres from (k, 2) points to each opening that may come next; inf for others."""
        k, n = len(points), len(self._places)
        starts, ends = points.repeat(n, axis=0), np.tile(self._places, (k, 1))
        way = (ends - starts).reshape(k, n, 2)
        seen = lines_of_sight(self._plan, starts, ends, _CLEAR).reshape(k, n)
        crossed = self._ahead.any(axis=1)
        seen &= ~crossed | ((way * self._ahead).sum(axis=2) > _BEFORE)
        first = np.where(seen, np.hypot(way[:, :, 0], way[:, :, 1]), np.inf)
        found = np.full((k, len(self.number)), np.inf)
        for node in np.flatnonzero(seen.any(axis=0)):
            found = np.minimum(found, first[:, node, None] + self._from_nodes[node])
        return self._next_alone(found)

    def onward(
        self, exits: Sequence[str], queues: list[list[float]], speed: float
    ) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        """(o,) seconds from each opening to the exits, and the opening after it, -1 for none.

        Args:
            exits: their names.
            queues: for each gate and exit, as many numbers as people head for it.
            speed: m/s.
        """
        mine = np.array([self.names[number] in exits for number in self.number], dtype=np.bool_)
        rest = np.where(mine, 0.0, np.inf)
        waits = np.array([len(queue) for queue in queues]) / self.flows
        steps = self._lengths / speed + waits[self.number]
        following = np.full(len(rest), -1, dtype=np.int64)
        for _ in range(len(rest)):
            times = steps + rest
            better = times.min(axis=1) < rest
            if not better.any():
                break
            following[better] = times.argmin(axis=1)[better]
            rest = np.minimum(rest, times.min(axis=1))
        return rest, following

    def way(self, first: int, following: NDArray[np.int64]) -> list[str]:
        """Names of the gates of the way that begins with an opening."""
        gates = []
        while not self._leaves[first]:
            gates.append(self.names[self.number[first]])
            first = int(following[first])
        return gates
