"""The steps to which a map file rounds what it keeps."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

POSITION_STEP = 0.0005
"""Paths are stored in steps of half a millimetre ..."""

HEADING_STEP = 0.0002
"""... and of 0.2 milliradians, an eightieth of a degree."""

COST_STEP = 1e-4

PATH_STEPS = np.array([POSITION_STEP, POSITION_STEP, HEADING_STEP])


def quantise_paths(paths: NDArray[np.floating]) -> NDArray[np.float32]:
    """Round (p, 3) samples to the steps of the file, so that a saved map reads back unchanged."""
    return (np.rint(np.asarray(paths, dtype=np.float64) / PATH_STEPS) * PATH_STEPS).astype(
        np.float32
    )


def quantise_costs(costs: NDArray[np.floating]) -> NDArray[np.float32]:
    """Round costs to the step of the file."""
    return (np.rint(np.asarray(costs, dtype=np.float64) / COST_STEP) * COST_STEP).astype(np.float32)
