"""`mesa-mobility verify`: the field's verification tests."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from mesa_mobility.commands.checks.options import FAILED, CheckOptions
from mesa_mobility.commands.console import answer_json, progress_bar, say
from mesa_mobility.commands.grouping import grouped

if TYPE_CHECKING:
    from mesa_mobility.verification import Entry, Outcome


@grouped
def verify(
    ids: Annotated[
        list[str] | None, typer.Argument(metavar="[ID]...", help="Tests to run; by default all.")
    ] = None,
    *,
    options: CheckOptions,
) -> None:
    """Run the verification tests of RiMEA, IMO, NIST and ISO for floors, stairs and lifts.

    Ends with status 1 if a test fails.
    """
    from mesa_mobility.verification import catalogue, suite, verify

    options.check_report()
    tests = suite(ids or [])
    rules = options.rules()
    entries = catalogue()
    with progress_bar(shown=not options.no_progress) as report:
        outcomes = verify(
            tests,
            options.runs,
            options.processes,
            caps=[name for name, entry in entries.items() if entry.cap],
            progress=report,
            drawn=options.report_file is not None,
            rules=rules,
        )
    if options.report_file is not None:
        from mesa_mobility.verification.report import write_report

        write_report(entries, outcomes, options.report_file, rules)
        options.finish_report()
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
    if options.as_json:
        named = {"preset": rules.preset_name}
        answer_json({name: _as_json(entries[name], outcomes[name]) | named for name in outcomes})
    if failing:
        raise typer.Exit(FAILED)


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
