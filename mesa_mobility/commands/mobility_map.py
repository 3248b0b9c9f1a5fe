"""`mesa-mobility map`: build, describe and judge mobility maps."""

from __future__ import annotations

import shlex
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from mesa_mobility.commands.console import (
    answer_json,
    answer_table,
    progress_bar,
    say,
    some_path,
)
from mesa_mobility.errors import MapError
from mesa_mobility.interrupts import INTERRUPTED, Stopped, gentle_interrupt, putting_in_place

if TYPE_CHECKING:
    from mesa_mobility.capture import LoadedClips, Recording
    from mesa_mobility.commands.console import Report
    from mesa_mobility.mobility import MobilityMap

app = typer.Typer(help="Build, describe and judge mobility maps.", no_args_is_help=True)

MOST_LEFT_OUT = 12
"""Clips up to which a build also leaves each out in turn: so many builds more."""

AsJson = Annotated[bool, typer.Option("--json", help="One JSON object as the last line of output.")]


@app.command()
def build(
    source: Annotated[
        Path,
        typer.Argument(
            metavar="MANIFEST_OR_DIR", help="Manifest of recordings, or a folder of them."
        ),
    ],
    output: Annotated[
        Path,
        typer.Option(
            "-o", "--output", help="Map file to write (.npz).", parser=some_path, metavar="PATH"
        ),
    ],
    type_name: Annotated[
        str | None,
        typer.Option("--type", metavar="NAME", help="Pedestrian type: rows to take (able_bodied)."),
    ] = None,
    clusters: Annotated[
        int | None, typer.Option(min=2, help="How many clusters of poses (one for 100).")
    ] = None,
    mirrored: Annotated[
        bool | None,
        typer.Option(
            "--mirror/--no-mirror",
            help="Add each clip's mirror image, or not; by default if the gait is symmetric.",
        ),
    ] = None,
    other_side: Annotated[
        bool,
        typer.Option("--other-side", help="Mirror images alone: a limp on the other leg."),
    ] = False,
    derived: Annotated[
        str | None,
        typer.Option(
            "--derive",
            metavar="NAME",
            help="A type of whom nobody is recorded, from recordings of others: child, "
            "older_adult, frail_older_adult, cane, crutches or walking_frame.",
        ),
    ] = None,
    poses: Annotated[
        bool,
        typer.Option("--poses", help="Also write the full-body poses behind the options."),
    ] = False,
    as_json: AsJson = False,
) -> None:
    """Compute a mobility map from recordings."""
    from mesa_mobility.bodies.bankfile import poses_path
    from mesa_mobility.capture import find_clips
    from mesa_mobility.mobility import (
        build_map,
        derived_type,
        left_out_one_at_a_time,
        prepare_recordings,
    )
    from mesa_mobility.results import check_writable

    if other_side and mirrored:
        raise typer.BadParameter("--other-side takes mirror images alone: leave --mirror out")
    if derived is not None and type_name is not None:
        raise typer.BadParameter("--derive takes recordings of the type that it needs: no --type")
    plan = None if derived is None else derived_type(derived)
    recorded = type_name or (plan.source if plan else "able_bodied")
    if output.is_dir():
        raise MapError(f"{output}: is a folder, expected a file to write")
    check_writable(output.parent)
    wall, cpu = time.perf_counter(), time.process_time()
    with stoppable_progress() as report:
        prepared = prepare_recordings(
            find_clips(source),
            recorded,
            mirrored=mirrored,
            other_side=other_side,
            progress=lambda done, total: report("reading recordings", done, total),
        )
        _say_clips(prepared.clips)
        for remark in prepared.remarks:
            say(remark)
        recordings = prepared.recordings
        metadata: dict[str, Any] = {}
        if plan is not None:
            recordings, metadata = plan.derive(recordings, plan.time_factor(recordings))
        name = derived or recorded
        command = _command(source, name, clusters, mirrored, other_side, derived is not None)
        built = build_map(
            recordings,
            type_name=name,
            clusters=clusters,
            metadata={"command": command, "preparation": prepared.choices, **metadata},
            progress=report,
        )
        left_out = None
        if 1 < len(prepared.clips.recordings) <= MOST_LEFT_OUT:
            try:
                left_out = left_out_one_at_a_time(recordings, clusters, report)
            except MapError as error:  # the map itself is good
                say(f"clips are not left out one at a time: {error}")
        bank = None
        if poses:
            from mesa_mobility.bodies import build_bank

            bank = build_bank(built, recordings, report)
    with putting_in_place():
        built.save(output)
        if bank is not None:
            bank.save(poses_path(output))
    info = {
        "file": str(output),
        "recordings": len(recordings),
        "skipped": [list(each) for each in prepared.clips.skipped],
        "split": [list(each) for each in prepared.clips.split],
        "wall_s": round(time.perf_counter() - wall, 3),
        "cpu_s": round(time.process_time() - cpu, 3),
        **_described(built),
    }
    if left_out is not None:
        info["clips_left_out_one_at_a_time"] = left_out
    say(f"written to {output}")
    _answer(info, as_json=as_json)


