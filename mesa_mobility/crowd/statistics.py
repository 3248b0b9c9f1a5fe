"""The figures of a run."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar

from mesa_mobility.crowd.hooks import Saved
from mesa_mobility.crowd.state.advance import Moved
from mesa_mobility.schema import Each, Kind, Maybe, Real, Several, Whole

if TYPE_CHECKING:
    from mesa_mobility.crowd.model import PedestrianModel


class Statistics(Saved):
    """Figures of a model, kept while it runs.

    Args:
        model: the model.

    Attributes:
        occupancy: (seconds, people inside) each simulated second.
        last_left: seconds at which somebody last left, or None.
    """

    saved: ClassVar[Mapping[str, Kind]] = {
        "occupancy": Several(Each(Real(0.0), Whole())),
        "last_left": Maybe(Real(0.0)),
        "_walked": Real(0.0, 1e18),
        "_person_frames": Whole(),
        "_fallback_frames": Whole(),
    }

    def __init__(self, model: PedestrianModel) -> None:
        self._model = model
        self.occupancy: list[tuple[float, int]] = []
        self.last_left: float | None = None
        self._walked = 0.0
        self._person_frames = self._fallback_frames = 0

    def count_people(self) -> None:
        """Note how many are inside now."""
        self.occupancy.append((self._model.elapsed, len(self._model.population.present)))

    def add(self, moved: Moved, frames: int) -> None:
        """Add the results of the last frames."""
        for _ in range(frames):  # rounding must not depend on how many frames are skipped
            self._walked += moved.speeds
        self._person_frames += frames * (len(moved.stay) + len(moved.gone))
        self._fallback_frames += frames * moved.fallen
        if len(moved.gone):
            self.last_left = self._model.elapsed

    @property
    def mean_speed(self) -> float:
        """Mean speed of the movements under way after the last step, m/s; 0 if nobody is inside."""
        now = self._model.population.aggregates
        return now.speeds / now.people if now.people else 0.0

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
        crowd = self._model.crowd
        total = int(crowd.decisions.sum())
        return float(crowd.fallbacks.sum()) / total if total else 0.0

    def summary(self) -> dict[str, Any]:
        """The figures of ``PedestrianModel.summary``."""
        model, last_left = self._model, self.last_left
        out = model.inside == 0 and last_left is not None and not model.sources.expecting
        return {
            "model": type(model).__name__,
            "preset": model.preset,
            "rules": model.rules.numbers(),
            "pedestrians": model.population.count,
            "simulated_s": round(model.elapsed, 6),
            "egress_s": round(last_left or 0.0, 6) if out else None,
            "left_inside": model.inside,
            "stalled": model.stalled,
            "stall_reason": model.stall_reason,
            "decisions": int(model.crowd.decisions.sum()),
            "fallback_decision_share": self.fallback_decision_share,
            "fallback_time_share": self.fallback_time_share,
            "mean_speed_mps": self.mean_speed_so_far,
            "occupancy": [list(row) for row in self.occupancy],
        }
