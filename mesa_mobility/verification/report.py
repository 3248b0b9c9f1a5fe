"""The report of the verification tests: one HTML page with everything in it."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from typing import Any

from mesa_mobility.crowd.presets.given import Given
from mesa_mobility.mobility.mapfile import shipped_maps
from mesa_mobility.reports.html import Link, Page, picture
from mesa_mobility.reports.versions import add_versions, machine, sha256_of, versions
from mesa_mobility.verification.catalogue import Entry, readings, standards
from mesa_mobility.verification.checks import Check
from mesa_mobility.verification.diagrams import DIAGRAMS
from mesa_mobility.verification.drawings import draw
from mesa_mobility.verification.suite import Outcome
from mesa_mobility.verification.wording import figure_words

WORDS = {"pass": "pass", "fail": "FAIL", "cap": "cap exceeded"}

_MOST_PICTURES = 3
"""Pictures of a test: its cases often differ in a number alone."""

_LONGEST_LIST = 20
"""Numbers of a list that a table shows."""

SAFETY = (
    "Overlaps of bodies and steps through walls are counted on the recorded tracks by code that "
    "the simulation does not use; a single one fails the test."
)


def write_report(
    entries: Mapping[str, Entry],
    outcomes: Mapping[str, Outcome],
    path: str | os.PathLike[str],
    rules: Given | None = None,
) -> None:
    """Write what tests asked for and found as one HTML page, which needs no other file.

    Args:
        entries: of the catalogue, by id.
        outcomes: by id; their drawings and diagrams are shown.
        path: of the page.
        rules: that models followed instead of the default preset.

    Raises:
        ResultsError: the page cannot be written.
    """
    seeds = max(len(outcome.seeds) for outcome in outcomes.values())
    page = Page("Verification of mesa-mobility", lead_of(seeds, rules))
    page.section("Summary", "summary")
    verdicts = [outcome.verdict for outcome in outcomes.values()]
    capped = verdicts.count("cap")
    page.text(
        f"Tests: {len(verdicts)}. Passed: {verdicts.count('pass')}. Failed: "
        f"{verdicts.count('fail')}."
        + (f" “Cap exceeded”: {capped}." if capped else "")
        + " A test passes if each figure that is judged meets its criterion with every seed."
    )
    if capped:
        page.text(
            "“Cap exceeded” says that a flow is greater than the one that the standard lets "
            "designers reckon with. Measured crowds exceed it, too; the test gives their flows."
        )
    page.table(
        "Tests and their verdicts",
        ["test", "standard", "what is tested", "verdict"],
        [
            [
                Link(name, name),
                entries[name].source,
                entries[name].what,
                WORDS[outcome.verdict],
            ]
            for name, outcome in outcomes.items()
        ],
    )
    page.section("Standards and method", "method")
    page.table("Standards", ["short name", "title"], list(standards().items()))
    page.text(SAFETY)
    page.text(
        "Where a standard leaves something open, each test says what was chosen. Figures with the "
        "verdict “reported” or “outside” do not count for the verdict of the test."
    )
    for title, some in _by_standard(outcomes).items():
        page.section(f"Tests of {title}", title.lower())
        for name in some:
            _test(page, entries[name], outcomes[name])
    computed_with(page, seeds, rules, f"mesa-mobility verify {' '.join(outcomes)}")
    page.signatures()
    page.write(path)


def lead_of(seeds: int, rules: Given | None) -> str:
    """The line below the title of reports on many runs."""
    return (
        f"Preset “{(rules or Given()).preset_name}”, {_said_of_seeds(seeds)}. "
        f"Written {datetime.now(UTC):%Y-%m-%d %H:%M} UTC."
    )


def computed_with(page: Page, seeds: int, rules: Given | None, command: str) -> None:
    """Add versions, inputs and the command that repeats runs of a standard's tests.

    Args:
        page: to add it to.
        seeds: their number.
        rules: that models followed.
        command: without its options; "" for none.
    """
    given = rules or Given()
    page.section("Versions, inputs and how to repeat", "repeat")
    add_versions(
        page,
        {**versions(), **given.used()},
        {
            f"recorded movements: {path.stem.replace('_', ' ')}": sha256_of(path)
            for path in sorted(shipped_maps().glob("*.npz"))
        },
        machine(),
    )
    if not command:
        return
    page.lead_in("With the same versions, this command gives the same figures:")
    words = [*command.split(), "--seeds", str(seeds)]
    if given.preset is not None:
        words += ["--preset", given.preset_name]
    for name, value in given.values.items():
        words += ["--set", f"{name}={value}"]
    page.command(words)


def table_of_checks(
    page: Page,
    caption: str,
    checks: Sequence[Check],
    figures: Mapping[str, Any],
    *,
    lists: bool = False,
    note: str = "",
) -> None:
    """Add figures with their criteria and verdicts, then those that are reported alone.

    Args:
        page: to add it to.
        caption: of the table.
        checks: figures with a criterion.
        figures: others; those that are no numbers are left out.
        lists: whether short lists of numbers are shown.
        note: a paragraph below.
    """
    rows: list[list[Any]] = [
        [figure_words(each.figure), value_text(each.value), each.wanted, word_of(each)]
        for each in checks
    ]
    rows += [
        [figure_words(name), _listed(value), None, "reported"]
        for name, value in figures.items()
        if isinstance(value, int | float) or (lists and _is_short_list(value))
    ]
    page.table(caption, ["figure", "simulated", "criterion", "verdict"], rows, note)


def word_of(check: Check) -> str:
    """The verdict on one figure: "outside" is reported alone, "FAIL" counts."""
    return "pass" if check.met else "FAIL" if check.gates else "outside"


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


def _is_short_list(value: Any) -> bool:
    return (
        isinstance(value, list)
        and 0 < len(value) <= _LONGEST_LIST
        and all(isinstance(each, int | float) for each in value)
    )


def _listed(value: Any) -> str:
    return ", ".join(map(value_text, value)) if isinstance(value, list) else value_text(value)


def _said_of_seeds(seeds: int) -> str:
    return f"seeds 1 to {seeds}" if seeds > 1 else "seed 1"


def _by_standard(outcomes: Mapping[str, Outcome]) -> dict[str, list[str]]:
    """Ids of tests by the short name of their standard."""
    known = {name.lower(): name for name in standards()}
    found: dict[str, list[str]] = {}
    for name in outcomes:
        found.setdefault(known[name.partition("-")[0]], []).append(name)
    return found


def _test(page: Page, entry: Entry, outcome: Outcome) -> None:
    page.subsection(f"{entry.id}: {entry.what}", entry.id)
    known = readings()
    rows = [
        ["source", entry.source],
        ["numbers read from", "; ".join(known[each] for each in entry.read)],
        ["floor", entry.geometry],
        ["people", entry.population],
        ["criterion", entry.criterion],
        ["judged strictly", entry.criterion_strict],
        ["chosen where the source is open", entry.chosen],
        ["verdict", WORDS[outcome.verdict]],
        ["why the cap need not be met", entry.cap if outcome.verdict == "cap" else ""],
    ]
    page.table("The test", ["", ""], [row for row in rows if row[1]])
    figures = {
        name: value
        for name, value in outcome.measured.items()
        if name not in {each.figure for each in outcome.checks}
    }
    table_of_checks(
        page,
        "What was found" + (": medians over the seeds" if len(outcome.seeds) > 1 else ""),
        outcome.checks,
        figures,
        lists=True,
    )
    for text in outcome.failed:
        page.notice(f"Not met: {text}.")
    if outcome.chart is not None:
        name, runs = outcome.chart
        page.picture(
            "Speed and flow against density: simulated, and measured where there is a band",
            picture(DIAGRAMS[name](runs)),
        )
    # A diagram says more than the ways of each of its runs.
    most = 1 if outcome.chart is not None else _MOST_PICTURES
    of = len(outcome.drawings)
    for number, (case, drawing) in enumerate(outcome.drawings[:most], 1):
        people = "1 person" if drawing.people == 1 else f"{drawing.people} people"
        some = "" if len(drawing.ways) == drawing.people else f", {len(drawing.ways)} drawn"
        which = f"run {number} of {of}, {case}" if of > 1 else case
        page.picture(
            f"Ways of {people}{some}, with a dot where each begins ({which}; seed "
            f"{outcome.seeds[0]})",
            picture(draw(drawing)),
        )
