"""Where the movements under way lead.

Of a movement only its start, its end and the option are kept; the knots between come from the
table of options, to the last bit as they were when they were tested.
"""

from __future__ import annotations

from mesa_mobility.crowd.options import OptionTable
from mesa_mobility.crowd.state import CrowdState
from mesa_mobility.jit import lean


@lean()
def knot(state: CrowdState, table: OptionTable, j: int, k: int) -> tuple[float, float]:
    """Where knot k of the movement of pedestrian j is, metres."""
    if k >= state.knots[j] - 1:
        return state.to_x[j], state.to_y[j]
    if k <= 0:
        return state.from_x[j], state.from_y[j]
    # Whoever is between its first knot and its last has an option.
    own = table.path[state.option[j]]
    x, y, c, s = state.from_x[j], state.from_y[j], state.from_c[j], state.from_s[j]
    return x + c * own[0, k] - s * own[1, k], y + s * own[0, k] + c * own[1, k]


@lean()
def facing_at_knot(state: CrowdState, table: OptionTable, j: int, k: int) -> float:
    """How pedestrian j faces at knot k of its movement, radians."""
    if k >= state.knots[j] - 1:
        return float(state.to_heading[j])
    if k <= 0:
        return float(state.from_heading[j])
    return float(state.from_heading[j] + table.path[state.option[j], 2, k])


@lean()
def position_at(state: CrowdState, table: OptionTable, j: int, time: float) -> tuple[float, float]:
    """Where pedestrian j is at a time in frames, standing once its movement has ended."""
    last = state.knots[j] - 1
    u = (time - state.start[j]) / state.spacing[j]
    k = int(u)
    if k >= last:
        return state.to_x[j], state.to_y[j]
    u -= k
    ax, ay = knot(state, table, j, k)
    bx, by = knot(state, table, j, k + 1)
    return ax + u * (bx - ax), ay + u * (by - ay)
