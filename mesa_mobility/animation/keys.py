"""The fewest frames between which a motion may be taken as straight."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def key_frames(
    values: NDArray[np.float64], tolerances: NDArray[np.float64], *, turns: bool = False
) -> list[NDArray[np.int64]]:
    """Frames of each channel that are kept, so that what viewers mix between them is near enough.

    The span between two keys is divided at the frame that is farthest off, until no frame is too
    far off (Douglas and Peucker 1973, in time).

    Args:
        values: (c, n, k) of each channel in successive frames; of turns, unit quaternions of which
            successive ones are on one side.
        tolerances: (c,) distance by which a frame may be off, in the unit of the values; of turns,
            radians.
        turns: whether the values are turns.

    Returns:
        For each channel its rising frames; the first alone if no frame is too far from it.
    """
    channels, count, width = values.shape
    flat = values.reshape(-1, width)
    limits = np.asarray(tolerances, dtype=np.float64)
    if turns:
        # The distance of unit quaternions is twice the sine of a fourth of the angle between them.
        limits = 2.0 * np.sin(limits / 4.0)
    firsts = np.arange(channels) * count
    rest = np.linalg.norm(values - values[:, :1], axis=2).max(axis=1) <= limits
    kept = np.zeros(len(flat), dtype=np.bool_)
    kept[firsts] = True
    begins = firsts[~rest]
    ends = begins + count - 1
    kept[ends] = True
    while len(begins):
        longer = ends - begins > 1
        begins, ends = begins[longer], ends[longer]
        splits = _farthest(flat, begins, ends, limits, count, turns)
        found = splits >= 0
        begins, ends, splits = begins[found], ends[found], splits[found]
        kept[splits] = True
        begins, ends = np.concatenate([begins, splits]), np.concatenate([splits, ends])
    rows = np.flatnonzero(kept)
    at = np.searchsorted(rows, [*firsts, len(flat)])
    return [rows[at[c] : at[c + 1]] - firsts[c] for c in range(channels)]


def _farthest(
    flat: NDArray[np.float64],
    begins: NDArray[np.int64],
    ends: NDArray[np.int64],
    limits: NDArray[np.float64],
    count: int,
    turns: bool,
) -> NDArray[np.int64]:
    """(s,) row in each span that is farthest from straight; -1 where none is too far."""
    if not len(begins):
        return begins
    inner = ends - begins - 1
    starts = np.cumsum(inner) - inner
    span = np.repeat(np.arange(len(begins)), inner)
    rows = begins[span] + 1 + np.arange(len(span)) - starts[span]
    share = ((rows - begins[span]) / (ends - begins)[span])[:, None]
    mixed = (1.0 - share) * flat[begins[span]] + share * flat[ends[span]]
    if turns:
        mixed /= np.linalg.norm(mixed, axis=1, keepdims=True)
    off = np.linalg.norm(flat[rows] - mixed, axis=1)
    most = np.maximum.reduceat(off, starts)
    _, first = np.unique(span[off == most[span]], return_index=True)
    worst = rows[off == most[span]][first]
    return np.where(most > limits[begins // count], worst, -1)
