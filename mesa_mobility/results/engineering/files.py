"""The figures of a run as CSV files and pictures, for reports and spreadsheets."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from mesa_mobility.results.engineering.clearing import clearing
from mesa_mobility.results.engineering.doors import clogging, doors, n_t
from mesa_mobility.results.engineering.maps import CELL_M, FloorMaps, maps_by_type
from mesa_mobility.results.engineering.queues import queue_lengths, queues, waiting_times
from mesa_mobility.results.engineering.rooms import Room, check_rooms, rooms_of
from mesa_mobility.results.files import all_or_none
from mesa_mobility.results.measures.by_type import EVERYBODY, tables_by_type
from mesa_mobility.results.tracks import Tracks

if TYPE_CHECKING:
    import pandas as pd

    from mesa_mobility.buildings import Building
    from mesa_mobility.floorplan import FloorPlan

PICTURES = {
    "level_of_service.png": "density_max",
    "dense.png": "dense_s",
    "usage.png": "people",
    "speed.png": "speed",
}
"""The map that each picture shows."""

RESULT_FILES = (
    "n_t.csv",
    "queues.csv",
    "waiting.csv",
    "clearing.csv",
    "maps.csv",
    *PICTURES,
    "doors.csv",
)


def write_results(
    trajectories: Tracks,
    plan: FloorPlan | Building,
    directory: str | os.PathLike[str],
    rooms: Sequence[Room] = (),
    *,
    cell: float = CELL_M,
    every: float = 1.0,
    title: str = "",
    progress: Callable[[str], None] = lambda what: None,
) -> None:
    """Write tables and pictures of a run, all of them or none.

    ``doors.csv``, ``clearing.csv``, ``waiting.csv`` and ``maps.csv`` have rows of everybody ("all")
    and of each type; clogs are those of everybody. ``n_t.csv`` and ``queues.csv`` have the curves
    of each door. A field that has no value is empty. `doors`, `clogging`, `queues`, `clearing`,
    `waiting_times`, `n_t`, `queue_lengths` and `maps` define the columns.

    Args:
        trajectories: the run.
        plan: its floor plan, or its building.
        directory: folder to write to, created if need be.
        rooms: named areas, beside those of the plan (`rooms_of`).
        cell: side of the cells of maps, metres.
        every: seconds between the measurements of maps.
        title: first line of the pictures.
        progress: called with what is being done.

    Raises:
        ResultsError: the folder or a file cannot be written, rooms that are not on the plan, or
            what these functions refuse.
    """
    from mesa_mobility.results.engineering.pictures import plot_map

    named = check_rooms([*rooms_of(plan), *rooms], plan)
    with all_or_none(directory, RESULT_FILES) as temporary:
        progress("tables")
        for name, table in _tables(trajectories, plan, named):
            table.to_csv(temporary / name, index=False, float_format="%.6g")
        progress("maps")
        found = maps_by_type(trajectories, plan, cell=cell, every=every)
        _table_of_maps(found).to_csv(temporary / "maps.csv", index=False, float_format="%.6g")
        progress("pictures")
        for name, what in PICTURES.items():
            plot_map(found[EVERYBODY], trajectories, plan, temporary / name, what=what, title=title)


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


def _table_of_maps(found: Mapping[str, Mapping[int, FloorMaps]]) -> pd.DataFrame:
    """Rows of all cells by type and level."""
    import pandas as pd

    tables = {
        (name, level): own.to_pandas()
        for name, each in found.items()
        for level, own in each.items()
    }
    whole = pd.concat(list(tables.values()), keys=list(tables), names=["type", "level"])
    return whole.reset_index(["type", "level"])


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
