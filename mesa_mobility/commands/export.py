"""`mesa-mobility export`: a saved run in another form, such as moving figures, films and tables."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from mesa_mobility.commands.console import (
    FormatSettings,
    NoProgress,
    progress_bar,
    say,
    some_path,
)

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


def export(
    run: RunDir,
    output: Output,
    kind: Annotated[
        str | None,
        typer.Option(
            "--format",
            metavar="NAME",
            help="By default what the end of PATH says; `mesa-mobility formats` lists formats.",
        ),
    ] = None,
    people: People = None,
    start: Start = 0.0,
    end: End = None,
    poses: Poses = None,
    settings: FormatSettings = None,
    speed: Annotated[
        float | None, typer.Option(help="Of a film: how many times as fast as it was.")
    ] = None,
    at: Annotated[
        str | None, typer.Option(metavar="0,10,20", help="Of a still: seconds of its panels.")
    ] = None,
    no_progress: NoProgress = False,
) -> None:
    """Write a saved run as moving figures, a page, a film, a still or a table.

    `animate` and `render` are other names of this command.
    """
    from mesa_mobility.bodies import PoseBank
    from mesa_mobility.plugins.formats import WRITE
    from mesa_mobility.results import Excerpt, Selection
    from mesa_mobility.results.formats.output_format import OUTPUTS
    from mesa_mobility.results.run import read_run

    chosen = OUTPUTS.of(output, WRITE) if kind is None else OUTPUTS.named(kind)
    given = {"speed": speed, "at": at}
    options = OUTPUTS.chosen_options(chosen, WRITE, given, settings or ())
    selection = Selection(numbers(people), start, end)
    found = read_run(run)
    with progress_bar(shown=not no_progress) as report:
        excerpt = Excerpt(
            found.trajectories,
            found.plan,
            selection,
            found.summary,
            None if poses is None else PoseBank.load(poses),
            lambda done, of: report("writing", done, of),
        )
        count = len(excerpt.people)
        chosen.write(excerpt, output, **options)
    size = f", {output.stat().st_size / 1e6:.1f} MB" if output.is_file() else ""
    say(f"{count} people written to {output}{size}")


def numbers(text: str | None) -> tuple[int, ...] | None:
    """Numbers of people as an option gives them."""
    if text is None:
        return None
    try:
        return tuple(int(each) for each in text.split(","))
    except ValueError:
        raise typer.BadParameter(
            f"--people: {text!r}, expected whole numbers separated by commas"
        ) from None
