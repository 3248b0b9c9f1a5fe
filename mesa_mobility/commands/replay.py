"""`mesa-mobility replay`: watch a saved run in the browser."""

from __future__ import annotations

import webbrowser
from pathlib import Path
from typing import Annotated

import typer

from mesa_mobility.commands.console import NoProgress, progress_bar, say, some_path
from mesa_mobility.commands.export import RunDir, Shown
from mesa_mobility.commands.grouping import grouped


@grouped
def replay(
    run: RunDir,
    shown: Shown,
    *,
    output: Annotated[
        Path | None,
        typer.Option(
            "-o",
            "--output",
            help="Page to write, by default replay.html in the run's folder.",
            parser=some_path,
            metavar="PATH",
        ),
    ] = None,
    no_open: Annotated[
        bool, typer.Option("--no-open", help="Write the page and open no browser.")
    ] = False,
    no_progress: NoProgress = False,
) -> None:
    """Watch a run in three dimensions: a page with a time slider that needs no network."""
    from mesa_mobility.animation.page import write_page
    from mesa_mobility.results.excerpts import title_of
    from mesa_mobility.results.run import read_run

    page = output or run / "replay.html"
    found = read_run(run)
    selection = shown.selection()
    count = len(selection.people_of(found.trajectories))
    with progress_bar(shown=not no_progress) as report:
        write_page(
            found.trajectories,
            found.plan,
            page,
            selection,
            bank=shown.bank(),
            title=title_of(found.summary, found.trajectories),
            progress=lambda done: report("bodies", done, count),
        )
    say(f"{count} people written to {page}, {page.stat().st_size / 1e6:.1f} MB")
    if not no_open:
        webbrowser.open(page.resolve().as_uri())
