"""Measured tracks as a model takes people from them."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.bodies.velocities import LEAST_WAY, WINDOW_S, velocities
from mesa_mobility.crowd.insertion.tracks import (
    FloatArray,
    IntArray,
    MeasuredTracks,
    TrackRows,
)
from mesa_mobility.errors import ModelError
from mesa_mobility.floorplan import FloorPlan
from mesa_mobility.human_limits import FASTEST_SPRINT

SHORTEST_S = 0.2
"""Least time of earlier frames that shows a velocity, seconds; before it, later frames do."""


@dataclass(frozen=True, eq=False)
class Measured(TrackRows):
    """Rows of tracks by (person, frame), with what is known of each at that time.

    Attributes:
        headings: (n,) radians.
        velocity: (n, 2) m/s, of the last 0.8 s; of the next in the first 0.2 s of a track.
        aimless: (n,) whether no direction is known yet: the person has not walked.
        jumps: persons and frames after which the file has a jump.
    """

    headings: FloatArray
    velocity: FloatArray
    aimless: NDArray[np.bool_]
    jumps: list[tuple[int, int]]


def measured(tracks: MeasuredTracks, plan: FloorPlan) -> Measured:
    """Tracks as a model on this plan takes people from them."""
    reading = tracks.reading
    rows = TrackRows.of(tracks, plan, "tracks" if reading is None else reading.file)
    person, frame, places, rate = rows.person, rows.frame, rows.places, rows.rate
    velocity, seconds = velocities(person, frame, places, rate)
    early = seconds < SHORTEST_S
    velocity[early] = velocities(person, frame, places, rate, ahead=True)[0][early]
    derived = reading is not None and reading.headings_from == "way"
    return Measured(
        **vars(rows),
        headings=np.array(tracks.heading[tracks.by_person]),
        velocity=velocity,
        aimless=derived & ~early & (_way_so_far(person, places) < LEAST_WAY),
        jumps=[]
        if reading is None
        else [(each.person, each.frame) for each in reading.of_kind("jump")],
    )


def _way_so_far(person: IntArray, places: FloatArray) -> FloatArray:
    """(n,) greatest distance from the first place of the track so far, metres."""
    starts = np.flatnonzero(np.diff(person, prepend=person[:1] - 1))
    first = np.repeat(starts, np.diff(starts, append=len(person)))
    away = np.hypot(*(places - places[first]).T)
    # Each track on a level of its own, above all before, so that its maximum starts anew.
    level = 2.0 * (away.max(initial=0.0) + 1.0) * np.searchsorted(starts, first)
    return np.maximum.accumulate(away + level) - level


def first_rows(track: Measured, start: int) -> IntArray:
    """(n,) for each person the first row from a frame on that is on the floor.

    One warning line names the people who never are, and one those who leave it and come back.

    Raises:
        ModelError: there is nobody.
    """
    from_now = track.frame >= start
    near = from_now & track.on_floor
    if not from_now.any():
        raise ModelError(f"{track.name}: from frame {start} on there is nobody")
    rows = np.flatnonzero(near)
    persons, at = np.unique(track.person[rows], return_index=True)
    never = np.flatnonzero(from_now & ~np.isin(track.person, persons))
    never = never[np.unique(track.person[never], return_index=True)[1]]
    if len(never):
        x, y = track.places[never[0]]
        said = f"{track.where(never[0])}: at ({x:.2f}, {y:.2f}) m, never on the floor"
        others = len(never) - 1
        said += f" (and {others} more people)" if others else ""
        if not len(persons):
            raise ModelError(f"{said}, expected tracks in metres and the plan's coordinates")
        warnings.warn(said, stacklevel=3)
    last = dict(zip(track.person[rows].tolist(), rows.tolist(), strict=True))
    ends = np.array([last[each] for each in persons.tolist()])
    first = rows[at]
    away = _between(first, ends, from_now & ~near)
    if len(away):
        worst = away[np.argmax(track.off[away])]
        warnings.warn(
            f"{track.where(worst)}: {track.off[worst]:.2f} m off the floor, as are "
            f"{len(away) - 1} more rows",
            stacklevel=3,
        )
    return first


def _between(first: IntArray, last: IntArray, chosen: NDArray[np.bool_]) -> IntArray:
    """Rows that are chosen and within one of the ranges."""
    change = np.zeros(len(chosen) + 1, dtype=np.int64)
    change[first] += 1
    change[last] -= 1
    return np.flatnonzero(chosen & (np.cumsum(change)[:-1] > 0))


def check_velocities(track: Measured, rows: IntArray) -> None:
    """Raise ModelError if somebody jumps or is too fast while their velocity is taken."""
    window = WINDOW_S * track.rate
    for person, frame in track.jumps:
        row = rows[track.person[rows] == person]
        if len(row) and track.frame[row[0]] - window <= frame < track.frame[row[0]]:
            raise ModelError(
                f"{track.name}: person {person} jumps after frame {frame}, so their velocity in "
                f"frame {track.frame[row[0]]} is not known"
            )
    speed = np.hypot(*track.velocity[rows].T)
    if (speed > FASTEST_SPRINT).any():
        row = rows[np.argmax(speed)]
        raise ModelError(
            f"{track.where(row)}: {speed.max():.1f} m/s, expected at most {FASTEST_SPRINT} m/s"
        )


def ways_out(
    track: Measured,
    rows: IntArray,
    exits: Sequence[str] | Mapping[int, Sequence[str]] | None,
    plan: FloorPlan,
) -> tuple[list[list[str]], IntArray]:
    """The exits by which people leave: lists of names, and (n,) the index of each person's list.

    Args:
        track: the tracks.
        rows: (n,) a row of each person.
        exits: names for everybody, or by number of the person; the exit to which the track leads
            for all others.
        plan: the floor plan.

    Raises:
        ModelError: the plan has no exit.
    """
    own = [[plan.exits[k].name] for k in track.exits(track.person[rows], plan)]
    if exits is not None:
        given = exits if isinstance(exits, Mapping) else dict.fromkeys(track.person[rows], exits)
        own = [
            list(given.get(int(person), way))
            for person, way in zip(track.person[rows], own, strict=True)
        ]
    ways = sorted({tuple(way) for way in own})
    return [list(way) for way in ways], np.array([ways.index(tuple(way)) for way in own], dtype=int)
