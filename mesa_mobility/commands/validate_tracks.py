"""`mesa-mobility validate tracks`: measured tracks beside their replay."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mesa_mobility.commands.console import NoProgress, say, some_path
from mesa_mobility.commands.models.making import Numbers, Rules, rules_given
from mesa_mobility.commands.validate import Asked, OutFolder, run_experiments
from mesa_mobility.commands.verify import AsJson, Jobs, ReportFile

if TYPE_CHECKING:
    from shapely import Polygon

    from mesa_mobility.validation.tracks.setting import Line


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
    frame_rate: Annotated[
        float | None, typer.Option(metavar="N", help="Frames a second, if the file does not tell.")
    ] = None,
    unit: Annotated[
        str | None, typer.Option(help="m, cm or mm, if the file does not tell.")
    ] = None,
    start: Annotated[
        int | None,
        typer.Option(
            min=0, metavar="FRAME", help="Frame at which the replay begins (6 s before --from)."
        ),
    ] = None,
    first: Annotated[
        int | None,
        typer.Option(
            "--from",
            min=0,
            metavar="FRAME",
            help="First frame to measure (a sixth of the people have crossed the line).",
        ),
    ] = None,
    last: Annotated[
        int | None,
        typer.Option(
            "--to",
            min=0,
            metavar="FRAME",
            help="Last frame to measure (five sixths have crossed it).",
        ),
    ] = None,
    area: Annotated[
        str | None,
        typer.Option(
            metavar="X,Y,X,Y|WKT",
            help="Where people are measured: two corners, or a polygon (the floor, "
            "without a tenth of all places at either end).",
        ),
    ] = None,
    line: Annotated[
        str | None,
        typer.Option(
            metavar="X,Y,X,Y", help="Both ends of a line to cross (the narrowest cut of the floor)."
        ),
    ] = None,
    speeds: Annotated[
        str | None,
        typer.Option(
            help="Free speeds of simulated people, as normal(1.55, 0.18); without it "
            "those of their type."
        ),
    ] = None,
    seeds: Annotated[int, typer.Option(min=1, metavar="N", help="Replays, seeds 1 to N.")] = 3,
    jobs: Jobs = None,
    preset: Rules = None,
    numbers: Numbers = None,
    as_json: AsJson = False,
    out: OutFolder = None,
    report_file: ReportFile = None,
    no_progress: NoProgress = False,
) -> None:
    """Replay measured people, and compare both crowds in the same windows.

    Ends with status 1 if a figure is not as measured.
    """
    rules = rules_given(preset, numbers or [])
    chosen_area = None if area is None else _area(area)
    chosen_line = None if line is None else _line(line)
    from mesa_mobility import FloorPlan, Trajectories
    from mesa_mobility.distributions import parse
    from mesa_mobility.validation.tracks import experiment, setting_of
    from mesa_mobility.verification.runs import crowd_model

    free_speeds = None if speeds is None else parse(speeds)
    floor = FloorPlan.from_file(plan)
    tracks = Trajectories.read(file, unit=unit, frame_rate=frame_rate)
    setting = setting_of(
        tracks,
        floor,
        str(plan),
        start=start,
        first=first,
        last=last,
        area=chosen_area,
        line=chosen_line,
        speeds=speeds,
    )
    say(f"{file}: {setting}")
    # Whatever cannot be replayed is found here, once, and not in every run.
    with rules.followed():
        crowd_model(floor, 1).replay(tracks, setting.start, preferred_speeds=free_speeds)
    given = Asked(seeds, jobs, as_json, out, report_file, no_progress)
    run_experiments([experiment(setting, floor, tracks)], rules, given)


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
