"""The result of a calibration."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

from mesa_mobility.crowd.presets.preset import Preset
from mesa_mobility.crowd.presets.provenance import Provenance
from mesa_mobility.experiments.intervals import Estimate

if TYPE_CHECKING:
    import pandas as pd

TRAINED, NEW_SEEDS, NEW_DATA = "training", "new seeds", "held-out data"
"""Data and seeds that the search has seen; training data with new seeds; data held out."""


@dataclass(frozen=True)
class Generation:
    """One generation of the search.

    Attributes:
        numbers: the sets of numbers that were tried, each as values by name.
        costs: cost of each set; small is good.
        failed: how many sets had a run that failed.
        middle: middle of the distribution after this generation, values by name.
    """

    numbers: Sequence[dict[str, float]]
    costs: Sequence[float]
    failed: int
    middle: dict[str, float]


@dataclass(frozen=True)
class Figure:
    """A distance with the numbers at the start and with those found.

    Attributes:
        part: "training" (data and seeds of the last generation), "new seeds" (training data, seeds
            that the search has not had) or "held-out data" (the same seeds).
        scenario: name of the scenario; empty for what the search makes small, over all of them.
        distance: name of the distance.
        start: mean distance over the seeds with the numbers at the start, with its interval.
        found: mean distance over the seeds with the numbers found, with its interval.
        change: mean of the difference, found less start, seed by seed, with its interval.
        failed: runs with either set of numbers that failed; they do not count.
    """

    part: str
    scenario: str
    distance: str
    start: Estimate
    found: Estimate
    change: Estimate
    failed: int

    @property
    def verdict(self) -> str:
        """Whether the numbers found are better, worse, or neither beyond the scatter of seeds."""
        low, high = self.change.low, self.change.high
        if low is None or high is None:
            return "one seed"
        return "better" if high < 0.0 else "worse" if low > 0.0 else "no difference"


@dataclass(frozen=True)
class Calibrated:
    """The outcome of a calibration.

    Attributes:
        store: path or URL of its folder.
        began: the day on which it began.
        base: the preset at the start.
        data: sha256 of the files with measured data, by name.
        values: the numbers found, by name.
        history: the generations of the search.
        figures: distances at the start and in the end, on training and held-out data.
    """

    store: str
    began: str
    base: Preset
    data: Mapping[str, str]
    values: dict[str, float]
    history: tuple[Generation, ...]
    figures: tuple[Figure, ...]

    @cached_property
    def preset(self) -> Preset:
        """The preset at the start with the numbers found, and where they come from.

        Numbers of behaviours that the preset does not name are left out.
        """
        known = self.base.parameters()
        changed = self.base.with_parameters(
            {name: value for name, value in self.values.items() if name in known}
        )
        figures = {
            f"{each.part}: {each.distance}" + (f", {each.scenario}" if each.scenario else ""): (
                each.found.value
            )
            for each in self.figures
            if each.found.value is not None
        }
        provenance = Provenance(
            date=self.began,
            command="mesa_mobility.calibration.calibrate",
            data=self.data,
            figures=figures,
        )
        return replace(changed, name=f"{changed.name}, calibrated", provenance=provenance)

    def frame(self) -> pd.DataFrame:
        """The figures as a table, a row each."""
        import pandas as pd

        rows = [
            {
                "part": each.part,
                "scenario": each.scenario,
                "distance": each.distance,
                "start": each.start.value,
                "found": each.found.value,
                "change": each.change.value,
                "change_low": each.change.low,
                "change_high": each.change.high,
                "verdict": each.verdict,
                "failed": each.failed,
            }
            for each in self.figures
        ]
        return pd.DataFrame(rows)
