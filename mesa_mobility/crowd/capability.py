"""Capability: what the body of a pedestrian's type can do next.

The component through which a pedestrian consults its type's mobility map
(section 6 of the paper: behaviour chooses among what capability offers).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.errors import ModelError
from mesa_mobility.mobility import MobilityMap

FRAME_SECONDS = 1.0 / 30.0
SAMPLE_FRAMES = 3
"""Frames between two samples of an option's path."""


class OptionTable(NamedTuple):
    """Options of all capabilities in a model, stacked for the compiled kernels.

    Clusters are numbered through: those of capability k follow those of k - 1.

    Fields: ``offsets`` (clusters + 1,), ``farthest`` (clusters,) reach of its options; by option:
    ``x``, ``y``, ``heading`` of the end and its unit vector ``ux``, ``uy``, ``speed``
    (displacement over duration, m/s), ``frames``, ``cluster`` at the end, ``reach`` (largest
    distance of the path from its start), ``path_start``; by sample: ``path`` (p, 3) x, y,
    heading.  Single precision, as the map: all options of a cluster are read at each decision.
    """

    offsets: NDArray[np.int64]
    farthest: NDArray[np.float64]
    x: NDArray[np.float32]
    y: NDArray[np.float32]
    heading: NDArray[np.float32]
    ux: NDArray[np.float32]
    uy: NDArray[np.float32]
    speed: NDArray[np.float32]
    frames: NDArray[np.int32]
    cluster: NDArray[np.int32]
    reach: NDArray[np.float64]
    path_start: NDArray[np.int64]
    path: NDArray[np.float32]


class Capability:
    """Movement options of one pedestrian type, by cluster.

    Args:
        mobility_map: the type's clustered mobility map.
        durations: option durations in frames to use; None for all that the map has.

    Raises:
        ModelError: a cluster has no option of these durations.
    """

    def __init__(self, mobility_map: MobilityMap, durations: Sequence[int] | None = None) -> None:
        self.map = mobility_map
        used = np.ones(mobility_map.n_options, dtype=bool)
        if durations is not None:
            used = np.isin(mobility_map.durations, durations)
        counts = np.add.reduceat(used.astype(np.int64), mobility_map.offsets[:-1])
        if (counts == 0).any():
            raise ModelError(
                f"mobility map of {mobility_map.pedestrian_type!r}: cluster "
                f"{int(np.argmin(counts))} has no option of {list(durations or ())} frames"
            )
        self.rows = np.flatnonzero(used)
        self.table = _option_table(mobility_map, self.rows, counts)

    @property
    def n_clusters(self) -> int:
        """Number of clusters."""
        return len(self.table.offsets) - 1

    @property
    def standing(self) -> int:
        """The cluster of people who stand."""
        return self.map.standing

    @property
    def longest_reach(self) -> float:
        """Farthest that any option leads from its start, metres."""
        return float(self.table.reach.max())

    @property
    def longest_extent(self) -> float:
        """Upper bound of the distance between any two places of one option's path, metres."""
        corners = [
            ufunc.reduceat(self.table.path[:, :2], self.table.path_start)
            for ufunc in (np.maximum, np.minimum)
        ]
        # The start, which is not among the samples, belongs to the path as well.
        spread = np.maximum(corners[0], 0.0) - np.minimum(corners[1], 0.0)
        return float(np.hypot(spread[:, 0], spread[:, 1]).max())

    def options(self, cluster: int) -> range:
        """Rows in ``table`` of the options that a pose of this cluster has."""
        return range(int(self.table.offsets[cluster]), int(self.table.offsets[cluster + 1]))


def _option_table(
    mobility_map: MobilityMap, rows: NDArray[np.int64], counts: NDArray[np.int64]
) -> OptionTable:
    samples = np.diff(mobility_map.path_offsets)
    used_samples = np.repeat(np.isin(np.arange(len(samples)), rows), samples)
    path = np.ascontiguousarray(mobility_map.paths[used_samples])
    starts = np.concatenate([[0], np.cumsum(samples[rows])])[:-1].astype(np.int64)
    x, y = mobility_map.end_points[rows].astype(np.float32).T
    heading = mobility_map.end_headings[rows].astype(np.float32)
    frames = mobility_map.durations[rows].astype(np.int32)
    reach = np.maximum.reduceat(np.hypot(*path[:, :2].astype(np.float64).T), starts)
    offsets = np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)
    wide = heading.astype(np.float64)
    speed = np.hypot(x.astype(np.float64), y) / (frames * FRAME_SECONDS)
    return OptionTable(
        offsets=offsets,
        farthest=np.maximum.reduceat(reach, offsets[:-1]),
        x=np.ascontiguousarray(x),
        y=np.ascontiguousarray(y),
        heading=heading,
        ux=np.cos(wide).astype(np.float32),
        uy=np.sin(wide).astype(np.float32),
        speed=speed.astype(np.float32),
        frames=frames,
        cluster=mobility_map.end_clusters[rows].astype(np.int32),
        reach=reach,
        path_start=starts,
        path=path,
    )


def stack_tables(capabilities: Sequence[Capability]) -> OptionTable:
    """One table for several capabilities, clusters and rows numbered through."""
    if len(capabilities) == 1:
        return capabilities[0].table
    tables = [capability.table for capability in capabilities]
    options = np.cumsum([0] + [len(table.x) for table in tables])
    clusters = np.cumsum([0] + [capability.n_clusters for capability in capabilities])
    samples = np.cumsum([0] + [len(table.path) for table in tables])
    shift = {"offsets": options, "cluster": clusters, "path_start": samples}
    columns = {}
    for name in OptionTable._fields:
        parts = [getattr(table, name) for table in tables]
        if name in shift:
            parts = [part + by for part, by in zip(parts, shift[name], strict=False)]
        if name == "offsets":
            parts = [parts[0], *(part[1:] for part in parts[1:])]
        columns[name] = np.concatenate(parts).astype(getattr(tables[0], name).dtype)
    return OptionTable(**columns)
