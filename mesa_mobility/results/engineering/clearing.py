"""Clearing times: when shares of the people have left a floor, a storey, a stair or a room."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.errors import ResultsError
from mesa_mobility.floorplan import FloorPlan
from mesa_mobility.results.engineering.rooms import Room, room_times
from mesa_mobility.results.measures.storeys import last_there, leaving_times, where
from mesa_mobility.results.tracks import Tracks

if TYPE_CHECKING:
    import pandas as pd

    from mesa_mobility.buildings import Building

FloatArray = NDArray[np.float64]

SHARES = (0.5, 0.95, 1.0)

COLUMNS = ("people", "left", "t50_s", "t95_s", "t100_s", "censored_s")


def time_to_share(times: FloatArray, share: float) -> float:
    """When a share of people has left: the least time by which N * share of N people have.

    This is the ceil(N * share)-th of the times in rising order, without interpolation: t_100 is
    when the last person left.

    Args:
        times: (n,) seconds; infinite for people who have not left when the run ends
            (right-censored), who leave later than all others.
        share: above 0, at most 1.

    Returns:
        Seconds; infinite if the share was not reached, nan if there are no people.

    Raises:
        ResultsError: a share out of range.
    """
    if not 0.0 < share <= 1.0:
        raise ResultsError(f"share of people {share!r}, expected above 0, at most 1")
    if not len(times):
        return math.nan
    # 0.95 * 20 is a little more than 19 to a computer.
    count = math.ceil(share * len(times) - 1e-9)
    return float(np.sort(times)[max(count, 1) - 1])


def clearing(
    trajectories: Tracks, plan: FloorPlan | Building, rooms: Sequence[Room] = ()
) -> pd.DataFrame:
    """When 50, 95 and 100 % of the people have left the floor and each of its parts.

    Everybody who was ever there counts, at the time at which they last left. People who are there
    when the run ends, since it stalled or was stopped, leave later than all others: a share that
    falls among them has no time, and is known to take longer than ``censored_s``.

    Args:
        trajectories: the run.
        plan: its floor plan, or its building.
        rooms: named areas.

    Returns:
        A row for each ``kind`` and ``place``, the index: "floor" ("all"); "level", by its number,
        and "stairs" of a building; "room". ``people`` who were ever there, ``left``, how many of
        them left; ``t50_s``, ``t95_s`` and ``t100_s``, as `time_to_share` has them, nan where
        censored; ``censored_s``, the end of the run where people are there then, nan elsewhere.

    Raises:
        ResultsError: as `room_times`.
    """
    import pandas as pd

    table = []
    for kind, place, every in _times(trajectories, plan, rooms):
        times = every[~np.isnan(every)]
        left = int(np.isfinite(times).sum())
        reached = [time_to_share(times, share) for share in SHARES]
        known = [each if math.isfinite(each) else math.nan for each in reached]
        end = trajectories.duration if left < len(times) else math.nan
        table.append((kind, place, len(times), left, *known, end))
    return pd.DataFrame(table, columns=["kind", "place", *COLUMNS]).set_index(["kind", "place"])


def exit_times(trajectories: Tracks) -> FloatArray:
    """(m,) seconds at which each person left; infinite for those inside, nan for those not there.

    Entry p belongs to person p.
    """
    frames = trajectories.exit_frames
    times = np.full(len(frames), np.nan)
    times[np.unique(trajectories.person)] = np.inf
    times[frames >= 0] = frames[frames >= 0] / trajectories.frame_rate
    return times


def _times(
    trajectories: Tracks, plan: FloorPlan | Building, rooms: Sequence[Room]
) -> Iterator[tuple[str, str, FloatArray]]:
    """Kind and name of each place, and when each person last left it."""
    yield "floor", "all", exit_times(trajectories)
    if not isinstance(plan, FloorPlan):
        for number, times in leaving_times(trajectories, plan).items():
            yield "level", str(number), times
        found = where(trajectories, plan)
        for number, stairs in enumerate(plan.stairs):
            rows = found.inside & (found.stairs == number)
            yield "stairs", stairs.name, last_there(trajectories, rows)
    for name, times in room_times(trajectories, plan, rooms).items():
        yield "room", name, times
