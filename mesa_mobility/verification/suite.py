"""Tests of a standard: their cases and verdicts."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from mesa_mobility.crowd.presets.given import Given
from mesa_mobility.verification.cases import Case, Figures, run_cases
from mesa_mobility.verification.checks import Check, Verdict, exactly
from mesa_mobility.verification.drawings import Drawing

Judge = Callable[[Sequence[Figures]], Verdict]
PooledJudge = Callable[[Sequence[Sequence[Figures]]], Verdict]

PASS, FAIL, CAP = "pass", "fail", "cap"


@dataclass(frozen=True)
class VerificationTest:
    """A test: cases to run and a judge of their results.

    Attributes:
        cases: run for each seed.
        judge: verdict on one seed, from the figures of the cases in their order.
        pooled: verdict on all seeds together, where the criterion is one of statistics.
        chart: name of a diagram of the runs of all seeds, for reports (`diagrams.DIAGRAMS`).
    """

    cases: tuple[Case, ...]
    judge: Judge | None = None
    pooled: PooledJudge | None = None
    chart: str = ""


@dataclass(frozen=True)
class Outcome:
    """Result of a test over all its seeds.

    Attributes:
        verdict: "pass", "fail", or "cap": only a design cap that real crowds exceed is exceeded.
        measured: figures; medians over the seeds.
        failed: criteria not met, each with the seed.
        reported: criteria not met on which the verdict does not depend, each with the seed.
        seeds: the seeds.
        per_seed: verdict and figures of each seed, or of all together.
        safety: overlaps and wall crossings, and the share of time in the fallback.
        checks: each figure with a criterion, once for all seeds: the median of its values, met if
            it is met with every seed.
        drawings: of the cases with the first seed, each with what the case is of, if asked for.
        chart: name of a diagram and the figures of all runs, if asked for and the test has one.
    """

    verdict: str
    measured: dict[str, Any]
    failed: list[str]
    reported: list[str]
    seeds: list[int]
    per_seed: list[dict[str, Any]]
    safety: dict[str, Any]
    checks: list[Check] = field(default_factory=list)
    drawings: list[tuple[str, Drawing]] = field(default_factory=list)
    chart: tuple[str, Sequence[Sequence[Figures]]] | None = None

    @property
    def passed(self) -> bool:
        """Whether the test's criterion is met on every seed."""
        return self.verdict == PASS


def verify(
    tests: Mapping[str, VerificationTest],
    seeds: Sequence[int],
    jobs: int,
    *,
    caps: Sequence[str] = (),
    progress: Callable[[str, float, float], None] | None = None,
    drawn: bool = False,
    rules: Given | None = None,
) -> dict[str, Outcome]:
    """Run tests and judge them; cases that several tests share are run once.

    Args:
        tests: by id.
        seeds: each test runs once for each.
        jobs: processes.
        caps: ids of tests whose reported figures are design caps of the standard.
        progress: called with the progress of the runs.
        drawn: whether outcomes have drawings.
        rules: what models follow instead of the default preset.
    """
    cases = [each for test in tests.values() for each in test.cases]
    results = run_cases(cases, seeds, jobs, progress, drawn=drawn, rules=rules)
    outcomes = {}
    for name, test in tests.items():
        runs = [[results[each, seed] for each in test.cases] for seed in seeds]
        outcomes[name] = judged(test, seeds, runs, is_cap=name in caps, drawn=drawn)
    return outcomes


def judged(
    test: VerificationTest,
    seeds: Sequence[int],
    runs: Sequence[Sequence[Figures]],
    *,
    is_cap: bool = False,
    drawn: bool = False,
) -> Outcome:
    """The outcome of a test from the figures of its cases, for each seed in turn."""
    verdicts: list[tuple[int | None, Verdict]]
    if test.pooled is not None:
        verdicts = [(None, _verdict(test.pooled, runs, [f for row in runs for f in row]))]
    else:
        assert test.judge is not None
        verdicts = [
            (seed, _verdict(test.judge, row, row)) for seed, row in zip(seeds, runs, strict=True)
        ]
    failed: list[str] = []
    reported: list[str] = []
    for seed, verdict in verdicts:
        where = "" if seed is None else f" (seed {seed})"
        for check in verdict.checks:
            if not check.met:
                (failed if check.gates else reported).append(_said(check) + where)
    verdict_word = PASS if all(verdict.passed for _, verdict in verdicts) else FAIL
    if verdict_word == PASS and is_cap and reported:
        verdict_word = CAP
    every = [figures for row in runs for figures in row]
    flat = [figures for figures in every if "error" not in figures]
    whole = len(flat) == len(every)
    return Outcome(
        verdict=verdict_word,
        measured=_medians([verdict.measured for _, verdict in verdicts]),
        failed=failed,
        reported=reported,
        seeds=list(seeds),
        per_seed=[
            {"seed": seed, "passed": verdict.passed, "measured": verdict.measured}
            for seed, verdict in verdicts
        ],
        safety=_safety(flat),
        checks=_over_seeds([verdict.checks for _, verdict in verdicts]),
        chart=(test.chart, runs) if drawn and whole and test.chart else None,
        drawings=[
            (each.words, figures["drawing"])
            for each, figures in zip(test.cases, runs[0], strict=True)
            if "drawing" in figures
        ],
    )


def _verdict(judge: Callable[[Any], Verdict], runs: Any, figures: Sequence[Figures]) -> Verdict:
    errors = [each["error"] for each in figures if "error" in each]
    if errors:
        return Verdict((Check("error", None, f"no error, got {errors[0]}", met=False),))
    verdict = judge(runs)
    safe = tuple(
        exactly(name, sum(each[name] for each in figures), 0)
        for name in ("overlaps", "wall_crossings")
    )
    return Verdict(verdict.checks + safe, verdict.figures)


def _said(check: Check) -> str:
    value = "not measured" if check.value is None else f"{check.value:.4g}"
    return f"{check.figure}: {value}, wanted {check.wanted}"


def _over_seeds(checks: Sequence[Sequence[Check]]) -> list[Check]:
    """Each figure once: the median of its values, None where a seed has none, and whether all meet
    the criterion."""
    by_figure: dict[str, list[Check]] = {}
    for each in (check for of in checks for check in of):
        by_figure.setdefault(each.figure, []).append(each)
    found = []
    for figure, own in by_figure.items():
        values = [each.value for each in own if each.value is not None]
        middle = float(np.median(values)) if len(values) == len(own) else None
        # A criterion may be another one with each seed: one that is not met says most.
        worst = next((each for each in own if not each.met), own[0])
        met = all(each.met for each in own)
        found.append(Check(figure, middle, worst.wanted, met, any(each.gates for each in own)))
    return found


def _medians(measured: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Median over the seeds of each figure that is a number, the first seed's of any other."""
    middle: dict[str, Any] = {}
    for name in dict.fromkeys(name for each in measured for name in each):
        values = [each.get(name) for each in measured]
        numbers = [v for v in values if isinstance(v, int | float) and not isinstance(v, bool)]
        middle[name] = float(np.median(numbers)) if len(numbers) == len(values) else values[0]
    return middle


def _safety(figures: Sequence[Figures]) -> dict[str, Any]:
    time = sum(each["person_s"] for each in figures)
    fallback = sum(each["fallback_time_share"] * each["person_s"] for each in figures)
    return {
        "runs": len(figures),
        "overlaps": sum(each["overlaps"] for each in figures),
        "wall_crossings": sum(each["wall_crossings"] for each in figures),
        "fallback_time_share": fallback / time if time else 0.0,
    }
