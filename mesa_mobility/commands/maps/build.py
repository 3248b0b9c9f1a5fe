"""`mesa-mobility map build`: a map from recordings, or from the limits of a wheelchair."""

from __future__ import annotations

import shlex
import time
from collections.abc import Sequence
from dataclasses import replace
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from mesa_mobility.commands.console import NoProgress, say, some_path, stoppable_progress
from mesa_mobility.commands.maps.answers import (
    AsJson,
    answer,
    described,
    examine_map,
    say_clips,
)
from mesa_mobility.errors import MapError
from mesa_mobility.interrupts import putting_in_place

if TYPE_CHECKING:
    from mesa_mobility.capture import Recording
    from mesa_mobility.commands.console import Report
    from mesa_mobility.mobility import OptionFamilies, PreparedRecordings


class Options(StrEnum):
    """What a map file keeps."""

    STORED = "stored"
    DISTRIBUTION = "distribution"


ONE_AT_A_TIME, SOME_AT_ONCE = "clips_left_out_one_at_a_time", "clips_left_out"
"""Entries of the answer."""

MOST_LEFT_OUT = 12
"""Clips up to which a build also leaves each out in turn: so many builds more. Of more, some are
left out at once: one build more."""


def build(
    source: Annotated[
        Path | None,
        typer.Argument(
            metavar="MANIFEST_OR_DIR",
            help="Manifest of recordings, or a folder of them; none for wheelchairs.",
        ),
    ] = None,
    *,
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
        int | None, typer.Option(min=2, help="How many clusters of poses (one for 150).")
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
            help="A type of whom nobody is recorded. From recordings of others: child, "
            "older_adult, frail_older_adult, cane, crutches or walking_frame; from none: "
            "wheelchair_manual, wheelchair_powered or wheelchair_assisted.",
        ),
    ] = None,
    name: Annotated[
        str | None,
        typer.Option("--name", help="Name of the type in the map (as --type or --derive)."),
    ] = None,
    kept: Annotated[
        Options,
        typer.Option(
            "--options",
            help="Store every option, or the recorded ones alone, each of which stands for a "
            "distribution of edited ones: the same options from a smaller file.",
        ),
    ] = Options.STORED,
    poses: Annotated[
        bool,
        typer.Option("--poses", help="Also write the full-body poses behind the options."),
    ] = False,
    as_json: AsJson = False,
    no_progress: NoProgress = False,
) -> None:
    """Compute a mobility map from recordings, or from the limits of a wheelchair."""
    from mesa_mobility.bodies.bankfile import poses_path
    from mesa_mobility.mobility import WHEELCHAIRS, map_of_families
    from mesa_mobility.results import check_writable

    if other_side and mirrored:
        raise typer.BadParameter("--other-side takes mirror images alone: leave --mirror out")
    if derived is not None and type_name is not None:
        raise typer.BadParameter("--derive takes recordings of the type that it needs: no --type")
    if output.is_dir():
        raise MapError(f"{output}: is a folder, expected a file to write")
    check_writable(output.parent)
    wall, cpu = time.perf_counter(), time.process_time()
    families: OptionFamilies | None
    info: dict[str, Any] = {}
    bank = None
    if derived is not None and derived in WHEELCHAIRS:
        choices = (source, clusters, mirrored, name)
        if (
            other_side
            or poses
            or kept != Options.STORED
            or any(each is not None for each in choices)
        ):
            raise typer.BadParameter(f"{derived}: takes no recordings, and nothing but --output")
        words = ["mesa-mobility", "map", "build", "--derive", derived, "-o", f"{derived}.npz"]
        families = None
        built = WHEELCHAIRS[derived].build(derived, {"command": shlex.join(words)})
    elif source is None:
        raise typer.BadParameter("MANIFEST_OR_DIR: expected recordings; only wheelchairs need none")
    else:
        families, recordings, info = _from_recordings(
            source,
            type_name,
            clusters,
            mirrored=mirrored,
            other_side=other_side,
            derived=derived,
            name=name,
            kept=kept,
            shown=not no_progress,
        )
        built = map_of_families(families)
        if poses:
            from mesa_mobility.bodies import build_bank

            with stoppable_progress(shown=not no_progress) as report:
                bank = build_bank(built, recordings, report)
    with stoppable_progress() as report:
        left_out = info.get(ONE_AT_A_TIME, info.get(SOME_AT_ONCE))
        built, examination = examine_map(built, report, left_out)
    with putting_in_place():
        if families is None or kept == Options.STORED:
            built.save(output)
        else:
            replace(families, metadata=built.metadata).save(output)
        if bank is not None:
            bank.save(poses_path(output))
    say(f"written to {output}")
    spent = {
        "file": str(output),
        "wall_s": round(time.perf_counter() - wall, 3),
        "cpu_s": round(time.process_time() - cpu, 3),
    }
    said = {**spent, **described(built), **info, **examination}
    said["warnings"] = [*info.get("recorded", {}).get("warnings", []), *said["warnings"]]
    answer(said, as_json=as_json)


