"""Accelerations of movement options.

A cluster joins poses of many speeds. An option starts from one of them but may be taken from any
pose of the cluster, so some options lead from standing to a brisk walk within one step.
People rarely do: of the recorded walkers' accelerations, 99 of 100 are below 1.1 m/s2, and of those
of people inside measured crowds, 99 of 100 are below 0.6 to 0.8 m/s2.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.mobility.edits import SAMPLE_EVERY

SMOOTHING_S = 0.3
"""Standard deviation in seconds of the Gaussian by which measured tracks are smoothed, too: steps
make the pelvis faster and slower all the time."""

SHORTEST_S = 2.0 * SMOOTHING_S
"""Shorter options have no acceleration of their own: smoothing leaves nothing of it."""

GENTLE = 0.95
"""m/s2; what the default preset leaves of a map are options that nowhere exceed it."""

_FRAME_S = 1.0 / 30.0
_SAMPLE_S = SAMPLE_EVERY * _FRAME_S


def has_acceleration(durations: NDArray[np.integer]) -> NDArray[np.bool_]:
    """Which options of these durations, in frames, are long enough to have an acceleration."""
    return durations * _FRAME_S >= SHORTEST_S


def is_gentle(
    durations: NDArray[np.integer], path_offsets: NDArray[np.integer], paths: NDArray[np.floating]
) -> NDArray[np.bool_]:
    """(m,) options that the default preset leaves; arguments as for ``peak_accelerations``."""
    return ~has_acceleration(durations) | (
        peak_accelerations(durations, path_offsets, paths) <= GENTLE
    )


def peak_accelerations(
    durations: NDArray[np.integer], path_offsets: NDArray[np.integer], paths: NDArray[np.floating]
) -> NDArray[np.float64]:
    """(m,) greatest acceleration along each option, m/s2.

    It is that of the path's velocity, smoothed by a Gaussian of ``SMOOTHING_S``.  The velocity
    before the start is taken to be that at the start, and so at the end.

    Args:
        durations: (m,) frames.
        path_offsets: (m,) or longer; where the samples of each option begin.
        paths: (p, 2) or wider; x and y in metres each 3 frames, relative to the start.
    """
    peaks = np.zeros(len(durations))
    for frames in np.unique(durations).tolist():
        rows = np.flatnonzero(durations == frames)
        count = frames // SAMPLE_EVERY
        changes = np.zeros((count - 1, 2, len(rows)), dtype=np.float32)
        weights = _acceleration_of(count).astype(np.float32)
        # One place after the other: a product of matrices rounds differently on other processors.
        for k in range(count):
            place = paths[path_offsets[rows] + k, :2].T
            changes += weights[k, :, None, None] * place
        peaks[rows] = np.sqrt(np.square(changes).sum(axis=1)).max(axis=0, initial=0.0)
    return peaks


def _acceleration_of(samples: int) -> NDArray[np.float64]:
    """(samples, samples - 1) matrix that makes smoothed accelerations of places after the start."""
    # Imported here, since reading most maps needs none of it.
    from scipy.ndimage import gaussian_filter1d

    velocities = (np.eye(samples) - np.eye(samples, k=-1)) / _SAMPLE_S
    smooth = gaussian_filter1d(velocities, SMOOTHING_S / _SAMPLE_S, axis=0, mode="nearest")
    changes: NDArray[np.float64] = np.diff(smooth, axis=0).T / _SAMPLE_S
    return changes
