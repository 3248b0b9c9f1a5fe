"""Two crowds compared, figure by figure, with an envelope over seeds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.errors import ResultsError
from mesa_mobility.results.distances.figures import AGREEMENTS, FIGURES, Agreement, Figure
from mesa_mobility.results.distances.seen import Seen
from mesa_mobility.results.distances.view import View
from mesa_mobility.results.tracks import Tracks

if TYPE_CHECKING:
    import pandas as pd

FloatArray = NDArray[np.float64]

NUMBER = "number"
"""Statistic of figures that compare two curves."""
QUANTILES = (0.05, 0.5, 0.95)
"""Lower end, middle and upper end of an envelope."""


@dataclass(frozen=True, eq=False)
class Envelope:
    """What several seeds give: quantiles 0.05, 0.5 and 0.95 over the seeds that have a value.

    Attributes:
        low: lower end, a number or (n,) curve.
        middle: median, a number or (n,) curve.
        high: upper end, a number or (n,) curve.
        seeds: number of runs.
    """

    low: FloatArray
    middle: FloatArray
    high: FloatArray
    seeds: int

    @classmethod
    def of(cls, values: FloatArray) -> Envelope:
        """The envelope of (seeds, ...) values; not a number where no seed has one."""
        filled = np.where(np.isfinite(values), values, np.nan)
        known = np.isfinite(filled).any(axis=0)
        # nanquantile warns of columns without any value.
        low, middle, high = np.where(
            known, np.nanquantile(np.where(known, filled, 0.0), QUANTILES, axis=0), np.nan
        )
        return cls(np.asarray(low), np.asarray(middle), np.asarray(high), len(values))


@dataclass(frozen=True, eq=False)
class Distance:
    """One figure of both crowds.

    Attributes:
        name: of the figure.
        unit: of values and distance.
        statistic: which statistic of the figure ``measured`` and ``simulated`` are, such as "sd".
        measured: statistic of all measured runs together; for ``erd``, ``epc`` and ``sc`` the value
            for equal curves.
        simulated: statistic of each seed.
        distance: of each seed from the measured runs.
        curve: the curve of each seed, or None for samples.
        measured_curve: of the measured runs together.
        sample: (k,) values of all seeds together, or None for curves.
        measured_sample: (k,) values of the measured runs together.
    """

    name: str
    unit: str
    statistic: str
    measured: float
    simulated: Envelope
    distance: Envelope
    curve: Envelope | None = None
    measured_curve: FloatArray | None = None
    sample: FloatArray | None = None
    measured_sample: FloatArray | None = None

    @property
    def ratio(self) -> float:
        """Simulated, in the middle of the seeds, over measured; not a number for ``erd``, ``epc``
        and ``sc``, which are ratios themselves."""
        if self.statistic == NUMBER:
            return float("nan")
        with np.errstate(divide="ignore", invalid="ignore"):
            return float(np.divide(self.simulated.middle, self.measured))


@dataclass(frozen=True, eq=False)
class Comparison:
    """Two crowds, compared.

    Attributes:
        distances: by name of the figure.
        left_out: figures that the view does not give what they need, and what that is.
    """

    distances: dict[str, Distance]
    left_out: dict[str, str]

    def __getitem__(self, name: str) -> Distance:
        if name not in self.distances:
            why = f"expected one of {', '.join(self.distances)}"
            if name in self.left_out:
                why = f"the view has no {self.left_out[name]}"
            raise ResultsError(f"figure {name!r}: {why}")
        return self.distances[name]

    def to_pandas(self) -> pd.DataFrame:
        """A row for each figure."""
        import pandas as pd

        rows = [
            {
                "figure": each.name,
                "statistic": each.statistic,
                "unit": each.unit,
                "measured": each.measured,
                "low": float(each.simulated.low),
                "simulated": float(each.simulated.middle),
                "high": float(each.simulated.high),
                "ratio": each.ratio,
                "distance_low": float(each.distance.low),
                "distance": float(each.distance.middle),
                "distance_high": float(each.distance.high),
                "seeds": each.distance.seeds,
            }
            for each in self.distances.values()
        ]
        return pd.DataFrame(rows)

    def __str__(self) -> str:
        return self.to_pandas().to_string(index=False, float_format=lambda value: f"{value:.3g}")


def compare(
    simulated: Tracks | Sequence[Tracks],
    measured: Tracks | Sequence[Tracks],
    view: View,
    *,
    measured_view: View | None = None,
    figures: Sequence[str] | None = None,
) -> Comparison:
    """Compare two crowds.

    Args:
        simulated: a run for each seed.
        measured: one run or several, which are taken together.
        view: where and when people count.
        measured_view: where and when people of the measured crowd count; by default ``view``.
        figures: names; by default all that the view suffices for.

    Raises:
        ResultsError: an unknown figure, a view that lacks what a named figure needs, nobody in the
            view, or PedPy is not installed.
    """
    ours = [Seen.of(each, view) for each in _several(simulated, "simulated")]
    theirs = [Seen.of(each, measured_view or view) for each in _several(measured, "measured")]
    known: dict[str, Figure | Agreement] = {each.name: each for each in (*AGREEMENTS, *FIGURES)}
    for name in figures or ():
        if name not in known:
            raise ResultsError(f"figure {name!r}: expected one of {', '.join(known)}")
    distances: dict[str, Distance] = {}
    left_out: dict[str, str] = {}
    for name in known if figures is None else figures:
        figure = known[name]
        lacking = [
            each
            for each in figure.needs
            if getattr(view, each) is None or getattr(measured_view or view, each) is None
        ]
        if lacking:
            if figures is not None:
                raise ResultsError(f"figure {name!r}: the view has no {lacking[0]}")
            left_out[name] = lacking[0]
            continue
        distances[name] = _distance(
            figure, [figure.measure(run) for run in ours], [figure.measure(run) for run in theirs]
        )
    return Comparison(distances, left_out)


def _several(runs: Tracks | Sequence[Tracks], name: str) -> list[Tracks]:
    found = [runs] if isinstance(runs, Tracks) else list(runs)
    if not found:
        raise ResultsError(f"{name}: no runs, expected one or more")
    return found


def _distance(
    figure: Figure | Agreement, ours: list[FloatArray], theirs: list[FloatArray]
) -> Distance:
    """One figure of both crowds."""
    if isinstance(figure, Agreement):
        shortest = min(len(each) for each in theirs)
        pooled = np.mean([each[:shortest] for each in theirs], axis=0)
        numbers = np.array([figure.number(each, pooled) for each in ours])
        return Distance(
            figure.name,
            "1",
            NUMBER,
            figure.perfect,
            Envelope.of(numbers),
            Envelope.of(np.abs(numbers - figure.perfect)),
        )
    pooled = figure.pooled(theirs)
    found = Distance(
        figure.name,
        figure.unit,
        figure.statistic[0],
        figure.number(pooled),
        Envelope.of(np.array([figure.number(each) for each in ours])),
        Envelope.of(np.array([figure.distance(each, pooled) for each in ours])),
    )
    if not figure.curve:
        return replace(found, sample=figure.pooled(ours), measured_sample=pooled)
    return replace(found, curve=Envelope.of(figure.table(ours)), measured_curve=pooled)
