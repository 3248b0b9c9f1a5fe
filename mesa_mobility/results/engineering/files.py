"""The figures of a run as CSV files and pictures, for reports and spreadsheets."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING

from mesa_mobility.results.engineering.maps import FloorMaps
from mesa_mobility.results.engineering.measured import Measured
from mesa_mobility.results.files import all_or_none
from mesa_mobility.results.measures.by_type import EVERYBODY

if TYPE_CHECKING:
    import pandas as pd

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
    measured: Measured,
    directory: str | os.PathLike[str],
    *,
    title: str = "",
    progress: Callable[[str], None] = lambda what: None,
) -> None:
    """Write tables and pictures of a run, all of them or none.

    ``doors.csv``, ``clearing.csv``, ``waiting.csv`` and ``maps.csv`` have rows of everybody ("all")
    and of each type; clogs are those of everybody. ``n_t.csv`` and ``queues.csv`` have the curves
    of each door. A field that has no value is empty. `doors`, `clogging`, `queues`, `clearing`,
    `waiting_times`, `n_t`, `queue_lengths` and `maps` define the columns.

    Args:
        measured: the figures, from `measure`.
        directory: folder to write to, created if need be.
        title: first line of the pictures.
        progress: called with what is being done.

    Raises:
        ResultsError: the folder or a file cannot be written.
    """
    from mesa_mobility.results.engineering.pictures import plot_map

    run = measured.trajectories, measured.plan
    with all_or_none(directory, RESULT_FILES) as temporary:
        for name, table in _tables(measured):
            table.to_csv(temporary / name, index=False, float_format="%.6g")
        progress("pictures")
        for name, what in PICTURES.items():
            plot_map(measured.maps[EVERYBODY], *run, temporary / name, what=what, title=title)


def _tables(measured: Measured) -> Iterator[tuple[str, pd.DataFrame]]:
    """Name and content of each file."""
    yield "doors.csv", measured.doors.reset_index()
    yield "clearing.csv", measured.clearing.reset_index()
    yield "waiting.csv", measured.waiting.reset_index()
    yield "n_t.csv", measured.n_t
    yield "queues.csv", measured.queues
    yield "maps.csv", _table_of_maps(measured.maps)


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
