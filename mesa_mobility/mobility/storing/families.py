"""Distributions of options: recorded options as ways through the poses, each with its family.

A recorded option is a pose in which it starts, and at most three frames in which it goes on in
another pose: some ten bytes instead of a path. It stands for a family, the edited options around
it. What of each family is used is worked out when the map is read, as it was when it was built. A
map that is kept so has the same options as one that stores all of them.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import kept
from mesa_mobility.errors import ContentError, MapError
from mesa_mobility.mobility.clusters import Clusters
from mesa_mobility.mobility.edits import ON_FLOORS, SAMPLE_EVERY, Editing
from mesa_mobility.mobility.paths import MOST_JUMPS, MOST_OPTIONS, ReachableOptions, joined
from mesa_mobility.mobility.poses import MOTION_STEP
from mesa_mobility.mobility.storing.archive import read_metadata, write_arrays
from mesa_mobility.mobility.storing.assembly import assemble
from mesa_mobility.mobility.storing.layouts import FAMILIES
from mesa_mobility.mobility.storing.steps import COST_STEP, quantise_costs
from mesa_mobility.mobility.thinning import DURATIONS, ClusterOptions
from mesa_mobility.schema import Array, Real, Several, Whole, check

# It also stands for the rule by which edited options follow from a file that does not hold them.
FORMAT_VERSION = 3

_NO_CLUSTER = np.iinfo(np.uint16).max

MOST_EDITS = 100
"""Most edits of each recorded option: maps that ship have 24."""


@dataclass(frozen=True, eq=False)
class OptionFamilies:
    """Recorded options, from which a map follows.  n poses, k clusters, m recorded options.

    Attributes:
        steps: (n, 3) int16; motion from each pose to the next, in ``MOTION_STEP``.
        clusters: the clusters of the poses, before anything is borrowed.
        counts: (k, 3) options of each cluster of 12, 24 and 45 frames.
        costs: (m,) float32; by cluster, then by duration.
        sources: (m,) int32; pose in which each option starts.
        jumps: (m, ``MOST_JUMPS``) int64; as in ``ReachableOptions``.
        metadata: of the map; ``build`` has the edits.
    """

    steps: NDArray[np.int16]
    clusters: Clusters
    counts: NDArray[np.int64]
    costs: NDArray[np.float32]
    sources: NDArray[np.int32]
    jumps: NDArray[np.int64]
    metadata: Mapping[str, Any]

    @classmethod
    def of(
        cls,
        motion: NDArray[np.float64],
        clusters: Clusters,
        options: ReachableOptions,
        metadata: Mapping[str, Any],
    ) -> OptionFamilies:
        """The families of these options; edited options are left out.

        Args:
            motion: (n, 3) motion from each pose to the next, ``PoseTable.step``.
            clusters: of the poses.
            options: of all clusters.
            metadata: of the map.
        """
        rows = np.flatnonzero(options.edits == 0)
        cluster = np.searchsorted(options.offsets, rows, side="right") - 1
        layer = np.searchsorted(DURATIONS, options.durations[rows])
        counts = np.zeros((len(clusters), len(DURATIONS)), dtype=np.int64)
        np.add.at(counts, (cluster, layer), 1)
        return cls(
            steps=np.rint(motion / MOTION_STEP).astype(np.int16),
            clusters=clusters,
            counts=counts,
            costs=quantise_costs(options.costs[rows]),
            sources=options.sources[rows],
            jumps=options.jumps[rows],
            metadata=metadata,
        )

    def options(self) -> ReachableOptions:
        """All options of the map, edited ones included."""
        layers = np.tile(np.arange(len(DURATIONS)), len(self.counts))
        layers = np.repeat(layers, self.counts.reshape(-1))
        editing = self.editing()
        frames = np.array(DURATIONS)[layers]
        paths, clusters, valid = _follow(
            frames, self.sources, self.jumps, self.steps * MOTION_STEP, self.clusters.labels
        )
        if not valid:
            raise MapError("an option leads past the last of its poses, or to one of no cluster")
        columns = ClusterOptions(
            layers=layers,
            cells=np.zeros_like(layers),
            costs=self.costs,
            paths=paths,
            path_clusters=clusters,
            sources=self.sources,
            jumps=self.jumps,
            edits=np.zeros(len(layers), dtype=np.int16),
        )
        bounds = np.concatenate([[0], np.cumsum(self.counts.sum(axis=1))])
        parts = [
            columns.taken(np.arange(first, last)) if last > first else None
            for first, last in itertools.pairwise(bounds)
        ]
        return joined(parts, editing.edits, editing.frames)

    def fields(self, lender: Callable[[], Any]) -> dict[str, Any]:
        """The fields of the map.

        Args:
            lender: gives the map from which standing and turns on the spot are borrowed, if the
                recordings lack them.

        Raises:
            MapError: the families do not fit together.
        """
        return assemble(self.options(), self.clusters, self.metadata, lender)

    def save(self, path: str | Path) -> None:
        """Write the map file, complete or not at all; reading it gives the whole map.

        Raises:
            MapError: the file cannot be written, or has more poses than fit into it.
        """
        path, n = Path(path), len(self.steps)
        if n > _NO_CLUSTER:
            raise MapError(f"{path}: {n} poses, expected at most {_NO_CLUSTER} with families")
        ranks = np.empty(n, dtype=np.int64)
        order, starts = _by_cluster(self.clusters.labels, len(self.clusters))
        ranks[order] = np.arange(len(order)) - starts[self.clusters.labels[order] + 1]
        jumped = self.jumps.T >= 0
        arrays = {
            "counts": self.counts,
            "costs": np.rint(self.costs.astype(np.float64) / COST_STEP),
            "sources": ranks[self.sources],
            "jump_frames": np.where(jumped, self.jumps.T // n, 0),
            "jump_poses": self.jumps.T[jumped] % n,
            "steps": np.diff(self.steps.astype(np.int64), axis=0, prepend=0).T,
            "labels": np.where(self.clusters.labels < 0, _NO_CLUSTER, self.clusters.labels),
            "mean_poses": self.clusters.mean_joints,
            "centres": self.clusters.centres,
            "sizes": self.clusters.sizes,
            "mean_speeds": self.clusters.mean_speeds,
        }
        metadata = {"format_version": FORMAT_VERSION, **self.metadata}
        write_arrays(path, FAMILIES, arrays, metadata)

    def editing(self) -> Editing:
        """How recorded options are edited; edits have the numbers in ``ReachableOptions``.

        Raises:
            ContentError: they are no turns and strides of people, too many, or of options of other
                durations.
        """
        edits = self.metadata.get("build", {}).get("edits", {})
        turns = edits.get("turns_deg_in_45_frames", [0.0])
        strides = edits.get("strides", [1.0])
        frames = edits.get("frames", list(ON_FLOORS.frames))
        check(turns, Several(Real(-180.0, 180.0)), "metadata, turns_deg_in_45_frames")
        check(strides, Several(Real(0.01, 10.0)), "metadata, strides")
        check(frames, Several(Whole(1, DURATIONS[-1])), "metadata, frames of edits")
        if not set(frames) <= set(DURATIONS):
            raise ContentError(f"metadata, frames of edits: {frames}, expected some of {DURATIONS}")
        check(len(turns) * len(strides), Whole(0, MOST_EDITS), "metadata, number of edits")
        copies = int(self.counts.sum(axis=1).max()) * (len(turns) * len(strides) + 1)
        check(copies, Whole(0, MOST_OPTIONS), "array 'counts', edited options of a cluster")
        return Editing(tuple(turns), tuple(strides), tuple(frames))


def read_families(arrays: dict[str, NDArray[Any]]) -> OptionFamilies:
    """The families of a file's arrays.

    Raises:
        MapError: they do not fit together.
    """
    metadata = read_metadata(arrays["metadata"], FORMAT_VERSION)
    k, n, m = len(arrays["counts"]), len(arrays["labels"]), len(arrays["costs"])
    shapes = {
        "counts": (k, len(DURATIONS)),
        "costs": (m,),
        "sources": (m,),
        "jump_frames": (MOST_JUMPS, m),
        "jump_poses": (int(np.count_nonzero(arrays["jump_frames"])),),
        "steps": (3, n),
        "labels": (n,),
        "mean_poses": (k, 9, 3),
        "centres": (k, 36),
        "sizes": (k,),
        "mean_speeds": (k,),
    }
    for name, shape in shapes.items():
        if arrays[name].shape != shape:
            raise MapError(f"array {name!r}: shape {arrays[name].shape}, expected {shape}")
    check(arrays["mean_speeds"], Array("f8", (k,), 0.0, 100.0), "array 'mean_speeds'")
    if m > MOST_OPTIONS // 2:
        raise MapError(f"{m} recorded options, expected at most {MOST_OPTIONS // 2}")
    counts = arrays["counts"].astype(np.int64)
    labels = arrays["labels"].astype(np.int32)
    labels[labels == _NO_CLUSTER] = -1
    if (counts < 0).any() or counts.sum() != m or m == 0:
        raise MapError(f"array 'counts': {counts.sum()} options, expected {m}, at least one")
    if labels.max(initial=-1) >= k or arrays["jump_poses"].max(initial=0) >= n:
        raise MapError("arrays 'labels' and 'jump_poses': expected clusters and poses that exist")
    order, starts = _by_cluster(labels, k)
    cluster = np.repeat(np.arange(k), counts.sum(axis=1))
    rank = arrays["sources"].astype(np.int64)
    if (rank >= (starts[2:] - starts[1:-1])[cluster]).any():
        raise MapError("array 'sources': expected poses of the option's cluster")
    frames = arrays["jump_frames"].astype(np.int64)
    jumps = np.full(frames.shape, -1, dtype=np.int64)
    jumps[frames > 0] = frames[frames > 0] * n + arrays["jump_poses"]
    return OptionFamilies(
        steps=np.cumsum(arrays["steps"].T, axis=0, dtype=np.int16),
        clusters=Clusters(
            labels=labels,
            centres=arrays["centres"],
            mean_joints=arrays["mean_poses"],
            sizes=arrays["sizes"],
            mean_speeds=arrays["mean_speeds"],
            stopped_by=str(metadata.get("build", {}).get("clusters_stopped_by", "")),
        ),
        counts=counts,
        costs=(arrays["costs"] * COST_STEP).astype(np.float32),
        sources=order[starts[cluster + 1] + rank].astype(np.int32),
        jumps=np.ascontiguousarray(jumps.T),
        metadata=metadata,
    )


def _by_cluster(
    labels: NDArray[np.int32], clusters: int
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Poses in order of cluster, and where each cluster starts in it, from cluster -1 on."""
    order = np.argsort(labels, kind="stable")
    return order, np.searchsorted(labels[order], np.arange(-1, clusters + 1))


