"""A page that plays a run, in one file that needs no network."""

from __future__ import annotations

import html
import os
from collections.abc import Callable
from contextlib import suppress
from importlib.resources import files
from pathlib import Path
from string import Template
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.animation.buildings.storeys import drawn_building
from mesa_mobility.animation.bundle import bank_arrays, bundled, figure_parts
from mesa_mobility.animation.figures.aids import aid_of
from mesa_mobility.animation.floor import drawn_floor
from mesa_mobility.bodies import PoseBank
from mesa_mobility.bodies.motion import FRAME_RATE
from mesa_mobility.bodies.sequence import stretches
from mesa_mobility.errors import MapError, ResultsError
from mesa_mobility.files.atomic import replacing
from mesa_mobility.floorplan import FloorPlan
from mesa_mobility.results.engineering.doors import crossings_of_doors
from mesa_mobility.results.engineering.service import service_limits
from mesa_mobility.results.excerpts import Selection
from mesa_mobility.results.formats.output_format import OutputFormat
from mesa_mobility.results.measures.crossings import passed_by
from mesa_mobility.results.tracks import Tracks

if TYPE_CHECKING:
    from mesa_mobility.buildings import Building
    from mesa_mobility.results import Decisions
    from mesa_mobility.results.excerpts import Excerpt

EVERY = 3
"""Frames between two places of a person: 0.1 s, as of the options' own paths."""

PLACE_STEP, TURN_STEP = 0.001, 0.001
"""Metres and radians in which places and headings are stored."""

SHARE_STEP = 0.001

STAGE_SCRIPTS = "bundle", "poses", "footing", "bodies", "copies", "troop", "scenery", "stage"
"""Files of the viewer that draw a crowd in three dimensions, in the order in which they load."""

PLAN_SCRIPTS = (
    *("plan/colours", "plan/drawing", "plan/floor", "plan/gestures", "plan/people", "plan/plane"),
    *("plan/layer", "plan/curves", "plan/view"),
)
"""Those that draw it from above, with maps and curves."""

PLAYER_SCRIPTS = "run", "maps", "path", "film", "player"
"""Those of the page of a run."""


class Page(OutputFormat):
    """Page that plays the run in three dimensions and needs no network."""

    name = "html"
    suffixes = (".html",)
    storeys = True

    def write(self, excerpt: Excerpt, path: Path) -> None:
        """See ``write_page``."""
        write_page(
            excerpt.trajectories,
            excerpt.plan,
            path,
            excerpt.selection,
            title=excerpt.title,
            bank=excerpt.bank,
            progress=excerpt.person_done,
        )


def viewer_part(name: str) -> str:
    """The text of a file of the viewer."""
    folder = files("mesa_mobility.animation") / "viewer"
    return (folder / name).read_text(encoding="utf-8")


def write_page(
    trajectories: Tracks,
    plan: FloorPlan | Building,
    path: str | os.PathLike[str],
    selection: Selection | None = None,
    *,
    title: str,
    bank: PoseBank | None = None,
    progress: Callable[[int], None] | None = None,
) -> None:
    """Write a page that plays a run in three dimensions, and needs no other file.

    People have moving limbs if the run holds its decisions and the poses of their map are known.
    They then hold their aids, such as canes. People in wheelchairs sit. All others are drawn
    without limbs.

    Args:
        trajectories: the run.
        plan: floor and walls, or a building.
        path: the page (.html).
        selection: people and times to show; by default everybody, all the time.
        title: the page's title.
        bank: poses of a map whose poses do not ship with the package.
        progress: called with the number of people done.

    Raises:
        ResultsError: the file cannot be written, the selection is empty, or the run does not have
            30 frames a second.
        MapError: ``bank`` belongs to none of the run's maps.
    """
    page = page_text(trajectories, plan, selection, title=title, bank=bank, progress=progress)
    with replacing(path, ResultsError) as target:
        target.write_text(page, encoding="utf-8")


def page_text(
    trajectories: Tracks,
    plan: FloorPlan | Building,
    selection: Selection | None = None,
    *,
    title: str,
    bank: PoseBank | None = None,
    progress: Callable[[int], None] | None = None,
) -> str:
    """The text of the page; arguments and errors are those of ``write_page``."""
    whole = isinstance(plan, FloorPlan)
    header, arrays = run_parts(
        trajectories, selection or Selection(), bank, progress, storeys=not whole
    )
    header |= {
        "title": title,
        "floor": _drawn(plan),
        "doors": _passages(trajectories, plan, header["last"] / FRAME_RATE),
        "service": service_limits().tolist(),
    }
    return Template(viewer_part("page.html")).substitute(
        title=html.escape(title),
        # Would end the script early.
        three=viewer_part("three.bundle.js").replace("</script", "<\\/script"),
        content=bundled(header, arrays),
        viewer="\n".join(
            viewer_part(f"{each}.js") for each in (*PLAN_SCRIPTS, *STAGE_SCRIPTS, *PLAYER_SCRIPTS)
        ),
    )


