"""The side-to-side motion of a straight walker's pelvis."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.ndimage import uniform_filter1d

from mesa_mobility.errors import ResultsError

FloatArray = NDArray[np.float64]

# Stride frequencies of walkers, Hz: slow ones go down to the lower figure, those faster than
# SLOW_MPS to the middle one.
STRIDE_HZ = (0.42, 0.62, 1.35)
SLOW_MPS = 0.7


@dataclass(frozen=True, eq=False)
class Sway:
    """Side-to-side motion of one walker.

    Attributes:
        stride_frequency: left-right cycles a second, Hz; the step frequency is twice that.
        per_cycle: (k,) metres, peak to peak within each gait cycle.
    """

    stride_frequency: float
    per_cycle: FloatArray

    @property
    def peak_to_peak(self) -> float:
        """Median over the gait cycles of the peak-to-peak motion, metres."""
        return float(np.median(self.per_cycle))


def lateral_sway(x: ArrayLike, y: ArrayLike, frame_rate: float = 30.0) -> Sway:
    """Side-to-side motion of someone who walks straight on.

    The motion across the direction of walking (a straight line fitted to the path) loses its slow
    drift (a cubic). The highest peak of its spectrum (Hann window) between 0.62 Hz, or 0.42 Hz for
    walkers below 0.7 m/s, and 1.35 Hz is the stride. What remains after subtracting the running
    mean over one stride is cut into strides.

    Args:
        x: (n,) metres, path of the pelvis.
        y: (n,) metres.
        frame_rate: frames a second.

    Raises:
        ResultsError: fewer than four gait cycles of the slowest stride, or no way made.
    """
    path = np.column_stack((np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64)))
    shortest = int(np.ceil(4 * frame_rate / STRIDE_HZ[0]))
    if len(path) < shortest:
        raise ResultsError(
            f"side-to-side motion needs {shortest / frame_rate:.1f} s of walking, "
            f"got {len(path) / frame_rate:.1f} s"
        )
    if not np.hypot(*(path[-1] - path[0])) > 1.0:
        raise ResultsError("side-to-side motion needs somebody who walks: less than 1 m covered")
    time = np.linspace(-1.0, 1.0, len(path))
    along = np.polynomial.polynomial.polyfit(time, path, 1)[1]
    along /= np.hypot(*along)
    across = path @ np.array([-along[1], along[0]])
    drift = np.polynomial.polynomial.polyfit(time, across, 3)
    across = across - np.polynomial.polynomial.polyval(time, drift)

    speed = np.hypot(*(path[-1] - path[0])) * frame_rate / (len(path) - 1)
    lowest = STRIDE_HZ[0] if speed < SLOW_MPS else STRIDE_HZ[1]
    stride = _highest_peak(across, frame_rate, lowest, STRIDE_HZ[2])
    cycle = round(frame_rate / stride)
    swing = across - uniform_filter1d(across, cycle)
    # Half a window at either end has no full running mean.
    swing = swing[cycle // 2 + 1 : len(swing) - cycle // 2 - 1]
    cycles = swing[: len(swing) // cycle * cycle].reshape(-1, cycle)
    return Sway(stride, np.ptp(cycles, axis=1))


def _highest_peak(signal: FloatArray, frame_rate: float, lowest: float, highest: float) -> float:
    # Eight times padded: a short walk otherwise resolves its stride to 0.1 Hz only.
    size = 8 * len(signal)
    frequency = np.fft.rfftfreq(size, 1.0 / frame_rate)
    strength = np.abs(np.fft.rfft(signal * np.hanning(len(signal)), size))
    band = np.flatnonzero((frequency >= lowest) & (frequency <= highest))
    # The slope of a peak outside the band may be higher than any peak within.
    peaks = band[(strength[band] > strength[band - 1]) & (strength[band] >= strength[band + 1])]
    candidates = peaks if len(peaks) else band
    return float(frequency[candidates[np.argmax(strength[candidates])]])
