"""Least-cost paths of exactly 12, 24 and 45 frames through the motion graph.

The paper takes all-pairs shortest paths and keeps those of 45 frames.  Taken
literally that yields next to nothing: an unconstrained least-cost path between
two poses is hundreds of frames long, and one in some thousands has exactly 45.
What a pedestrian needs is every pose reachable in exactly 45 frames at least
cost: a layered dynamic programme, one layer a frame, bounded by a budget of
transition cost.  The layers at 12 and 24 frames give the shorter options.

Poses of one cluster share their options (section 5 of the paper): the options
of all poses of a cluster are thinned together, one for each cell of end point
and end heading, the cheapest kept.  Edited copies then fill cells that no
recorded option ends in.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import kept
from mesa_mobility.compiled.threads import THREADS
from mesa_mobility.errors import MapError
from mesa_mobility.mobility.edits import SAMPLE_EVERY, Edit
from mesa_mobility.mobility.thinning import (
    BUDGET,
    DURATIONS,
    EDITED_FRAMES,
    ClusterOptions,
    edit_copies,
    merge,
    with_copies,
)

if TYPE_CHECKING:
    from mesa_mobility.mobility.clusters import Clusters
    from mesa_mobility.mobility.graph import MotionGraph

TRANSITION_PENALTY = 1.0
"""Fixed cost of leaving the recording, in units of the transition threshold."""

MOST_JUMPS = int(BUDGET / TRANSITION_PENALTY)
"""Transitions that a path within the budget has at most."""

MOST_OPTIONS = 1_000_000
"""Most options of a map: three times those of the able-bodied one, in half a gigabyte."""

CELL = (0.08, 0.08, np.deg2rad(30.0))
"""Cell of thinning: metres, metres, radians of the end point and end heading.

