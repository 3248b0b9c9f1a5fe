"""The body of a pedestrian while its model runs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mesa_mobility.bodies import BodyMotion, Movements, PoseBank, body_motion
from mesa_mobility.crowd.options.table import FRAMES_A_SECOND
from mesa_mobility.errors import ModelError

if TYPE_CHECKING:
    from mesa_mobility.crowd.people.pedestrian import Pedestrian

REMEMBERED = 3 * FRAMES_A_SECOND
"""Frames of the past that a body is worked out from: some five steps."""

LONGEST_MOVEMENT = 45


def body_now(person: Pedestrian, bank: PoseBank | None = None) -> BodyMotion:
    """The body of a pedestrian in the present frame; see ``Pedestrian.pose``."""
    model = person.model
    since = model.frame - REMEMBERED
    decided = model.decided(since - LONGEST_MOVEMENT)
    if decided is None:
        raise ModelError('poses need the decisions: create the model with record="decisions"')
    tracks = model.recorder.arrays(since)
    rows = np.flatnonzero(tracks["person"] == person.row)
    if not len(rows):
        raise ModelError(f"pedestrian {person.row}: no pose before the first step")
    own = decided["person"] == person.row
    movements = Movements(
        starts=decided["frame"][own].astype(np.int64),
        options=decided["option"][own].astype(np.int64),
        shares=decided["share"][own].astype(np.float64),
    )
    digest = person.pedestrian_type.mobility_map.digest
    if bank is None:
        bank = PoseBank.of(digest)
    bank.check_map(digest)
    track = np.column_stack([tracks[name][rows] for name in ("x", "y", "heading")])
    motion = body_motion(bank, movements, tracks["frame"][rows].astype(np.int64), track)
    return motion.at(model.frame)