def _from_recordings(
    source: Path,
    type_name: str | None,
    clusters: int | None,
    *,
    mirrored: bool | None,
    other_side: bool,
    derived: str | None,
    name: str | None,
    kept: Options,
    shown: bool,
) -> tuple[OptionFamilies, Sequence[Recording], dict[str, Any]]:
    """The recorded options of a map, the recordings as used, and what to say of them."""
    from mesa_mobility.capture import find_clips
    from mesa_mobility.mobility import (
        build_families,
        derived_type,
        prepare_recordings,
    )
    from mesa_mobility.mobility.preparing.summary import summary_of

    plan = None if derived is None else derived_type(derived)
    recorded = type_name or (plan.source if plan else "able_bodied")
    with stoppable_progress(shown=shown) as report:
        prepared = prepare_recordings(
            find_clips(source),
            recorded,
            mirrored=mirrored,
            other_side=other_side,
            progress=lambda done, total: report("reading recordings", done, total),
        )
        say_clips(prepared.clips)
        read = summary_of(prepared.clips.recordings)
        for line in (*read.lines, *prepared.remarks):
            say(line)
        for line in read.warnings:
            say(f"warning: {line}")
        recordings = prepared.recordings
        metadata: dict[str, Any] = {}
        if plan is not None:
            recordings, metadata = plan.derive(recordings, plan.time_factor(recordings))
        name = name or derived or recorded
        words = ["mesa-mobility", "map", "build", source.name, "-o", f"{name}.npz"]
        words += ["--type", recorded] if derived is None else ["--derive", derived]
        words += [] if name == (derived or recorded) else ["--name", name]
        words += [] if clusters is None else ["--clusters", str(clusters)]
        words += [] if mirrored is None else ["--mirror" if mirrored else "--no-mirror"]
        words += ["--other-side"] if other_side else []
        words += [] if kept == Options.STORED else ["--options", kept.value]
        # Files without folders: the same recordings give the same map wherever they lie.
        command = shlex.join(words)
        families = build_families(
            recordings,
            type_name=name,
            clusters=clusters,
            metadata={"command": command, "preparation": prepared.choices, **metadata},
            progress=report,
        )
        info: dict[str, Any] = {
            "recorded": read.answer(),
            "recordings": len(recordings),
            "skipped": [list(each) for each in prepared.clips.skipped],
            "split": [list(each) for each in prepared.clips.split],
        }
        left_out = _left_out(prepared, recordings, clusters, report)
    if left_out is not None:
        info[ONE_AT_A_TIME if "clips" in left_out else SOME_AT_ONCE] = left_out
    return families, recordings, info


def _left_out(
    prepared: PreparedRecordings,
    recordings: Sequence[Recording],
    clusters: int | None,
    report: Report,
) -> dict[str, Any] | None:
    """How well clips are covered that are left out, each in turn or some at once."""
    from mesa_mobility.mobility import left_out_one_at_a_time, sample_left_out

    clips = len(prepared.clips.recordings)
    if clips < 2:
        say("clips are not left out: there is one")
        return None
    compare = left_out_one_at_a_time if clips <= MOST_LEFT_OUT else sample_left_out
    try:
        return compare(recordings, clusters, report)
    except MapError as error:  # the map itself is good
        each = " one at a time" if clips <= MOST_LEFT_OUT else ""
        say(f"clips are not left out{each}: {error}")
        return None
