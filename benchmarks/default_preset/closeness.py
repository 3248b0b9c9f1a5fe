"""How far figures are off, in units of what each may be."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

MOST = 6.0
"""A figure that is off by more counts as off by this much: no single one rules the search."""


def off(ratios: Mapping[str, tuple[float, float]]) -> float:
    """Mean square of ln(simulated / measured) in units of tolerances.

    Args:
        ratios: simulated over measured and the tolerance of that, by figure; a ratio that is not
            a positive number is as far off as any.
    """
    each = [
        min(abs(math.log(ratio)) / tolerance, MOST) if 0.0 < ratio < math.inf else MOST
        for ratio, tolerance in ratios.values()
    ]
    return float(np.mean(np.square(each)))


def beyond(value: float, low: float, high: float, tolerance: float) -> float:
    """Square of how far a value is outside a range, in units of the tolerance."""
    outside = max(low - value, value - high, 0.0) / tolerance
    return min(outside, MOST) ** 2 if math.isfinite(outside) else MOST**2
