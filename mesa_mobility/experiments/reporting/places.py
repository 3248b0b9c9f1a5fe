"""Doors, clearing times and types of people in an experiment: means over the runs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from mesa_mobility.experiments.observed import observed
from mesa_mobility.experiments.reporting.basis import model_again
from mesa_mobility.experiments.reporting.estimates import MOST_ROWS, known_of
from mesa_mobility.experiments.reporting.labels import labels_of
from mesa_mobility.experiments.reporting.pictures import value_text
from mesa_mobility.experiments.storing.rows import FAILED
from mesa_mobility.reports.run.texts import in_words
from mesa_mobility.reports.words import words_of

if TYPE_CHECKING:
    import pandas as pd

    from mesa_mobility.reports.html import Page

_OF_DOORS = ("people", "first_s", "last_s", "flow_per_s")

_CLEARED = {"t50_s": "50 % (s)", "t95_s": "95 % (s)", "t100_s": "100 % (s)"}

_PLACES = ("level", "stairs", "room")
"""Kinds of places that have clearing times, beside the whole floor."""


_HEADS = {"level": "Levels", "stairs": "Stairs", "lift": "Lifts"}

_STOREYS = {
    "level": {
        "people": "people who were ever there",
        "clear_s": "empty after (s)",
        "most": "most at a time",
    },
    "stairs": {
        "people": "people who were ever there",
        "down": "whole ways down",
        "up": "whole ways up",
        "mean_s": "mean time of these (s)",
        "most": "most at a time",
    },
    "lift": {
        "people": "people who rode",
        "rides": "rides with people",
        "mean_wait_s": "mean wait (s)",
        "longest_wait_s": "longest wait (s)",
        "mean_ride_s": "mean time in the car (s)",
        "most": "most at a time",
    },
}
"""Figures of parts of buildings, by kind."""


def add_doors(page: Page, experiment: Any, frame: pd.DataFrame) -> None:
    """Add figures of doors, clearing times, and figures of levels, stairs and lifts, by point."""
    page.section("Doors, exits and clearing times", "doors")
    doors = [
        column.removeprefix("door.").removesuffix(".people")
        for column in map(str, frame.columns)
        if column.startswith("door.") and column.endswith(".people")
    ]
    if not doors:
        page.text(
            "The runs have not kept figures of doors. An experiment keeps them if it asks so."
        )
        return
    page.table(
        "Doors and exits: means over the runs, by point of the design",
        [*_named(experiment), "door or exit", *(words_of(each) for each in _OF_DOORS)],
        _rows(experiment, frame, {each: f"door.{each}." for each in doors}, _OF_DOORS),
        "In brackets: 95 % intervals of the means. Everybody counts at their first passage.",
    )
    places = {"the whole floor": ""}
    for column in map(str, frame.columns):
        kind, _, place = column.removesuffix(".t95_s").partition(".")
        if column.endswith(".t95_s") and kind in _PLACES:
            places[place if kind in place.split() else f"{kind} {place}"] = f"{kind}.{place}."
    page.table(
        "Clearing times: when 50, 95 and 100 % of the people who were ever there have left for "
        "good; means over the runs, by point of the design",
        [*_named(experiment), "place", *_CLEARED.values()],
        _rows(experiment, frame, places, _CLEARED),
        "In brackets: 95 % intervals of the means. No mean is given where a run did not reach the "
        "share.",
    )
    for kind, figures in _STOREYS.items():
        parts = [
            column.removeprefix(f"{kind}.").removesuffix(".most")
            for column in map(str, frame.columns)
            if column.startswith(f"{kind}.") and column.endswith(".most")
        ]
        if parts:
            page.table(
                f"{_HEADS[kind]}: means over the runs, by point of the design",
                [*_named(experiment), kind, *figures.values()],
                _rows(experiment, frame, {each: f"{kind}.{each}." for each in parts}, figures),
                "In brackets: 95 % intervals of the means. No mean is given where a run has no "
                "value.",
            )


def add_types(page: Page, experiment: Any, frame: pd.DataFrame) -> None:
    """Add people and times inside by type of people, at each point of the design."""
    if "types" not in frame:
        return
    runs = [list(each) if each is not None else [] for each in frame["types"]]
    numbers = sorted({int(each["type"]) for run in runs for each in run})
    if len(numbers) < 2:
        return
    called = _called(experiment, frame, numbers)
    rows = []
    for _, of in frame.groupby("point", sort=False):
        point = [value_text(of[name].iloc[0]) for name in experiment.design.column_types()]
        for number in numbers:
            found = [
                {str(key): value for key, value in each.items()}
                for run, status in zip(of["types"], of["status"], strict=True)
                if status != FAILED and run is not None
                for each in run
                if each["type"] == number
            ]
            said = []
            for key in ("people", "left", "mean_s", "longest_s"):
                values = [each[key] for each in found]
                known = np.array([np.inf if v is None else v for v in values], dtype=np.float64)
                known[np.isnan(known)] = np.inf
                said.append(str(known_of("mean", "mean_time_inside_s", known)))
            rows.append([*point, called[number], *said])
    page.table(
        "People by type: means over the runs, by point of the design",
        [
            *_named(experiment),
            "type",
            "people",
            "left",
            "mean time inside (s)",
            "longest time inside (s)",
        ],
        rows[:MOST_ROWS],
        "In brackets: 95 % intervals of the means. No mean is given where somebody of the type was "
        "still inside at the end of a run.",
    )


def _called(experiment: Any, frame: pd.DataFrame, numbers: list[int]) -> dict[int, str]:
    """What types of people are called; their numbers where the design varies them."""
    model = None
    if "population" not in experiment.design.column_types():
        model = model_again(experiment, frame)
    kinds = [each.name for each in getattr(model, "pedestrian_types", ())]
    return {
        number: in_words(kinds[number]) if number < len(kinds) else f"type {number + 1}"
        for number in numbers
    }


def _named(experiment: Any) -> list[str]:
    labels = labels_of(experiment)
    return [words_of(name, labels) for name in experiment.design.column_types()]


def _rows(
    experiment: Any, frame: pd.DataFrame, places: dict[str, str], figures: Any
) -> list[list[str]]:
    """A row for each point and place: the values of the point, the place, means of figures.

    Args:
        experiment: the experiment.
        frame: rows of its store.
        places: the beginning of their columns, by what they are called.
        figures: the ends of the columns.
    """
    names = list(experiment.design.column_types())
    rows = []
    for _, of in frame.groupby("point", sort=False):
        point = [value_text(of[name].iloc[0]) for name in names]
        for place, begin in places.items():
            found = []
            for figure in figures:
                column = f"{begin}{figure}"
                values = observed(of, column) if column in of else np.full(len(of), np.nan)
                found.append(str(known_of("mean", column, values[~np.isnan(values)])))
            rows.append([*point, place, *found])
    return rows[:MOST_ROWS]
