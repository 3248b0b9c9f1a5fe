"""Bodies of the people of a run."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesa_mobility.bodies import BodyMotion, PoseBank, body_motion
from mesa_mobility.bodies.motion import FRAME_RATE
from mesa_mobility.errors import ResultsError
from mesa_mobility.results.tracks import Tracks

if TYPE_CHECKING:
    from mesa_mobility.buildings import Building


def body_of(
    trajectories: Tracks,
    person: int,
    frames: ArrayLike | None = None,
    *,
    bank: PoseBank | None = None,
    building: Building | None = None,
) -> BodyMotion:
    """The body of one person of a run.

    Args:
        trajectories: the run, with its decisions.
        person: who.
        frames: (k,) frames, whole or between two; by default all in which the person is there.
        bank: poses of the person's type on level floors; by default those that ship for the type's
            map. Poses on stairs are always those that ship.
        building: where the run was, to put feet on the treads of its stairs. Without it, bodies on
            stairs walk as on a slope.

    Raises:
        ResultsError: no decisions, nobody of that number, or a time at which they are not there.
        MapError: no poses of the person's map ship, or the bank is of another map.
    """
    decisions = trajectories.decisions
    if decisions is None:
        raise ResultsError(
            "the run has no decisions, from which bodies are drawn: record them with "
            "`mesa-mobility run --record decisions`"
        )
    known, track = track_of(trajectories, person)
    if not len(known):
        raise ResultsError(f"person {person}: not in this run of {trajectories.people} people")
    if trajectories.frame_rate != FRAME_RATE or np.any(np.diff(known) != 1):
        raise ResultsError(
            f"person {person}: expected each frame of its track at {FRAME_RATE:g} Hz"
        )
    own = decisions.rows_of(person)
    kind = int(decisions.type_index[own[0]]) if len(own) else 0
    motion = body_motion(
        decisions.bank_of(kind, bank),
        decisions.movements_of(person),
        known,
        track,
        elevation=elevation_of(trajectories, person),
        footing=None if building is None else building.footing,
    )
    return motion if frames is None else motion.at(frames)


def track_of(trajectories: Tracks, person: int) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Where one person is: (k,) frames, and (k, 3) x, y (metres) and heading (radians) in them."""
    rows = trajectories.rows_of(person)
    columns = (trajectories.x, trajectories.y, trajectories.heading)
    return trajectories.frame[rows].astype(np.int64), np.column_stack([c[rows] for c in columns])


def elevation_of(trajectories: Tracks, person: int) -> NDArray[np.float64] | None:
    """(k,) elevation of one person in the frames of `track_of`, metres; None on a floor plan."""
    return trajectories.z[trajectories.rows_of(person)] if "z" in trajectories.fields else None
