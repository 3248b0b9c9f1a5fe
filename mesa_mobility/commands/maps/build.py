"""`mesa-mobility map build`: a map from recordings, or from the limits of a wheelchair."""

from __future__ import annotations

import shlex
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from mesa_mobility.commands.console import AsJson, NoProgress, say, some_path, stoppable_progress
from mesa_mobility.commands.grouping import grouped
from mesa_mobility.commands.maps.answers import (
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


TREAD = 0.29
"""Metres, of a stair with risers of 17 cm."""


class Options(StrEnum):
    """What a map file keeps."""

    STORED = "stored"
    DISTRIBUTION = "distribution"


class OnStairs(StrEnum):
    """A way to walk on stairs."""

    UP = "up"
    DOWN = "down"


ONE_AT_A_TIME, SOME_AT_ONCE = "clips_left_out_one_at_a_time", "clips_left_out"
"""Entries of the answer."""

MOST_LEFT_OUT = 12
"""Clips up to which a build also leaves each out in turn: so many builds more. Of more, some are
left out at once: one build more."""


@dataclass(frozen=True)
class Wanted:
    """The map that is wanted."""

    type_name: Annotated[
        str | None,
        typer.Option(
            "--type",
            metavar="NAME",
            help="Pedestrian type, by default able_bodied. Only rows of this type in the manifest "
            "are used.",
        ),
    ] = None
    clusters: Annotated[
        int | None,
        typer.Option(
            min=2, help="Number of clusters of poses. By default one for every 150 poses."
        ),
    ] = None
    mirrored: Annotated[
        bool | None,
        typer.Option(
            "--mirror/--no-mirror",
            help="Add each clip's mirror image, or not; by default if the gait is symmetric.",
        ),
    ] = None
    other_side: Annotated[
        bool,
        typer.Option(
            "--other-side",
            help="Use only mirror images, for people who limp on the other leg.",
        ),
    ] = False
    derived: Annotated[
        str | None,
        typer.Option(
            "--derive",
            metavar="NAME",
            help="A type of which nobody is recorded. Made from recordings of others: child, "
            "older_adult, frail_older_adult, cane, crutches or walking_frame. Made without "
            "recordings: wheelchair_manual, wheelchair_powered or wheelchair_assisted.",
        ),
    ] = None
    stairs: Annotated[
        OnStairs | None,
        typer.Option(
            "--stairs",
            help="A map of walking up or down stairs, from recordings of a few steps. Each cycle "
            "of the gait is repeated at several cadences, with strides as long as a tread.",
        ),
    ] = None
    tread: Annotated[
        float, typer.Option(min=0.15, max=0.6, help="Depth of a tread with --stairs, metres.")
    ] = TREAD
    name: Annotated[
        str | None,
        typer.Option(
            "--name", help="Name of the type in the map. By default that of --type or --derive."
        ),
    ] = None
    kept: Annotated[
        Options,
        typer.Option(
            "--options",
            help="`stored` writes every option. `distribution` writes only recorded options, from "
            "which edited ones are made on reading: the map is the same and the file smaller.",
        ),
    ] = Options.STORED

    def check(self) -> None:
        """Refuse options that contradict each other.

        Raises:
            typer.BadParameter: they do.
        """
        if self.other_side and self.mirrored:
            raise typer.BadParameter("--other-side takes mirror images alone: leave --mirror out")
        if self.derived is not None and self.type_name is not None:
            raise typer.BadParameter(
                "--derive takes recordings of the type that it needs: no --type"
            )

        if self.stairs is not None and (self.derived, self.mirrored) != (None, None):
            raise typer.BadParameter("--stairs repeats recorded steps: no --derive, no --mirror")
        if self.stairs is None and self.tread != TREAD:
            raise typer.BadParameter("--tread: expected with --stairs only")

    @property
    def is_plain(self) -> bool:
        """Whether it is derived, and nothing else is said of it."""
        return self == Wanted(derived=self.derived)

    def command(self, source: str, recorded: str, name: str) -> str:
        """The command that builds it, with files but no folders: the same recordings give the same
        map wherever they lie."""
        words = ["mesa-mobility", "map", "build", source, "-o", f"{name}.npz"]
        words += ["--type", recorded] if self.derived is None else ["--derive", self.derived]
        words += [] if name == (self.derived or recorded) else ["--name", name]
        words += [] if self.clusters is None else ["--clusters", str(self.clusters)]
        words += [] if self.mirrored is None else ["--mirror" if self.mirrored else "--no-mirror"]
        words += ["--other-side"] if self.other_side else []
        words += [] if self.stairs is None else ["--stairs", self.stairs.value]
        words += [] if self.tread == TREAD else ["--tread", f"{self.tread:g}"]
        words += [] if self.kept == Options.STORED else ["--options", self.kept.value]
        return shlex.join(words)


@grouped
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
    wanted: Wanted,
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

    wanted.check()
    if output.is_dir():
        raise MapError(f"{output}: is a folder, expected a file to write")
    check_writable(output.parent)
    wall, cpu = time.perf_counter(), time.process_time()
    families: OptionFamilies | None
    info: dict[str, Any] = {}
    bank = None
    derived = wanted.derived
    if derived is not None and derived in WHEELCHAIRS:
        if source is not None or poses or not wanted.is_plain:
            raise typer.BadParameter(f"{derived}: takes no recordings, and nothing but --output")
        words = ["mesa-mobility", "map", "build", "--derive", derived, "-o", f"{derived}.npz"]
        families = None
        built = WHEELCHAIRS[derived].build(derived, {"command": shlex.join(words)})
    elif source is None:
        raise typer.BadParameter("MANIFEST_OR_DIR: expected recordings; only wheelchairs need none")
    else:
        families, recordings, info = _from_recordings(source, wanted, shown=not no_progress)
        built = map_of_families(families)
        if poses:
            from mesa_mobility.bodies import build_bank

            with stoppable_progress(shown=not no_progress) as report:
                bank = build_bank(built, recordings, report)
    with stoppable_progress() as report:
        left_out = info.get(ONE_AT_A_TIME, info.get(SOME_AT_ONCE))
        built, examination = examine_map(built, report, left_out)
    with putting_in_place():
        if families is None or wanted.kept == Options.STORED:
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
    source: Path, wanted: Wanted, *, shown: bool
) -> tuple[OptionFamilies, Sequence[Recording], dict[str, Any]]:
    """The recorded options of a map, the recordings as used, and what to say of them."""
    from mesa_mobility.capture import find_clips
    from mesa_mobility.mobility import (
        build_families,
        derived_type,
        prepare_recordings,
    )
    from mesa_mobility.mobility.edits import ON_FLOORS, ON_STAIRS
    from mesa_mobility.mobility.preparing.stairs import on_long_stairs
    from mesa_mobility.mobility.preparing.summary import summary_of

    plan = None if wanted.derived is None else derived_type(wanted.derived)
    recorded = wanted.type_name or (plan.source if plan else "able_bodied")
    with stoppable_progress(shown=shown) as report:
        prepared = prepare_recordings(
            find_clips(source),
            recorded,
            mirrored=False if wanted.stairs else wanted.mirrored,
            other_side=wanted.other_side,
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
        editing = ON_FLOORS
        if wanted.stairs is not None:
            recordings, metadata = on_long_stairs(
                recordings, up=wanted.stairs is OnStairs.UP, tread=wanted.tread
            )
            editing = ON_STAIRS
        name = wanted.name or wanted.derived or recorded
        command = wanted.command(source.name, recorded, name)
        families = build_families(
            recordings,
            type_name=name,
            clusters=wanted.clusters,
            editing=editing,
            metadata={"command": command, "preparation": prepared.choices, **metadata},
            progress=report,
        )
        info: dict[str, Any] = {
            "recorded": read.answer(),
            "recordings": len(recordings),
            "skipped": [list(each) for each in prepared.clips.skipped],
            "split": [list(each) for each in prepared.clips.split],
        }
        if wanted.stairs is None:
            left_out = _left_out(prepared, recordings, wanted.clusters, report)
        else:
            say("clips are not left out: the same steps are repeated in many recordings")
            left_out = None
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
