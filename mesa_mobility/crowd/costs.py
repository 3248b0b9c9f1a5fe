"""Cost of options from the compiled terms: equation (1), term by term."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from mesa_mobility.crowd.capability import FRAME_SECONDS, OptionTable
from mesa_mobility.crowd.kernels import call_option_loop, call_pair_loop
from mesa_mobility.crowd.state import CrowdState


class Terms(NamedTuple):
    """Compiled cost terms: addresses, weights and parameters (row per term)."""

    option_address: NDArray[np.int64]
    option_weight: NDArray[np.float64]
    option_parameters: NDArray[np.float64]
    pair_address: NDArray[np.int64]
    pair_weight: NDArray[np.float64]
    pair_parameters: NDArray[np.float64]


class Ends(NamedTuple):
    """Where the options of a pedestrian end, in the world: place, unit vector of facing, seconds
    until then, m/s on the way; (n,) each."""

    x: NDArray[np.float64]
    y: NDArray[np.float64]
    ux: NDArray[np.float64]
    uy: NDArray[np.float64]
    duration: NDArray[np.float64]
    speed: NDArray[np.float64]


def empty_ends(n: int) -> Ends:
    """Room for the ends of n options."""
    return Ends(*(np.empty(n) for _ in Ends._fields))


class Others(NamedTuple):
    """Neighbours of a pedestrian: place and velocity at the moment of its decision; (n,) each."""

    x: NDArray[np.float64]
    y: NDArray[np.float64]
    vx: NDArray[np.float64]
    vy: NDArray[np.float64]


@njit(cache=True)
def preferred_now(i: int, state: CrowdState) -> float:
    """Preferred speed of pedestrian i, m/s: none for somebody who has no way to go."""
    return state.preferred[i] if state.route[i] < np.inf else 0.0


@njit(cache=True)
def lay_ends(
    i: int, first: int, last: int, table: OptionTable, state: CrowdState, to: Ends
) -> None:
    """Write the ends of the options ``first`` to ``last`` of pedestrian i."""
    c, s = math.cos(state.heading[i]), math.sin(state.heading[i])
    px, py = state.x[i], state.y[i]
    x, y, ux, uy = (
        table.x[first:last],
        table.y[first:last],
        table.ux[first:last],
        table.uy[first:last],
    )
    frames, speed = table.frames[first:last], table.speed[first:last]
    for k in range(last - first):
        to.x[k] = px + c * x[k] - s * y[k]
        to.y[k] = py + s * x[k] + c * y[k]
        to.ux[k] = c * ux[k] - s * uy[k]
        to.uy[k] = s * ux[k] + c * uy[k]
        to.duration[k] = frames[k] * FRAME_SECONDS
        to.speed[k] = speed[k]


@njit(cache=True)
def option_costs(
    n: int,
    ends: Ends,
    target_x: float,
    target_y: float,
    preferred: float,
    terms: Terms,
    out: NDArray[np.float64],
) -> None:
    """Weighted sum of the option terms of one pedestrian's n options, added to ``out``."""
    for t in range(len(terms.option_address)):
        call_option_loop(
            terms.option_address[t], n, ends.x, ends.y, ends.ux, ends.uy, ends.duration,
            ends.speed, target_x, target_y, preferred, terms.option_parameters[t],
            terms.option_weight[t], out,
        )  # fmt: skip


@njit(cache=True)
def pair_cost(k: int, ends: Ends, count: int, others: Others, terms: Terms) -> float:
    """Weighted sum of the pair terms of option k over the first ``count`` neighbours."""
    total = 0.0
    for t in range(len(terms.pair_address)):
        total += terms.pair_weight[t] * call_pair_loop(
            terms.pair_address[t], count, ends.x[k], ends.y[k], ends.ux[k], ends.uy[k],
            ends.duration[k], ends.speed[k], others.x, others.y, others.vx, others.vy,
            terms.pair_parameters[t],
        )  # fmt: skip
    return total
