"""The figures of a run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mesa_mobility.crowd.model import PedestrianModel


def summarise(model: PedestrianModel) -> dict[str, Any]:
    """Figures of a run so far.

    Returns:
        ``model``, ``preset``, ``pedestrians``, ``simulated_s``, ``egress_s`` (None while anybody is
        inside), ``left_inside``, ``stalled``, ``decisions``, ``fallback_decision_share``,
        ``fallback_time_share``, ``mean_speed_mps`` (over all pedestrian-time) and
        ``occupancy`` ([[t, inside], ...] each second).
    """
    return {
        "model": type(model).__name__,
        "preset": model.preset,
        "pedestrians": model.count,
        "simulated_s": round(model.elapsed, 6),
        "egress_s": None if model.inside else round(model.last_left, 6),
        "left_inside": model.inside,
        "stalled": model.stalled,
        "decisions": int(model.crowd.decisions.sum()),
        "fallback_decision_share": model.fallback_decision_share,
        "fallback_time_share": model.fallback_time_share,
        "mean_speed_mps": model.mean_speed_so_far,
        "occupancy": [list(row) for row in model.occupancy],
    }
