"""The report of comparisons with experiments: one HTML page with everything in it."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from mesa_mobility.crowd.presets.given import Given
from mesa_mobility.reports.html import Link, Page, picture
from mesa_mobility.validation.experiment import Experiment
from mesa_mobility.verification import Verdict
from mesa_mobility.verification.report import SAFETY, computed_with, lead_of, table_of_checks

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_COLUMNS = 2
"""Panels of a picture beside each other."""

_PANEL = 4.4, 3.4
"""Width and height of a panel, inches."""


def write_report(
    experiments: Sequence[Experiment],
    verdicts: Mapping[str, Verdict],
    seeds: int,
    path: str | os.PathLike[str],
    rules: Given | None = None,
    command: str = "",
) -> None:
    """Write how crowds compare with measured ones as one HTML page, which needs no other file.

    Args:
        experiments: in the order of the page.
        verdicts: by the experiments' names.
        seeds: number of seeds.
        path: of the page.
        rules: that models followed instead of the default preset.
        command: that runs them again, without its options; "" for none.

    Raises:
        ResultsError: the page cannot be written.
    """
    page = Page("Validation of mesa-mobility", lead_of(seeds, rules))
    passed = [verdicts[each.name].passed for each in experiments]
    page.section("Summary", "summary")
    page.text(
        f"{sum(passed)} of {len(passed)} comparisons pass. A comparison passes if each figure that "
        "is judged lies within what was measured, and there are no overlaps of bodies and no steps "
        "through walls."
    )
    page.table(
        "Comparisons and their verdicts",
        ["comparison", "what is compared", "figures judged", "not as measured", "verdict"],
        [
            [
                Link(_words(each), each.name),
                each.what,
                sum(check.gates for check in verdicts[each.name].checks),
                sum(check.gates and not check.met for check in verdicts[each.name].checks),
                "pass" if well else "FAIL",
            ]
            for each, well in zip(experiments, passed, strict=True)
        ],
    )
    page.text(SAFETY)
    page.section("Comparisons", "comparisons")
    for each in experiments:
        _comparison(page, each, verdicts[each.name], seeds)
    computed_with(page, seeds, rules, command)
    page.signatures()
    page.write(path)


def _words(experiment: Experiment) -> str:
    return experiment.name.replace("_", " ")


def _comparison(page: Page, experiment: Experiment, verdict: Verdict, seeds: int) -> None:
    page.subsection(f"{_words(experiment)}: {experiment.what}", experiment.name)
    rows = [
        ["measured", experiment.source],
        ["criterion", experiment.criterion],
        ["verdict", "pass" if verdict.passed else "FAIL"],
    ]
    page.table("The comparison", ["", ""], rows)
    table_of_checks(
        page,
        "What was found" + (f" in the runs of {seeds} seeds" if seeds > 1 else ""),
        verdict.checks,
        verdict.figures,
        note="Figures with the verdict “outside” or “reported” do not count for the verdict of the "
        "comparison.",
    )
    if verdict.figures:
        page.picture(
            f"Measured (grey) and simulated (coloured): {experiment.what}. Bands about curves hold "
            "the middle 80 %, other bands what was measured",
            picture(_in_two_columns(experiment.draw(verdict.figures))),
        )


def _in_two_columns(figure: Figure) -> Figure:
    """A figure whose panels are large enough on paper: two beside each other."""
    if len(figure.axes) > _COLUMNS:
        rows = -(-len(figure.axes) // _COLUMNS)
        grid = figure.add_gridspec(rows, _COLUMNS)
        for number, axes in enumerate(figure.axes):
            axes.set_subplotspec(grid[divmod(number, _COLUMNS)])
        width, height = _PANEL
        figure.set_size_inches(_COLUMNS * width, rows * height)
    return figure
