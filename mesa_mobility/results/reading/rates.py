"""The frame rate of tracks that do not tell it, by the gait of people who walk.

The length of a step and the frequency of steps rise together: their ratio, the walk ratio, is about
the same for all adults and speeds (N. Sekiya, H. Nagasaki, H. Ito and T. Furuna, The invariant
relationship between step length and step rate during free walking, Journal of Human Movement
Studies 30 (1996)). Heads sway to the side once in two steps. So the way of a sway gives its
frequency, and its frames the frame rate.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.signal import periodogram

from mesa_mobility.results.reading.rows import Rows

FloatArray = NDArray[np.float64]

WALK_RATIO = 0.38
"""Length of a step over the frequency of steps, metres x seconds: 0.0064 m / (steps a minute)."""
USUAL_RATES = (8.0, 10.0, 16.0, 25.0, 30.0, 50.0, 60.0)
"""Frame rates of cameras and simulators; that of many experiments is 16 or 25."""
WINDOW = 96
"""Frames of a piece of a track: 2 to 10 s."""
LEAST_WAY = 1.5
"""Way in a piece that counts, metres: people walk."""
STRIDES = (0.7, 2.2)
"""Shortest and longest stride that is looked for, metres."""
LEAST_PIECES = 20
MOST_SCATTER = 2.0
"""Largest ratio of the third to the first quartile of rates by piece."""


def usual_rate(rows: Rows, metres: float) -> tuple[float, float, int] | None:
    """The usual frame rate that fits people's gait.

    Args:
        rows: sorted by (person, frame).
        metres: of a unit of their coordinates.

    Returns:
        The rate, the rate that the gait gives, and from how many pieces of tracks; None if too few
        people walk straight on, or their gaits disagree.
    """
    found = gait_rates(rows, metres)
    if len(found) < LEAST_PIECES:
        return None
    low, middle, high = np.percentile(found, (25, 50, 75))
    if high > MOST_SCATTER * low:
        return None
    usual = min(USUAL_RATES, key=lambda rate: abs(np.log(rate / middle)))
    return usual, float(middle), len(found)


def gait_rates(rows: Rows, metres: float) -> FloatArray:
    """(k,) frame rate by the gait in each piece of a track in which somebody walks."""
    places = np.column_stack([rows.x, rows.y]) * metres
    starts = np.arange(0, len(places) - WINDOW, WINDOW // 2)
    ends = starts + WINDOW - 1
    whole = (rows.person[starts] == rows.person[ends]) & (
        rows.frame[ends] - rows.frame[starts] == WINDOW - 1
    )
    pieces = places[starts[whole, None] + np.arange(WINDOW)]
    way = pieces[:, -1] - pieces[:, 0]
    length = np.hypot(way[:, 0], way[:, 1])
    walks = length >= LEAST_WAY
    pieces, way, length = pieces[walks], way[walks], length[walks]
    if not len(pieces):
        return np.empty(0)
    aside = (pieces[:, :, 1] * way[:, None, 0] - pieces[:, :, 0] * way[:, None, 1]) / length[
        :, None
    ]
    # A cubic takes out that people turn and change lanes.
    basis = np.vander(np.linspace(-1.0, 1.0, WINDOW), 4)
    aside = aside - aside @ np.linalg.pinv(basis).T @ basis.T
    frequency, power = periodogram(aside * np.hanning(WINDOW), nfft=1024, axis=1)
    step = (length / (WINDOW - 1))[:, None]  # metres a frame
    with np.errstate(divide="ignore"):
        stride = step / frequency[None]
    power = np.where((stride >= STRIDES[0]) & (stride <= STRIDES[1]), power, -1.0)
    sways = np.flatnonzero(power.max(axis=1, initial=-1.0) > 0.0)
    best = power[sways].argmax(axis=1)
    # A step is half a stride, and takes half of its time: so many strides a second, and a frame.
    a_second = stride[sways, best] / (4.0 * WALK_RATIO)
    return np.asarray(a_second / frequency[best])
