"""Consecutive numbers for the corners of several routers.

Bodies of each core radius have routes of their own, which bend at different places around the same
corner of a wall.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from mesa_mobility.floorplan import Router

# Two bodies pass the same edge at places that are no farther apart than this multiple of the
# difference of their clearances (1.41 at a right angle), plus a little.
_APART = 1.6
_A_LITTLE = 0.01


class Corners:
    """Numbers of the nodes of several routers, up to date with their floor plan.

    Args:
        routers: the routers, of one plan, each with its own clearance.
    """

    def __init__(self, routers: Sequence[Router]) -> None:
        self._routers = routers
        self._graphs: list[object] = []
        self._bounds = np.zeros(len(routers) + 1, dtype=np.int64)
        self._shared: NDArray[np.int64] = np.empty(0, dtype=np.int64)

    @property
    def count(self) -> int:
        """Number of nodes of all routers."""
        return int(self._now()[-1])

    @property
    def firsts(self) -> NDArray[np.int64]:
        """(routers,) number of each router's first node."""
        return self._now()[:-1]

    def router_of(self, numbers: NDArray[np.int64]) -> NDArray[np.int64]:
        """(n,) index of the router to which each node belongs, -1 for numbers below 0."""
        found: NDArray[np.int64] = np.searchsorted(self._now(), numbers, side="right") - 1
        return found

    def of_one_router(self, corners: NDArray[np.int64]) -> bool:
        """Whether both of each of (n, 2) corners belong to the same router."""
        if len(self._routers) == 1:
            return True
        corner, following = self.router_of(corners[:, 0]), self.router_of(corners[:, 1])
        return bool(((corner < 0) | (corner == following)).all())

    def shared(self, corners: NDArray[np.int64]) -> NDArray[np.int64]:
        """(n, 2) the same corners, with one number for all routers' corners around one edge."""
        if len(self._routers) == 1:
            return corners
        self._now()
        return np.where(corners >= 0, self._shared[corners], -1)

    def _now(self) -> NDArray[np.int64]:
        graphs = [router.graph for router in self._routers]
        if not self._graphs or any(
            new is not old for new, old in zip(graphs, self._graphs, strict=True)
        ):
            self._graphs = list(graphs)
            self._bounds = np.cumsum([0, *(graph.number_of_nodes() for graph in graphs)])
            if len(graphs) > 1:
                self._shared = self._share([_places(router) for router in self._routers])
        return self._bounds

    def _share(self, places: list[NDArray[np.float64]]) -> NDArray[np.int64]:
        """For each node, the first router's corner around the same edge, or the node itself.

        Args:
            places: for each router, (k, 2) positions of its nodes, metres; inf where they are no
                corners.
        """
        shared = np.arange(self._bounds[-1])
        first = np.flatnonzero(np.isfinite(places[0][:, 0]))
        if len(first) == 0:
            return shared
        tree = cKDTree(places[0][first])
        for number in range(1, len(places)):
            corners = np.flatnonzero(np.isfinite(places[number][:, 0]))
            gap = abs(self._routers[number].clearance - self._routers[0].clearance)
            away, nearest = tree.query(places[number][corners])
            near = away <= _APART * gap + _A_LITTLE
            shared[self._bounds[number] + corners[near]] = first[nearest[near]]
        return shared


def _places(router: Router) -> NDArray[np.float64]:
    nodes = router.graph.nodes(data=True)
    return np.array(
        [
            node["position"] if node["kind"] == "corner" else (np.inf, np.inf)
            for _, node in sorted(nodes)
        ],
        dtype=np.float64,
    ).reshape(-1, 2)
