"""The report of comparisons with experiments: one HTML page with everything in it."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence

from mesa_mobility.crowd.presets.given import Given
from mesa_mobility.reports.html import Page, picture
from mesa_mobility.validation.experiment import Experiment
from mesa_mobility.verification import Check, Verdict
from mesa_mobility.verification.report import computed_with, value_text


def write_report(
    experiments: Sequence[Experiment],
    verdicts: Mapping[str, Verdict],
    seeds: int,
    path: str | os.PathLike[str],
    rules: Given | None = None,
) -> None:
    """Write how crowds compare with measured ones as one HTML page, which needs no other file.

    Args:
        experiments: in the order of the page.
        verdicts: by the experiments' names.
        seeds: number of seeds.
        path: of the page.
        rules: that models followed instead of the default preset.

    Raises:
        ResultsError: the page cannot be written.
    """
    page = Page("Validation of mesa-mobility")
    passed = [verdicts[each.name].passed for each in experiments]
    page.text(
        f"{sum(passed)} of {len(passed)} comparisons pass. A comparison passes if each figure that "
        "is judged is as measured; no overlaps of bodies and no steps through walls are allowed."
    )
    page.table(
        "Summary",
        ["comparison", "what", "verdict"],
        [
            [each.name, each.what, "pass" if well else "FAIL"]
            for each, well in zip(experiments, passed, strict=True)
        ],
    )
    for each in experiments:
        verdict = verdicts[each.name]
        page.table(
            f"{each.name}: {each.what}",
            ["figure", "simulated", "criterion", "verdict"],
            [
                [check.figure, value_text(check.value), check.wanted, word_of(check)]
                for check in verdict.checks
            ]
            + [
                [name, value_text(figure), None, "reported"]
                for name, figure in verdict.figures.items()
                if isinstance(figure, int | float)
            ],
            f"Source: {each.source}.",
        )
        if verdict.figures:
            page.picture(
                "", picture(each.draw(verdict.figures)), f"Measured and simulated: {each.what}"
            )
    computed_with(page, seeds, rules)
    page.write(path)


def word_of(check: Check) -> str:
    """The verdict on one figure: "outside" is reported alone, "FAIL" counts."""
    return "pass" if check.met else "FAIL" if check.gates else "outside"
