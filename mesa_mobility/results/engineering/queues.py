"""Waiting: who stands or barely moves, for how long, and how many wait before each door."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.results.engineering.doors import crossings_of_doors, doors_of, next_door
from mesa_mobility.results.measures.occupancy import frames_at
from mesa_mobility.results.measures.speeds import frames_in
from mesa_mobility.results.tracks import Tracks

if TYPE_CHECKING:
    import pandas as pd

    from mesa_mobility.buildings import Building
    from mesa_mobility.floorplan import FloorPlan

FloatArray = NDArray[np.float64]

WAITING_MPS = 0.2
"""Speed below which people wait, m/s."""

WINDOW_S = 1.0
"""Seconds over which it is measured, about a gait cycle: the sway of the body counts less."""

COLUMNS = ("waited", "waiting_s", "longest_wait_s", "mean_queue", "most_queue", "most_queue_s")


def waiting_rows(trajectories: Tracks, slower_than: float = WAITING_MPS) -> NDArray[np.int64]:
    """(k,) the rows, one a second and person, from which people wait for a second.

    A person waits from t to t + 1 s if their straight displacement in that time is shorter than
    ``slower_than`` times 1 s. The speed is a convention.

    Args:
        trajectories: the run.
        slower_than: m/s.

    Raises:
        ResultsError: less than one frame a second.
    """
    frames = frames_in(WINDOW_S, trajectories, "window")
    start, end = trajectories.steps(frames)
    once = trajectories.frame[start] % frames == 0
    start, end = start[once], end[once]
    way = np.hypot(
        trajectories.x[end] - trajectories.x[start], trajectories.y[end] - trajectories.y[start]
    )
    rows: NDArray[np.int64] = start[way < slower_than * frames / trajectories.frame_rate]
    return rows


def waiting_times(trajectories: Tracks, slower_than: float = WAITING_MPS) -> FloatArray:
    """(m,) seconds that each person waited in all; entry p belongs to person p.

    Arguments and errors as for `waiting_rows`.
    """
    rows = waiting_rows(trajectories, slower_than)
    seconds = np.bincount(trajectories.person[rows], minlength=len(trajectories.radii))
    return WINDOW_S * seconds.astype(np.float64)


def queue_lengths(
    trajectories: Tracks, plan: FloorPlan | Building, slower_than: float = WAITING_MPS
) -> dict[str, list[list[float]]]:
    """How many people wait before each gate and exit, as [[t, people], ...] by its name.

    The queue of a door are the people who wait, as `waiting_rows` has it, and whose next passage is
    over this door, wherever they stand. Who passes no door any more is in no queue.

    Args:
        trajectories: the run.
        plan: its floor plan, or its building.
        slower_than: m/s.

    Returns:
        An entry a second, from 0 to the end of the run.

    Raises:
        ResultsError: as `doors`; less than one frame a second.
    """
    rows, following = _queued(trajectories, plan, slower_than)
    frames = trajectories.frame[rows]
    found = {}
    for number, (opening, _) in enumerate(doors_of(plan)):
        counts = np.bincount(frames[following == number], minlength=trajectories.frames)
        found[opening.name] = [
            [time, int(counts[frame])] for time, frame in frames_at(trajectories, WINDOW_S)
        ]
    return found


def queues(
    trajectories: Tracks, plan: FloorPlan | Building, slower_than: float = WAITING_MPS
) -> pd.DataFrame:
    """How long people waited before each gate and exit, and how many at a time.

    Args:
        trajectories: the run.
        plan: its floor plan, or its building.
        slower_than: m/s, as for `waiting_rows`.

    Returns:
        A row for each gate and exit, by name: ``waited``, the people who waited before it for a
        second or more; ``waiting_s``, the mean of their seconds, and ``longest_wait_s``, both nan
        if nobody waited; ``mean_queue`` and ``most_queue``, the mean over the seconds of the run
        and the greatest number of people in the queue, as `queue_lengths` has it; and
        ``most_queue_s``, the second from which it was first that long, nan if nobody waited.

    Raises:
        ResultsError: as `queue_lengths`.
    """
    import pandas as pd

    rows, following = _queued(trajectories, plan, slower_than)
    seconds = len(frames_at(trajectories, WINDOW_S))
    table = []
    for number, (opening, _) in enumerate(doors_of(plan)):
        own = rows[following == number]
        times = WINDOW_S * np.unique(trajectories.person[own], return_counts=True)[1]
        lengths = np.bincount(trajectories.frame[own])
        table.append(
            {
                "door": opening.name,
                "waited": len(times),
                "waiting_s": times.mean() if len(times) else np.nan,
                "longest_wait_s": times.max() if len(times) else np.nan,
                "mean_queue": len(own) / seconds,
                "most_queue": int(lengths.max(initial=0)),
                "most_queue_s": (
                    lengths.argmax() / trajectories.frame_rate if len(lengths) else np.nan
                ),
            }
        )
    return pd.DataFrame(table, columns=["door", *COLUMNS]).set_index("door")


def _queued(
    trajectories: Tracks, plan: FloorPlan | Building, slower_than: float
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """(k,) rows of people who wait, and the (k,) doors that they pass next."""
    rows = waiting_rows(trajectories, slower_than)
    return rows, next_door(trajectories, crossings_of_doors(trajectories, plan))[rows]
