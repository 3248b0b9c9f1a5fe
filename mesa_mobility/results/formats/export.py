"""Trajectories in the forms that other tools of the field read.

The track of a person who leaves ends with the first frame beyond the exit. PedPy leaves out the
movement into the last frame of a track, so nobody would cross the line of an exit. Exports for
analysis therefore have ``BEYOND`` rows more: the person walks straight on, at the velocity of the
step across the exit. They are made here and not recorded, so that no measure of our own takes
anybody beyond an exit for somebody inside. Those whom a program takes out walk on as well: tracks
do not tell them apart.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from mesa_mobility.errors import ResultsError
from mesa_mobility.results.columns import COLUMNS
from mesa_mobility.results.tracks import Tracks

if TYPE_CHECKING:
    import pedpy


BEYOND = 3
"""Frames for which people walk on beyond the exit."""
# Rows handed over together: bounds the Python objects alive at a time.
CHUNK = 100_000


def to_pedpy(trajectories: Tracks) -> pedpy.TrajectoryData:
    """As PedPy's `TrajectoryData` (columns id, frame, x, y in metres), with rows beyond the exits.

    A person who left has ``BEYOND`` rows more than here, straight on at the velocity of the step
    across the exit: N(t) at the line of an exit then counts everybody who left by it.

    Raises:
        ResultsError: PedPy is not installed, or there are no rows.
    """
    try:
        import pandas as pd
        import pedpy
    except ImportError as error:
        raise ResultsError("PedPy is not installed: pip install pedpy") from error
    trajectories = walked_on(trajectories)
    data = pd.DataFrame(
        {
            "id": trajectories.person.astype(np.int64),
            "frame": trajectories.frame.astype(np.int64),
            "x": trajectories.x,
            "y": trajectories.y,
        }
    )
    return pedpy.TrajectoryData(data=data, frame_rate=trajectories.frame_rate)


def walked_on(trajectories: Tracks) -> Tracks:
    """The rows, and those of people who walk on beyond an exit; for export alone.

    See this module's docstring for why.

    Raises:
        ResultsError: no rows.
    """
    if not len(trajectories):
        raise ResultsError("there is nothing to export: the trajectories have no rows")
    order = trajectories.by_person
    before, after = order[:-1], order[1:]
    person, frame = trajectories.person, trajectories.frame
    # The last two rows of those who left; who has a single row has taken no step.
    across = (person[before] == person[after]) & (frame[before] + 1 == frame[after])
    across &= trajectories.exit_frames[person[after]] == frame[after]
    before, after = np.repeat(before[across], BEYOND), np.repeat(after[across], BEYOND)
    steps = np.tile(np.arange(1, BEYOND + 1, dtype=np.int32), int(across.sum()))
    beyond: dict[str, Any] = {
        "frame": frame[after] + steps,
        "person": person[after],
        "x": trajectories.x[after] + steps * (trajectories.x[after] - trajectories.x[before]),
        "y": trajectories.y[after] + steps * (trajectories.y[after] - trajectories.y[before]),
        "heading": trajectories.heading[after],
    }
    assert trajectories.last_frame is not None
    columns: dict[str, Any] = {
        name: np.concatenate([getattr(trajectories, name), beyond[name]]) for name in COLUMNS
    }
    return replace(
        trajectories,
        **columns,
        last_frame=max(trajectories.last_frame, int(beyond["frame"].max(initial=0))),
        inside_at_end=np.empty(0, dtype=np.int32),
        # An exit is on a level: who walks on from there stays at its elevation.
        fields={
            name: np.concatenate([values, values[after]])
            for name, values in trajectories.fields.items()
            if name == "z"
        },
        decisions=None,
    )
