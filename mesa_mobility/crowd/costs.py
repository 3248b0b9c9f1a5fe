"""Cost of options from the compiled terms: equation (1), term by term."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from mesa_mobility.crowd.capability import FRAME_SECONDS, OptionTable
from mesa_mobility.crowd.kernels import call_kernel
from mesa_mobility.crowd.state import CrowdState


class Terms(NamedTuple):
    """Compiled cost terms: addresses, weights and parameters (row per term)."""

    option_address: NDArray[np.int64]
    option_weight: NDArray[np.float64]
    option_parameters: NDArray[np.float64]
    pair_address: NDArray[np.int64]
    pair_weight: NDArray[np.float64]
    pair_parameters: NDArray[np.float64]


@njit(cache=True)
def preferred_now(i: int, state: CrowdState) -> float:
    """Preferred speed of pedestrian i, m/s: none for somebody who has no way to go."""
    return state.preferred[i] if state.route[i] < np.inf else 0.0


@njit(cache=True)
def option_costs(
    i: int,
    options: NDArray[np.int64],
    table: OptionTable,
    state: CrowdState,
    terms: Terms,
    out: NDArray[np.float64],
) -> None:
    """Weighted sum of the option terms for some options of pedestrian i, added to ``out``."""
    c, s = math.cos(state.heading[i]), math.sin(state.heading[i])
    preferred = preferred_now(i, state)
    for k in range(len(options)):
        o = options[k]
        x = state.x[i] + c * table.x[o] - s * table.y[o]
        y = state.y[i] + s * table.x[o] + c * table.y[o]
        duration = table.frames[o] * FRAME_SECONDS
        for t in range(len(terms.option_address)):
            out[k] += terms.option_weight[t] * call_kernel(
                terms.option_address[t], x, y, state.heading[i] + table.heading[o],
                table.displacement[o], duration, table.displacement[o] / duration,
                state.target_x[i], state.target_y[i], preferred,
                terms.option_parameters[t],
            )  # fmt: skip


@njit(cache=True)
def pair_cost(
    i: int,
    o: int,
    table: OptionTable,
    state: CrowdState,
    velocity: NDArray[np.float64],
    near: NDArray[np.int64],
    terms: Terms,
) -> float:
    """Weighted sum of the pair terms of option o of pedestrian i over its neighbours."""
    if len(terms.pair_address) == 0:
        return 0.0
    c, s = math.cos(state.heading[i]), math.sin(state.heading[i])
    x = state.x[i] + c * table.x[o] - s * table.y[o]
    y = state.y[i] + s * table.x[o] + c * table.y[o]
    duration = table.frames[o] * FRAME_SECONDS
    total = 0.0
    for t in range(len(terms.pair_address)):
        part = 0.0
        for j in near:
            part += call_kernel(
                terms.pair_address[t], x, y, state.heading[i] + table.heading[o], duration,
                table.displacement[o] / duration, state.x[j], state.y[j], velocity[j, 0],
                velocity[j, 1], terms.pair_parameters[t],
            )  # fmt: skip
        total += terms.pair_weight[t] * part
    return total
