"""The report of one run as a page of HTML."""

from __future__ import annotations

import os
from collections.abc import Callable
from datetime import UTC, datetime

from mesa_mobility.reports.html import Page
from mesa_mobility.reports.run.basis import add_assumptions, add_people, add_plan
from mesa_mobility.reports.run.doors import add_doors
from mesa_mobility.reports.run.evidence import add_checks, add_definitions, add_repeating
from mesa_mobility.reports.run.findings import add_results, add_summary
from mesa_mobility.reports.run.service import add_service
from mesa_mobility.results.engineering.measured import Measured
from mesa_mobility.results.run import Run


def write_run_report(
    run: Run,
    measured: Measured,
    path: str | os.PathLike[str],
    *,
    title: str = "",
    progress: Callable[[str], None] = lambda what: None,
) -> None:
    """Write what one run has found as one HTML page, which needs no other file.

    The page has plan, people, assumptions, results, doors, levels of service, checks, definitions
    of all figures, versions with digests, how to repeat the run, and space for signatures.

    Args:
        run: the run, saved or just made.
        measured: its figures, from `measure`.
        path: of the page.
        title: of the page; by default the name of the model.
        progress: called with what is being done.

    Raises:
        ResultsError: the page cannot be written.
    """
    name = str(run.summary.get("model", "run")).replace("_", " ")
    page = Page(
        title or f"Evacuation of the model “{name}”: report of one run",
        f"One simulated run with mesa-mobility {run.summary.get('mesa_mobility', '')}, seed "
        f"{run.summary.get('seed', '-')}. Written {datetime.now(UTC):%Y-%m-%d %H:%M} UTC.",
    )
    progress("page")
    add_summary(page, run, measured)
    add_plan(page, measured)
    add_people(page, run, measured)
    add_assumptions(page, run)
    add_results(page, run, measured)
    add_doors(page, measured)
    add_service(page, measured)
    add_checks(page, run)
    add_definitions(page)
    add_repeating(page, run)
    page.signatures()
    page.write(path)
