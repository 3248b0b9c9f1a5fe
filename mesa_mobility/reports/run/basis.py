"""The basis of a run: plan, people and assumptions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely

from mesa_mobility.floorplan import FloorPlan, Room
from mesa_mobility.reports.html import Page, picture
from mesa_mobility.reports.run.pictures import PAGE
from mesa_mobility.reports.run.texts import count, number
from mesa_mobility.results.engineering.doors import doors_of
from mesa_mobility.results.engineering.measured import Measured
from mesa_mobility.results.floor import plan_figure
from mesa_mobility.results.measures.by_type import people_by, rows_by_type
from mesa_mobility.results.run import Run

if TYPE_CHECKING:
    from mesa_mobility.buildings import Building

ASSUMPTIONS = (
    "Each person follows recorded movements of real people, and chooses the next one by a sum of "
    "costs. The numbers of these costs are those of the preset.",
    "Bodies are hard: two people never overlap, and nobody passes through a wall.",
    "Time advances in frames of 1/30 s. Positions are those of the middle of the body.",
    "The run ends when everybody has left, when nobody makes progress any more (it then counts as "
    "stalled), or at the time at which it was stopped.",
    "Smoke, heat, the time until people notice an alarm, and help by staff are in the run only if "
    "they are listed among the parameters or behaviours below.",
    "The run is one of many possible: another seed gives other people and other chance. Only an "
    "experiment with many runs shows how much the figures scatter.",
)
"""Assumptions of every run."""


LIMITS = (
    "Known limits of the model: crowds before narrow necks stand closer together than measured "
    "ones, so that densities and levels of service there are too unfavourable; people in dense "
    "closed corridors are slower than measured; fewer people pass wide necks than measured, and "
    "more pass stairs than handbooks allow. The documentation has the figures (“Known limits”, "
    "“Verification and validation”)."
)
"""Where the model is known to differ from measured crowds."""

_KINDS = {"gate": "door", "exit": "exit"}


def add_plan(page: Page, measured: Measured) -> None:
    """Add the plan with its doors and exits."""
    plan = measured.plan
    page.section("Plan", "plan")
    page.text(_said_of_plan(plan))
    add_plan_picture(page, plan)
    if not isinstance(plan, FloorPlan):
        stairs = [[each.name, each.upper, each.lower] for each in plan.stairs]
        if stairs:
            page.table("Stairs", ["name", "from level", "to level"], stairs)
    if measured.rooms:
        add_rooms(page, measured.rooms)


def add_rooms(page: Page, rooms: Sequence[Room]) -> None:
    """Add the rooms of a plan, with the areas that its file states, if it states any."""
    columns = ["name", "level", "floor (m²)"]
    rows = [[each.name, each.level, number(each.area)] for each in rooms]
    if any(each.stated_area for each in rooms):
        columns.append("area as the file states it (m²)")
        rows = [[*row, number(each.stated_area)] for row, each in zip(rows, rooms, strict=True)]
    page.table("Rooms", columns, rows)


def add_plan_picture(page: Page, plan: FloorPlan | Building) -> None:
    """Add the drawing of a plan, and its doors and exits with their numbers in it."""
    levels = "" if isinstance(plan, FloorPlan) else ", level by level from the top"
    numbers = {each.name: f"{k}" for k, (each, _) in enumerate(doors_of(plan), 1)}
    page.picture(
        f"Floor plan with the numbers of doors and exits{levels}",
        picture(plan_figure(plan, PAGE, numbers)),
    )
    rows = [
        [numbers[each.name], each.name, _KINDS[each.kind], level, number(each.length, 2)]
        for each, level in doors_of(plan)
    ]
    columns = ["number", "name", "kind", "level", "width (m)"]
    page.table("Doors and exits", columns, rows)


def add_people(page: Page, run: Run, measured: Measured) -> None:
    """Add who the people are, how fast they like to walk and when they set off."""
    tracks = measured.trajectories
    page.section("People", "people")
    first = np.zeros(len(tracks.radii), dtype=np.int64)
    first[tracks.person[::-1]] = tracks.frame[::-1]
    people = np.unique(tracks.person)
    later = int((first[people] > 0).sum())
    page.text(
        f"{count(len(people), 'person', 'people')} in all; "
        + (f"{later} of them came in during the run." if later else "all there from the start.")
    )
    add_types(page, run.summary.get("people") or ())
    if "type" not in tracks.person_data:
        return
    own = people_by(tracks, "type")
    rows = []
    for each in rows_by_type(tracks):
        of = own[each["type"]]
        radii = tracks.radii[of]
        rows.append(
            [
                str(each["type"]).replace("_", " "),
                each["people"],
                f"{each['people'] / len(people):.0%}",
                number(2 * float(radii.mean()), 2),
                each["left"],
                number(each["mean_egress_s"]),
                number(each["p95_egress_s"]),
                number(each["mean_speed_mps"], 2),
            ]
        )
    page.table(
        "What became of them",
        [
            "type",
            "people",
            "share",
            "width of the body core (m)",
            "left",
            "mean time inside (s)",
            "95 % are out after (s)",
            "mean speed (m/s)",
        ],
        rows,
        "The time inside runs from a person's first frame until they leave. People who are still "
        "inside are later than all others: with any of them there is no mean. The mean speed "
        "includes the time for which people wait.",
    )


def add_types(page: Page, people: Iterable[Mapping[str, Any]]) -> None:
    """Add how fast people of each type like to walk, and when they set off.

    Args:
        page: to add it to.
        people: as the summary of a run has them.
    """
    rows = [
        [
            str(each["type"]).replace("_", " "),
            each["people"],
            _of_three(each["preferred_mps"], 2),
            _of_three(each["sets_off_s"], 1),
        ]
        for each in people
    ]
    if rows:
        page.table(
            "Types of people: least, mean and greatest",
            ["type", "people", "speed when alone (m/s)", "sets off after the start (s)"],
            rows,
        )


def add_assumptions(page: Page, run: Run) -> None:
    """Add parameters and rules of the model."""
    summary = run.summary
    page.section("Assumptions", "assumptions")
    for each in ASSUMPTIONS:
        page.text(each)
    page.notice(LIMITS)
    given: dict[str, Any] = dict(summary.get("parameters") or {})
    rows = [[name.replace("_", " "), said(value)] for name, value in given.items()]
    if rows:
        page.table(
            f"Parameters of the model “{summary.get('model')}”", ["parameter", "value"], rows
        )
    add_rules(page, summary.get("rules") or {}, summary)


def add_rules(page: Page, rules: Any, summary: Any) -> None:
    """Add the behaviours of a preset with their numbers."""
    if not isinstance(rules, dict) or not rules:
        return
    settings = rules.get("settings") or {}
    rows = []
    for name, weight in (rules.get("terms") or {}).items():
        rows.append([_words(name), f"weight {weight:g}", _numbers(settings.get(name))])
    for name in rules.get("tactics") or ():
        rows.append([_words(name), "tactic", _numbers(settings.get(name))])
    if rules.get("target_choice"):
        name = rules["target_choice"]
        rows.append([_words(name), "choice of exit", _numbers(settings.get(name))])
    for each in summary.get("behaviors") or ():
        rows.append([_words(str(each)), "added to the preset", ""])
    changed = summary.get("set") or {}
    page.table(
        f"Behaviour of the people: preset “{rules.get('name', '-')}”",
        ["behaviour", "part", "numbers that the preset sets"],
        rows,
        "Numbers changed for this run: "
        + ("; ".join(f"{name} = {value}" for name, value in changed.items()) or "none")
        + ". The documentation of mesa-mobility defines each behaviour and compares the preset "
        "with measured crowds (verification and validation, known limits).",
    )


def said(value: Any) -> str:
    """A value of a parameter as a reader expects it."""
    if value is None:
        return "none"
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:g}" if isinstance(value, float) else str(value)


def _said_of_plan(plan: FloorPlan | Building) -> str:
    if isinstance(plan, FloorPlan):
        exits, gates = len(plan.open_exits()), len(plan.open_gates())
        x0, y0, x1, y1 = plan.bounds
        return (
            f"One floor of {x1 - x0:.1f} m by {y1 - y0:.1f} m with {plan.free.area:,.0f} m² of "
            f"free floor, {count(exits, 'exit')} and {count(gates, 'door')} inside."
        )
    area = sum(shapely.area(plan.floor_plan_of(each.number).free) for each in plan.levels)
    return (
        f"A building of {count(len(plan.levels), 'level')} with {area:,.0f} m² of free floor, "
        f"{count(len(plan.stairs), 'stair')} and {count(len(plan.lifts), 'lift')}."
    )


def _of_three(values: Sequence[float], digits: int) -> str:
    least, mean, most = values
    if least == most:
        return number(mean, digits)
    return " / ".join(number(each, digits) for each in (least, mean, most))


def _words(name: str) -> str:
    return name.replace("_", " ")


def _numbers(values: Any) -> str:
    return "; ".join(f"{_words(name)} {said(value)}" for name, value in (values or {}).items())
