"""The report of the verification tests: one HTML page with everything in it."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from datetime import UTC, datetime
from typing import Any

from mesa_mobility.crowd.presets.given import Given
from mesa_mobility.mobility import shipped_map_path
from mesa_mobility.reports.html import Page, picture
from mesa_mobility.reports.versions import add_versions, machine, sha256_of, versions
from mesa_mobility.verification.catalogue import Entry
from mesa_mobility.verification.drawings import draw
from mesa_mobility.verification.suite import Outcome

WORDS = {"pass": "pass", "fail": "FAIL", "cap": "cap exceeded"}

_MOST_PICTURES = 3
"""Pictures of a test: its cases often differ in a number alone."""


def write_report(
    entries: Mapping[str, Entry],
    outcomes: Mapping[str, Outcome],
    path: str | os.PathLike[str],
    rules: Given | None = None,
) -> None:
    """Write what tests asked for and found as one HTML page, which needs no other file.

    Args:
        entries: of the catalogue, by id.
        outcomes: by id; their drawings are shown.
        path: of the page.
        rules: that models followed instead of the default preset.

    Raises:
        ResultsError: the page cannot be written.
    """
    page = Page("Verification of mesa-mobility")
    verdicts = [outcome.verdict for outcome in outcomes.values()]
    page.text(
        f"Passed: {verdicts.count('pass')}. Failed: {verdicts.count('fail')}. Over a design cap "
        f"that measured crowds exceed too: {verdicts.count('cap')}. Every test "
        "runs with one preset, which is listed below; overlaps of bodies and steps through walls "
        "are counted on the recorded tracks, and a single one fails the test."
    )
    page.table(
        "Summary",
        ["test", "what", "verdict"],
        [[name, entries[name].what, WORDS[outcome.verdict]] for name, outcome in outcomes.items()],
    )
    for name, outcome in outcomes.items():
        _test(page, entries[name], outcome)
    computed_with(page, seeds=max(len(outcome.seeds) for outcome in outcomes.values()), rules=rules)
    page.write(path)


def computed_with(page: Page, seeds: int, rules: Given | None) -> None:
    """Add what the runs of a standard's tests were computed with, its rules included."""
    written = datetime.now(UTC).isoformat(timespec="minutes")
    add_versions(
        page,
        {**versions(), **(rules or Given()).used()},
        {"map able_bodied": sha256_of(shipped_map_path("able_bodied"))},
        machine(),
        f"{f'Seeds 1 to {seeds}' if seeds > 1 else 'Seed 1'}. Written {written}.",
    )


def value_text(value: Any) -> str:
    """A figure as a table shows it."""
    if value is None or (isinstance(value, float) and not math.isfinite(value)):
        return "-"
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def measured_text(outcome: Outcome) -> str:
    """The figures of an outcome on one line, without its counts of safety."""
    return ", ".join(
        f"{figure} {value_text(value)}"
        for figure, value in outcome.measured.items()
        if not isinstance(value, list | dict) and figure not in outcome.safety
    )


def _test(page: Page, entry: Entry, outcome: Outcome) -> None:
    safety = outcome.safety
    rows = [
        ["criterion", entry.asked],
        ["source", entry.source],
        ["floor", entry.geometry],
        ["people", entry.population],
        ["chosen where the source is open", entry.chosen],
        ["measured, medians over the seeds", measured_text(outcome)],
        ["overlaps, steps through walls", f"{safety['overlaps']}, {safety['wall_crossings']}"],
        ["not met", "; ".join(outcome.failed)],
        ["reported, not judged", "; ".join(outcome.reported)],
        ["why the cap need not be met", entry.cap if outcome.verdict == "cap" else ""],
        ["verdict", WORDS[outcome.verdict]],
    ]
    page.table(f"{entry.id}: {entry.what}", ["", ""], [row for row in rows if row[1]])
    for case, drawing in outcome.drawings[:_MOST_PICTURES]:
        people = "1 person" if drawing.people == 1 else f"{drawing.people} people"
        some = "" if len(drawing.ways) == drawing.people else f", {len(drawing.ways)} drawn"
        page.picture("", picture(draw(drawing)), f"{case}: {people}{some}")
