"""Verdicts that several standards share: lone walkers, speed distributions, egress."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from mesa_mobility.verification.cases import Figures
from mesa_mobility.verification.checks import (
    Check,
    Verdict,
    at_least,
    exactly,
    less_than,
    rising,
    within,
)
from mesa_mobility.verification.references import published
from mesa_mobility.verification.suite import PooledJudge

KS_LEVEL = 0.05
LEAST_ENTRIES = 50
"""Entries that a bin needs to count."""


def mean(values: Sequence[float | None]) -> float | None:
    """Mean over the seeds; None if one of them has no value."""
    known = [value for value in values if value is not None]
    return float(np.mean(known)) if known and len(known) == len(values) else None


def everybody_out(figures: Sequence[Figures]) -> list[Check]:
    """Nobody is left inside in any of the runs."""
    return [exactly("left inside", sum(each["left_inside"] for each in figures), 0)]


def lone_walk(
    time: tuple[float, float], speed: float, tolerance: float = 0.05
) -> Callable[[Sequence[Figures]], Verdict]:
    """Travel time within bounds (seconds), speed within a share of the one set (m/s)."""

    def judge(runs: Sequence[Figures]) -> Verdict:
        (walk,) = runs
        low, high = speed * (1 - tolerance), speed * (1 + tolerance)
        return Verdict(
            (
                within("travel time s", walk["egress_s"], *time),
                within("speed m/s", walk["speed_mps"], low, high),
                at_least("least y m", walk["least_y_m"], 0.0),
                within("greatest y m", walk["greatest_y_m"], 0.0, 2.0),
            )
        )

    return judge


def climbs(
    speeds: Sequence[float], names: Sequence[str] = ()
) -> Callable[[Sequence[Figures]], Verdict]:
    """A judge of runs in which one person walks on a stair: each at the speed set, within 5 %.

    Args:
        speeds: set in each run, m/s.
        names: what each run is called; by default after its speed.
    """
    called = names or [f"where {speed:g} m/s is set" for speed in speeds]

    def judge(runs: Sequence[Figures]) -> Verdict:
        return Verdict(
            (
                *everybody_out(runs),
                *(
                    within(f"speed {name} m/s", run["speed_mps"], 0.95 * speed, 1.05 * speed)
                    for name, run, speed in zip(called, runs, speeds, strict=True)
                ),
            )
        )

    return judge


def corner(limit: float) -> Callable[[Sequence[Figures]], Verdict]:
    """A judge of a walk around a corner: all are out before ``limit`` (s), no point is outside."""

    def judge(runs: Sequence[Figures]) -> Verdict:
        (walk,) = runs
        return Verdict(
            (
                *everybody_out(runs),
                exactly("points outside", walk["points_outside"], 0),
                less_than("all out s", walk["egress_s"], limit),
            )
        )

    return judge


def speed_spread(
    distribution: Any, mean: float, sd: float, *, sd_within: float = 0.05
) -> Callable[[Sequence[Sequence[Figures]]], Verdict]:
    """Speeds walked, over all seeds, are those of a distribution (a frozen one of SciPy).

    Mean and standard deviation within 0.05 m/s, a Kolmogorov-Smirnov test at the 5 % level, and
    each person's mean speed within 0.05 m/s of their assigned speed.
    """

    def judge(seeds: Sequence[Sequence[Figures]]) -> Verdict:
        walked = np.array([v for (run,) in seeds for v in run["walked_mps"]], dtype=np.float64)
        assigned = np.array([v for (run,) in seeds for v in run["assigned_mps"]])
        arrived = walked[np.isfinite(walked)]
        p_value = float(stats.kstest(arrived, distribution.cdf).pvalue)
        error = np.abs(walked - assigned)
        return Verdict(
            (
                exactly("walkers who did not arrive", len(walked) - len(arrived), 0),
                within("mean m/s", float(arrived.mean()), mean - 0.05, mean + 0.05),
                within("sd m/s", float(arrived.std(ddof=1)), sd - sd_within, sd + sd_within),
                at_least("KS p", p_value, KS_LEVEL),
            ),
            {
                "variance": float(arrived.var(ddof=1)),
                "mean error m/s": float(np.nanmean(error)),
                "greatest error m/s": float(np.nanmax(error)),
            },
        )

    return judge


def counterflow(runs: Sequence[Figures]) -> Verdict:
    """Crossing takes longer with more people in the other direction; nobody remains stuck."""
    times = [each["last_entered_s"] for each in runs]
    ratios = {}
    if all(time is not None for time in times):
        ratios = {
            f"T{count}/T0": time / times[0]
            for count, time in zip((10, 50, 100), times[1:], strict=True)
        }
    stuck = sum(100 - each["entered"] for each in runs)
    return Verdict(
        (
            exactly("people who did not get through", stuck, 0),
            *everybody_out(runs),
            rising("least rise of the last entry s", times),
        ),
        {
            **{f"T{n} s": time for n, time in zip((0, 10, 50, 100), times, strict=True)},
            **ratios,
        },
    )


def closed_exits(runs: Sequence[Figures]) -> Verdict:
    """Closing two of four exits about doubles the time to empty the hall."""
    four, two = (each["egress_s"] for each in runs)
    ratio = None if four is None or two is None else two / four
    return Verdict(
        (*everybody_out(runs), within("T_B/T_A", ratio, 1.7, 2.3)),
        {"T_A s": four, "T_B s": two},
    )


def single_file_bins(figures: Sequence[Figures]) -> dict[str, NDArray[np.float64]]:
    """p10, p50 and p90 of the speed (m/s) in bins 0.2 persons/m wide, as the reference has them."""
    density = np.concatenate([each["density"] for each in figures])
    along = np.concatenate([each["along"] for each in figures])
    number = np.floor(density / 0.2).astype(np.int64)
    rows = []
    for k in range(int(number.max()) + 1):
        here = along[number == k]
        if len(here) >= LEAST_ENTRIES:
            rows.append(((k + 0.5) * 0.2, len(here), *np.percentile(here, (10, 50, 90))))
    return dict(zip(("density", "n", "p10", "p50", "p90"), np.array(rows).T, strict=True))


def single_file_share(bins: Figures) -> tuple[Check, Figures]:
    """Share of the bins whose median lies within the least and greatest speed measured."""
    reference = published("1D single file")
    where = np.searchsorted(reference["density"], bins["density"] - 1e-6)
    known = (bins["density"] > 0.29) & (bins["density"] < reference["density"][-1] + 0.05)
    low, high = reference["v_min"][where[known]], reference["v_max"][where[known]]
    middle = bins["p50"][known]
    inside = (middle >= low) & (middle <= high)
    share = float(inside.mean()) if len(inside) else None
    return at_least("share of bins within the reference", share, 0.75), {
        "bins compared": len(inside),
        "bins outside": [round(float(d), 1) for d in bins["density"][known][~inside]],
    }


def allocated(runs: Sequence[Figures]) -> Verdict:
    """15 people leave by the main exit and 8 by the other, as assigned."""
    (run,) = runs
    return Verdict(
        (
            exactly("to the main exit", run["to_main"], 15),
            exactly("to the secondary exit", run["to_secondary"], 8),
            exactly("by another exit than allocated", run["astray"], 0),
        )
    )


def starts_follow(names: Sequence[str], distributions: Sequence[Any]) -> PooledJudge:
    """Times at which people start follow the distributions, one for each case."""

    def judge(seeds: Sequence[Sequence[Figures]]) -> Verdict:
        checks: list[Check] = []
        for name, distribution, of in zip(
            names, distributions, zip(*seeds, strict=True), strict=True
        ):
            pairs = [
                (start, time)
                for run in of
                for start, time in zip(run["started"], run["assigned"], strict=True)
            ]
            late = [start - time for start, time in pairs if start is not None]
            known = [start for start, _ in pairs if start is not None]
            p_value = float(stats.kstest(known, distribution.cdf).pvalue) if known else None
            checks += [
                exactly(f"{name}: people who never started", len(pairs) - len(known), 0),
                at_least(f"{name}: KS p", p_value, KS_LEVEL),
                within(f"{name}: latest start after its time s", max(late, default=None), 0, 1.5),
            ]
        return Verdict(tuple(checks))

    return judge