@kept(nogil=True)
def _follow(
    frames: NDArray[np.int64],
    sources: NDArray[np.int32],
    jumps: NDArray[np.int64],
    step: NDArray[np.float64],
    labels: NDArray[np.int32],
) -> tuple[NDArray[np.float32], NDArray[np.int32], bool]:
    """Paths and clusters of options that start in these poses; whether all poses are there."""
    m, n = len(frames), len(labels)
    samples = frames.max() // SAMPLE_EVERY
    paths = np.zeros((m, samples, 3), np.float32)
    clusters = np.zeros((m, samples), np.int32)
    for i in range(m):
        node = np.int64(sources[i])
        x, y, heading = 0.0, 0.0, 0.0
        for frame in range(1, frames[i] + 1):
            via = node
            for jump in jumps[i]:
                if jump >= 0 and jump // n == frame:
                    via = jump % n
            node = via + 1
            if node >= n or labels[node] < 0:
                return paths, clusters, False
            ch, sh = np.cos(heading), np.sin(heading)
            x = x + ch * step[via, 0] - sh * step[via, 1]
            y = y + sh * step[via, 0] + ch * step[via, 1]
            heading = heading + step[via, 2]
            if frame % SAMPLE_EVERY == 0:
                s = frame // SAMPLE_EVERY - 1
                paths[i, s, 0], paths[i, s, 1], paths[i, s, 2] = x, y, heading
                clusters[i, s] = labels[node]
    return paths, clusters, True
