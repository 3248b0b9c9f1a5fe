"""Levels of service of a run: maps of density, usage and speed."""

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import pairwise

import numpy as np

from mesa_mobility.floorplan import FloorPlan
from mesa_mobility.reports.html import Page
from mesa_mobility.reports.run.pictures import PAGE, drawn
from mesa_mobility.results.engineering.maps import DENSE, FloorMaps, maps
from mesa_mobility.results.engineering.measured import Measured
from mesa_mobility.results.engineering.pictures import plot_map
from mesa_mobility.results.engineering.service import LETTERS, level_of_service, service_limits
from mesa_mobility.results.measures.by_type import EVERYBODY

LASTING = 0.1
"""Share of the evacuation for which a density above the limit is a congestion (IMO)."""


def add_service(page: Page, measured: Measured, of: str = "") -> None:
    """Add levels of service, time above a density, usage and speeds.

    Args:
        page: to add them to.
        measured: the figures.
        of: a sentence on what the maps are of.
    """
    tracks, plan, found = measured.trajectories, measured.plan, measured.maps[EVERYBODY]
    page.section("Level of service", "level-of-service")
    if of:
        page.text(of)
    cell = next(iter(found.values())).grid.cell
    page.text(
        "Levels of service say what a density means for people who walk (J. J. Fruin, Pedestrian "
        "Planning and Design, 1971): from A, free to walk, to F, a standstill. Densities are "
        f"measured every {measured.every:g} s in cells of {cell:g} m (see “Definitions”), from the "
        "start on: people who have not set off yet count as well."
    )
    page.table(
        "Levels of service for walkways, and how much of the floor is in each at its greatest "
        "density",
        ["level of service", "density (persons/m²)", "floor (m²)", "share of the floor"],
        _areas(found),
        "Fruin publishes the limits as 35, 25, 15, 10 and 5 square feet a person."
        + ("" if isinstance(plan, FloorPlan) else " Stairs are not part of the floor."),
    )
    _map(
        page,
        measured,
        found,
        "density_max",
        "Level of service at the greatest density of each cell during the run",
    )
    at, said = _moment(measured)
    now = maps(tracks, plan, cell=cell, start=at, end=at)
    _map(
        page,
        measured,
        now,
        "density_max",
        f"Level of service after {at:.1f} s, {said}",
        "no density, since nobody is there or walls separate the place from everybody",
        f"level of service after {at:.1f} s",
    )
    page.text(_congestion(measured, found))
    if any(np.nanmax(own.dense_s, initial=0.0) > 0.0 for own in found.values()):
        limit = f"above {DENSE:g} persons/m²"
        _map(
            page,
            measured,
            found,
            "dense_s",
            f"Time for which each cell was {limit}",
            "never",
            f"time {limit} (s)",
        )
    _map(
        page,
        measured,
        found,
        "people",
        "Usage: number of people who were ever in each cell",
        "nobody",
        "people who were ever there",
    )
    _map(
        page,
        measured,
        found,
        "speed",
        f"Mean speed of the people in each cell, measured every {measured.every:g} s",
        "nobody was there",
    )


def _moment(measured: Measured) -> tuple[float, str]:
    """A time to show, and why: when half of the people are out, or else half-way."""
    half = float(measured.clearing.loc[EVERYBODY]["t50_s"].iloc[0])
    if math.isfinite(half):
        return half, "when half of the people are out"
    return measured.trajectories.duration / 2, "half-way through the run"


def _areas(found: Mapping[int, FloorMaps]) -> list[list[str]]:
    """A row for each level of service: limits, floor and share."""
    areas = dict.fromkeys(LETTERS, 0.0)
    for own in found.values():
        letters, floor = level_of_service(own.density_max), own.grid.share * own.grid.cell**2
        for letter in LETTERS:
            areas[letter] += float(floor[letters == letter].sum())
    whole, limits = sum(areas.values()) or 1.0, service_limits()
    ranges = [
        f"up to {limits[0]:.2f}",
        *(f"{low:.2f} to {high:.2f}" for low, high in pairwise(limits)),
        f"more than {limits[-1]:.2f}",
    ]
    return [
        [letter, between, f"{areas[letter]:,.1f}", f"{areas[letter] / whole:.0%}"]
        for letter, between in zip(LETTERS, ranges, strict=True)
    ]


def _congestion(measured: Measured, found: Mapping[int, FloorMaps]) -> str:
    duration = measured.trajectories.duration
    lasting = dense = 0.0
    for own in found.values():
        floor = own.grid.share * own.grid.cell**2
        dense += float(floor[np.nan_to_num(own.dense_s) > 0.0].sum())
        lasting += float(floor[np.nan_to_num(own.dense_s) > LASTING * duration].sum())
    return (
        f"Congestion (IMO MSC.1/Circ.1533): more than {DENSE:g} persons/m² for more than a tenth "
        f"of the evacuation. {dense:.1f} m² of floor were above this density at some time, and "
        f"{lasting:.1f} m² for more than a tenth of the {duration:.1f} s. So there is "
        f"{'' if lasting > 0.0 else 'no '}congestion in this run."
    )


def _map(
    page: Page,
    measured: Measured,
    found: Mapping[int, FloorMaps],
    what: str,
    caption: str,
    white: str = "",
    label: str = "",
) -> None:
    tracks, plan = measured.trajectories, measured.plan
    levels = "" if isinstance(plan, FloorPlan) else ", level by level from the top"
    page.picture(
        caption + levels + (f"; white: {white}" if white else ""),
        drawn(
            lambda path: plot_map(found, tracks, plan, path, what=what, label=label, largest=PAGE)
        ),
    )
