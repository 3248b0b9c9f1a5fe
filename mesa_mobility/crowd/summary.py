"""The figures of a run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from mesa_mobility.crowd.model import PedestrianModel


def mean_speed(model: PedestrianModel) -> float:
    """Mean speed of the movements under way, m/s; 0 if nobody is inside."""
    if model.inside == 0:
        return 0.0
    return float(np.hypot(model.crowd.vx[model.rows], model.crowd.vy[model.rows]).mean())


def summarise(model: PedestrianModel) -> dict[str, Any]:
    """Figures of a run so far.

    Returns:
        ``model``, ``preset``, ``pedestrians``, ``simulated_s``, ``egress_s`` (None while anybody is
        inside, or where nobody ever was), ``left_inside``, ``stalled``, ``decisions``,
        ``fallback_decision_share``, ``fallback_time_share``, ``mean_speed_mps``
        (over all pedestrian-time) and ``occupancy`` ([[t, inside], ...] each second).
    """
    return {
        "model": type(model).__name__,
        "preset": model.preset,
        "pedestrians": model.count,
        "simulated_s": round(model.elapsed, 6),
        "egress_s": None if model.inside or model.last_left is None else round(model.last_left, 6),
        "left_inside": model.inside,
        "stalled": model.stalled,
        "decisions": int(model.crowd.decisions.sum()),
        "fallback_decision_share": model.fallback_decision_share,
        "fallback_time_share": model.fallback_time_share,
        "mean_speed_mps": model.mean_speed_so_far,
        "occupancy": [list(row) for row in model.occupancy],
    }
