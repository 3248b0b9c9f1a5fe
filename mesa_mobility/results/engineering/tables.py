"""The figures of a run as CSV files, for reports and spreadsheets."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from mesa_mobility.results.engineering.clearing import clearing
from mesa_mobility.results.engineering.doors import clogging, doors, n_t
from mesa_mobility.results.engineering.queues import queue_lengths, queues, waiting_times
from mesa_mobility.results.engineering.rooms import Room, rooms_of
from mesa_mobility.results.files import all_or_none
from mesa_mobility.results.measures.by_type import EVERYBODY, tables_by_type
from mesa_mobility.results.tracks import Tracks

if TYPE_CHECKING:
    import pandas as pd

    from mesa_mobility.buildings import Building
    from mesa_mobility.floorplan import FloorPlan

TABLES = ("n_t.csv", "queues.csv", "waiting.csv", "clearing.csv", "doors.csv")


def write_tables(
    trajectories: Tracks,
    plan: FloorPlan | Building,
    directory: str | os.PathLike[str],
    rooms: Sequence[Room] = (),
) -> None:
    """Write the tables of a run, all of them or none.

    ``doors.csv``, ``clearing.csv`` and ``waiting.csv`` have rows of everybody ("all") and of each
    type; clogs are those of everybody. ``n_t.csv`` and ``queues.csv`` have the curves of each door.
    A field that has no value is empty. `doors`, `clogging`, `queues`, `clearing`, `waiting_times`,
    `n_t` and `queue_lengths` define the columns.

    Args:
        trajectories: the run.
        plan: its floor plan, or its building.
        directory: folder to write to, created if need be.
        rooms: named areas, beside those of the plan (`rooms_of`).

    Raises:
        ResultsError: the folder or a file cannot be written, rooms that are not on the plan, or
            what these functions refuse.
    """
    every = [*rooms_of(plan), *rooms]
    with all_or_none(directory, TABLES) as temporary:
        for name, table in _tables(trajectories, plan, every):
            table.to_csv(temporary / name, index=False, float_format="%.6g")


def _tables(
    trajectories: Tracks, plan: FloorPlan | Building, rooms: Sequence[Room]
) -> Iterator[tuple[str, pd.DataFrame]]:
    """Name and content of each file."""
    import pandas as pd

    def by_type(measure: Callable[[Tracks], pd.DataFrame]) -> pd.DataFrame:
        return tables_by_type(measure, trajectories)

    clogs = pd.concat([clogging(trajectories, plan)], keys=[EVERYBODY], names=["type"])
    passed = by_type(lambda tracks: doors(tracks, plan).join(queues(tracks, plan)))
    yield "doors.csv", passed.join(clogs).reset_index()
    yield "clearing.csv", by_type(lambda tracks: clearing(tracks, plan, rooms)).reset_index()
    yield "waiting.csv", by_type(_waiting).droplevel(1).reset_index()
    yield "n_t.csv", n_t(trajectories, plan)
    lengths = queue_lengths(trajectories, plan)
    curves = [(name, *each) for name, curve in lengths.items() for each in curve]
    yield "queues.csv", pd.DataFrame(curves, columns=["door", "time_s", "people"])


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
