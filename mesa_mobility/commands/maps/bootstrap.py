"""`mesa-mobility map bootstrap`: maps of clips drawn with replacement."""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from mesa_mobility.commands.console import (
    AsJson,
    NoProgress,
    answer_json,
    answer_table,
    say,
    some_path,
    stoppable_progress,
)
from mesa_mobility.commands.maps.answers import examine_map, say_clips
from mesa_mobility.errors import MapError
from mesa_mobility.interrupts import putting_in_place

if TYPE_CHECKING:
    from mesa_mobility.capture import Recording
    from mesa_mobility.commands.console import Report

FAILED = 1


def bootstrap(
    source: Annotated[
        Path,
        typer.Argument(
            metavar="MANIFEST_OR_DIR", help="Manifest of recordings, or a folder of them."
        ),
    ],
    out: Annotated[
        Path, typer.Option(help="Folder for the maps.", parser=some_path, metavar="DIR")
    ],
    maps: Annotated[int, typer.Option(min=2, metavar="B", help="Number of maps.")] = 8,
    seed: Annotated[int, typer.Option(min=0, help="Seed of the draws.")] = 1,
    type_name: Annotated[
        str,
        typer.Option(
            "--type",
            metavar="NAME",
            help="Pedestrian type. Only rows of this type in the manifest are used.",
        ),
    ] = "able_bodied",
    clusters: Annotated[
        int | None,
        typer.Option(
            min=2, help="Number of clusters of poses. By default one for every 150 poses."
        ),
    ] = None,
    as_json: AsJson = False,
    no_progress: NoProgress = False,
) -> None:
    """Draw clips with replacement, and build a map from each draw as `map build` does from all.

    Existing maps are kept. So an interrupted command can be repeated, and more maps can be added.
    Ends with status 1 if the clips of a draw give no map.
    """
    from mesa_mobility.capture import find_clips
    from mesa_mobility.mobility import draw_clips, prepare_recordings
    from mesa_mobility.results import check_writable

    check_writable(out, [f"{type_name}-{number}.npz" for number in range(1, maps + 1)])
    with stoppable_progress("maps that are complete are kept", shown=not no_progress) as report:
        prepared = prepare_recordings(
            find_clips(source),
            type_name,
            progress=lambda done, total: report("reading recordings", done, total),
        )
        say_clips(prepared.clips)
        for remark in prepared.remarks:
            say(remark)
        rows = []
        for number in range(1, maps + 1):
            drawn, said = draw_clips(prepared.recordings, seed, number)
            command = [
                "mesa-mobility",
                "map",
                "bootstrap",
                source.name,
                "--out",
                "maps",
                "--type",
                type_name,
                "--seed",
                str(seed),
            ]
            command += [] if clusters is None else ["--clusters", str(clusters)]
            metadata = {
                "command": shlex.join(command),
                "preparation": prepared.choices,
                "bootstrap": said,
            }
            file = out / f"{type_name}-{number}.npz"
            rows.append(_made(file, drawn, type_name, clusters, metadata, maps, report))
    if as_json:
        answer_json({"maps": rows})
    else:
        answer_table({row["file"]: row["said"] for row in rows})
    if any("error" in row for row in rows):
        raise typer.Exit(FAILED)


def _made(
    file: Path,
    drawn: Sequence[Recording],
    type_name: str,
    clusters: int | None,
    metadata: dict[str, Any],
    maps: int,
    report: Report,
) -> dict[str, Any]:
    """Build a map, unless it is there, and what to say of it."""
    from mesa_mobility.mobility import MobilityMap, build_map
    from mesa_mobility.mobility.provenance import provenance

    said = metadata["bootstrap"]
    row: dict[str, Any] = {"file": str(file), "clips": said["clips"]}
    if file.exists():
        there = MobilityMap.load(file).metadata
        same = there.get("provenance") == provenance(drawn) and all(
            there.get(key) == metadata[key] for key in ("command", "bootstrap", "preparation")
        )
        if not same:
            raise MapError(f"{file}: is another map, expected nothing there")
        return {**row, "said": "there already"}
    try:
        built = build_map(
            drawn,
            type_name=type_name,
            clusters=clusters,
            metadata=metadata,
            progress=lambda stage, done, total: report(
                f"map {said['number']} of {maps}, {stage}", done, total
            ),
        )
    except MapError as error:  # the others may be good
        say(f"map {said['number']}: {error}")
        return {**row, "said": "none", "error": str(error)}
    built, examination = examine_map(built, report)
    with putting_in_place():
        built.save(file)
    options = f"{built.n_options} options in {built.n_clusters} clusters"
    return {
        **row,
        "said": f"{said['clips']} different clips, {options}",
        "warnings": examination["warnings"],
    }
