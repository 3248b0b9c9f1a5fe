"""Numbers for the corners of several routers.

Bodies of each core radius have routes of their own, which bend at different places around the same
corner of a wall.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from mesa_mobility.floorplan import Router
from mesa_mobility.floorplan.routing.route_nodes import CORNER, Nodes

# Two bodies pass the same edge at places that are no farther apart than this multiple of the
# difference of their clearances (1.41 at a right angle), plus a little.
_APART = 1.6
_A_LITTLE = 0.01


class Corners:
    """Numbers of the nodes of several routers, up to date with their floor plan.

    Node k of router r has number k * routers + r, whichever of the routers there are.

    Args:
        routers: the routers, of one plan, each with its own clearance; None for those that have
            not been needed yet.
    """

    def __init__(self, routers: Sequence[Router | None]) -> None:
        self._routers = routers
        self._nodes: list[Nodes | None] = []
        self._count = 0
        self._shared: NDArray[np.int64] = np.empty(0, dtype=np.int64)

    @property
    def count(self) -> int:
        """Upper bound of the numbers."""
        self._update()
        return self._count

    def numbers(self, nodes: NDArray[np.int64], router: int) -> NDArray[np.int64]:
        """Numbers of these nodes of a router; -1 for none."""
        return np.where(nodes >= 0, nodes * len(self._routers) + router, -1)

    def nodes(self, numbers: NDArray[np.int64]) -> NDArray[np.int64]:
        """The nodes with these numbers, as their own routers count them; -1 for none."""
        return np.where(numbers >= 0, numbers // len(self._routers), -1)

    def router_of(self, numbers: NDArray[np.int64]) -> NDArray[np.int64]:
        """Index of the router to which each node belongs, -1 for numbers below 0."""
        return np.where(numbers >= 0, numbers % len(self._routers), -1)

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
        self._update()
        return np.where(corners >= 0, self._shared[corners], -1)

    def _update(self) -> None:
        nodes = [None if router is None else router.nodes for router in self._routers]
        if self._nodes and all(new is old for new, old in zip(nodes, self._nodes, strict=True)):
            return
        self._nodes = nodes
        most = max((len(each.kind) for each in nodes if each is not None), default=0)
        self._count = most * len(nodes)
        if len(nodes) > 1:
            self._shared = self._share()

    def _share(self) -> NDArray[np.int64]:
        """For each node, the first router's corner around the same edge, or the node itself."""
        shared = np.arange(self._count)
        first, *others = [each for each in enumerate(self._routers) if each[1] is not None]
        tree, known = None, np.empty(0, dtype=np.int64)
        for number, router in (first, *others):
            assert router is not None
            assert first[1] is not None
            nodes, places = _corners(router)
            if tree is None:
                if len(nodes) == 0:
                    break
                tree, known = cKDTree(places), self.numbers(nodes, number)
                continue
            gap = abs(router.clearance - first[1].clearance)
            away, nearest = tree.query(places)
            near = away <= _APART * gap + _A_LITTLE
            shared[self.numbers(nodes[near], number)] = known[nearest[near]]
        return shared


def _corners(router: Router) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """(k,) the nodes of a router that are corners, and their (k, 2) positions, metres."""
    corners = np.flatnonzero(router.nodes.kind == CORNER)
    return corners, router.nodes.xy[corners]
