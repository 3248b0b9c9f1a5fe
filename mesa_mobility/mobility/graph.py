"""The motion graph: allowed transitions between poses and their costs.

Pose j + 1 may follow pose i because pose j looks like pose i (Lee et al. 2002).
A natural successor costs next to nothing.  The graph is pruned while it is
built: only the best match of each stretch of 1.5 s of a clip, below a threshold,
is ever kept, so that the full n x n matrix of distances never exists.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numba import prange
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import internal, kept
from mesa_mobility.errors import MapError
from mesa_mobility.mobility.poses import PoseTable

if TYPE_CHECKING:
    import networkx as nx

NATURAL_COST = 1e-4
"""Cost of following the recording for one frame: least-cost paths then prefer fewer frames."""

MIN_SEPARATION = 15
"""Frames that two poses of one clip must lie apart for a transition between them."""

MAX_TRANSITIONS = 10
"""Transitions kept from one pose, best first."""

THRESHOLD = 0.45
"""Distance of two poses, in feature units, from which on there is no transition between them.

It does not depend on the recordings.  A multiple of the distance of consecutive frames would: the
slower the gait, the smaller that distance, and the tighter the threshold.
"""

STRETCH = 45
"""Frames of a clip among which only the best match is kept: neighbours of it add nothing."""

STILL = 1e-6
"""Distance of consecutive poses, in feature units, up to which the legs do not move."""


@dataclass(frozen=True)
class MotionGraph:
    """Poses and the transitions between them, in compressed sparse rows.

    Attributes:
        poses: the pose table; node numbers are its rows.
        offsets: (n + 1,) int64; edges of node i are ``offsets[i]:offsets[i + 1]``.
        successors: (e,) int32; the pose an edge leads to.
        via: (e,) int32; the pose whose recorded motion is played on the edge: i itself
            on a natural edge, the look-alike j on a transition i -> j + 1.
        costs: (e,) float32; distance over threshold (0 to 1) of a transition, 1e-4 if natural.
        kept: (n,) bool; poses of the largest strongly connected component.
        component_sizes: poses in each strongly connected component, largest first.
    """

    poses: PoseTable
    offsets: NDArray[np.int64]
    successors: NDArray[np.int32]
    via: NDArray[np.int32]
    costs: NDArray[np.float32]
    kept: NDArray[np.bool_]
    component_sizes: tuple[int, ...]

    @property
    def share_kept(self) -> float:
        """Share of poses in the largest strongly connected component."""
        return float(self.kept.mean())

    @property
    def transitions(self) -> int:
        """Number of edges that are not natural successors."""
        return int(np.sum(self.via != self._sources))

    @cached_property
    def _sources(self) -> NDArray[np.int64]:
        return np.repeat(np.arange(len(self.poses)), np.diff(self.offsets))

    @cached_property
    def graph(self) -> nx.DiGraph:
        """The strongly connected component as a networkx DiGraph.

        Nodes carry ``clip`` and ``frame``; edges carry ``cost``, ``kind`` ("natural" or
        "transition") and ``via``.
        """
        import networkx as nx

        graph = nx.DiGraph(threshold=THRESHOLD)
        first = self.poses.first
        for node in np.flatnonzero(self.kept).tolist():
            clip = int(self.poses.clip[node])
            graph.add_node(node, clip=self.poses.clip_names[clip], frame=node - int(first[clip]))
        rows = zip(
            self._sources.tolist(),
            self.successors.tolist(),
            self.via.tolist(),
            self.costs.tolist(),
            strict=True,
        )
        graph.add_edges_from(
            (i, j, {"cost": c, "kind": "natural" if v == i else "transition", "via": v})
            for i, j, v, c in rows
        )
        return graph


def motion_graph(poses: PoseTable) -> MotionGraph:
    """Build and prune the motion graph of a pose table.

    Raises:
        MapError: the recordings are too short or too unlike each other to be joined.
    """
    n = len(poses)
    last = np.zeros(n, dtype=np.bool_)
    last[poses.first[1:] - 1] = True
    natural = np.flatnonzero(~last)
    gaps = np.linalg.norm(poses.features[natural + 1] - poses.features[natural], axis=1)
    if not (gaps > STILL).any():
        raise MapError(
            f"nobody moves in the {n} poses of {len(poses.clip_names)} clips: "
            "expected recordings of people who walk"
        )
    columns = np.ascontiguousarray(poses.features.T)
    match, distance = _best_matches(
        columns,
        poses.clip,
        poses.first,
        np.float32(THRESHOLD * THRESHOLD),
        MIN_SEPARATION,
        STRETCH,
        MAX_TRANSITIONS,
    )
    row, rank = np.nonzero(match >= 0)
    look_alike = match[row, rank].astype(np.int64)
    source = np.concatenate([natural, row])
    successor = np.concatenate([natural + 1, look_alike + 1])
    via = np.concatenate([natural, look_alike])
    cost = np.concatenate(
        [np.full(len(natural), NATURAL_COST), np.sqrt(distance[row, rank]) / THRESHOLD]
    )
    order = np.lexsort((cost, source))
    source, successor, via, cost = source[order], successor[order], via[order], cost[order]

    labels = _strong_labels(n, source, successor)
    sizes = np.bincount(labels)
    kept = labels == np.argmax(sizes)
    inside = kept[source] & kept[successor]
    if not inside.any():
        raise MapError(
            f"the {n} poses of {len(poses.clip_names)} clips have no transitions that lead back: "
            "expected clips that resemble each other somewhere"
        )
    source = source[inside]
    offsets = np.concatenate([[0], np.cumsum(np.bincount(source, minlength=n))]).astype(np.int64)
    return MotionGraph(
        poses=poses,
        offsets=offsets,
        successors=successor[inside].astype(np.int32),
        via=via[inside].astype(np.int32),
        costs=cost[inside].astype(np.float32),
        kept=kept,
        component_sizes=tuple(sorted(sizes.tolist(), reverse=True)),
    )


def _strong_labels(
    n: int, source: NDArray[np.int64], successor: NDArray[np.int64]
) -> NDArray[np.int32]:
    # Imported here, since reading a map imports this module but does not need them.
    from scipy.sparse import csr_array
    from scipy.sparse.csgraph import connected_components

    # Older versions of SciPy take 32-bit indices alone here.
    edges = (source.astype(np.int32), successor.astype(np.int32))
    matrix = csr_array((np.ones(len(source), np.int8), edges), shape=(n, n))
    return connected_components(matrix, directed=True, connection="strong")[1]


@internal()
def squared_distances(
    pose: NDArray[np.float32],
    columns: NDArray[np.float32],
    start: int,
    width: int,
    d2: NDArray[np.float32],
) -> None:
    """Write the squared distances of a pose (dims,) to poses in columns, ``width`` from ``start``
    on, to the first places of ``d2``."""
    for q in range(width):
        d2[q] = 0.0
    for d in range(len(pose)):
        x = pose[d]
        for q in range(width):
            delta = columns[d, start + q] - x
            d2[q] += delta * delta


@kept(parallel=True)
def _best_matches(
    columns: NDArray[np.float32],
    clip: NDArray[np.int32],
    first: NDArray[np.int64],
    threshold2: np.float32,
    min_separation: int,
    stretch: int,
    most: int,
) -> tuple[NDArray[np.int32], NDArray[np.float32]]:
    """Look-alikes of every pose: the best of each stretch of a clip, ``most`` at most.

    Every pose is compared with every other.  In 36 dimensions this scan, one
    vectorised pass over transposed columns, is quicker than a k-d tree, and its
    result does not depend on the number of threads.
    """
    n = columns.shape[1]
    match = np.full((n, most), -1, np.int32)
    distance = np.full((n, most), np.inf, np.float32)
    for i in prange(n):
        d2 = np.empty(stretch, np.float32)
        for k in range(len(first) - 1):
            stop = first[k + 1] - 1  # the last frame of a clip has no successor to lead to
            for start in range(first[k], stop, stretch):
                width = min(stretch, stop - start)
                squared_distances(columns[:, i], columns, start, width, d2)
                best, best_d2 = -1, threshold2
                for q in range(width):
                    j = start + q
                    if d2[q] < best_d2 and (k != clip[i] or abs(j - i) >= min_separation):
                        best, best_d2 = j, d2[q]
                if best < 0 or best_d2 >= distance[i, most - 1]:
                    continue
                slot = most - 1
                while slot > 0 and distance[i, slot - 1] > best_d2:
                    distance[i, slot] = distance[i, slot - 1]
                    match[i, slot] = match[i, slot - 1]
                    slot -= 1
                distance[i, slot] = best_d2
                match[i, slot] = best
    return match, distance


@dataclass(frozen=True)
class ShortestPaths:
    """Least-cost paths from some poses to all others, whatever their length.

    The paper's all-pairs shortest paths, taken literally, for comparison only:
    ``reachable_options`` uses paths of exactly 45 frames instead.

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
    from scipy.sparse import csr_array
    from scipy.sparse.csgraph import dijkstra

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