@app.command()
def info(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="Map file.")],
    as_json: AsJson = False,
) -> None:
    """Print the contents and sources of a map file."""
    from mesa_mobility.mobility import MobilityMap

    _answer({"file": str(file), **_described(MobilityMap.load(file))}, as_json=as_json)


@app.command()
def coverage(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="Map file.")],
    sources: Annotated[
        list[Path],
        typer.Argument(
            metavar="RECORDING_OR_MANIFEST...", help="Recordings that the map has never seen."
        ),
    ],
    leave_out: Annotated[
        bool,
        typer.Option(
            "--leave-one-out",
            help="The map's own recordings: compare each clip with a map of the others.",
        ),
    ] = False,
    as_json: AsJson = False,
) -> None:
    """Compare a map's options with the movements in other recordings."""
    from mesa_mobility.mobility import MobilityMap, left_out_one_at_a_time
    from mesa_mobility.mobility import coverage as compare

    mobility_map = MobilityMap.load(file)
    recordings = []
    with stoppable_progress() as report:
        for source in sources:
            recordings.extend(load_recordings(source, report, mobility_map if leave_out else None))
        if leave_out:
            clusters = mobility_map.metadata.get("build", {}).get("clusters_asked")
            figures = left_out_one_at_a_time(recordings, clusters, report)
        else:
            report("comparing", 0, 1)
            figures = compare(mobility_map, recordings)
            report("comparing", 1, 1)
    _answer({"file": str(file), **figures}, as_json=as_json)


@contextmanager
def stoppable_progress() -> Iterator[Report]:
    """A progress bar; Ctrl-C ends the command at the next report."""
    with progress_bar() as report, gentle_interrupt() as stop_here:

        def progress(what: str, done: float, total: float) -> None:
            report(what, done, total)
            stop_here()

        try:
            yield progress
        except Stopped:
            say("interrupted: nothing written")
            raise typer.Exit(INTERRUPTED) from None


def load_recordings(source: Path, report: Report, built: MobilityMap | None) -> list[Recording]:
    """All recordings as they are, or for a map those that it was built from, as they were used."""
    from mesa_mobility.capture import find_clips, load_clips, scale
    from mesa_mobility.mobility import prepare_recordings
    from mesa_mobility.mobility.preparing.clips import BOTH

    def progress(done: int, total: int) -> None:
        report("reading recordings", done, total)

    if built is not None:
        # Leaving out clips of one side or of the other comes to the same. Older maps tell by clip.
        sides = built.metadata.get("preparation", {}).get("mirrored")
        each = [clip["mirrored"] for clip in built.metadata.get("provenance", [])]
        mirrored = sides == BOTH if sides else all(each)
        scaled = built.metadata.get("derived", {})
        recorded = scaled.get("from", built.pedestrian_type)
        prepared = prepare_recordings(
            find_clips(source), recorded, mirrored=mirrored, progress=progress
        )
        _say_clips(prepared.clips)
        length, time_factor = scaled.get("length_factor", 1.0), scaled.get("time_factor", 1.0)
        return [scale(recording, length, time_factor) for recording in prepared.recordings]
    loaded = load_clips(find_clips(source), mirrored=False, progress=progress)
    _say_clips(loaded)
    return loaded.recordings


def _say_clips(loaded: LoadedClips) -> None:
    for clip, reason in loaded.skipped:
        say(f"skipped {clip}: {reason}")
    for clip, reason in loaded.split:
        say(f"split {clip}: {reason}")


def _described(map_: MobilityMap) -> dict[str, Any]:
    """What is in a map and what its people can do; warnings go to standard error."""
    from mesa_mobility.mobility import abilities_of

    able = abilities_of(map_)
    standing = map_.metadata.get("standing", "recorded")
    if standing != "recorded":
        say(standing)
    for warning in able["warnings"]:
        say(f"warning: {warning}")
    return {**map_.info(), "abilities": able}


def _command(
    source: Path,
    type_name: str,
    clusters: int | None,
    mirrored: bool | None,
    other_side: bool,
    derived: bool,
) -> str:
    # Names without folders: the same recordings give the same map wherever they lie.
    words = ["mesa-mobility", "map", "build", source.name, "-o", f"{type_name}.npz"]
    words += ["--derive" if derived else "--type", type_name]
    words += [] if clusters is None else ["--clusters", str(clusters)]
    words += [] if mirrored is None else ["--mirror" if mirrored else "--no-mirror"]
    words += ["--other-side"] if other_side else []
    return shlex.join(words)


def _answer(values: dict[str, Any], *, as_json: bool) -> None:
    if as_json:
        answer_json(values)
    else:
        answer_table(_lines(values))


def _lines(values: dict[str, Any], prefix: str = "") -> dict[str, str]:
    lines: dict[str, str] = {}
    for name, value in values.items():
        label = f"{prefix}{name}".replace("_", " ")
        if isinstance(value, dict):
            lines |= _lines(value, f"{label}: ")
        elif isinstance(value, list) and not all(isinstance(each, int | float) for each in value):
            lines[label] = f"{len(value)} entries, see --json"
        else:
            values_here = value if isinstance(value, list) else [value]
            lines[label] = ", ".join(_text(each) for each in values_here) or "none"
    return lines


def _text(value: Any) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)
