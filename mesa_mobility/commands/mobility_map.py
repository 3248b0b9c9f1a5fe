"""`mesa-mobility map`: build, describe and judge mobility maps."""

from __future__ import annotations

import shlex
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from mesa_mobility.commands.console import answer_json, answer_table, progress_bar, say
from mesa_mobility.errors import CaptureError, MapError

if TYPE_CHECKING:
    from mesa_mobility.capture import LoadedClips
    from mesa_mobility.commands.console import Report

app = typer.Typer(help="Build, describe and judge mobility maps.", no_args_is_help=True)

AsJson = Annotated[bool, typer.Option("--json", help="One JSON object as the last line of output.")]
MANIFEST = "manifest.tsv"


@app.command()
def build(
    source: Annotated[
        Path,
        typer.Argument(
            metavar="MANIFEST_OR_DIR", help="Manifest of recordings, or a folder of them."
        ),
    ],
    output: Annotated[Path, typer.Option("-o", "--output", help="Map file to write (.npz).")],
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
    with progress_bar() as report:
        clips = _load(source, report, type_name=type_name, mirrored=mirrored)
        built = build_map(
            clips.recordings,
            type_name=type_name,
            **({} if clusters is None else {"clusters": clusters}),
            metadata={"command": _command(source, type_name, clusters, mirrored)},
            progress=report,
        )
    built.save(output)
    info = {
        "file": str(output),
        "recordings": len(clips.recordings),
        "skipped": [list(each) for each in clips.skipped],
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
    with progress_bar() as report:
        for source in sources:
            clips = _load(source, report, type_name=None, mirrored=False)
            recordings.extend(clips.recordings)
        report("comparing", 0, 1)
        _answer({"file": str(file), **compare(mobility_map, recordings)}, as_json=as_json)
