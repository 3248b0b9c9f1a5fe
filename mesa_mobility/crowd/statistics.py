"""The figures of a run."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.options.table import FRAME_SECONDS
from mesa_mobility.crowd.stall import stall_reason
from mesa_mobility.crowd.state.aggregates import Aggregates
from mesa_mobility.crowd.state.records import Crowd
from mesa_mobility.floorplan import FloorPlan


class CrowdStatistics:
    """Figures of a model, worked out from its crowd."""

    crowd: Crowd
    floor_plan: FloorPlan
    frame: int
    count: int
    preset: str
    stalled: bool
    last_left: float | None
    occupancy: list[tuple[float, int]]
    expecting: bool
    _rows: NDArray[np.int64]
    _seen: Aggregates
    _walked: float
    _person_frames: int
    _fallback_frames: int

    @property
    def frame_rate(self) -> float:
        """Frames a second."""
        return 1.0 / FRAME_SECONDS

    @property
    def elapsed(self) -> float:
        """Simulated seconds since the start."""
        return self.frame * FRAME_SECONDS

    @property
    def inside(self) -> int:
        """People inside."""
        return len(self._rows)

    @property
    def stall_reason(self) -> str | None:
        """Why the evacuation has stalled, in a few words; None if it has not."""
        return stall_reason(self.floor_plan, self._seen) if self.stalled else None

    @property
    def mean_speed(self) -> float:
        """Mean speed of the movements under way after the last step, m/s; 0 if nobody is inside."""
        return self._seen.speeds / self._seen.people if self._seen.people else 0.0

    @property
    def mean_speed_so_far(self) -> float:
        """Mean speed over all pedestrian-time so far, m/s."""
        return self._walked / self._person_frames if self._person_frames else 0.0

    @property
    def fallback_time_share(self) -> float:
        """Share of pedestrian-time spent in the fallback."""
        return self._fallback_frames / self._person_frames if self._person_frames else 0.0

    @property
    def fallback_decision_share(self) -> float:
        """Share of decisions that ended in the fallback."""
        total = int(self.crowd.decisions.sum())
        return float(self.crowd.fallbacks.sum()) / total if total else 0.0

    def summary(self) -> dict[str, Any]:
        """Figures of the run so far, ready for JSON.

        Returns:
            ``model``, ``preset``, ``pedestrians``, ``simulated_s``, ``egress_s`` (None while
            anybody is inside or to come, or where nobody ever was), ``left_inside``, ``stalled``,
            ``stall_reason`` (None unless stalled), ``decisions``, ``fallback_decision_share``,
            ``fallback_time_share``, ``mean_speed_mps`` (over all pedestrian-time) and ``occupancy``
            ([[t, inside], ...] each second).
        """
        out = self.inside == 0 and self.last_left is not None and not self.expecting
        return {
            "model": type(self).__name__,
            "preset": self.preset,
            "pedestrians": self.count,
            "simulated_s": round(self.elapsed, 6),
            "egress_s": round(self.last_left or 0.0, 6) if out else None,
            "left_inside": self.inside,
            "stalled": self.stalled,
            "stall_reason": self.stall_reason,
            "decisions": int(self.crowd.decisions.sum()),
            "fallback_decision_share": self.fallback_decision_share,
            "fallback_time_share": self.fallback_time_share,
            "mean_speed_mps": self.mean_speed_so_far,
            "occupancy": [list(row) for row in self.occupancy],
        }
