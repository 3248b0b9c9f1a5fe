"""`mesa-mobility experiment`: many runs, kept in a store."""

from __future__ import annotations

from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from mesa_mobility.commands.console import (
    AsJson,
    NoProgress,
    answer_json,
    answer_rows,
    answer_table,
    counting_bar,
    say,
    some_path,
)
from mesa_mobility.commands.models.making import PresetName, Settings, split_settings
from mesa_mobility.commands.reports.options import AsPdf, finish_page
from mesa_mobility.errors import ModelError
from mesa_mobility.interrupts import INTERRUPTED, Stopped, gentle_interrupt

if TYPE_CHECKING:
    from mesa_mobility.experiments import Experiment

FAILED = 1

app = typer.Typer(
    help="Run many simulations and keep them in a store. An experiment can be resumed.",
    no_args_is_help=True,
)
StoreAt = Annotated[str, typer.Argument(metavar="STORE", help="Folder or URL of the store.")]


@app.command("run")
def run(
    file: Annotated[
        Path,
        typer.Argument(
            metavar="FILE",
            help="The experiment in TOML, or in JSON as reports print it.",
            parser=some_path,
        ),
    ],
    store: Annotated[
        str | None,
        typer.Option(
            metavar="STORE",
            help="Folder or URL of the store; by default FILE without .toml or .json.",
        ),
    ] = None,
    workers: Annotated[
        int | None,
        typer.Option(
            min=1, metavar="N", help="Processes side by side. By default one for each processor."
        ),
    ] = None,
    scheduler: Annotated[
        str | None,
        typer.Option(
            metavar="ADDRESS", help="Address of a Dask scheduler to use instead of processes."
        ),
    ] = None,
    settings: Settings = None,
    preset: PresetName = None,
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="Say what would be run, and run nothing.")
    ] = False,
    no_progress: NoProgress = False,
) -> None:
    """Do the runs of an experiment that its store does not have yet.

    Ends with status 1 if runs have failed or timed out.
    """
    from mesa_mobility.experiments import open_store, read_experiment, run_experiment
    from mesa_mobility.experiments.missing import count_missing
    from mesa_mobility.experiments.workers.compiling import is_compiled

    if scheduler is not None and workers is not None:
        raise ModelError("--workers: a scheduler has its own workers, expected one of the two")
    experiment = _with_settings(read_experiment(file), settings or [], preset)
    place = store if store is not None else str(file.with_suffix(""))
    if dry_run:
        missing = count_missing(experiment, place)
        points = len(experiment.design)
        answer_table(
            {
                "Store": place,
                "Points": f"{points}",
                "Replications": f"{experiment.replications}",
                "Runs to do": f"{missing}",
            }
        )
        return
    if scheduler is None and not is_compiled():
        say("compiling first, once after installation: takes a minute or two")
    interrupted = False
    with gentle_interrupt() as stop_here, counting_bar(shown=not no_progress) as report:
        told: list[str] = []

        def progress(now: Any) -> None:
            if now.address and not told:
                told.append(now.address)
                say(f"dashboard of the scheduler: {now.address}")
            report(f"{now.ended} of {now.total} runs, {now.failed} failed", now.ended, now.total)
            stop_here()

        try:
            run_experiment(
                experiment,
                place,
                executor="processes" if scheduler is None else scheduler,
                workers=workers,
                progress=progress,
            )
        except Stopped:
            interrupted = True
    counts = _said(place, as_json=False)
    for text, runs in open_store(place).warnings().items():
        say(f"warning: {text} ({runs} runs)")
    if interrupted:
        say("interrupted: what has ended is kept; the same command goes on")
        raise typer.Exit(INTERRUPTED)
    if counts["failed"] or counts["timed_out"]:
        raise typer.Exit(FAILED)


@app.command("status")
def status(store: StoreAt, as_json: AsJson = False) -> None:
    """Say how far an experiment has come."""
    _said(store, as_json=as_json)


