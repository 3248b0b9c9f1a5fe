"""Cost of options from the compiled terms: equation (1), term by term."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import force_inlined, internal
from mesa_mobility.crowd.collision.sampled import EgoPose
from mesa_mobility.crowd.costs.kernel_calls import (
    call_bound_loop,
    call_option_loop,
    call_wall_loop,
)
from mesa_mobility.crowd.costs.layout import (
    END_UX,
    END_UY,
    END_X,
    END_Y,
    FIELDS,
    ME_CORE,
    ME_PREFERRED,
    ME_TARGET_X,
    ME_TARGET_Y,
    ME_VX,
    ME_VY,
    ME_X,
    ME_Y,
    KernelTable,
    Own,
    Terms,
)
from mesa_mobility.crowd.options.option_groups import UX, UY, OptionGroups, X, Y
from mesa_mobility.crowd.state.records import CrowdState


@internal()
def preferred_now(i: int, state: CrowdState) -> float:
    """Preferred speed of pedestrian i, m/s; 0 for somebody without a route."""
    return state.preferred[i] if state.route[i] < np.inf else 0.0


@force_inlined()
def lay_self(me: EgoPose, state: CrowdState, terms: Terms, record: NDArray[np.float64]) -> Own:
    """The pedestrian as cost terms see it; ``record`` (8 + fields,) is written."""
    i = me.row
    record[ME_X], record[ME_Y] = me.x, me.y
    record[ME_TARGET_X], record[ME_TARGET_Y] = state.target_x[i], state.target_y[i]
    record[ME_PREFERRED] = preferred_now(i, state)
    record[ME_VX], record[ME_VY] = state.vx[i], state.vy[i]
    record[ME_CORE] = me.core
    for field in range(terms.fields.shape[1]):
        record[FIELDS + field] = terms.fields[i, field]
    return Own(state.type_index[i], record)


@force_inlined()
def group_bounds(
    me: EgoPose,
    own: Own,
    first: int,
    groups: OptionGroups,
    table: KernelTable,
    ends: NDArray[np.float64],
    out: NDArray[np.float64],
) -> None:
    """Write lower bounds of the option terms in ``len(out)`` groups from ``first`` on.

    ``ends`` (6, n) gets the ends of the groups.  All terms must have bounds.
    """
    c, s, px, py = me.c, me.s, me.x, me.y
    of, n = groups.ends[:, first:], len(out)
    x, y, ux, uy = of[X], of[Y], of[UX], of[UY]
    to_x, to_y, to_ux, to_uy = ends[END_X], ends[END_Y], ends[END_UX], ends[END_UY]
    for k in range(n):
        to_x[k] = px + c * x[k] - s * y[k]
        to_y[k] = py + s * x[k] + c * y[k]
        to_ux[k] = c * ux[k] - s * uy[k]
        to_uy[k] = s * ux[k] + c * uy[k]
        out[k] = 0.0
    for t in range(len(table.address)):
        weight = table.weight[own.kind, t]
        call_bound_loop(
            table.address[t],
            (n, ends, of, own.record, table.fields[t], table.numbers[t], weight, out),
        )


@force_inlined()
def option_costs(
    own: Own, ends: NDArray[np.float64], table: KernelTable, out: NDArray[np.float64]
) -> None:
    """Add the weighted sum of the option terms to ``out``, one number for each option."""
    n = len(out)
    for t in range(len(table.address)):
        weight = table.weight[own.kind, t]
        call_option_loop(
            table.address[t],
            (n, ends, own.record, table.fields[t], table.numbers[t], weight, out),
        )


@internal()
def wall_cost(
    own: Own, k: int, ends: NDArray[np.float64], walls: NDArray[np.float64], table: KernelTable
) -> float:
    """Weighted sum of the wall terms of option k, each for its worst wall.

    Args:
        own: the pedestrian.
        k: the option.
        ends: (6, n) ends of options.
        walls: (w, 5) walls within reach, with squared distances.
        table: the wall terms.
    """
    total, option = 0.0, ends[:, k:]
    for t in range(len(table.address)):
        total += table.weight[own.kind, t] * call_wall_loop(
            table.address[t],
            (len(walls), option, walls, own.record, table.fields[t], table.numbers[t]),
        )
    return total
