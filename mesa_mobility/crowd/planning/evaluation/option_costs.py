"""Cost of options from the compiled terms: equation (1), term by term."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import force_inlined, internal
from mesa_mobility.crowd.collision.sampled import EgoPose
from mesa_mobility.crowd.costs.kernel_calls import (
    call_bound_loop,
    call_option_loop,
    call_wall_loop,
)
from mesa_mobility.crowd.costs.layout import END_UX, END_UY, END_X, END_Y, SECONDS, SPEED
from mesa_mobility.crowd.options.option_groups import (
    DURATION,
    FASTEST,
    RADIUS,
    SLOWEST,
    TURN,
    UX,
    UY,
    OptionGroups,
    X,
    Y,
)
from mesa_mobility.crowd.options.table import FRAME_SECONDS, OptionTable
from mesa_mobility.crowd.state.records import CrowdState


class Terms(NamedTuple):
    """Compiled cost terms: addresses, weights and parameters (row per term).

    ``bound_address`` belongs to the option terms, 0 for those without a lower bound.
    ``pairs_address`` belongs to the pair terms: the loop over some neighbours and many options;
    so does ``pair_bound_address``, 0 for those without a lower bound.
    Wall terms count the worst wall. Weights are by pedestrian type and term.

    ``fields`` (people, fields) are the values that any of the terms takes, ``option_fields`` and
    ``pair_fields`` which of them each term takes.
    """

    bound_address: NDArray[np.int64]
    option_address: NDArray[np.int64]
    option_weight: NDArray[np.float64]
    option_parameters: NDArray[np.float64]
    option_fields: NDArray[np.int64]
    pair_address: NDArray[np.int64]
    pair_weight: NDArray[np.float64]
    pair_parameters: NDArray[np.float64]
    pair_fields: NDArray[np.int64]
    pairs_address: NDArray[np.int64]
    pair_bound_address: NDArray[np.int64]
    wall_address: NDArray[np.int64]
    wall_weight: NDArray[np.float64]
    wall_parameters: NDArray[np.float64]
    fields: NDArray[np.float64]


@internal()
def preferred_now(i: int, state: CrowdState) -> float:
    """Preferred speed of pedestrian i, m/s; 0 for somebody without a route."""
    return state.preferred[i] if state.route[i] < np.inf else 0.0


@internal()
def lay_ends(
    me: EgoPose, rows: NDArray[np.int64], table: OptionTable, to: NDArray[np.float64], at: int
) -> None:
    """Write the ends (6, n) of a pedestrian's options in ``rows``, from column ``at`` on."""
    c, s, px, py = me.c, me.s, me.x, me.y
    to_x, to_y, to_duration = to[END_X, at:], to[END_Y, at:], to[SECONDS, at:]
    to_ux, to_uy, to_speed = to[END_UX, at:], to[END_UY, at:], to[SPEED, at:]
    for k in range(len(rows)):
        o = table.options[rows[k]]
        to_x[k] = px + c * o.x - s * o.y
        to_y[k] = py + s * o.x + c * o.y
        to_ux[k] = c * o.ux - s * o.uy
        to_uy[k] = s * o.ux + c * o.uy
        to_duration[k] = o.frames * FRAME_SECONDS
        to_speed[k] = o.speed


@force_inlined()
def group_bounds(
    me: EgoPose,
    first: int,
    last: int,
    groups: OptionGroups,
    state: CrowdState,
    terms: Terms,
    ends: NDArray[np.float64],
    out: NDArray[np.float64],
) -> None:
    """Write lower bounds of the option terms in groups ``first`` to ``last``.

    ``ends`` (6, n) is workspace.  All terms must have bounds.
    """
    c, s, px, py = me.c, me.s, me.x, me.y
    of = groups.ends
    x, y, ux, uy = of[X, first:], of[Y, first:], of[UX, first:], of[UY, first:]
    to_x, to_y, to_ux, to_uy = ends[END_X], ends[END_Y], ends[END_UX], ends[END_UY]
    for k in range(last - first):
        to_x[k] = px + c * x[k] - s * y[k]
        to_y[k] = py + s * x[k] + c * y[k]
        to_ux[k] = c * ux[k] - s * uy[k]
        to_uy[k] = s * ux[k] + c * uy[k]
        out[k] = 0.0
    preferred, kind = preferred_now(me.row, state), state.type_index[me.row]
    for t in range(len(terms.bound_address)):
        call_bound_loop(
            terms.bound_address[t], last - first, to_x, to_y, of[RADIUS, first:], to_ux, to_uy,
            of[TURN, first:], of[DURATION, first:], of[SLOWEST, first:], of[FASTEST, first:],
            px, py, state.target_x[me.row], state.target_y[me.row], preferred, state.vx[me.row],
            state.vy[me.row], terms.option_parameters[t], terms.option_weight[kind, t], out,
        )  # fmt: skip


@force_inlined()
def option_costs(
    me: EgoPose,
    first: int,
    last: int,
    ends: NDArray[np.float64],
    state: CrowdState,
    terms: Terms,
    out: NDArray[np.float64],
) -> None:
    """Add the weighted sum of the option terms to ``out``, for rows ``first`` to ``last``."""
    preferred, kind = preferred_now(me.row, state), state.type_index[me.row]
    for t in range(len(terms.option_address)):
        call_option_loop(
            terms.option_address[t], last - first, ends[END_X, first:], ends[END_Y, first:],
            ends[END_UX, first:], ends[END_UY, first:], ends[SECONDS, first:], ends[SPEED, first:],
            me.x, me.y, state.target_x[me.row], state.target_y[me.row], preferred,
            state.vx[me.row], state.vy[me.row], terms.fields[me.row], terms.option_fields[t],
            terms.option_parameters[t], terms.option_weight[kind, t], out[first:],
        )  # fmt: skip


@internal()
def wall_cost(
    me: EgoPose,
    k: int,
    ends: NDArray[np.float64],
    walls: NDArray[np.float64],
    state: CrowdState,
    terms: Terms,
) -> float:
    """Weighted sum of the wall terms of option k, each for its worst wall.

    Args:
        me: the pedestrian.
        k: the option.
        ends: (6, n) ends of options.
        walls: (w, 5) walls within reach, with squared distances.
        state: the crowd.
        terms: compiled terms.
    """
    total, kind = 0.0, state.type_index[me.row]
    for t in range(len(terms.wall_address)):
        total += terms.wall_weight[kind, t] * call_wall_loop(
            terms.wall_address[t], len(walls), ends[END_X, k], ends[END_Y, k], ends[END_UX, k],
            ends[END_UY, k], ends[SECONDS, k], ends[SPEED, k], me.x, me.y,
            state.target_x[me.row], state.target_y[me.row], me.core, walls,
            terms.wall_parameters[t],
        )  # fmt: skip
    return total