@app.command("report")
def report(
    store: StoreAt,
    out: Annotated[
        Path | None,
        typer.Option(
            help="The page; by default report.html in the store.", parser=some_path, metavar="PATH"
        ),
    ] = None,
    as_pdf: AsPdf = False,
) -> None:
    """Write plan, people, design, results, failures and versions as one HTML page."""
    from mesa_mobility.experiments import open_store, write_report
    from mesa_mobility.reports.pdf import browser_program

    if as_pdf:
        browser_program()
    finish_page(write_report(open_store(store), out), as_pdf=as_pdf)


@app.command("compare")
def compare(
    store: StoreAt,
    by: Annotated[
        str, typer.Option(metavar="PARAMETER", help="The parameter whose values are compared.")
    ],
    figure: Annotated[
        str,
        typer.Option(metavar="COLUMN", help="Figure of the runs, such as door.east.flow_per_s."),
    ] = "egress_s",
    confidence: Annotated[
        float, typer.Option(help="That no equal designs are called different.")
    ] = 0.95,
    power: Annotated[
        float, typer.Option(help="Probability with which the detectable difference is found.")
    ] = 0.9,
    as_json: AsJson = False,
) -> None:
    """Compare designs in pairs of runs: difference, interval, effect, detectable difference.

    Runs should have common seeds (`seeds = "common"` in the experiment's file).
    """
    from mesa_mobility.experiments import compare as compare_designs
    from mesa_mobility.experiments import open_store
    from mesa_mobility.experiments.reporting.pictures import value_text
    from mesa_mobility.reports.words import words_of

    opened = open_store(store)
    found = compare_designs(opened, by, figure, confidence=confidence, power=power)
    if opened.experiment().seeds != "common":
        say("seeds are independent: common seeds would show smaller differences")
    if as_json:
        answer_json({"by": by, "figure": figure, "comparisons": [asdict(each) for each in found]})
        return
    say(f"{words_of(figure, opened.experiment().report.labels)}, by {by}")
    answer_rows(
        ["designs", "difference (interval)", "p", "detectable", "verdict"],
        [
            [
                f"{value_text(each.first)}, {value_text(each.second)}",
                str(each.difference),
                f"{each.p:.2g}",
                "-" if each.detectable is None else f"{each.detectable:.3g}",
                each.verdict,
            ]
            for each in found
        ],
    )


def _with_settings(experiment: Experiment, settings: list[str], preset: str | None) -> Experiment:
    """An experiment with more parameters that are the same in all runs."""
    from mesa_mobility.crowd.presets.naming import as_value, number_named
    from mesa_mobility.crowd.presets.shipped import is_preset_file, preset_of
    from mesa_mobility.experiments.experiment import model_class, model_name
    from mesa_mobility.plugins.parameters import chosen

    own, numbers = split_settings(settings)
    called = model_name(experiment.model)
    fixed = {
        **experiment.fixed,
        **chosen(model_class(experiment.model), called, own),
        **{name: as_value(name, number_named(name), text) for name, text in numbers.items()},
    }
    if preset is not None:
        preset_of(preset)
        # Workers may run in another folder.
        fixed["preset"] = str(Path(preset).absolute()) if is_preset_file(preset) else preset
    return replace(experiment, fixed=fixed)


def _said(place: str, *, as_json: bool) -> dict[str, Any]:
    from mesa_mobility.experiments import open_store

    counts = open_store(place).status()
    if as_json:
        answer_json(counts)
    else:
        asked = counts["asked"]
        answer_table(
            {
                "Store": counts["store"] + (" (being run)" if counts["running"] else ""),
                "Asked for": "as many as it takes" if asked is None else f"{asked} runs",
                "Missing": "-" if counts["missing"] is None else f"{counts['missing']}",
                "Done": f"{counts['done']}",
                "Blocked": f"{counts['blocked']}",
                "Stalled": f"{counts['stalled']}",
                "Failed": f"{counts['failed']}",
                "Timed out": f"{counts['timed_out']}",
                "Time of the runs": f"{counts['runs_s']:.1f} s",
                "Files": f"{counts['files']}",
            }
        )
    return counts
