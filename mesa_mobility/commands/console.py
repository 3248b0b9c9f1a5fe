"""Output of commands: answers on standard output, messages on standard error."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Annotated, Any, Protocol

import typer
from rich.console import Console
from rich.progress import (
    BarColumn,
    Progress,
    ProgressColumn,
    TaskProgressColumn,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)
from rich.table import Table

from mesa_mobility.interrupts import INTERRUPTED, Stopped, cleaning_up, gentle_interrupt

EVERY_S = 10.0
"""Seconds from one line of progress to the next, where no bar can be drawn."""

FormatSettings = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="NAME=VALUE",
        help="An option of the file's format; repeatable. `mesa-mobility formats NAME` lists them.",
    ),
]
AsJson = Annotated[bool, typer.Option("--json", help="One JSON object as the last line of output.")]
NoProgress = Annotated[bool, typer.Option("--no-progress", help="No progress on standard error.")]


class Report(Protocol):
    """Shows the progress of long work."""

    def __call__(self, what: str, done: float = 0.0, total: float | None = None) -> None:
        """`what` is being done, `done` of `total`, which may be unknown."""


def some_path(text: str) -> Path:
    """A path as an option gives it; an empty text, which stands for the current folder, is none."""
    if not text.strip():
        raise typer.BadParameter("got nothing, expected a path")
    return Path(text)


def say(message: str) -> None:
    """One line on standard error."""
    print(message, file=sys.stderr)


def answer_json(values: Mapping[str, Any]) -> None:
    """One JSON object on one line of standard output."""
    from mesa_mobility.results.files import json_text

    sys.stderr.flush()
    print(json_text(values), flush=True)


def answer_table(rows: Mapping[str, str]) -> None:
    """Print a table of two columns, names and values, on standard output."""
    table = Table(show_header=False, box=None, padding=(0, 2, 0, 0))
    table.add_column(style="bold", no_wrap=True)
    table.add_column(overflow="fold")
    for name, value in rows.items():
        table.add_row(name, value)
    Console(highlight=False, markup=False).print(table)


def answer_rows(columns: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    """Print a table with a heading for each column; long texts take several lines."""
    table = Table(box=None, padding=(0, 2, 0, 0))
    for name in columns:
        table.add_column(name)
    for row in rows:
        table.add_row(*row)
    Console(highlight=False, markup=False).print(table)


@contextmanager
def progress_bar(*, shown: bool = True) -> Iterator[Report]:
    """Progress on standard error: a bar on a terminal, elsewhere a line every ten seconds."""
    with _bar(TimeElapsedColumn(), shown=shown) as report:
        yield report


@contextmanager
def counting_bar(*, shown: bool = True) -> Iterator[Report]:
    """As ``progress_bar``, with the time left on a terminal."""
    times = (TimeElapsedColumn(), TextColumn("left"), TimeRemainingColumn())
    with _bar(*times, shown=shown) as report:
        yield report


@contextmanager
def stoppable_progress(kept: str = "nothing written", *, shown: bool = True) -> Iterator[Report]:
    """As ``progress_bar``; the first Ctrl-C ends the command at the next report.

    Args:
        kept: what is said then of files.
        shown: whether there is any progress.
    """
    with progress_bar(shown=shown) as report, gentle_interrupt() as stop_here:

        def progress(what: str, done: float = 0.0, total: float | None = None) -> None:
            report(what, done, total)
            stop_here()

        try:
            yield progress
        except Stopped:
            say(f"interrupted: {kept}")
            raise typer.Exit(INTERRUPTED) from None


@contextmanager
def _bar(*times: ProgressColumn, shown: bool = True) -> Iterator[Report]:
    console = Console(stderr=True)
    if not shown:
        # Older versions of Rich end a disabled bar with an empty line.
        yield lambda what, done=0.0, total=None: None
        return
    if not console.is_terminal:
        with _lines() as report:
            yield report
        return
    bar = Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        TaskProgressColumn(),
        *times,
        console=console,
        transient=True,
    )
    # Rich hides the cursor while a bar is drawn.
    with cleaning_up(console.show_cursor), bar:
        task = bar.add_task("starting", total=None)

        def report(what: str, done: float = 0.0, total: float | None = None) -> None:
            bar.update(task, description=what, completed=done, total=total)

        yield report


@contextmanager
def _lines() -> Iterator[Report]:
    """A line on standard error every ``EVERY_S`` seconds, also while nothing is reported."""
    began, ended = time.monotonic(), threading.Event()
    now = ["starting"]

    def tell() -> None:
        while not ended.wait(EVERY_S):
            minutes, seconds = divmod(round(time.monotonic() - began), 60)
            with suppress(OSError, ValueError):  # nobody reads it any more
                say(f"{now[0]}, {minutes}:{seconds:02} min")

    def report(what: str, done: float = 0.0, total: float | None = None) -> None:
        now[0] = f"{what}, {done / total:.0%}" if total else what

    teller = threading.Thread(target=tell, name="mesa-mobility progress", daemon=True)
    teller.start()
    try:
        yield report
    finally:
        ended.set()
        teller.join()
