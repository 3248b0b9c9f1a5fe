"""The body of a pedestrian while its model runs."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.bodies import BodyMotion, Movements, PoseBank, body_motion
from mesa_mobility.crowd.options.table import FRAMES_A_SECOND, LONGEST_MOVEMENT
from mesa_mobility.errors import ModelError

REMEMBERED = 3 * FRAMES_A_SECOND
"""Frames of the past that a body is worked out from: some five steps."""


class Recorded(Protocol):
    """A model that records what people do."""

    frame: int
    recorder: Any

    def decided(self, since: int = 0) -> dict[str, NDArray[np.generic]] | None:
        """The decisions from a frame on, or None."""


def body_now(model: Recorded, row: int, digest: str, bank: PoseBank | None = None) -> BodyMotion:
    """The body of a pedestrian in the present frame; see ``Pedestrian.pose``.

    Args:
        model: the model.
        row: the pedestrian.
        digest: of the mobility map of their type.
        bank: poses of the type; by default those that ship for the map.
    """
    since = model.frame - REMEMBERED
    decided = model.decided(since - LONGEST_MOVEMENT)
    if decided is None:
        raise ModelError('poses need the decisions: create the model with record="decisions"')
    tracks = model.recorder.arrays(since)
    rows = np.flatnonzero(tracks["person"] == row)
    if not len(rows):
        raise ModelError(f"pedestrian {row}: no pose before the first step")
    own = decided["person"] == row
    movements = Movements(
        starts=decided["frame"][own].astype(np.int64),
        options=decided["option"][own].astype(np.int64),
        shares=decided["share"][own].astype(np.float64),
    )
    if bank is None:
        bank = PoseBank.of(digest)
    bank.check_map(digest)
    track = np.column_stack([tracks[name][rows] for name in ("x", "y", "heading")])
    motion = body_motion(bank, movements, tracks["frame"][rows].astype(np.int64), track)
    return motion.at(model.frame)
