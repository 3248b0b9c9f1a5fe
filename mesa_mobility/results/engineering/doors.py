"""Doors and exits: who passes them and when, their flow, and where they clog."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

from mesa_mobility.errors import ResultsError
from mesa_mobility.floorplan import FloorPlan
from mesa_mobility.results.measures.crossings import (
    Crossings,
    crossings_of_lines,
    flow,
    passed_by,
)
from mesa_mobility.results.measures.storeys import where
from mesa_mobility.results.tracks import Tracks

if TYPE_CHECKING:
    import pandas as pd

    from mesa_mobility.buildings import Building
    from mesa_mobility.floorplan.floor.openings import Opening

COLUMNS = (
    "kind",
    "level",
    "width_m",
    "people",
    "first_s",
    "last_s",
    "flow_per_s",
    "flow_per_m_s",
)
CLOGGING_COLUMNS = ("clogs", "clogged_s", "longest_clog_s")

GAP_S = 2.0
"""Seconds without a passage that are a clog if people wait for the door."""

REACH_M = 1.0
"""Metres from the line within which people wait for it."""


class Door(NamedTuple):
    """A gate or an exit, with the number of its level."""

    opening: Opening
    level: int


def doors(trajectories: Tracks, plan: FloorPlan | Building) -> pd.DataFrame:
    """How many people passed each gate and exit, when, and the flow.

    Everybody counts once, at their first passage in either direction. With these N passages at the
    times t_1 to t_N the flow is J = (N - 1) / (t_N - t_1), and the specific flow is J / w for a
    line of the width w (A. Seyfried et al., Transportation Science 43 (2009) 395-406).

    Args:
        trajectories: the run.
        plan: its floor plan, or its building. The ends of stairs are in `by_stairs`.

    Returns:
        A row for each gate and exit, by name: ``kind``, "gate" or "exit"; ``level``, its number, 0
        on a floor plan; ``width_m``; ``people``; ``first_s`` and ``last_s``, seconds of the first
        and the last of these passages, nan if there is none; ``flow_per_s``, and ``flow_per_m_s``,
        persons per metre and second, nan for fewer than two passages.

    Raises:
        ResultsError: a run in a building whose tracks have no elevations.
    """
    import pandas as pd

    found = crossings_of_doors(trajectories, plan)
    table = []
    for opening, level in doors_of(plan):
        own = door_figures(found[opening.name])
        rate = own["flow_per_s"]
        table.append(
            {
                "door": opening.name,
                "kind": opening.kind,
                "level": level,
                "width_m": opening.length,
                **{name: np.nan if value is None else value for name, value in own.items()},
                "flow_per_m_s": np.nan if rate is None else rate / opening.length,
            }
        )
    return pd.DataFrame(table, columns=["door", *COLUMNS]).set_index("door")


def door_figures(found: Crossings) -> dict[str, Any]:
    """Figures of one door, ready for JSON; see `doors`.

    Args:
        found: its passages.

    Returns:
        ``people``, ``first_s``, ``last_s`` and ``flow_per_s``; None where `doors` has nan.
    """
    return figures_of_times(np.array([time for time, _ in passed_by(found)]))


def figures_of_times(times: NDArray[np.float64]) -> dict[str, Any]:
    """``people``, ``first_s``, ``last_s`` and ``flow_per_s`` of people's times (k,), seconds.

    Infinite times are of people who have not passed yet: they count as people, the last time is
    then None, and the flow is that of the others.
    """
    known = times[np.isfinite(times)]
    return {
        "people": len(times),
        "first_s": float(known.min()) if len(known) else None,
        "last_s": float(known.max()) if len(known) and len(known) == len(times) else None,
        "flow_per_s": flow(known),
    }


def n_t(trajectories: Tracks, plan: FloorPlan | Building) -> pd.DataFrame:
    """The N-t curve of each gate and exit.

    Returns:
        A row for each first passage, by door, then time: ``door``, ``time_s``, and ``people`` who
        have passed by then, themselves included.

    Raises:
        ResultsError: as `doors`.
    """
    import pandas as pd

    table = [
        (name, time, count)
        for name, found in crossings_of_doors(trajectories, plan).items()
        for time, count in passed_by(found)
    ]
    return pd.DataFrame(table, columns=["door", "time_s", "people"])


def clogging(
    trajectories: Tracks,
    plan: FloorPlan | Building,
    *,
    gap: float = GAP_S,
    reach: float = REACH_M,
) -> pd.DataFrame:
    """How often and how long the flow through each gate and exit stopped although people waited.

    A clog is a time of more than ``gap`` seconds between two successive passages, or from the last
    one to the end of a run that leaves people inside, in each frame of which somebody is within
    ``reach`` of the line who passes it next, or passes no line any more. Clogs as gaps between
    passages: I. Zuriguel et al., Scientific Reports 4 (2014) 7324. Both numbers are a convention.

    Args:
        trajectories: the run, with all of its people: of some people alone, gaps are no clogs.
        plan: its floor plan, or its building.
        gap: seconds.
        reach: metres.

    Returns:
        A row for each gate and exit, by name: ``clogs``, their number; ``clogged_s``, their sum;
        ``longest_clog_s``, 0 if there is none.

    Raises:
        ResultsError: as `doors`; a gap or a reach that is not positive.
    """
    import pandas as pd

    for name, value in (("gap", gap), ("reach", reach)):
        if not 0.0 < value < np.inf:
            raise ResultsError(f"clogging: {name} is {value}, expected more than 0")
    found = crossings_of_doors(trajectories, plan)
    following = next_door(trajectories, found)
    levels = _levels(trajectories, plan)
    inside = trajectories.exit_frames[trajectories.person] != trajectories.frame
    table = []
    for number, (opening, level) in enumerate(doors_of(plan)):
        rows = inside & ((following == number) | (following < 0)) & (levels == level)
        rows &= _near(trajectories, opening.line, reach)
        waiting = np.zeros(trajectories.frames, dtype=np.bool_)
        waiting[trajectories.frame[rows]] = True
        lengths = _clogs(found[opening.name].time, waiting, trajectories, gap)
        table.append(
            (opening.name, len(lengths), lengths.sum(), lengths.max(initial=0.0)),
        )
    return pd.DataFrame(table, columns=["door", *CLOGGING_COLUMNS]).set_index("door")


def crossings_of_doors(trajectories: Tracks, plan: FloorPlan | Building) -> dict[str, Crossings]:
    """The passages over each gate and exit, by its name, open or closed.

    Raises:
        ResultsError: a run in a building whose tracks have no elevations.
    """
    levels = _levels(trajectories, plan)
    found: dict[str, Crossings] = {}
    for number in dict.fromkeys(level for _, level in doors_of(plan)):
        on = levels == number
        own = trajectories if on.all() else trajectories.only(_or_next_to(trajectories, on))
        here = [opening for opening, level in doors_of(plan) if level == number]
        passed = crossings_of_lines(own, [(each.a, each.b) for each in here])
        found |= zip([each.name for each in here], passed, strict=True)
    return found


def doors_of(plan: FloorPlan | Building) -> list[Door]:
    """The gates and exits of a floor plan, or of all levels of a building without its stairs."""
    if isinstance(plan, FloorPlan):
        return [Door(each, 0) for each in plan.openings()]
    return [
        Door(each, level.number) for level in plan.levels for each in (*level.gates, *level.exits)
    ]


def next_door(trajectories: Tracks, found: Mapping[str, Crossings]) -> NDArray[np.int64]:
    """(n,) which of the doors the person of each row passes next; -1 where they pass none.

    Args:
        trajectories: the run.
        found: the passages of each door.
    """
    person, time, door = (
        np.concatenate([np.empty(0), *(np.asarray(each) for each in columns)])
        for columns in (
            [each.person for each in found.values()],
            [each.time for each in found.values()],
            [np.full(len(each.time), number) for number, each in enumerate(found.values())],
        )
    )
    span = trajectories.duration + 1.0
    order = np.lexsort((time, person))
    keys = np.append(person[order] * span + time[order], np.inf)
    people = np.append(person[order], -1.0)
    at = np.searchsorted(
        keys, trajectories.person * span + trajectories.frame / trajectories.frame_rate
    )
    following = np.append(door[order], -1.0)[at]
    following[people[at] != trajectories.person] = -1.0
    return following.astype(np.int64)


def _clogs(
    passed: NDArray[np.float64], waiting: NDArray[np.bool_], tracks: Tracks, gap: float
) -> NDArray[np.float64]:
    """(k,) seconds that each clog lasted.

    Args:
        passed: times of passages in rising order, seconds.
        waiting: (frames,) whether anybody waits.
        tracks: the run.
        gap: seconds.
    """
    ends = np.append(passed, tracks.duration) if len(tracks.remaining) else passed
    lengths = np.diff(ends)
    if not len(lengths):
        return lengths
    first = np.ceil(ends[:-1] * tracks.frame_rate - 1e-9).astype(np.int64)
    last = np.floor(ends[1:] * tracks.frame_rate + 1e-9).astype(np.int64)
    nobody = np.append(0, np.cumsum(~waiting))
    # The frame of a passage is the first beyond the line: nobody need wait in it any more.
    last = np.maximum(np.minimum(last, len(waiting)), first)
    free = nobody[last] - nobody[first]
    clogs: NDArray[np.float64] = lengths[(lengths > gap) & (free == 0)]
    return clogs


def _near(trajectories: Tracks, line: shapely.LineString, reach: float) -> NDArray[np.bool_]:
    """(n,) whether each row is within a distance of a line, metres."""
    x0, y0, x1, y1 = line.buffer(reach).bounds
    x, y = trajectories.x, trajectories.y
    near = (x >= x0) & (x <= x1) & (y >= y0) & (y <= y1)
    near[near] = shapely.dwithin(shapely.points(x[near], y[near]), line, reach)
    return near


def _levels(trajectories: Tracks, plan: FloorPlan | Building) -> NDArray[np.int16]:
    """(n,) the number of the level of each row; 0 on a floor plan."""
    if isinstance(plan, FloorPlan):
        return np.zeros(len(trajectories), dtype=np.int16)
    return where(trajectories, plan).level


def _or_next_to(trajectories: Tracks, rows: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """(n,) the rows of a mask, and the rows of the same people just before and after them."""
    order = trajectories.by_person
    here = rows[order]
    same = np.diff(trajectories.person[order]) == 0
    near = here.copy()
    near[1:] |= here[:-1] & same
    near[:-1] |= here[1:] & same
    wider = np.empty_like(rows)
    wider[order] = near
    return wider
