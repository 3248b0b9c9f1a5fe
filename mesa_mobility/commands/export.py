"""`mesa-mobility export`: a saved run in another form, such as moving figures, films and tables."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mesa_mobility.commands.console import (
    FormatSettings,
    NoProgress,
    progress_bar,
    say,
    some_path,
)
from mesa_mobility.commands.grouping import grouped

if TYPE_CHECKING:
    from mesa_mobility.bodies import PoseBank
    from mesa_mobility.results import Selection

RunDir = Annotated[Path, typer.Argument(metavar="RUN_DIR", help="Folder that `run --out` wrote.")]


@dataclass(frozen=True)
class Shown:
    """Which part of a run is shown, and with whose bodies."""

    people: Annotated[
        str | None,
        typer.Option(metavar="1,5,7", help="Numbers of the people to show. By default everybody."),
    ] = None
    start: Annotated[
        float, typer.Option("--from", help="Time in seconds from which on the run is shown.")
    ] = 0.0
    end: Annotated[
        float | None,
        typer.Option("--to", help="Time in seconds until which it is shown. By default its end."),
    ] = None
    poses: Annotated[
        Path | None,
        typer.Option(
            help="Poses of the run's map (.poses.npz), if the map does not come with the package.",
            parser=some_path,
            metavar="PATH",
        ),
    ] = None

    def selection(self) -> Selection:
        """People and times.

        Raises:
            typer.BadParameter: numbers of people that are none.
        """
        from mesa_mobility.results import Selection

        return Selection(_numbers(self.people), self.start, self.end)

    def bank(self) -> PoseBank | None:
        """The poses given, if any."""
        from mesa_mobility.bodies import PoseBank

        return None if self.poses is None else PoseBank.load(self.poses)


@grouped
def export(
    run: RunDir,
    output: Annotated[
        Path,
        typer.Option(
            "-o", "--output", help="File or folder to write.", parser=some_path, metavar="PATH"
        ),
    ],
    shown: Shown,
    *,
    kind: Annotated[
        str | None,
        typer.Option(
            "--format",
            metavar="NAME",
            help="Format to write; `mesa-mobility formats` lists them. By default the suffix of "
            "PATH decides.",
        ),
    ] = None,
    settings: FormatSettings = None,
    level: Annotated[
        int | None,
        typer.Option(
            help="Of a run in a building: the level whose people are written, without bodies. By "
            "default everybody is, in formats that have elevations."
        ),
    ] = None,
    speed: Annotated[
        float | None, typer.Option(help="For a film: its speed, as a multiple of real time.")
    ] = None,
    at: Annotated[
        str | None,
        typer.Option(metavar="0,10,20", help="For a still: the times in seconds of its panels."),
    ] = None,
    no_progress: NoProgress = False,
) -> None:
    """Write a saved run as moving figures, a page, a film, a still or a table.

    `animate` and `render` are other names of this command.
    """
    from mesa_mobility.plugins.formats import WRITE
    from mesa_mobility.results import Excerpt
    from mesa_mobility.results.formats.output_format import OUTPUTS
    from mesa_mobility.results.run import read_run

    chosen = OUTPUTS.of(output, WRITE) if kind is None else OUTPUTS.named(kind)
    given = {"speed": speed, "at": at}
    options = OUTPUTS.chosen_options(chosen, WRITE, given, settings or ())
    selection = shown.selection()
    found = read_run(run) if level is None else read_run(run).on(level)
    with progress_bar(shown=not no_progress) as report:
        excerpt = Excerpt(
            found.trajectories,
            found.plan if chosen.storeys else found.floor_plan,
            selection,
            found.summary,
            shown.bank(),
            lambda done, of: report("writing", done, of),
        )
        count = len(excerpt.people)
        chosen.write(excerpt, output, **options)
    size = f", {output.stat().st_size / 1e6:.1f} MB" if output.is_file() else ""
    say(f"{count} people written to {output}{size}")


def _numbers(text: str | None) -> tuple[int, ...] | None:
    """Numbers of people as an option gives them."""
    if text is None:
        return None
    try:
        return tuple(int(each) for each in text.split(","))
    except ValueError:
        raise typer.BadParameter(
            f"--people: {text!r}, expected whole numbers separated by commas"
        ) from None
