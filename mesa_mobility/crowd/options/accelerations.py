"""Accelerations of movement options.

A cluster joins poses of many speeds. An option starts from one of them but may be taken from any
pose of the cluster, so some options lead from standing to a brisk walk within one step.
People rarely do: of the recorded walkers' accelerations, 99 of 100 are below 1.1 m/s2, and of those
of people inside measured crowds, 99 of 100 are below 0.6 to 0.8 m/s2.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from mesa_mobility.crowd.options.table import FRAME_SECONDS, SAMPLE_FRAMES, Parts
from mesa_mobility.mobility import MobilityMap

SMOOTHING_S = 0.3
"""Standard deviation in seconds of the Gaussian by which measured tracks are smoothed, too: steps
make the pelvis faster and slower all the time."""

SHORTEST_S = 2.0 * SMOOTHING_S
"""Shorter options have no acceleration of their own: smoothing leaves nothing of it."""

_SAMPLE_S = SAMPLE_FRAMES * FRAME_SECONDS


def without_abrupt(mobility_map: MobilityMap, parts: Parts, most: float) -> Parts:
    """The options, whole or shortened, whose acceleration nowhere exceeds ``most`` (m/s2).

    Those shorter than ``SHORTEST_S`` are kept, and so are those of clusters that have no other.
    """
    peaks = peak_accelerations(mobility_map)
    long = mobility_map.durations * FRAME_SECONDS >= SHORTEST_S
    gentle = ~long[parts.rows] | (parts.share * peaks[parts.rows] <= most)
    cluster = np.searchsorted(mobility_map.offsets, parts.rows, side="right") - 1
    left = np.bincount(cluster[gentle], minlength=mobility_map.n_clusters)
    return parts.taken(np.flatnonzero(gentle | (left[cluster] == 0)))


def peak_accelerations(mobility_map: MobilityMap) -> NDArray[np.float64]:
    """(options,) greatest acceleration along each option of a map, m/s2.

    It is that of the path's velocity, smoothed by a Gaussian of ``SMOOTHING_S``.  The velocity
    before the start is taken to be that at the start, and so at the end.
    """
    peaks = np.zeros(mobility_map.n_options)
    for frames in np.unique(mobility_map.durations).tolist():
        rows = np.flatnonzero(mobility_map.durations == frames)
        count = frames // SAMPLE_FRAMES
        changes = np.zeros((count - 1, 2, len(rows)), dtype=np.float32)
        weights = _acceleration_of(count).astype(np.float32)
        # One place after the other: a product of matrices rounds differently on other processors.
        for k in range(count):
            place = mobility_map.paths[mobility_map.path_offsets[rows] + k, :2].T
            changes += weights[k, :, None, None] * place
        peaks[rows] = np.sqrt(np.square(changes).sum(axis=1)).max(axis=0, initial=0.0)
    return peaks


def _acceleration_of(samples: int) -> NDArray[np.float64]:
    """(samples, samples - 1) matrix that makes smoothed accelerations of places after the start."""
    velocities = (np.eye(samples) - np.eye(samples, k=-1)) / _SAMPLE_S
    smooth = gaussian_filter1d(velocities, SMOOTHING_S / _SAMPLE_S, axis=0, mode="nearest")
    changes: NDArray[np.float64] = np.diff(smooth, axis=0).T / _SAMPLE_S
    return changes
