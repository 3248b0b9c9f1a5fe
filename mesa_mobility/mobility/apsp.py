"""The paper's all-pairs shortest paths, taken literally, for comparison only.

``reachable_options`` uses paths of exactly 45 frames instead; this module shows why.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from mesa_mobility.mobility.graph import MotionGraph


@dataclass(frozen=True)
class ShortestPaths:
    """Least-cost paths from some poses to all others, whatever their length.

    Attributes:
        sources: (s,) the poses they start from.
        frames: (s, n) int32; frames of the least-cost path to each pose, -1 if unreachable.
    """

    sources: NDArray[np.int64]
    frames: NDArray[np.int32]

    @property
    def median_frames(self) -> float:
        """Median length of a path, in frames."""
        return float(np.median(self.frames[self.frames > 0]))

    def share_of_exactly(self, frames: int) -> float:
        """Share of paths that have exactly this many frames."""
        reached = self.frames > 0
        return float((self.frames[reached] == frames).mean())


def shortest_paths(graph: MotionGraph, sources: NDArray[np.int64]) -> ShortestPaths:
    """Least-cost paths of any length from ``sources`` (Dijkstra on the pruned graph)."""
    n = len(graph.poses)
    # Older versions of SciPy take 32-bit indices alone here.
    offsets = graph.offsets.astype(np.int32)
    matrix = csr_array((graph.costs, graph.successors, offsets), shape=(n, n))
    frames = np.full((len(sources), n), -1, dtype=np.int32)
    for row, source in enumerate(sources):
        cost, before = dijkstra(matrix, indices=int(source), return_predecessors=True)
        reached = np.flatnonzero(np.isfinite(cost))
        frames[row, source] = 0
        # In order of cost a predecessor always comes before its successors.
        for node in reached[np.argsort(cost[reached], kind="stable")]:
            if node != source:
                frames[row, node] = frames[row, before[node]] + 1
    return ShortestPaths(sources=np.asarray(sources), frames=frames)
