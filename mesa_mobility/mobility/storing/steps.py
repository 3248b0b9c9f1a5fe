"""The steps to which a map file rounds what it keeps."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

POSITION_STEP = 0.0005
"""Paths are stored in steps of half a millimetre ..."""

HEADING_STEP = 0.0002
"""... and of 0.2 milliradians, an eightieth of a degree."""

COST_STEP = 1e-4

_PIECE = 8192

PATH_STEPS = np.array([POSITION_STEP, POSITION_STEP, HEADING_STEP])


def quantise_paths(paths: NDArray[np.floating]) -> NDArray[np.float32]:
    """Round (p, 3) samples to the steps of the file, so that a saved map reads back unchanged."""
    rounded = np.empty(paths.shape, dtype=np.float32)
    # In pieces that stay in the processor's cache: a map has some millions of samples.
    for start in range(0, len(paths), _PIECE):
        steps = paths[start : start + _PIECE] / PATH_STEPS
        np.multiply(np.rint(steps, out=steps), PATH_STEPS, out=steps)
        rounded[start : start + _PIECE] = steps
    return rounded


def quantise_costs(costs: NDArray[np.floating]) -> NDArray[np.float32]:
    """Round costs to the step of the file."""
    return (np.rint(np.asarray(costs, dtype=np.float64) / COST_STEP) * COST_STEP).astype(np.float32)
