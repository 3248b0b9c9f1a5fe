"""How far replayed people are from where they were measured."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.bodies.velocities import velocities
from mesa_mobility.results.tracks import Tracks

FloatArray = NDArray[np.float64]


class Replayed(Protocol):
    """What ``model.replay`` tells of who was put where."""

    frame: int
    from_frame: int
    persons: NDArray[np.int64]
    rows: NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class PositionErrors:
    """How far people are from where they were measured, some seconds after a replay began.

    Entries are not numbers if the person had left the model or was not measured any more, or has no
    velocity from earlier frames.

    Attributes:
        seconds: (k,) after the start.
        persons: (n,) numbers in the tracks.
        simulated: (n, k) metres.
        constant_velocity: (n, k) metres, of somebody who walks on with the velocity of the last
            0.8 s before the start, from the measured place.
    """

    seconds: FloatArray
    persons: NDArray[np.int64]
    simulated: FloatArray
    constant_velocity: FloatArray

    def means(self) -> tuple[FloatArray, FloatArray]:
        """(k,) mean over people, metres, simulated and at constant velocity."""
        known = np.isfinite(self.simulated)
        with np.errstate(invalid="ignore"):
            ours, straight = (
                np.where(known, each, 0.0).sum(axis=0) / known.sum(axis=0)
                for each in (self.simulated, self.constant_velocity)
            )
        return ours, straight


def position_errors(
    run: Tracks, tracks: Tracks, replay: Replayed, seconds: Sequence[float] = (1.5, 3.0, 4.8)
) -> PositionErrors:
    """How far the people who were there at the start of a replay are from where they were measured.

    Args:
        run: trajectories of the model after the replay.
        tracks: those that were replayed.
        replay: what ``model.replay`` returned.
        seconds: after the start.
    """
    after = np.asarray(seconds, dtype=np.float64)
    order = tracks.by_person
    person, frame = tracks.person[order].astype(np.int64), tracks.frame[order].astype(np.int64)
    places = np.column_stack([tracks.x[order], tracks.y[order]])
    velocity, taken = velocities(person, frame, places, tracks.frame_rate)
    shape = len(replay.persons), len(after)
    ours, straight = np.full(shape, np.nan), np.full(shape, np.nan)
    for k, (number, row) in enumerate(zip(replay.persons, replay.rows, strict=True)):
        first, last = np.searchsorted(person, [number, number + 1])
        start = first + np.searchsorted(frame[first:last], replay.from_frame)
        if taken[start] == 0.0:
            continue
        then = replay.from_frame + after * tracks.frame_rate
        measured = _at(frame[first:last], places[first:last], then)
        rows = run.rows_of(int(row))
        walked = np.column_stack([run.x[rows], run.y[rows]])
        found = _at(run.frame[rows], walked, replay.frame + after * run.frame_rate)
        ahead = places[start] + after[:, None] * velocity[start]
        ours[k] = np.hypot(*(found - measured).T)
        straight[k] = np.where(np.isfinite(ours[k]), np.hypot(*(ahead - measured).T), np.nan)
    return PositionErrors(after, replay.persons, ours, straight)


def _at(frames: NDArray[np.integer], places: FloatArray, wanted: FloatArray) -> FloatArray:
    """(k, 2) places at frames, between two of them if need be; not numbers outside the track."""
    return np.column_stack(
        [np.interp(wanted, frames, each, left=np.nan, right=np.nan) for each in places.T]
    )
