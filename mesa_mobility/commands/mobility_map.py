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
    from mesa_mobility.capture import LoadedClips
    from mesa_mobility.commands.console import Report

app = typer.Typer(help="Build, describe and judge mobility maps.", no_args_is_help=True)

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
        str, typer.Option("--type", metavar="NAME", help="Pedestrian type: rows to take.")
    ] = "able_bodied",
    clusters: Annotated[
        int | None, typer.Option(min=2, help="How many clusters of poses (350).")
    ] = None,
    mirrored: Annotated[
        bool, typer.Option("--mirror/--no-mirror", help="Add each clip's mirror image.")
    ] = True,
    as_json: AsJson = False,
) -> None:
    """Compute a mobility map from recordings."""
    from mesa_mobility.mobility import build_map
    from mesa_mobility.results import check_writable

    if output.is_dir():
        raise MapError(f"{output}: is a folder, expected a file to write")
    check_writable(output.parent)
    wall, cpu = time.perf_counter(), time.process_time()
    with _stoppable_progress() as report:
        clips = _load(source, report, type_name=type_name, mirrored=mirrored)
        built = build_map(
            clips.recordings,
            type_name=type_name,
            **({} if clusters is None else {"clusters": clusters}),
            metadata={"command": _command(source, type_name, clusters, mirrored)},
            progress=report,
        )
    with putting_in_place():
        built.save(output)
    info = {
        "file": str(output),
        "recordings": len(clips.recordings),
        "skipped": [list(each) for each in clips.skipped],
        "split": [list(each) for each in clips.split],
        "wall_s": round(time.perf_counter() - wall, 3),
        "cpu_s": round(time.process_time() - cpu, 3),
        **built.info(),
    }
    say(f"written to {output}")
    _answer(info, as_json=as_json)


@app.command()
def info(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="Map file.")],
    as_json: AsJson = False,
) -> None:
    """Say what is in a map file and where it comes from."""
    from mesa_mobility.mobility import MobilityMap

    _answer({"file": str(file), **MobilityMap.load(file).info()}, as_json=as_json)


@app.command()
def coverage(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="Map file.")],
    sources: Annotated[
        list[Path],
        typer.Argument(
            metavar="RECORDING_OR_MANIFEST...", help="Recordings that the map has never seen."
        ),
    ],
    as_json: AsJson = False,
) -> None:
    """Compare a map's options with what people in other recordings did next."""
    from mesa_mobility.mobility import MobilityMap
    from mesa_mobility.mobility import coverage as compare

    mobility_map = MobilityMap.load(file)
    recordings = []
    with _stoppable_progress() as report:
        for source in sources:
            clips = _load(source, report, type_name=None, mirrored=False)
            recordings.extend(clips.recordings)
        report("comparing", 0, 1)
        figures = compare(mobility_map, recordings)
        report("comparing", 1, 1)
    _answer({"file": str(file), **figures}, as_json=as_json)


@contextmanager
def _stoppable_progress() -> Iterator[Report]:
    with progress_bar() as report, gentle_interrupt() as stop_here:

        def progress(what: str, done: float, total: float) -> None:
            report(what, done, total)
            stop_here()

        try:
            yield progress
        except Stopped:
            say("interrupted: nothing written")
            raise typer.Exit(INTERRUPTED) from None


def _load(source: Path, report: Report, *, type_name: str | None, mirrored: bool) -> LoadedClips:
    from mesa_mobility.capture import find_clips, load_clips

    loaded = load_clips(
        find_clips(source),
        pedestrian_type=type_name,
        mirrored=mirrored,
        progress=lambda done, total: report("reading recordings", done, total),
    )
    for clip, reason in loaded.skipped:
        say(f"skipped {clip}: {reason}")
    for clip, reason in loaded.split:
        say(f"split {clip}: {reason}")
    return loaded


def _command(source: Path, type_name: str, clusters: int | None, mirrored: bool) -> str:
    # Names without folders: the same recordings give the same map wherever they lie.
    words = ["mesa-mobility", "map", "build", source.name, "-o", f"{type_name}.npz"]
    words += ["--type", type_name]
    words += [] if clusters is None else ["--clusters", str(clusters)]
    words += [] if mirrored else ["--no-mirror"]
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
