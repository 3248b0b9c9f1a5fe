"""Cost of options from the compiled terms: equation (1), term by term."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import force_inlined, internal
from mesa_mobility.crowd.collision.sampled import Decider
from mesa_mobility.crowd.costs.kernel_calls import (
    call_bound_loop,
    call_option_loop,
    call_wall_loop,
)
from mesa_mobility.crowd.costs.layout import END_UX, END_UY, END_X, END_Y, KernelTable
from mesa_mobility.crowd.options.option_groups import UX, UY, OptionGroups, X, Y


@force_inlined()
def group_bounds(
    me: Decider,
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
        weight = table.weight[me.kind, t]
        call_bound_loop(
            table.address[t],
            (n, ends, of, me.record, table.fields[t], table.numbers[t], weight, out),
        )


@force_inlined()
def option_costs(
    me: Decider, ends: NDArray[np.float64], table: KernelTable, out: NDArray[np.float64]
) -> None:
    """Add the weighted sum of the option terms to ``out``, one number for each option."""
    n = len(out)
    for t in range(len(table.address)):
        weight = table.weight[me.kind, t]
        call_option_loop(
            table.address[t],
            (n, ends, me.record, table.fields[t], table.numbers[t], weight, out),
        )


@internal()
def wall_cost(
    me: Decider, k: int, ends: NDArray[np.float64], walls: NDArray[np.float64], table: KernelTable
) -> float:
    """Weighted sum of the wall terms of option k, each for its worst wall.

    Args:
        me: the pedestrian.
        k: the option.
        ends: (6, n) ends of options.
        walls: (w, 5) walls within reach, with squared distances.
        table: the wall terms.
    """
    total, option = 0.0, ends[:, k:]
    for t in range(len(table.address)):
        total += table.weight[me.kind, t] * call_wall_loop(
            table.address[t],
            (len(walls), option, walls, me.record, table.fields[t], table.numbers[t]),
        )
    return total
