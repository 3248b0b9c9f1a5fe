"""All figures of a run for a report, measured once."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from mesa_mobility.results.engineering.clearing import clearing
from mesa_mobility.results.engineering.doors import clogging, doors, n_t
from mesa_mobility.results.engineering.maps import CELL_M, FloorMaps, maps_by_type
from mesa_mobility.results.engineering.queues import queue_lengths, queues, waiting_times
from mesa_mobility.results.engineering.rooms import Room, check_rooms, rooms_of
from mesa_mobility.results.measures.by_type import EVERYBODY, tables_by_type
from mesa_mobility.results.tracks import Tracks

if TYPE_CHECKING:
    import pandas as pd

    from mesa_mobility.buildings import Building
    from mesa_mobility.floorplan import FloorPlan


@dataclass(frozen=True, eq=False)
class Measured:
    """Figures of a run. Tables by type have rows of everybody ("all") and of each type.

    Attributes:
        trajectories: the run.
        plan: its floor plan, or its building.
        rooms: named areas, those of the plan included.
        every: seconds between the measurements of maps.
        doors: `doors`, `queues` and, of everybody, `clogging`, by ``type`` and ``door``.
        clearing: `clearing`, by ``type``, ``kind`` and ``place``.
        waiting: people and the seconds for which they wait, by ``type``.
        n_t: the N-t curve of each door.
        queues: ``door``, ``time_s`` and ``people`` who wait, second by second.
        maps: `maps_by_type`.
    """

    trajectories: Tracks
    plan: FloorPlan | Building
    rooms: Sequence[Room]
    every: float
    doors: pd.DataFrame
    clearing: pd.DataFrame
    waiting: pd.DataFrame
    n_t: pd.DataFrame
    queues: pd.DataFrame
    maps: Mapping[str, Mapping[int, FloorMaps]]


def measure(
    trajectories: Tracks,
    plan: FloorPlan | Building,
    rooms: Sequence[Room] = (),
    *,
    cell: float = CELL_M,
    every: float = 1.0,
    progress: Callable[[str], None] = lambda what: None,
) -> Measured:
    """Measure doors, queues, clearing times and maps of a run.

    Args:
        trajectories: the run.
        plan: its floor plan, or its building.
        rooms: named areas, beside those of the plan (`rooms_of`).
        cell: side of the cells of maps, metres.
        every: seconds between the measurements of maps.
        progress: called with what is being done.

    Raises:
        ResultsError: rooms that are not on the plan, or what the single functions refuse.
    """
    import pandas as pd

    def by_type(figures: Callable[[Tracks], pd.DataFrame]) -> pd.DataFrame:
        return tables_by_type(figures, trajectories)

    named = check_rooms([*rooms_of(plan), *rooms], plan)
    progress("tables")
    clogs = pd.concat([clogging(trajectories, plan)], keys=[EVERYBODY], names=["type"])
    passed = by_type(lambda tracks: doors(tracks, plan).join(queues(tracks, plan)))
    cleared = by_type(lambda tracks: clearing(tracks, plan, named))
    lengths = queue_lengths(trajectories, plan)
    curves = [(name, *each) for name, curve in lengths.items() for each in curve]
    progress("maps")
    return Measured(
        trajectories,
        plan,
        named,
        every,
        passed.join(clogs),
        cleared,
        by_type(_waiting).droplevel(1),
        n_t(trajectories, plan),
        pd.DataFrame(curves, columns=["door", "time_s", "people"]),
        maps_by_type(trajectories, plan, cell=cell, every=every),
    )


def _waiting(trajectories: Tracks) -> pd.DataFrame:
    """One row: how many people there are, and the seconds for which they wait."""
    import pandas as pd

    times = waiting_times(trajectories)[np.unique(trajectories.person)]
    return pd.DataFrame(
        {
            "people": [len(times)],
            "mean_wait_s": [times.mean() if len(times) else np.nan],
            "p95_wait_s": [np.quantile(times, 0.95) if len(times) else np.nan],
            "longest_wait_s": [times.max(initial=0.0)],
        }
    )
