"""`mesa-mobility validate`: crowds beside measured ones."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from mesa_mobility.commands.checks.options import FAILED, CheckOptions
from mesa_mobility.commands.console import answer_json, progress_bar, say, some_path
from mesa_mobility.commands.grouping import grouped

if TYPE_CHECKING:
    from mesa_mobility.crowd.presets.given import Given
    from mesa_mobility.validation import Experiment
    from mesa_mobility.verification import Verdict

OutFolder = Annotated[
    Path | None,
    typer.Option(
        help="Folder for validation.json and a picture of each experiment.",
        parser=some_path,
        metavar="PATH",
    ),
]


@grouped
def validate(
    names: Annotated[
        list[str] | None,
        typer.Argument(metavar="[NAME]...", help="Experiments to run; by default all."),
    ] = None,
    *,
    options: CheckOptions,
    out: OutFolder = None,
) -> None:
    """Compare crowds with measured ones: speeds, flows, densities, lanes, standing.

    Ends with status 1 if a figure misses its criterion.
    """
    from mesa_mobility.validation import chosen

    chosen_ones = chosen(names or [])
    command = " ".join(["mesa-mobility validate", *(each.name for each in chosen_ones)])
    run_experiments(chosen_ones, options.rules(), options, out, command)


def run_experiments(
    experiments: list[Experiment],
    rules: Given,
    options: CheckOptions,
    out: Path | None,
    command: str = "",
) -> None:
    """Run and judge experiments, and write and print what was asked for.

    Args:
        experiments: to run.
        rules: for all models that are made.
        options: how they are run, and the report.
        out: folder for figures and pictures.
        command: that runs them again with the options of ``rules``, for the report; "" for none.

    Raises:
        typer.Exit: a figure is not as measured.
        ResultsError: a file cannot be written.
    """
    from mesa_mobility.results import check_writable
    from mesa_mobility.validation import judged
    from mesa_mobility.verification import run_cases

    report_file = options.report_file
    if out is not None:
        check_writable(out, _files(experiments))
    options.check_report()
    cases = [each for experiment in experiments for each in experiment.cases]
    with progress_bar(shown=not options.no_progress) as report:
        results = run_cases(cases, options.runs, options.processes, report, rules=rules)
    verdicts = {
        experiment.name: judged(
            experiment,
            [[results[each, seed] for each in experiment.cases] for seed in options.runs],
        )
        for experiment in experiments
    }
    named = {"preset": rules.preset_name}
    answer = {each.name: _as_json(each, verdicts[each.name]) | named for each in experiments}
    if out is not None:
        _write(out, experiments, verdicts, answer)
        say(f"written to {out}")
    if report_file is not None:
        from mesa_mobility.validation.report import write_report

        write_report(experiments, verdicts, options.seeds, report_file, rules, command)
        options.finish_report()
    _print_table(experiments, verdicts)
    if options.as_json:
        answer_json(answer)
    if not all(verdict.passed for verdict in verdicts.values()):
        raise typer.Exit(FAILED)


def _as_json(experiment: Experiment, verdict: Verdict) -> dict[str, Any]:
    return {
        "passed": verdict.passed,
        "measured": verdict.measured,
        "criterion": {check.figure: check.wanted for check in verdict.checks},
        "source": experiment.source,
        "what": experiment.what,
        "failed": [check.figure for check in verdict.checks if check.gates and not check.met],
        "reported": [check.figure for check in verdict.checks if not check.gates],
    }


def _write(
    out: Path,
    experiments: list[Experiment],
    verdicts: dict[str, Verdict],
    answer: dict[str, Any],
) -> None:
    from mesa_mobility.results.files import all_or_none, json_text

    with all_or_none(out, _files(experiments)) as temporary:
        for each in experiments:
            figures = verdicts[each.name].figures
            if figures:
                each.draw(figures).savefig(temporary / f"{each.name}.png")
        text = json_text(answer, indent=1) + "\n"
        (temporary / "validation.json").write_text(text, encoding="utf-8")


def _files(experiments: list[Experiment]) -> list[str]:
    """Names of the files that `--out` may get."""
    return [*(f"{each.name}.png" for each in experiments), "validation.json"]


def _print_table(experiments: list[Experiment], verdicts: dict[str, Verdict]) -> None:
    from rich.console import Console
    from rich.table import Table

    from mesa_mobility.verification.report import word_of

    table = Table(box=None, padding=(0, 2, 0, 0))
    for column in ("experiment", "figure", "measured", "wanted", "verdict"):
        table.add_column(column, overflow="fold")
    for each in experiments:
        verdict = verdicts[each.name]
        for check in verdict.checks:
            value = "-" if check.value is None else f"{check.value:.4g}"
            table.add_row(each.name, check.figure, value, check.wanted, word_of(check))
        for name, figure in verdict.figures.items():
            if isinstance(figure, int | float):
                table.add_row(each.name, name, f"{figure:.4g}", "", "")
    Console(highlight=False, markup=False).print(table)