def run_parts(
    trajectories: Tracks,
    selection: Selection,
    bank: PoseBank | None = None,
    progress: Callable[[int], None] | None = None,
    *,
    storeys: bool = False,
) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
    """Header and arrays of a run: people's places, movements and decisions, and the poses.

    Places have elevations if there are several storeys.
    """
    if trajectories.frame_rate != FRAME_RATE:
        raise ResultsError(f"{trajectories.frame_rate:g} frames a second: expected {FRAME_RATE:g}")
    first, last = selection.frames_of(trajectories)
    people = selection.people_of(trajectories)
    decisions = trajectories.decisions
    banks = {} if decisions is None else _banks(decisions, bank)
    known = list(dict.fromkeys(banks.values()))
    types = trajectories.person_data.get("type")
    names = [] if types is None else np.unique(types[people]).tolist()
    tracks, courses, decided, rows = [], [], [], []
    ordered = trajectories.by_person
    begins = np.searchsorted(trajectories.person[ordered], np.arange(max(people) + 2))
    for done, person in enumerate(people, start=1):
        track = _track(
            trajectories, ordered[begins[person] : begins[person + 1]], (first, last), storeys
        )
        course, own, found = _course(decisions, banks, person, int(track[0, 0]), last)
        tracks.append(track)
        courses.append(course)
        decided.append(own)
        kind = 0 if types is None else names.index(str(types[person]))
        number = -1 if found is None else known.index(found)
        out = int(trajectories.exit_frames[person]) in range(first, last + 1)
        rows.append((person, len(track), len(course), len(own), kind, number, out))
        if progress is not None:
            progress(done)
    header, arrays = figure_parts()
    header |= {
        "first": first,
        "last": last,
        "types": names,
        "aids": [aid_of(name) for name in names],
        "scales": [each.scale for each in known],
        "clips": [[str(clip["clip"]) for clip in each.metadata["clips"]] for each in known],
        "decided": decisions is not None,
        "steps": {"place": PLACE_STEP, "turn": TURN_STEP, "share": SHARE_STEP},
    }
    for number, each in enumerate(known):
        arrays |= bank_arrays(each, f"bank{number}")
    arrays["people"] = np.array(rows, dtype=np.int32)
    for name, parts in (("tracks", tracks), ("courses", courses), ("decisions", decided)):
        together = np.concatenate(parts)
        for k, column in enumerate(together.T):
            arrays[f"{name}.{k}"] = np.ascontiguousarray(column, dtype=np.int32)
    return header, arrays


def _banks(decisions: Decisions, given: PoseBank | None) -> dict[int, PoseBank]:
    """The poses known of the run's types, by the numbers of the types."""
    if given is not None and given.metadata["map_digest"] not in decisions.maps:
        given.check_map(decisions.maps[0])
    found = {}
    for kind, digest in enumerate(decisions.maps):
        own = given if given is not None and given.metadata["map_digest"] == digest else None
        with suppress(MapError):
            found[kind] = decisions.bank_of(kind, own)
    return found


def _drawn(plan: FloorPlan | Building) -> dict[str, Any]:
    return drawn_floor(plan) if isinstance(plan, FloorPlan) else drawn_building(plan)


def _passages(trajectories: Tracks, plan: FloorPlan | Building, end: float) -> list[dict[str, Any]]:
    """Seconds of each first passage of a gate or exit until a time, by name."""
    found = crossings_of_doors(trajectories, plan)
    return [
        {"name": name, "times": [round(time, 2) for time, _ in passed_by(own) if time <= end]}
        for name, own in found.items()
    ]


def _track(
    trajectories: Tracks, rows: NDArray[np.int64], span: tuple[int, int], storeys: bool
) -> NDArray[np.int64]:
    """(n, 4) frames, x, y and heading of a person, the differences of successive rows in steps.

    With several storeys it is (n, 5), and the last column is the elevation.
    """
    first, last = span
    rows = rows[(trajectories.frame[rows] >= first) & (trajectories.frame[rows] <= last)]
    rows = np.append(rows[:-1:EVERY], rows[-1])
    heading = np.unwrap(trajectories.heading[rows])
    columns = [
        trajectories.frame[rows],
        np.rint(trajectories.x[rows] / PLACE_STEP),
        np.rint(trajectories.y[rows] / PLACE_STEP),
        np.rint(heading / TURN_STEP),
    ]
    if storeys:
        columns.append(np.rint(trajectories.z[rows] / PLACE_STEP))
    table = np.column_stack(columns).astype(np.int64)
    return np.diff(table, axis=0, prepend=0)


def _course(
    decisions: Decisions | None,
    banks: dict[int, PoseBank],
    person: int,
    first: int,
    last: int,
) -> tuple[NDArray[np.int64], NDArray[np.int64], PoseBank | None]:
    """(s, 5) stretches and (d, 3) decisions of a person, and the poses behind these if known.

    A stretch is frame, pose, whether the person moves, stride in thousandths, decision; a decision
    is frame, option, share. Frames are differences of successive rows.
    """
    none = np.zeros((0, 5), dtype=np.int64), np.zeros((0, 3), dtype=np.int64)
    if decisions is None:
        return *none, None
    rows = decisions.rows_of(person)
    movements = decisions.movements_of(person)
    share = np.rint(movements.shares / SHARE_STEP).astype(np.int64)
    own = np.column_stack([movements.starts, movements.options, share])
    kind = int(decisions.type_index[rows[0]]) if len(rows) else 0
    bank, table = banks.get(kind), none[0]
    if bank is not None:
        began = min(first, int(movements.starts.min(initial=first)))
        found = stretches(bank, movements, began)
        stride = np.rint(found.strides * 1000).astype(np.int64)
        table = np.column_stack([found.frames, found.poses, found.moving, stride, found.own])
        table = table[table[:, 0] <= last]
    for each in (table, own):
        each[:, 0] = np.diff(each[:, 0], prepend=0)
    return table, own, bank
