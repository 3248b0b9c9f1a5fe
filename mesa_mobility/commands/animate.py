"""`mesa-mobility animate` and `render`: a saved run as moving figures, films and stills."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from mesa_mobility.commands.console import NoProgress, progress_bar, say, some_path
from mesa_mobility.errors import ResultsError


class Format(StrEnum):
    """What is written."""

    GLB = "glb"
    BVH = "bvh"
    HTML = "html"
    USD = "usd"


RunDir = Annotated[Path, typer.Argument(metavar="RUN_DIR", help="Folder that `run --out` wrote.")]
Output = Annotated[
    Path, typer.Option("-o", "--output", help="What to write.", parser=some_path, metavar="PATH")
]
People = Annotated[
    str | None, typer.Option(metavar="1,5,7", help="Numbers of the people shown (everybody).")
]
Start = Annotated[float, typer.Option("--from", help="Seconds from which on.")]
End = Annotated[float | None, typer.Option("--to", help="Seconds until when (the end).")]

Poses = Annotated[
    Path | None,
    typer.Option(
        help="Poses of the run's map (.poses.npz) where they do not ship.",
        parser=some_path,
        metavar="PATH",
    ),
]


def animate(
    run: RunDir,
    output: Output,
    kind: Annotated[
        Format,
        typer.Option(
            "--format",
            help="glb, usd: one file; bvh: a folder, one file a person; html: an offline page.",
        ),
    ] = Format.GLB,
    people: People = None,
    start: Start = 0.0,
    end: End = None,
    poses: Poses = None,
    no_progress: NoProgress = False,
) -> None:
    """Write the people of a run as moving figures, for Blender and the web."""
    from mesa_mobility.animation import (
        Selection,
        walkers,
        write_bvh,
        write_glb,
        write_page,
        write_usd,
    )
    from mesa_mobility.bodies import PoseBank
    from mesa_mobility.results.run import read_run, title_of

    found = read_run(run)
    selection = Selection(numbers(people), start, end)
    bank = None if poses is None else PoseBank.load(poses)
    count = len(selection.people_of(found.trajectories))
    each = walkers(found.trajectories, selection, bank)
    with progress_bar(shown=not no_progress) as report:

        def progress(done: int) -> None:
            report("writing people", done, count)

        if kind is Format.GLB:
            write_glb(each, found.plan, output, progress=progress)
        elif kind is Format.USD:
            write_usd(each, found.plan, output, progress=progress)
        elif kind is Format.HTML:
            write_page(
                found.trajectories,
                found.plan,
                output,
                selection,
                title=title_of(found.summary, found.trajectories),
                bank=bank,
                progress=progress,
            )
        else:
            try:
                output.mkdir(parents=True, exist_ok=True)
            except OSError as error:
                raise ResultsError(f"{output}: expected a folder for one file a person") from error
            for done, walker in enumerate(each, start=1):
                write_bvh(walker.motion, output / f"person_{walker.person}.bvh")
                progress(done)
    size = f", {output.stat().st_size / 1e6:.1f} MB" if output.is_file() else ""
    say(f"{count} people written to {output}{size}")


def render(
    run: RunDir,
    output: Output,
    people: People = None,
    start: Start = 0.0,
    end: End = None,
    speed: Annotated[float, typer.Option(help="How many times as fast as it was.")] = 1.0,
    at: Annotated[
        str | None, typer.Option(metavar="0,10,20", help="Seconds of the panels of a still.")
    ] = None,
    no_progress: NoProgress = False,
) -> None:
    """Draw a run from above: a film (.mp4, .gif, .webp) or a still (.png, .pdf, .svg)."""
    from mesa_mobility.animation import Selection, write_film
    from mesa_mobility.animation.film import FILMS
    from mesa_mobility.results import plot_snapshots
    from mesa_mobility.results.run import read_run

    found = read_run(run)
    if output.suffix.lower() in FILMS:
        selection = Selection(numbers(people), start, end)
        with progress_bar(shown=not no_progress) as report:
            write_film(
                found.trajectories,
                found.plan,
                output,
                selection,
                speed=speed,
                progress=lambda done, total: report("drawing", done, total),
            )
    else:
        if output.suffix.lower() not in (".png", ".pdf", ".svg"):
            raise ResultsError(f"{output}: expected .mp4, .gif, .webp, .png, .pdf or .svg")
        times = [start] if at is None else [_number(each, "--at") for each in at.split(",")]
        plot_snapshots(found.trajectories, found.plan, output, times=times)
    say(f"written to {output}")


def numbers(text: str | None) -> tuple[int, ...] | None:
    """Numbers of people as an option gives them."""
    if text is None:
        return None
    return tuple(int(_number(each, "--people")) for each in text.split(","))


def _number(text: str, option: str) -> float:
    try:
        value = float(text)
    except ValueError:
        raise typer.BadParameter(
            f"{option}: {text!r}, expected numbers separated by commas"
        ) from None
    return value
