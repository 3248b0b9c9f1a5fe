"""Failures of an experiment's runs, what they used, and how to repeat them."""

from __future__ import annotations

import json
from collections import Counter
from typing import TYPE_CHECKING, Any

from mesa_mobility.experiments.reporting.estimates import MOST_ROWS
from mesa_mobility.reports.run.texts import in_words
from mesa_mobility.reports.versions import add_versions

if TYPE_CHECKING:
    import pandas as pd

    from mesa_mobility.experiments.store import Store
    from mesa_mobility.reports.html import Page

_MOST_SETS = 20
"""Sets of inputs that are shown."""


def add_failures(page: Page, store: Store, frame: pd.DataFrame) -> None:
    """Add which runs have failed or timed out, and what runs warn of."""
    page.section("Failures and warnings", "failures")
    failed = frame[frame["error"].notna()]
    if not len(failed):
        page.text("No run failed, and none took longer than its limit.")
    else:
        errors = Counter(zip(failed["status"], failed["error"], strict=True))
        first: dict[str, str] = {}
        for run, seed, error in zip(failed["run"], failed["seed"], failed["error"], strict=True):
            first.setdefault(error, f"{run} (seed {seed})")
        page.table(
            "Failures",
            ["runs", "status", "error", "first run"],
            [
                [count, status.replace("_", " "), error, first[error]]
                for (status, error), count in errors.most_common(MOST_ROWS)
            ],
        )
    for text, runs in store.warnings().items():
        page.text(f"Warning of {runs} of {len(frame)} runs: {text}.")


def add_inputs(page: Page, frame: pd.DataFrame) -> None:
    """Add what runs used: once what all have in common, then each set of what differs."""
    known = frame["inputs"].dropna() if "inputs" in frame else ()
    sets = {text: json.loads(text) for text in dict.fromkeys(known)}
    counts = Counter(known)
    if not sets:
        return
    page.section("Inputs", "inputs")
    every = [dict.items(each) for each in sets.values()]
    common = set(every[0]).intersection(*every[1:])
    rows = [[len(known), *each] for each in sorted(common)]
    for text, count in counts.most_common(_MOST_SETS):
        rows += [[count, *each] for each in sorted(set(sets[text].items()) - common)]
    note = "“Runs” is the number of runs that used the input."
    if (more := len(sets) - _MOST_SETS) > 0:
        note += f" {more} further sets differ from run to run; the column inputs has them."
    if missing := len(frame) - len(known):
        note += f" {missing} runs ended before their inputs were known, or are of another version."
    shown = [[count, in_words(name), which] for count, name, which in rows]
    page.table("Inputs of the runs", ["runs", "input", "which"], shown, note)


def add_repeating(page: Page, definition: dict[str, Any]) -> None:
    """Add versions, sessions and the experiment as a file."""
    session = definition["sessions"][-1]
    page.section("Versions and how to repeat the experiment", "repeat")
    add_versions(
        page,
        session["versions"],
        session["inputs"],
        session["machine"],
        "Those of the session in which runs were last computed.",
    )
    page.table(
        "Sessions: when runs were computed, and how",
        ["began", "how runs were spread", "mesa-mobility"],
        [
            [
                each["began"].replace("T", " ").replace("+00:00", " UTC"),
                each["executor"],
                each["versions"].get("mesa-mobility", "-"),
            ]
            for each in definition["sessions"]
        ],
    )
    page.lead_in(
        "Save the text below as experiment.json. With the same versions and inputs, this command "
        "computes the same runs:"
    )
    page.command(["mesa-mobility", "experiment", "run", "experiment.json"])
    page.json(definition["experiment"])
