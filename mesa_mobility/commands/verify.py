"""`mesa-mobility verify`: the field's verification tests."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from mesa_mobility.commands.console import (
    NoProgress,
    answer_json,
    progress_bar,
    say,
    some_path,
)
from mesa_mobility.commands.models.making import Numbers, Rules, rules_given
from mesa_mobility.runs.processes import available_processors

if TYPE_CHECKING:
    from mesa_mobility.verification import Entry, Outcome

FAILED = 1

Seeds = Annotated[int, typer.Option(min=1, metavar="N", help="Runs of each test, seeds 1 to N.")]
Jobs = Annotated[
    int | None, typer.Option(min=1, help="Processes side by side (one for each processor).")
]
ReportFile = Annotated[
    Path | None,
    typer.Option(
        "--report",
        help="One HTML page with criteria, sources, figures, pictures, verdicts and versions.",
        parser=some_path,
        metavar="FILE",
    ),
]
AsJson = Annotated[bool, typer.Option("--json", help="One JSON object as the last line of output.")]


def verify(
    ids: Annotated[
        list[str] | None, typer.Argument(metavar="[ID]...", help="Tests to run; all without.")
    ] = None,
    seeds: Seeds = 1,
    jobs: Jobs = None,
    preset: Rules = None,
    numbers: Numbers = None,
    as_json: AsJson = False,
    report_file: ReportFile = None,
    no_progress: NoProgress = False,
) -> None:
    """Run the verification tests of RiMEA, IMO, NIST and ISO for a level floor.

    Ends with status 1 if a test fails.
    """
    from mesa_mobility.verification import catalogue, suite, verify

    check_report(report_file)
    tests = suite(ids or [])
    rules = rules_given(preset, numbers or [])
    entries = catalogue()
    with progress_bar(shown=not no_progress) as report:
        outcomes = verify(
            tests,
            range(1, seeds + 1),
            jobs or available_processors(),
            caps=[name for name, entry in entries.items() if entry.cap],
            progress=report,
            drawn=report_file is not None,
            rules=rules,
        )
    if report_file is not None:
        from mesa_mobility.verification.report import write_report

        write_report(entries, outcomes, report_file, rules)
        say(f"written to {report_file}")
    _print_table(entries, outcomes)
    failing = [name for name, outcome in outcomes.items() if outcome.verdict == "fail"]
    capped = [name for name, outcome in outcomes.items() if outcome.verdict == "cap"]
    for name in failing:
        for reason in outcomes[name].failed:
            say(f"{name}: {reason}")
    for name in capped:
        say(f"{name}: {outcomes[name].reported[0]}: {entries[name].cap}")
    say(
        f"{len(outcomes) - len(failing) - len(capped)} passed, {len(failing)} failed"
        + (
            f", design cap exceeded as measured crowds exceed it: {', '.join(capped)}"
            if capped
            else ""
        )
    )
    if as_json:
        answer_json({name: _as_json(entries[name], outcomes[name]) for name in outcomes})
    if failing:
        raise typer.Exit(FAILED)


def check_report(file: Path | None) -> None:
    """Make sure that a report can be written, before anything is run for it.

    Raises:
        ResultsError: it cannot.
    """
    from mesa_mobility.results import check_writable

    if file is not None:
        check_writable(file.parent, [file.name])


def _as_json(entry: Entry, outcome: Outcome) -> dict[str, Any]:
    return {
        "passed": outcome.passed,
        "measured": outcome.measured,
        "criterion": entry.asked,
        "source": entry.source,
        "what": entry.what,
        "verdict": outcome.verdict,
        "failed": outcome.failed,
        "reported": outcome.reported,
        "chosen": entry.chosen,
        "cap": entry.cap,
        "seeds": outcome.seeds,
        "per_seed": outcome.per_seed,
        "safety": outcome.safety,
    }


def _print_table(entries: dict[str, Entry], outcomes: dict[str, Outcome]) -> None:
    from rich.console import Console
    from rich.table import Table

    from mesa_mobility.verification.report import WORDS, measured_text

    table = Table(box=None, padding=(0, 2, 0, 0))
    for column in ("id", "what", "measured", "criterion", "verdict"):
        table.add_column(column, overflow="fold", no_wrap=column == "id")
    for name, outcome in outcomes.items():
        entry = entries[name]
        table.add_row(name, entry.what, measured_text(outcome), entry.asked, WORDS[outcome.verdict])
    Console(highlight=False, markup=False).print(table)
