"""The figures of a run."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

from mesa_mobility.crowd.population import Population
from mesa_mobility.crowd.saved import Saved
from mesa_mobility.crowd.state.advance import Moved
from mesa_mobility.crowd.state.records import Crowd
from mesa_mobility.schema import Each, Kind, Maybe, Real, Several, Whole


class Statistics(Saved):
    """Figures of a model, kept while it runs.

    Args:
        population: its people.
        crowd: their records.

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

    def __init__(self, population: Population, crowd: Crowd) -> None:
        self._population, self._crowd = population, crowd
        self.occupancy: list[tuple[float, int]] = []
        self.last_left: float | None = None
        self._walked = 0.0
        self._person_frames = self._fallback_frames = 0

    def count_people(self, elapsed: float) -> None:
        """Note how many are inside now, ``elapsed`` seconds after the start."""
        self.occupancy.append((elapsed, len(self._population.present)))

    def add(self, moved: Moved, frames: int, elapsed: float) -> None:
        """Add the results of the last frames, up to ``elapsed`` seconds after the start."""
        for _ in range(frames):  # rounding must not depend on how many frames are skipped
            self._walked += moved.speeds
        self._person_frames += frames * (len(moved.stay) + len(moved.gone))
        self._fallback_frames += frames * moved.fallen
        if len(moved.gone):
            self.last_left = elapsed

    @property
    def mean_speed(self) -> float:
        """Mean speed of the movements under way after the last step, m/s; 0 if nobody is inside."""
        now = self._population.aggregates
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
        crowd = self._crowd
        total = int(crowd.decisions.sum())
        return float(crowd.fallbacks.sum()) / total if total else 0.0
