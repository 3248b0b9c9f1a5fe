"""Options that start or end abruptly are left out; see ``mobility.standing.accelerations``."""

from __future__ import annotations

import numpy as np

from mesa_mobility.crowd.options.table import Parts
from mesa_mobility.mobility import MobilityMap
from mesa_mobility.mobility.standing.accelerations import has_acceleration, peak_accelerations


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
