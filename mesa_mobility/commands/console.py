"""Output of commands: answers on standard output, messages on standard error."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Protocol

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


class Report(Protocol):
    """Shows the progress of long work."""

    def __call__(self, what: str, done: float, total: float) -> None:
        """`what` is being done, `done` of `total`."""


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
    """A progress bar on standard error; nothing is drawn where that is not a terminal."""
    with _bar(TimeElapsedColumn(), shown=shown) as report:
        yield report


@contextmanager
def counting_bar() -> Iterator[Report]:
    """A progress bar with the time left."""
    with _bar(TimeElapsedColumn(), TextColumn("left"), TimeRemainingColumn()) as report:
        yield report


@contextmanager
def stoppable_progress(kept: str = "nothing written") -> Iterator[Report]:
    """A progress bar; the first Ctrl-C ends the command at the next report.

    Args:
        kept: what is said then of files.
    """
    with progress_bar() as report, gentle_interrupt() as stop_here:

        def progress(what: str, done: float, total: float) -> None:
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
    if not shown or not console.is_terminal:
        # Older versions of Rich end a disabled bar with an empty line.
        yield lambda what, done, total: None
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

        def report(what: str, done: float, total: float) -> None:
            bar.update(task, description=what, completed=done, total=total)

        yield report
