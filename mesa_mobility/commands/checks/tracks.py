"""`mesa-mobility validate tracks`: measured tracks beside their replay."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mesa_mobility.commands.checks.options import CheckOptions
from mesa_mobility.commands.checks.validate import OutFolder, run_experiments
from mesa_mobility.commands.console import say, some_path
from mesa_mobility.commands.exits import ExitOptions
from mesa_mobility.commands.grouping import grouped
from mesa_mobility.commands.reading import TracksOptions

if TYPE_CHECKING:
    from shapely import Polygon

    from mesa_mobility.validation.tracks.setting import Line


@dataclass(frozen=True)
class Replays(CheckOptions):
    """How replays are run, and what is written of them."""

    seeds: Annotated[
        int, typer.Option(min=1, metavar="N", help="Replay N times, with the seeds 1 to N.")
    ] = 3


@dataclass(frozen=True)
class Windows:
    """Where and when both crowds are measured."""

    start: Annotated[
        int | None,
        typer.Option(
            min=0,
            metavar="FRAME",
            help="Frame at which the replay begins. By default 6 s before --from.",
        ),
    ] = None
    first: Annotated[
        int | None,
        typer.Option(
            "--from",
            min=0,
            metavar="FRAME",
            help="First frame to measure. By default the one at which a sixth of the people have "
            "crossed the line.",
        ),
    ] = None
    last: Annotated[
        int | None,
        typer.Option(
            "--to",
            min=0,
            metavar="FRAME",
            help="Last frame to measure. By default the one at which five sixths have crossed it.",
        ),
    ] = None
    area: Annotated[
        str | None,
        typer.Option(
            metavar="X,Y,X,Y|WKT",
            help="Where people are measured: two corners, or a polygon. By default the part of "
            "the floor that holds, along the direction of walking, the middle 80 % of all measured "
            "places.",
        ),
    ] = None
    line: Annotated[
        str | None,
        typer.Option(
            metavar="X,Y,X,Y",
            help="Both ends of the line whose crossings are counted. By default the narrowest cut "
            "of the floor across the direction of walking.",
        ),
    ] = None


@grouped
def validate_tracks(
    file: Annotated[
        Path, typer.Argument(metavar="FILE", help="Measured tracks, such as text of an archive.")
    ],
    plan: Annotated[
        Path,
        typer.Option(
            help="Floor plan, with the exits by which people leave.",
            metavar="FILE",
            parser=some_path,
        ),
    ],
    reading: TracksOptions,
    windows: Windows,
    doors: ExitOptions,
    speeds: Annotated[
        str | None,
        typer.Option(
            help="Free speeds of simulated people, such as normal(1.55, 0.18). By default those of "
            "their type."
        ),
    ] = None,
    *,
    options: Replays,
    out: OutFolder = None,
) -> None:
    """Replay measured people, and compare the simulated with the measured crowd.

    Both are measured at the same times and places. Ends with status 1 if a figure misses its
    criterion.
    """
    rules = options.rules()
    area = None if windows.area is None else _area(windows.area)
    line = None if windows.line is None else _line(windows.line)
    from mesa_mobility.distributions import parse
    from mesa_mobility.validation.tracks import experiment, setting_of
    from mesa_mobility.verification.runs import crowd_model

    free_speeds = None if speeds is None else parse(speeds)
    floor = doors.floor_plan(plan)
    tracks = reading.read(file)
    setting = setting_of(
        tracks,
        floor,
        str(plan),
        start=windows.start,
        first=windows.first,
        last=windows.last,
        area=area,
        line=line,
        speeds=speeds,
    )
    setting = replace(setting, exits=doors.text, level=doors.level)
    say(f"{file}: {setting}")
    # Whatever cannot be replayed is found here, once, and not in every run.
    with rules.followed():
        crowd_model(floor, 1).replay(tracks, setting.start, preferred_speeds=free_speeds)
    run_experiments([experiment(setting, floor, tracks)], rules, options, out)


def _area(text: str) -> Polygon:
    from shapely import box

    from mesa_mobility.floorplan.floor.checks import read_polygon

    if text.lstrip()[:1].isalpha():
        return read_polygon(text, "--area")
    (ax, ay), (bx, by) = _corners(text, "--area")
    if ax == bx or ay == by:
        raise typer.BadParameter(f"--area: got {text!r}, expected two corners of an area")
    return box(min(ax, bx), min(ay, by), max(ax, bx), max(ay, by))


def _line(text: str) -> Line:
    a, b = _corners(text, "--line")
    if a == b:
        raise typer.BadParameter(f"--line: got {text!r}, expected two different ends")
    return a, b


def _corners(text: str, option: str) -> Line:
    from math import isfinite

    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError:
        numbers = []
    if len(numbers) != 4 or not all(map(isfinite, numbers)):
        raise typer.BadParameter(f"{option}: got {text!r}, expected four numbers X,Y,X,Y in metres")
    return (numbers[0], numbers[1]), (numbers[2], numbers[3])
