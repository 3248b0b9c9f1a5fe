"""Comparisons with experiments: their cases, verdict and picture."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

from matplotlib.figure import Figure

from mesa_mobility.verification import Case, Check, Verdict
from mesa_mobility.verification.cases import Figures

Runs: TypeAlias = Sequence[Sequence[Figures]]
"""Figures of each case, for each seed in turn."""


@dataclass(frozen=True)
class Experiment:
    """One comparison.

    Attributes:
        name: its name on the command line.
        what: its subject, in one line.
        source: origin of the measured figures, as a reader can find it.
        criterion: what is asked of the simulated crowd, in words.
        cases: run for each seed.
        judge: verdict, with a table for each figure that is drawn, from the runs of all seeds.
        draw: a picture of a verdict's figures.
    """

    name: str
    what: str
    source: str
    criterion: str
    cases: tuple[Case, ...]
    judge: Callable[[Runs], Verdict]
    draw: Callable[[dict[str, Any]], Figure]


def judged(experiment: Experiment, runs: Runs) -> Verdict:
    """The verdict on an experiment, with checks for overlaps and steps through walls.

    If a run has ended with an error, the verdict is one unmet check that quotes the first error.
    """
    flat = [figures for row in runs for figures in row]
    errors = [each["error"] for each in flat if "error" in each]
    if errors:
        return Verdict((Check("error", None, f"no error, got {errors[0]}", met=False),))
    verdict = experiment.judge(runs)
    time = sum(each["person_s"] for each in flat)
    spent = sum(each["fallback_time_share"] * each["person_s"] for each in flat)
    safe = tuple(
        Check(name, float(sum(each[name] for each in flat)), "0", not any(e[name] for e in flat))
        for name in ("overlaps", "wall_crossings")
    )
    figures = {**verdict.figures, "runs": len(flat), "fallback time share": spent / time}
    return Verdict(verdict.checks + safe, figures)
