"""Cost of options from the compiled terms: equation (1), term by term."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.close import Stance
from mesa_mobility.crowd.groups import OptionGroups
from mesa_mobility.crowd.kernels import call_bound_loop, call_option_loop, call_pair_loop
from mesa_mobility.crowd.options import FRAME_SECONDS, OptionTable
from mesa_mobility.crowd.state import CrowdState
from mesa_mobility.jit import lean


class Terms(NamedTuple):
    """Compiled cost terms: addresses, weights and parameters (row per term).

    ``bound_address`` belongs to the option terms, 0 for those that have no lower bound.
    """

    bound_address: NDArray[np.int64]
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


class Others(NamedTuple):
    """Neighbours of a pedestrian: place and velocity at the moment of its decision; (n,) each.

    ``cost`` is space for what each adds.
    """

    x: NDArray[np.float64]
    y: NDArray[np.float64]
    vx: NDArray[np.float64]
    vy: NDArray[np.float64]
    cost: NDArray[np.float64]


@lean()
def preferred_now(i: int, state: CrowdState) -> float:
    """Preferred speed of pedestrian i, m/s: none for somebody who has no way to go."""
    return state.preferred[i] if state.route[i] < np.inf else 0.0


@lean()
def lay_ends(me: Stance, rows: NDArray[np.int64], table: OptionTable, to: Ends, at: int) -> None:
    """Write the ends of a pedestrian's options in ``rows``, from row ``at`` of ``to`` on."""
    c, s, px, py = me.c, me.s, me.x, me.y
    x, y, ux, uy, speed, frames = table.x, table.y, table.ux, table.uy, table.speed, table.frames
    to_x, to_y, to_duration = to.x[at:], to.y[at:], to.duration[at:]
    to_ux, to_uy, to_speed = to.ux[at:], to.uy[at:], to.speed[at:]
    for k in range(len(rows)):
        o = rows[k]
        to_x[k] = px + c * x[o] - s * y[o]
        to_y[k] = py + s * x[o] + c * y[o]
        to_ux[k] = c * ux[o] - s * uy[o]
        to_uy[k] = s * ux[o] + c * uy[o]
        to_duration[k] = frames[o] * FRAME_SECONDS
        to_speed[k] = speed[o]


@lean()
def group_bounds(
    me: Stance,
    first: int,
    last: int,
    groups: OptionGroups,
    state: CrowdState,
    terms: Terms,
    ends: Ends,
    out: NDArray[np.float64],
) -> None:
    """Write lower bounds of what the option terms cost in groups ``first`` to ``last``.

    ``ends`` is space to work in.  All terms must have bounds.
    """
    c, s, px, py = me.c, me.s, me.x, me.y
    x, y, ux, uy = groups.x[first:], groups.y[first:], groups.ux[first:], groups.uy[first:]
    to_x, to_y, to_ux, to_uy = ends.x, ends.y, ends.ux, ends.uy
    for k in range(last - first):
        to_x[k] = px + c * x[k] - s * y[k]
        to_y[k] = py + s * x[k] + c * y[k]
        to_ux[k] = c * ux[k] - s * uy[k]
        to_uy[k] = s * ux[k] + c * uy[k]
        out[k] = 0.0
    preferred = preferred_now(me.row, state)
    for t in range(len(terms.bound_address)):
        call_bound_loop(
            terms.bound_address[t], last - first, to_x, to_y, groups.radius[first:], to_ux, to_uy,
            groups.turn[first:], groups.duration[first:], groups.slowest[first:],
            groups.fastest[first:], state.target_x[me.row], state.target_y[me.row], preferred,
            terms.option_parameters[t], terms.option_weight[t], out,
        )  # fmt: skip


@lean()
def option_costs(
    first: int,
    last: int,
    ends: Ends,
    target_x: float,
    target_y: float,
    preferred: float,
    terms: Terms,
    out: NDArray[np.float64],
) -> None:
    """Add the weighted sum of the option terms to ``out``, for rows ``first`` to ``last``."""
    for t in range(len(terms.option_address)):
        call_option_loop(
            terms.option_address[t], last - first, ends.x[first:], ends.y[first:],
            ends.ux[first:], ends.uy[first:], ends.duration[first:], ends.speed[first:],
            target_x, target_y, preferred, terms.option_parameters[t], terms.option_weight[t],
            out[first:],
        )  # fmt: skip


@lean()
def pair_cost(k: int, ends: Ends, count: int, others: Others, terms: Terms) -> float:
    """Weighted sum of the pair terms of option k over the first ``count`` neighbours."""
    total = 0.0
    for t in range(len(terms.pair_address)):
        call_pair_loop(
            terms.pair_address[t], count, ends.x[k], ends.y[k], ends.ux[k], ends.uy[k],
            ends.duration[k], ends.speed[k], others.x, others.y, others.vx, others.vy,
            terms.pair_parameters[t], others.cost,
        )  # fmt: skip
        summed = 0.0
        for a in range(count):
            summed += others.cost[a]
        total += terms.pair_weight[t] * summed
    return total
