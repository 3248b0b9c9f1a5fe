"""The basis of a run: plan, people and assumptions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely

from mesa_mobility.floorplan import FloorPlan, Room
from mesa_mobility.reports.html import Page, picture
from mesa_mobility.reports.run.pictures import PAGE
from mesa_mobility.reports.run.places import time_text
from mesa_mobility.reports.run.rules import add_parameters, add_rules
from mesa_mobility.reports.run.texts import count, in_words, level_words, number
from mesa_mobility.results.engineering.doors import doors_of
from mesa_mobility.results.engineering.measured import Measured
from mesa_mobility.results.measures.by_type import people_by, rows_by_type
from mesa_mobility.results.plan_picture import plan_figure
from mesa_mobility.results.run import Run

if TYPE_CHECKING:
    from mesa_mobility.buildings import Building

ASSUMPTIONS = (
    "Each person moves as recorded people did: again and again they choose the next movement, the "
    "one with the least sum of costs. The preset, below, has the weights of these costs.",
    "Bodies are hard: two people never overlap, and nobody passes through a wall.",
    "Time advances in steps (frames) of 1/30 s. Positions are those of the middle of the body.",
    "The run ends when everybody has left, when nobody makes progress any more (it then counts as "
    "stalled), or at the time at which it was stopped.",
    "Smoke, heat, the time until people notice an alarm, and help by staff are in the run only if "
    "they are listed among the parameters or behaviours below.",
    "The run is one of many possible: another seed gives other people at other places. Only an "
    "experiment of many runs shows how much the figures vary by chance.",
)
"""Assumptions of every run."""


LIMITS = (
    "Known limits of the model: crowds before narrow necks stand closer together than measured "
    "ones, so that densities and levels of service there are too unfavourable; people in dense "
    "closed corridors are slower than measured; fewer people pass wide necks than measured; and "
    "more pass doors and stairs than handbooks let designers reckon with. The documentation has "
    "the figures (“Known limits”, “Verification and validation”)."
)
"""Where the model is known to differ from measured crowds."""

_KINDS = {"gate": "door", "exit": "exit"}


def add_plan(page: Page, measured: Measured) -> None:
    """Add the plan with its doors and exits."""
    plan = measured.plan
    page.section("Plan", "plan")
    page.lead_in(_said_of_plan(plan))
    add_plan_picture(page, plan)
    if not isinstance(plan, FloorPlan):
        _add_ways(page, plan)
    if measured.rooms:
        add_rooms(page, measured.rooms, plan)


def add_rooms(page: Page, rooms: Sequence[Room], plan: FloorPlan | Building) -> None:
    """Add the rooms of a plan, with the areas that its file states, if it states any."""
    levels = level_words(plan)
    free = (
        {0: plan.free}
        if isinstance(plan, FloorPlan)
        else {each.number: plan.floor_plan_of(each.number).free for each in plan.levels}
    )
    columns = ["name", *(["level"] if levels else []), "area (m²)", "free floor (m²)"]
    rows: list[list[Any]] = [
        [
            each.name,
            *([levels[each.level]] if levels else []),
            number(each.area),
            number(shapely.intersection(each.shape, free[each.level]).area),
        ]
        for each in rooms
    ]
    if any(each.stated_area for each in rooms):
        columns.append("area as the file states it (m²)")
        rows = [[*row, number(each.stated_area)] for row, each in zip(rows, rooms, strict=True)]
    page.table("Rooms; obstacles are no free floor", columns, rows)


def _add_ways(page: Page, building: Building) -> None:
    """Add what joins the levels: stairs, ramps, escalators and lifts."""
    levels = level_words(building)
    if building.stairs:
        page.table(
            "Stairs, ramps and escalators",
            ["name", "kind", "from level", "to level", "clear width (m)"],
            [
                [
                    each.name,
                    type(each).__name__.lower(),
                    levels[each.upper],
                    levels[each.lower],
                    number(each.width, 2),
                ]
                for each in building.stairs
            ],
        )
    if building.lifts:
        page.table(
            "Lifts",
            ["name", "levels", "most people in the car", "speed (m/s)", "who uses it"],
            [
                [
                    each.name,
                    ", ".join(map(str, each.numbers)),
                    each.capacity,
                    number(each.speed, 2),
                    "everybody" if each.everybody else "people who use no stairs",
                ]
                for each in building.lifts
            ],
        )


def add_plan_picture(page: Page, plan: FloorPlan | Building) -> None:
    """Add the drawing of a plan, and its doors and exits with their numbers in it."""
    levels = "" if isinstance(plan, FloorPlan) else ", level by level from the top"
    numbers = {each.name: f"{k}" for k, (each, _) in enumerate(doors_of(plan), 1)}
    page.picture(
        f"Floor plan with the numbers of doors and exits of the table below{levels}",
        picture(plan_figure(plan, PAGE, numbers)),
    )
    names = level_words(plan)
    rows = [
        [
            f"{numbers[each.name]}: {each.name}",
            _KINDS[each.kind],
            *([names[level]] if names else []),
            number(each.length, 2),
        ]
        for each, level in doors_of(plan)
    ]
    columns = ["number and name", "kind", *(["level"] if names else []), "clear width (m)"]
    if rows:
        page.table("Doors and exits", columns, rows)


def add_people(page: Page, run: Run, measured: Measured) -> None:
    """Add who the people are, how fast they like to walk and when they set off."""
    tracks = measured.trajectories
    page.section("People", "people")
    first = np.zeros(len(tracks.radii), dtype=np.int64)
    first[tracks.person[::-1]] = tracks.frame[::-1]
    people = np.unique(tracks.person)
    later = int((first[people] > 0).sum())
    came = f"{later} of them came in during the run" if later else "all are there from the start"
    page.text(f"{count(len(people), 'person', 'people')} in all; {came}.")
    add_types(page, run.summary.get("people") or ())
    if "type" not in tracks.person_data:
        return
    own, cleared = people_by(tracks, "type"), measured.clearing
    rows = []
    for each in rows_by_type(tracks):
        of = own[each["type"]]
        radii = tracks.radii[of]
        rows.append(
            [
                in_words(str(each["type"])),
                each["people"],
                f"{each['people'] / len(people):.0%}",
                number(2 * float(radii.mean()), 2),
                each["left"],
                number(each["mean_egress_s"]),
                time_text(cleared.loc[each["type"], "floor"].iloc[0], "t95_s"),
                number(each["mean_speed_mps"], 2),
            ]
        )
    page.table(
        "How people of each type got on",
        [
            "type",
            "people",
            "share",
            "mean width of the body core (m)",
            "left",
            "mean time inside (s)",
            "95 % are out after (s)",
            "mean speed (m/s)",
        ],
        rows,
        "The time inside runs from when a person is first there until they leave. If anybody is "
        "still inside at the end, there is no mean. The mean speed includes waiting.",
    )


def add_types(page: Page, people: Iterable[Mapping[str, Any]]) -> None:
    """Add how fast people of each type like to walk, and when they set off.

    Args:
        page: to add it to.
        people: as the summary of a run has them.
    """
    rows = [
        [
            in_words(str(each["type"])),
            each["people"],
            _of_three(each["preferred_mps"], 2),
            _of_three(each["sets_off_s"], 1),
        ]
        for each in sorted(people, key=lambda each: str(each["type"]))
    ]
    if rows:
        page.table(
            "Types of people",
            ["type", "people", "speed when alone (m/s)", "sets off after (s)"],
            rows,
            "Three numbers are the least, the mean and the greatest of the people of a type; one "
            "is that of all. People set off so many seconds after they are first there.",
        )


def add_assumptions(page: Page, run: Run) -> None:
    """Add parameters and rules of the model."""
    summary = run.summary
    page.section("Assumptions", "assumptions")
    for each in ASSUMPTIONS:
        page.text(each)
    page.notice(LIMITS)
    add_parameters(page, str(summary.get("model")), summary.get("parameters") or {})
    changed = summary.get("set") or {}
    said = "; ".join(f"{name} = {value}" for name, value in changed.items()) or "none"
    add_rules(
        page,
        summary.get("rules") or {},
        [str(each) for each in summary.get("behaviors") or ()],
        f"Numbers changed for this run: {said}.",
    )


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
