"""The body of a pedestrian while its model runs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.bodies import BodyMotion, Movements, PoseBank, bank_of_maps, body_motion
from mesa_mobility.crowd.options.table import FRAMES_A_SECOND, LONGEST_MOVEMENT
from mesa_mobility.errors import ModelError
from mesa_mobility.mobility import MobilityMap

REMEMBERED = 3 * FRAMES_A_SECOND
"""Frames of the past that a body is worked out from: some five steps."""


class Recorded(Protocol):
    """A model that records what people do."""

    frame: int
    recorder: Any

    def decided(self, since: int = 0) -> dict[str, NDArray[np.generic]] | None:
        """The decisions from a frame on, or None."""


def body_now(
    model: Recorded, row: int, maps: Sequence[MobilityMap], bank: PoseBank | None = None
) -> BodyMotion:
    """The body of a pedestrian in the present frame; see ``Pedestrian.pose``.

    Args:
        model: the model.
        row: the pedestrian.
        maps: by which people of their type move, that of the type first.
        bank: poses of the first map; by default those that ship for it.
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
    poses = bank_of_maps([(each.digest, each.lengths) for each in maps], bank)
    track = np.column_stack([tracks[name][rows] for name in ("x", "y", "heading")])
    motion = body_motion(poses, movements, tracks["frame"][rows].astype(np.int64), track)
    return motion.at(model.frame)