Places matter more than headings: of two options of the same end, people hardly tell apart those
that differ by less than 30 degrees, and the heading can be changed in the next movement.
"""

_CHUNK = 48


@dataclass(frozen=True)
class ReachableOptions:
    """Thinned options of all clusters, in order of cluster, duration and cell.

    The standing cluster has none where nobody stands in the recordings.

    Attributes:
        offsets: (k + 1,) int64; options of cluster c are ``offsets[c]:offsets[c + 1]``.
        durations: (m,) int16; frames.
        costs: (m,) float32; cost of the path in the motion graph.
        paths: (m, 15, 3) float32; x, y in metres and heading in radians every 3 frames
            from the third on, relative to the start; rows past the end are zero.
        path_clusters: (m, 15) int32; cluster of the pose at each sample.
        sources: (m,) int32; pose in which the option starts; of an edited copy, that of its
            original; -1 if the option is borrowed from another map.
        jumps: (m, ``MOST_JUMPS``) int64; its transitions, ``frame * n + via`` for the pose ``via``
            of n whose step is taken in that frame; -1 for none.
        edits: (m,) int16; number, from 1 on, of the edit that made an option from a recorded one;
            0 for recorded options.
    """

    offsets: NDArray[np.int64]
    durations: NDArray[np.int16]
    costs: NDArray[np.float32]
    paths: NDArray[np.float32]
    path_clusters: NDArray[np.int32]
    sources: NDArray[np.int32]
    jumps: NDArray[np.int64]
    edits: NDArray[np.int16]


def reachable_options(
    graph: MotionGraph,
    clusters: Clusters,
    edits: Sequence[Edit] = (),
    cell: tuple[float, float, float] = CELL,
    progress: Callable[[int, int], None] | None = None,
    edited_frames: Sequence[int] = EDITED_FRAMES,
) -> ReachableOptions:
    """Options of every cluster: all places its poses can reach, thinned.

    Args:
        graph: the motion graph.
        clusters: the clusters of its poses.
        edits: how recorded options are edited to fill further cells.
        cell: cell of thinning; metres, metres, radians.
        progress: called as ``progress(poses done, poses)``.
        edited_frames: durations of the options that are edited.
    """
    order = np.argsort(clusters.labels, kind="stable")
    order = order[clusters.labels[order] >= 0].astype(np.int32)
    bounds = np.searchsorted(clusters.labels[order], np.arange(len(clusters) + 1))
    chunks = [
        (cluster, order[start : min(start + _CHUNK, bounds[cluster + 1])])
        for cluster in range(len(clusters))
        for start in range(bounds[cluster], bounds[cluster + 1], _CHUNK)
    ]
    step = graph.poses.step
    longest_step = float(np.hypot(step[:, 0], step[:, 1]).max())
    half_cells = int(np.ceil(DURATIONS[-1] * longest_step / min(cell[:2]))) + 1
    durations = np.array(DURATIONS, dtype=np.int64)
    cells = np.array(cell)
    links = _Links(graph.offsets, graph.successors, graph.via, graph.costs)

    def collect(chunk: NDArray[np.int32]) -> tuple[NDArray, ...]:
        return _collect(
            chunk,
            links,
            step,
            clusters.labels,
            durations,
            cells,
            half_cells,
        )

    found: list[list[tuple[NDArray, ...]]] = [[] for _ in range(len(clusters))]
    done = 0
    # Results are taken in order, so their number changes nothing.
    with ThreadPoolExecutor(THREADS) as pool:
        for (cluster, chunk), result in zip(
            chunks, pool.map(collect, (c for _, c in chunks)), strict=True
        ):
            found[cluster].append(result)
            done += len(chunk)
            if progress is not None:
                progress(done, len(order))
    return joined([merge(parts) if parts else None for parts in found], edits, edited_frames)


def joined(
    recorded: Iterable[ClusterOptions | None],
    edits: Sequence[Edit] = (),
    edited_frames: Sequence[int] = EDITED_FRAMES,
) -> ReachableOptions:
    """The options of all clusters from those recorded in each, with edited copies.

    Args:
        recorded: of each cluster; None for one without poses, where nobody stands in the
            recordings.
        edits: how recorded options are edited to fill further cells.
        edited_frames: durations of the options that are edited.
    """
    each: list[ClusterOptions | None] = []
    counts: list[int] = []
    for own in recorded:
        copies = None if own is None else with_copies(own, edits, edited_frames)
        each.append(copies)
        counts.append(0 if copies is None else len(copies.layers))
        if sum(counts) > MOST_OPTIONS:
            raise MapError(f"more than {MOST_OPTIONS} options, expected those of one person's type")
    columns = zip(*(own for own in each if own is not None), strict=True)
    all_ = ClusterOptions(*(np.concatenate(column) for column in columns))
    edit_copies(all_, edits)
    return ReachableOptions(
        offsets=np.concatenate([[0], np.cumsum(counts)]),
        durations=np.array(DURATIONS, dtype=np.int16)[all_.layers],
        costs=all_.costs,
        paths=all_.paths,
        path_clusters=all_.path_clusters,
        sources=all_.sources,
        jumps=all_.jumps,
        edits=all_.edits,
    )


class _Links(NamedTuple):
    """The edges of the motion graph, as `MotionGraph` has them."""

    offsets: NDArray[np.int64]
    successors: NDArray[np.int32]
    via: NDArray[np.int32]
    costs: NDArray[np.float32]


@kept(nogil=True)
def _collect(
    sources: NDArray[np.int32],
    links: _Links,
    step: NDArray[np.float64],
    labels: NDArray[np.int32],
    durations: NDArray[np.int64],
    cell: NDArray[np.float64],
    half_cells: int,
) -> tuple[NDArray, NDArray, NDArray, NDArray, NDArray, NDArray, NDArray]:
    """Options of some poses of one cluster, thinned; see ``ReachableOptions``."""
    offsets, successors, via, costs = links
    n = len(labels)
    frames = durations[-1]
    nodes = np.empty((frames + 1, n), np.int32)
    parents = np.empty((frames + 1, n), np.int32)
    vias = np.empty((frames + 1, n), np.int32)
    spent = np.empty((frames + 1, n), np.float64)
    place = np.empty((frames + 1, n, 3), np.float64)
    slot_in_layer = np.full(n, -1, np.int32)

    headings = int(np.ceil(2.0 * np.pi / cell[2]))
    side = 2 * half_cells + 1
    slot_of_cell = np.full((len(durations), side * side * headings), -1, np.int32)
    samples = frames // SAMPLE_EVERY
    capacity, used = 4096, 0
    out_cell = np.empty(capacity, np.int64)
    out_layer = np.empty(capacity, np.int64)
    out_cost = np.empty(capacity, np.float32)
    out_path = np.zeros((capacity, samples, 3), np.float32)
    out_cluster = np.zeros((capacity, samples), np.int32)
    out_source = np.empty(capacity, np.int32)
    out_jumps = np.empty((capacity, MOST_JUMPS), np.int64)

    for source in sources:
        nodes[0, 0], parents[0, 0], spent[0, 0] = source, -1, 0.0
        place[0, 0, :] = 0.0
        count = 1
        layer = 0
        for frame in range(1, frames + 1):
            # Relax every edge from the layer before.
            following = 0
            for a in range(count):
                node = nodes[frame - 1, a]
                for e in range(offsets[node], offsets[node + 1]):
                    c = spent[frame - 1, a] + costs[e]
                    if via[e] != node:
                        c += TRANSITION_PENALTY
                    if c > BUDGET:
                        continue
                    successor = successors[e]
                    s = slot_in_layer[successor]
                    if s < 0:
                        s = following
                        following += 1
                        slot_in_layer[successor] = s
                        nodes[frame, s] = successor
                    elif c >= spent[frame, s]:
                        continue
                    spent[frame, s], parents[frame, s], vias[frame, s] = c, a, via[e]
            count = following
            for a in range(count):
                slot_in_layer[nodes[frame, a]] = -1
                p, v = parents[frame, a], vias[frame, a]
                heading = place[frame - 1, p, 2]
                ch, sh = np.cos(heading), np.sin(heading)
                place[frame, a, 0] = place[frame - 1, p, 0] + ch * step[v, 0] - sh * step[v, 1]
                place[frame, a, 1] = place[frame - 1, p, 1] + sh * step[v, 0] + ch * step[v, 1]
                place[frame, a, 2] = heading + step[v, 2]
            if frame != durations[layer]:
                continue
            for a in range(count):
                ix = int(np.floor(place[frame, a, 0] / cell[0] + 0.5)) + half_cells
                iy = int(np.floor(place[frame, a, 1] / cell[1] + 0.5)) + half_cells
                ih = int(np.floor(place[frame, a, 2] / cell[2] + 0.5)) % headings
                key = (ix * side + iy) * headings + ih
                slot = slot_of_cell[layer, key]
                if slot >= 0 and spent[frame, a] >= out_cost[slot]:
                    continue
                if slot < 0:
                    if used == capacity:
                        out_cell = np.concatenate((out_cell, np.empty_like(out_cell)))
                        out_layer = np.concatenate((out_layer, np.empty_like(out_layer)))
                        out_cost = np.concatenate((out_cost, np.empty_like(out_cost)))
                        out_path = np.concatenate((out_path, np.zeros_like(out_path)))
                        out_cluster = np.concatenate((out_cluster, np.zeros_like(out_cluster)))
                        out_source = np.concatenate((out_source, np.empty_like(out_source)))
                        out_jumps = np.concatenate((out_jumps, np.empty_like(out_jumps)))
                        capacity *= 2
                    slot = used
                    used += 1
                    slot_of_cell[layer, key] = slot
                    out_cell[slot] = key
                    out_layer[slot] = layer
                out_cost[slot] = spent[frame, a]
                out_source[slot] = source
                out_jumps[slot] = -1
                jump = 0
                b = a
                for f in range(frame, 0, -1):
                    if vias[f, b] != nodes[f - 1, parents[f, b]]:
                        out_jumps[slot, jump] = f * n + vias[f, b]
                        jump += 1
                    if f % SAMPLE_EVERY == 0:
                        out_path[slot, f // SAMPLE_EVERY - 1, 0] = place[f, b, 0]
                        out_path[slot, f // SAMPLE_EVERY - 1, 1] = place[f, b, 1]
                        out_path[slot, f // SAMPLE_EVERY - 1, 2] = place[f, b, 2]
                        out_cluster[slot, f // SAMPLE_EVERY - 1] = labels[nodes[f, b]]
                    b = parents[f, b]
            layer += 1
    return (
        out_cell[:used],
        out_layer[:used],
        out_cost[:used],
        out_path[:used],
        out_cluster[:used],
        out_source[:used],
        out_jumps[:used],
    )
