"""Capability: the movement options of a pedestrian type.

The component through which a pedestrian consults the mobility map of their type
(section 6 of the paper: behaviour chooses among what capability offers).
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Self

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.options.option_groups import alike, group
from mesa_mobility.crowd.options.shortened import with_shortened
from mesa_mobility.crowd.options.table import (
    FRAME_SECONDS,
    SAMPLE_FRAMES,
    OptionTable,
    Parts,
    option_table,
    padded_paths,
)
from mesa_mobility.errors import ModelError
from mesa_mobility.mobility import MobilityMap
from mesa_mobility.mobility.standing.accelerations import has_acceleration, peak_accelerations

ALIKE = 0.05
"""Difference of velocities at which two clusters fit a measured one equally well, m/s: tracks of
heads are hardly more exact."""


class Capability:
    """Movement options of one pedestrian type, by cluster.

    Args:
        mobility_map: the type's clustered mobility map.
        durations: option durations in frames to use; None for all that the map has.
        shares: shortened copies to add, as shares of the ground covered: those of the shortest
            options of each cluster, then of the next longer ones, and so on.
        most_acceleration: m/s2; options that exceed it are left out. None for all.

    Attributes:
        table: the options.
        parts: for each option, the map's option that it is taken from, and its share.

    Raises:
        ModelError: a cluster has no option of these durations.
    """

    def __init__(
        self,
        mobility_map: MobilityMap,
        durations: Sequence[int] | None = None,
        shares: Sequence[Sequence[float]] = (),
        most_acceleration: float | None = None,
    ) -> None:
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
        parts = with_shortened(mobility_map, np.flatnonzero(used), shares)
        if most_acceleration is not None:
            parts = without_abrupt(mobility_map, parts, most_acceleration)
        cluster = np.searchsorted(mobility_map.offsets, parts.rows, side="right") - 1
        counts = np.bincount(cluster, minlength=mobility_map.n_clusters)
        offsets = np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)
        features = alike(mobility_map, parts)
        order, groups = _in_groups(mobility_map.durations[parts.rows], features, cluster)
        self.parts = parts.taken(order)
        path = padded_paths(mobility_map, self.parts)
        self.table = option_table(mobility_map, self.parts, path, offsets, groups)

    @classmethod
    def of_table(cls, mobility_map: MobilityMap, parts: Parts, table: OptionTable) -> Self:
        """A capability whose options have been laid out before.

        Args:
            mobility_map: the type's clustered mobility map.
            parts: as the attribute.
            table: the options.
        """
        made = object.__new__(cls)
        made.map, made.parts, made.table = mobility_map, parts, table
        return made

    @property
    def n_clusters(self) -> int:
        """Number of clusters."""
        return len(self.table.farthest)

    @property
    def standing(self) -> int:
        """The standing cluster."""
        return self.map.standing

    @property
    def longest_reach(self) -> float:
        """Farthest that any option leads from its start, metres."""
        return float(self.table.farthest.max())

    @cached_property
    def first_velocities(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Velocities with which movements from each cluster begin, in the person's coordinates.

        Returns:
            (clusters, 2) m/s, mean over the unshortened options of their velocity in the first
            0.1 s, and (clusters,) m/s, how far options are from it (root of the mean square).
        """
        whole = self.parts.share == 1.0
        steps = self.table.path[:, :2, 1].astype(np.float64) / (SAMPLE_FRAMES * FRAME_SECONDS)
        cluster = np.repeat(np.arange(self.n_clusters), np.diff(self.table.offsets))
        counts = np.bincount(cluster[whole], minlength=self.n_clusters)
        sums = [np.bincount(cluster[whole], steps[whole, axis], self.n_clusters) for axis in (0, 1)]
        mean = np.column_stack(sums) / np.maximum(counts, 1)[:, None]
        squares = ((steps - mean[cluster]) ** 2).sum(axis=1)
        spread = np.bincount(cluster[whole], squares[whole], self.n_clusters)
        return mean, np.sqrt(spread / np.maximum(counts, 1))

    def clusters_at(
        self, velocities: NDArray[np.float64], rng: np.random.Generator
    ) -> NDArray[np.int64]:
        """(n,) clusters from which movements begin with (n, 2) velocities, m/s.

        Tracks do not show the phase of a person's gait. So one of the clusters is drawn that are at
        most ``ALIKE`` worse than the best one.

        Args:
            velocities: in the coordinates of the person, who faces +x.
            rng: draws among the clusters.
        """
        mean, spread = self.first_velocities
        away = np.linalg.norm(velocities[:, None] - mean[None], axis=2)
        off = np.hypot(away, spread[None])
        fits = off <= off.min(axis=1, initial=np.inf)[:, None] + ALIKE
        # The place of the drawn one among those that fit.
        drawn = (rng.random(len(fits)) * fits.sum(axis=1)).astype(np.int64)
        return np.argmax(fits.cumsum(axis=1) > drawn[:, None], axis=1)

    def options(self, cluster: int) -> range:
        """Rows in ``table`` of the options that a pose of this cluster has."""
        return range(int(self.table.offsets[cluster]), int(self.table.offsets[cluster + 1]))


def _in_groups(
    frames: NDArray[np.integer], features: NDArray[np.float64], cluster: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The order of options by group, and the start of each group in it."""
    sort = np.lexsort((frames, cluster))
    cluster, frames = cluster[sort], frames[sort]
    changes = (np.diff(cluster) != 0) | (np.diff(frames) != 0)
    bounds = np.concatenate([[0], np.flatnonzero(changes) + 1, [len(sort)]])
    order, starts = group(features[sort], bounds.astype(np.int64))
    return sort[order], starts


def without_abrupt(mobility_map: MobilityMap, parts: Parts, most: float) -> Parts:
    """The options, whole or shortened, whose acceleration nowhere exceeds ``most`` (m/s2).

    Those too short to have an acceleration are kept, and so are those of clusters that have no
    other.
    """
    peaks = peak_accelerations(
        mobility_map.durations, mobility_map.path_offsets, mobility_map.paths
    )
    long = has_acceleration(mobility_map.durations)
    gentle = ~long[parts.rows] | (parts.share * peaks[parts.rows] <= most)
    cluster = np.searchsorted(mobility_map.offsets, parts.rows, side="right") - 1
    left = np.bincount(cluster[gentle], minlength=mobility_map.n_clusters)
    return parts.taken(np.flatnonzero(gentle | (left[cluster] == 0)))
