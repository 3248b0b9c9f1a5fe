"""Options of commands that write a report."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from mesa_mobility.commands.console import say, some_path
from mesa_mobility.errors import ModelError

AsPdf = Annotated[
    bool,
    typer.Option(
        "--pdf",
        help="Also print the report as PDF, beside the page. Needs Chromium or Chrome, which "
        "MESA_MOBILITY_BROWSER can name.",
    ),
]


@dataclass(frozen=True)
class ReportOptions:
    """The page to write, and whether to print it."""

    report_file: Annotated[
        Path | None,
        typer.Option(
            "--report",
            help="HTML page to write, for those who have to judge the results.",
            parser=some_path,
            metavar="FILE",
        ),
    ] = None
    as_pdf: AsPdf = False

    def check_report(self) -> None:
        """Make sure that the report can be written, before anything is run for it.

        Raises:
            ModelError: a PDF is asked for without a page.
            ResultsError: the report cannot be written, or there is no browser.
        """
        if self.report_file is None:
            if self.as_pdf:
                raise ModelError("--pdf: prints a report, expected --report FILE as well")
            return
        check_page(self.report_file, as_pdf=self.as_pdf)

    def finish_report(self) -> None:
        """Print the page that has been written, if asked for, and say where it is."""
        if self.report_file is not None:
            finish_page(self.report_file, as_pdf=self.as_pdf)


def check_page(path: Path, *, as_pdf: bool) -> None:
    """Make sure that a page can be written, and printed if asked for.

    Raises:
        ResultsError: it cannot.
    """
    from mesa_mobility.reports.pdf import browser_program
    from mesa_mobility.results import check_writable

    names = [path.name, *([path.with_suffix(".pdf").name] if as_pdf else [])]
    check_writable(path.parent, names)
    if as_pdf:
        browser_program()


def finish_page(path: Path, *, as_pdf: bool) -> None:
    """Print a page that has been written, if asked for, and say where it is.

    Raises:
        ResultsError: it cannot be printed.
    """
    say(f"written to {path}")
    if as_pdf:
        from mesa_mobility.reports.pdf import write_pdf

        target = path.with_suffix(".pdf")
        write_pdf(path, target)
        say(f"printed to {target}")
