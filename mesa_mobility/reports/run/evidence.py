"""Evidence for a run: checks, definitions, versions and the command that repeats it."""

from __future__ import annotations

import hashlib
import json
from typing import Any

from mesa_mobility.crowd.model_files import find_model
from mesa_mobility.errors import MobilityError
from mesa_mobility.plugins.parameters import OWN_OPTION, parameters
from mesa_mobility.reports.html import Page
from mesa_mobility.reports.run.rules import said
from mesa_mobility.reports.run.texts import in_words, number
from mesa_mobility.reports.versions import machine, sha256_of
from mesa_mobility.results.run import DECISIONS, TRAJECTORIES, Run

PASS, FAIL = "pass", "FAIL"

OWN = "mesa-mobility"
"""The source of definitions that no publication has."""

DEFINITIONS = (
    (
        "people at a door",
        "everybody who crosses its line, once, at their first passage in either direction",
        "as in PedPy, the analysis library of Forschungszentrum Jülich",
    ),
    (
        "flow",
        "J = (N - 1) / T of these N passages, with the time T from the first to the last of them",
        "Seyfried et al. 2009, Transportation Science 43: 395",
    ),
    ("specific flow", "J / w, with the width w of the line", "the same"),
    (
        "clog",
        "more than 2 s between two passages while somebody within 1 m waits to pass",
        "after Zuriguel et al. 2014, Scientific Reports 4: 7324; the two numbers are a convention",
    ),
    ("waiting", "moving less than 0.2 m in a second", f"{OWN}, a convention"),
    (
        "queue of a door",
        "people who wait, and whose next passage is over its line, wherever they stand",
        OWN,
    ),
    (
        "time to 50, 95, 100 %",
        "least time by which so many of the people who were ever there have left for good; people "
        "who are there at the end count as later than all others (right-censored)",
        OWN,
    ),
    (
        "mean speed",
        "straight distance that a person covers in a second, averaged over all seconds of all "
        "people, so that waiting counts",
        OWN,
    ),
    (
        "density of a cell",
        "mean over its floor of 1 / A, with the area A of the floor that is nearest to a person "
        "(Voronoi)",
        "Steffen and Seyfried 2010, Physica A 389: 1902",
    ),
    (
        "speed in a cell",
        "straight distance from half a second before to half a second after, over 1 s",
        OWN,
    ),
    (
        "level of service",
        "density of walkways in six levels, A to F",
        "Fruin 1971, Pedestrian Planning and Design",
    ),
    (
        "congestion",
        "more than 4 persons/m² for more than a tenth of the evacuation",
        "IMO MSC.1/Circ.1533 (2016)",
    ),
)
"""Name, definition and source of each figure."""


def checks_of(run: Run) -> list[list[Any]]:
    """The checks of a run: what is checked, what was found and required, and the verdict."""
    summary = run.summary
    rows: list[list[Any]] = [
        [words, summary.get(name), "0", _verdict(summary, name)]
        for name, words in (
            ("overlaps", "overlaps of two bodies"),
            ("wall_crossings", "steps through walls"),
            ("off_floor", "positions off the floor"),
        )
    ]
    blocked, stalled = summary.get("blocked"), summary.get("stalled")
    rows += [
        [
            "people who stood for a minute without a reason",
            None if blocked is None else len(blocked),
            "0",
            _verdict(summary, "blocked"),
        ],
        [
            "run ended because nobody made progress",
            None if stalled is None else said(stalled),
            "no",
            _verdict(summary, "stalled"),
        ],
        [
            "smallest distance between the middles of two people (m)",
            number(summary.get("min_distance_m"), 3),
            None,
            "reported",
        ],
    ]
    if "fallback_time_share" in summary:
        share = summary["fallback_time_share"]
        rows.append(
            [
                "share of the time in which people had no movement free of collisions, and moved "
                "straight to their target",
                f"{share:.2%}",
                None,
                "reported",
            ]
        )
    return rows


def add_checks(page: Page, run: Run) -> None:
    """Add what an independent program has counted on the tracks."""
    page.section("Checks", "checks")
    page.table(
        "Checks of the run",
        ["check", "found", "required", "verdict"],
        checks_of(run),
        "The first three and the smallest distance are counted on the recorded tracks, by code "
        "that the simulation does not use. The others are counted by the simulation itself.",
    )


def add_definitions(page: Page) -> None:
    """Add how all figures are defined, with sources."""
    page.section("Definitions", "definitions")
    page.table("Figures of this report", ["figure", "definition", "source"], DEFINITIONS)


def add_repeating(page: Page, run: Run) -> None:
    """Add versions, digests and the command that repeats the run."""
    summary = run.summary
    page.section("Versions, inputs and how to repeat the run", "repeat")
    page.table("Versions", ["what", "version"], _versions(summary))
    page.table(
        "Digests (sha256) of inputs and results: files with the same digest are the same",
        ["what", "sha256"],
        _digests(run),
    )
    page.lead_in("With the same versions and inputs, this command gives the same tracks:")
    page.command(command_of(summary))


def command_of(summary: Any) -> list[str]:
    """The words of the command that runs a run again, as far as its summary tells."""
    words = ["mesa-mobility", "run", str(summary.get("model", "MODEL"))]
    if summary.get("seed") is not None:
        words += ["--seed", str(summary["seed"])]
    defaults = _defaults(str(summary.get("model", "")))
    given = dict(summary.get("parameters") or {})
    if isinstance(summary.get("preset"), str):
        words += ["--preset", summary["preset"]]
    for name, value in given.items():
        if name in OWN_OPTION or value is None or str(defaults.get(name, "")) == str(value):
            continue
        words += ["--exits", str(value)] if name == "exits" else ["--set", f"{name}={value}"]
    for name, value in (summary.get("set") or {}).items():
        words += ["--set", f"{name}={value}"]
    for each in summary.get("behaviors") or ():
        words += ["--behavior", str(each)]
    ended = summary.get("egress_s") is not None or summary.get("stalled")
    if not ended and summary.get("simulated_s"):
        words += ["--seconds", f"{summary['simulated_s']:g}"]
    return words


def _defaults(model: str) -> dict[str, Any]:
    """Defaults of a model's parameters; none if it is not installed here."""
    try:
        return {name: each.default for name, each in parameters(find_model(model)).items()}
    except MobilityError:
        return {}


def _verdict(summary: Any, name: str) -> str:
    if summary.get(name) is None:
        return "not counted"
    return FAIL if summary[name] else PASS


def _versions(summary: Any) -> list[list[str]]:
    rows = [["mesa-mobility", str(summary.get("mesa_mobility", "-"))]]
    rows += [[name, str(value)] for name, value in (summary.get("versions") or {}).items()]
    return [*rows, ["machine on which this page was written", machine()]]


def _digests(run: Run) -> list[list[str]]:
    summary = run.summary
    rows = [[f"preset {summary.get('preset', '-')}", str(summary.get("preset_sha256", "-"))]]
    for kind, of in (summary.get("maps") or {}).items():
        made = "" if of.get("file") else ", made by the model"
        rows.append([f"recorded movements: {in_words(kind)}{made}", str(of.get("sha256") or "-")])
    text = json.dumps(run.plan.to_geojson(), sort_keys=True)
    rows.append(["floor plan, written as GeoJSON", hashlib.sha256(text.encode()).hexdigest()])
    folder = run.folder
    for name in (TRAJECTORIES, DECISIONS):
        if folder is not None and (folder / name).is_file():
            rows.append([f"file {name} of the run", sha256_of(folder / name)])
    return rows
