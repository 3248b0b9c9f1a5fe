"""Capability: what the body of a pedestrian's type can do next.

The component through which a pedestrian consults its type's mobility map
(section 6 of the paper: behaviour chooses among what capability offers).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.groups import alike, group
from mesa_mobility.crowd.options import option_table, padded_paths
from mesa_mobility.errors import ModelError
from mesa_mobility.mobility import MobilityMap


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
        offsets = np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)
        self.rows, groups = _in_groups(mobility_map, np.flatnonzero(used))
        self.table = option_table(mobility_map, self.rows, offsets, groups)

    @property
    def n_clusters(self) -> int:
        """Number of clusters."""
        return len(self.table.farthest)

    @property
    def standing(self) -> int:
        """The cluster of people who stand."""
        return self.map.standing

    @property
    def longest_reach(self) -> float:
        """Farthest that any option leads from its start, metres."""
        return float(self.table.farthest.max())

    @property
    def longest_extent(self) -> float:
        """Upper bound of the distance between any two places of one option's path, metres."""
        places = self.table.path[:, :2]
        spread = places.max(axis=2) - places.min(axis=2)
        return float(np.hypot(spread[:, 0], spread[:, 1]).max())

    def options(self, cluster: int) -> range:
        """Rows in ``table`` of the options that a pose of this cluster has."""
        return range(int(self.table.offsets[cluster]), int(self.table.offsets[cluster + 1]))


def _in_groups(
    mobility_map: MobilityMap, rows: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Rows of a map in groups of options alike, and where in them each group starts."""
    cluster = np.searchsorted(mobility_map.offsets, rows, side="right")
    frames = mobility_map.durations[rows]
    order = np.lexsort((frames, cluster))
    rows, cluster, frames = rows[order], cluster[order], frames[order]
    changes = (np.diff(cluster) != 0) | (np.diff(frames) != 0)
    bounds = np.concatenate([[0], np.flatnonzero(changes) + 1, [len(rows)]])
    features = alike(
        padded_paths(mobility_map, rows), mobility_map.end_headings[rows].astype(np.float64), frames
    )
    order, starts = group(features, bounds.astype(np.int64))
    return rows[order], starts
