"""The gates and exits of a floor plan, and the ways between them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from mesa_mobility.behaviors.routes.flows import flows_through
from numpy.typing import NDArray
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

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


class Onward(NamedTuple):
    """The ways from o openings to some exits.

    Attributes:
        metres: (o,) their lengths; inf without a way.
        seconds: (o,) for which people wait on them in queues.
        following: (o,) the opening after each, -1 for none.
    """

    metres: NDArray[np.float64]
    seconds: NDArray[np.float64]
    following: NDArray[np.int64]


class Network:
    """Lengths between gates and exits, each gate once for either direction in which it is crossed.

    Of a gate that is drawn on two sheets the drawing on its own sheet counts, and of the doors of
    lifts the way in: where riders get out depends on where they go next.

    Args:
        graph: the routes of people with one kind of body, as the plan is now.
        plan: the floor plan.

    Attributes:
        graph: the routes.
        number: (o,) the queue before each opening, a gate in one direction or an exit: its number
            in ``FloorPlan.openings()``, and before all doors of a lift that of the first.
        flows: (o,) people a second who pass each.
    """

    def __init__(self, graph: nx.DiGraph, plan: FloorPlan) -> None:
        import networkx as nx

        self.graph = graph
        self._plan = plan
        openings: dict[tuple[str, tuple[float, float]], list[int]] = {}
        doors = {gate.name: shaft for shaft in plan.shafts for gate in shaft.gates}
        inwards: list[int] = []
        for node, data in graph.nodes(data=True):
            name, direction = data["opening"], data["direction"]
            if not name or plan.drawings(name)[0].name != name:
                continue
            if name in doors:
                if float(np.dot(doors[name].into(), direction)) < 0.0:
                    continue
                inwards.append(node)
            openings.setdefault((name, direction), []).append(node)
        self._names = [name for name, _ in openings]
        numbers = queue_numbers(plan)
        self.number = np.array([numbers[name] for name in self._names], dtype=np.int64)
        self.flows = flows_through(plan, self._names, [way for _, way in openings])
        exits = {each.name for each in plan.exits}
        self._leaves = np.array([name in exits for name in self._names], dtype=np.bool_)
        self._places = np.array([xy for _, xy in graph.nodes(data="position")]).reshape(-1, 2)
        self._ahead = np.array(
            [way or (0.0, 0.0) for _, way in graph.nodes(data="direction")]
        ).reshape(-1, 2)
        self._from_nodes = np.full((len(graph), len(openings)), np.inf)
        # Nobody turns round in a car: from its door routes lead to other doors alone.
        within = [
            (node, other)
            for node in inwards
            for other in graph.successors(node)
            if graph.nodes[other]["opening"] not in doors
        ]
        ways = nx.restricted_view(graph, [], within)
        if openings:  # otherwise the graph may be empty
            edges = np.array(ways.edges(), dtype=np.int64).reshape(-1, 2)
            lengths = [length for _, _, length in ways.edges(data="weight")]
            shape = (len(graph), len(graph))
            backwards = csr_matrix((lengths, edges.T[::-1]), shape=shape)
        for number, nodes in enumerate(openings.values()):
            self._from_nodes[:, number] = dijkstra(backwards, indices=nodes, min_only=True)
        self._lengths = np.array(
            [self._from_nodes[nodes].min(axis=0) for nodes in openings.values()]
        ).reshape(len(openings), len(openings))
        np.fill_diagonal(self._lengths, np.inf)
        self._lengths[self._leaves] = np.inf
        self._lengths = self._next_alone(self._lengths)
        # Nobody who has passed a gate goes straight back through it.
        names = np.array(self._names)
        self._onward = np.where(names[:, None] == names, np.inf, self._lengths)

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

    def onward(self, exits: Sequence[str], queued: NDArray[np.int64], speed: float) -> Onward:
        """The quickest ways from each opening to the exits.

        Args:
            exits: their names.
            queued: for each queue the number of people in it.
            speed: at which they are the quickest, m/s.
        """
        mine = np.array([name in exits for name in self._names], dtype=np.bool_)
        rest = np.where(mine, 0.0, np.inf)
        waits = queued[self.number] / self.flows
        steps = self._onward / speed + waits
        following = np.full(len(rest), -1, dtype=np.int64)
        for _ in range(len(rest)):
            times = steps + rest
            better = times.min(axis=1) < rest
            if not better.any():
                break
            following[better] = times.argmin(axis=1)[better]
            rest = np.minimum(rest, times.min(axis=1))
        metres, seconds = np.where(mine, 0.0, np.inf), np.where(mine, 0.0, np.inf)
        for each in np.argsort(rest, kind="stable"):
            after = following[each]
            if after >= 0:
                metres[each] = self._onward[each, after] + metres[after]
                seconds[each] = waits[after] + seconds[after]
        return Onward(metres, seconds, following)

    def way(self, first: int, following: NDArray[np.int64]) -> list[str]:
        """Names of the gates of the way that begins with an opening."""
        gates = []
        while not self._leaves[first]:
            gates.append(self._names[first])
            first = int(following[first])
        return gates


def queue_numbers(plan: FloorPlan) -> dict[str, int]:
    """The number of the queue before each gate and exit, by its name.

    The drawings of a gate have one queue, and so have all doors of a lift: one car serves them.
    """
    numbers = {opening.name: number for number, opening in enumerate(plan.openings())}
    first = {gate.name: each.gates[0].name for each in plan.shafts for gate in each.gates}
    return {name: numbers[first.get(name, plan.drawings(name)[0].name)] for name in numbers}
