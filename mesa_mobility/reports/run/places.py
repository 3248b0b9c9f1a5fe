"""Places in the report of a run: when floor, levels, stairs and rooms are empty."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from mesa_mobility.reports.html import Page
from mesa_mobility.reports.run.texts import in_words, level_words, number
from mesa_mobility.results.engineering.measured import Measured
from mesa_mobility.results.engineering.service import level_of_service
from mesa_mobility.results.measures.by_type import EVERYBODY
from mesa_mobility.results.run import Run

if TYPE_CHECKING:
    import pandas as pd

    from mesa_mobility.buildings import Building
    from mesa_mobility.floorplan import FloorPlan


def rows_of(table: pd.DataFrame, kind: str = EVERYBODY) -> list[dict[str, Any]]:
    """Rows of a table by type, of everybody or of one type."""
    own = table.loc[kind].reset_index()
    return [{str(name): value for name, value in row.items()} for row in own.to_dict("records")]


def types_of(table: pd.DataFrame) -> list[str]:
    """The types of people in a table by type, in its order."""
    return [kind for kind in dict.fromkeys(table.index.get_level_values(0)) if kind != EVERYBODY]


def time_text(row: Any, name: str) -> str:
    """A clearing time, or the bound where it was not reached."""
    value, censored = row[name], row["censored_s"]
    if math.isfinite(value):
        return f"{value:.1f}"
    return f"> {censored:.1f}" if math.isfinite(censored) else "-"


def add_clearing(page: Page, measured: Measured) -> None:
    """Add clearing times of the floor, levels, stairs and rooms, and those of each type."""
    levels = level_words(measured.plan)
    every = rows_of(measured.clearing)
    places = [_place(each["kind"], str(each["place"]), levels) for each in every]
    bound = (
        "“> …” where the share falls among people who are still there when the run ends: it takes "
        "longer than that."
    )
    page.table(
        "Clearing times: when 50, 95 and 100 % of the people who were ever there have left for "
        "good",
        ["place", "people", "left", "50 % (s)", "95 % (s)", "100 % (s)"],
        [
            [
                place,
                each["people"],
                each["left"],
                *(time_text(each, f"t{share}_s") for share in (50, 95, 100)),
            ]
            for place, each in zip(places, every, strict=True)
        ],
        bound,
    )
    types = types_of(measured.clearing)
    if len(types) < 2:
        return
    own = {kind: rows_of(measured.clearing, kind) for kind in types}
    page.table(
        "Clearing times by type of people: when 95 % of those who were ever there have left for "
        "good, in seconds",
        ["place", *map(in_words, types)],
        [
            [place, *(time_text(own[kind][row], "t95_s") for kind in types)]
            for row, place in enumerate(places)
        ],
        f"{bound} “-” where nobody of the type ever was.",
    )


def add_storeys(page: Page, run: Run, plan: FloorPlan | Building) -> None:
    """Add who was on each level, each stair and in each lift."""
    summary, names = run.summary, level_words(plan)
    if levels := summary.get("by_level"):
        page.table(
            "People on levels",
            [
                "level",
                "people ever there",
                "at the start",
                "at the end",
                "empty after (s)",
                "most at a time",
            ],
            [
                [
                    names.get(each["level"], str(each["level"])),
                    each["people"],
                    each["at_start"],
                    each["at_end"],
                    number(each["clear_s"]),
                    each["most"],
                ]
                for each in levels
            ],
        )
    if stairs := summary.get("by_stairs"):
        widths = {each.name: each.width for each in getattr(plan, "stairs", ())}
        page.table(
            "People on stairs",
            [
                "stairs",
                "people ever there",
                "whole ways down",
                "whole ways up",
                "mean time (s)",
                "flow at the head (persons/s)",
                "flow at the foot (persons/s)",
                "specific flow at the foot (persons/(m s))",
                "most at a time",
                "then density (persons/m²) and level of service",
            ],
            [
                [
                    each["stairs"],
                    each["people"],
                    each["down"],
                    each["up"],
                    number(each["mean_s"]),
                    number(each["head_per_s"], 2),
                    number(each["foot_per_s"], 2),
                    number(_over(each["foot_per_s"], widths.get(each["stairs"])), 2),
                    each["most"],
                    _served(each["most_per_m2"]),
                ]
                for each in stairs
            ],
            "A whole way leads from one end of the stairs to the other; the mean time is that of "
            "whole ways. People who are on the stairs at the start, or turn back, have none. The "
            "density is over flights and landings; levels of service are those of Fruin for "
            "stairs.",
        )
    if lifts := summary.get("by_lift"):
        trips = {each["lift"]: each["trips"] for each in summary.get("lifts", ())}
        page.table(
            "People in lifts",
            [
                "lift",
                "people who rode",
                "ways down",
                "ways up",
                "rides of the car with people",
                "with empty ones",
                "mean wait (s)",
                "longest wait (s)",
                "mean time in the lift (s)",
                "most at a time",
            ],
            [
                [
                    each["lift"],
                    each["people"],
                    each["down"],
                    each["up"],
                    each["rides"],
                    trips.get(each["lift"]),
                    number(each["mean_wait_s"]),
                    number(each["longest_wait_s"]),
                    number(each["mean_ride_s"]),
                    each["most"],
                ]
                for each in lifts
            ],
            "People wait from when they come within 4 m of the door until they get in, the way to "
            "the door included. People who never ride, such as those who still wait at the end, "
            "are not counted.",
        )


def _place(kind: str, place: str, levels: dict[int, str]) -> str:
    if kind == "floor":
        return "the whole building" if levels else "the whole floor"
    if kind == "level":
        return f"level {levels.get(int(place), place)}"
    return place if kind in place.split() else f"{kind} {place}"


def _served(density: float) -> str:
    return f"{number(density, 2)} ({level_of_service(density, 'stairs')})"


def _over(value: float | None, width: float | None) -> float | None:
    return None if value is None or not width else value / width
