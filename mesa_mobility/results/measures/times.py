"""Times until something happens, where to some it has not happened when the run ends."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def quantile_of_times(times: NDArray[np.float64], q: float) -> float | None:
    """Quantile of times, of which infinite ones are later than all others.

    Args:
        times: (n,) seconds; infinite where it has not happened (right-censored).
        q: from 0 to 1.

    Returns:
        The quantile, interpolated between two of the times; None where one of these is infinite,
        or where there are no times.
    """
    if not len(times):
        return None
    known = np.isfinite(times)
    upper = int(np.ceil((len(times) - 1) * q))
    if upper >= int(known.sum()):
        return None
    # The infinite ones lie beyond the two, as any other late time does.
    return float(np.quantile(np.where(known, times, times[known].max()), q))
