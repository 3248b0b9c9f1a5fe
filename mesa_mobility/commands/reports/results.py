"""`mesa-mobility results`: the engineering figures of a saved run as tables and pictures."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mesa_mobility.commands.console import NoProgress, progress_bar, say, some_path
from mesa_mobility.commands.export import RunDir
from mesa_mobility.commands.grouping import grouped
from mesa_mobility.commands.reports.options import ReportOptions

if TYPE_CHECKING:
    from mesa_mobility.results import Room

RoomsFile = Annotated[
    Path | None,
    typer.Option(
        "--rooms",
        help="Named areas in GeoJSON, of which to say when they are empty.",
        parser=some_path,
        metavar="FILE",
    ),
]


@grouped
def results(
    run: RunDir,
    page: ReportOptions,
    *,
    out: Annotated[
        Path | None,
        typer.Option(
            "-o",
            "--out",
            help="Folder to write to, by default `results` in the run's folder.",
            parser=some_path,
            metavar="PATH",
        ),
    ] = None,
    rooms: RoomsFile = None,
    cell: Annotated[float, typer.Option(help="Side of the cells of maps in metres.")] = 0.5,
    every: Annotated[
        float, typer.Option(help="Seconds between the measurements of densities and speeds.")
    ] = 1.0,
    no_progress: NoProgress = False,
) -> None:
    """Write the figures of a run for a report: doors, queues, clearing times and maps."""
    from mesa_mobility.results import check_writable, measure, write_results
    from mesa_mobility.results.engineering.files import RESULT_FILES
    from mesa_mobility.results.excerpts import title_of
    from mesa_mobility.results.run import read_run

    folder = out or run / "results"
    given = rooms_in(rooms)
    found = read_run(run)
    check_writable(folder, RESULT_FILES)
    page.check_report()
    with progress_bar(shown=not no_progress) as report:
        measured = measure(
            found.trajectories, found.plan, given, cell=cell, every=every, progress=report
        )
        title = title_of(found.summary, found.trajectories)
        write_results(measured, folder, title=title, progress=report)
        if page.report_file is not None:
            from mesa_mobility.reports.run.report import write_run_report

            write_run_report(found, measured, page.report_file, progress=report)
    say(f"written to {folder}")
    page.finish_report()


def rooms_in(file: Path | None) -> list[Room]:
    """The rooms of a file; none without a file.

    Raises:
        FloorPlanError: no file of rooms.
    """
    from mesa_mobility.results import read_rooms

    return [] if file is None else read_rooms(file)
