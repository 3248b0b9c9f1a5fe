"""`mesa-mobility map info` and `coverage`: what is in a map, and which movements it covers."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mesa_mobility.commands.console import AsJson, NoProgress, stoppable_progress
from mesa_mobility.commands.maps.answers import (
    answer,
    described,
    examine_map,
    say_clips,
)

if TYPE_CHECKING:
    from mesa_mobility.capture import Recording
    from mesa_mobility.commands.console import Report
    from mesa_mobility.mobility import MobilityMap


def info(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="Map file.")],
    as_json: AsJson = False,
) -> None:
    """Print the contents and sources of a map file, and examine what its people cannot do."""
    from mesa_mobility.mobility import MobilityMap

    mobility_map = MobilityMap.load(file)
    with stoppable_progress() as report:
        _, examination = examine_map(mobility_map, report)
    answer({"file": str(file), **described(mobility_map), **examination}, as_json=as_json)


def coverage(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="Map file.")],
    sources: Annotated[
        list[Path],
        typer.Argument(
            metavar="RECORDING_OR_MANIFEST...",
            help="Recordings that the map was not built from; with --leave-one-out, its own.",
        ),
    ],
    leave_out: Annotated[
        bool,
        typer.Option(
            "--leave-one-out",
            help="The recordings are the map's own. Compare each clip with a map built from the "
            "others.",
        ),
    ] = False,
    as_json: AsJson = False,
    no_progress: NoProgress = False,
) -> None:
    """Compare a map's options with the movements in other recordings."""
    from mesa_mobility.mobility import MobilityMap, left_out_one_at_a_time
    from mesa_mobility.mobility import coverage as compare

    mobility_map = MobilityMap.load(file)
    recordings = []
    with stoppable_progress(shown=not no_progress) as report:
        for source in sources:
            recordings.extend(load_recordings(source, report, mobility_map if leave_out else None))
        if leave_out:
            clusters = mobility_map.metadata.get("build", {}).get("clusters_asked")
            figures = left_out_one_at_a_time(recordings, clusters, report)
        else:
            report("comparing", 0, 1)
            figures = compare(mobility_map, recordings)
            report("comparing", 1, 1)
    answer({"file": str(file), **figures}, as_json=as_json)


def load_recordings(source: Path, report: Report, built: MobilityMap | None) -> list[Recording]:
    """All recordings as they are, or for a map those that it was built from, as they were used."""
    from mesa_mobility.capture import find_clips, load_clips
    from mesa_mobility.mobility import recordings_behind

    def progress(done: int, total: int) -> None:
        report("reading recordings", done, total)

    if built is not None:
        prepared = recordings_behind(built, find_clips(source), progress)
        say_clips(prepared.clips)
        return prepared.recordings
    loaded = load_clips(find_clips(source), mirrored=False, progress=progress)
    say_clips(loaded)
    return loaded.recordings
