"""Trajectories in the forms that other tools of the field read.

The track of a person who leaves ends with the first frame beyond the exit. PedPy leaves out the
movement into the last frame of a track, so nobody would cross the line of an exit. Exports for
analysis therefore have ``BEYOND`` rows more: the person walks straight on, at the velocity of the
step across the exit. They are made here and not recorded, so that no measure of our own takes
anybody beyond an exit for somebody inside. Those whom a program takes out walk on as well: tracks
do not tell them apart.
"""

from __future__ import annotations

import os
import sqlite3
import zlib
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely

from mesa_mobility.errors import ResultsError
from mesa_mobility.files.atomic import replacing
from mesa_mobility.results.columns import COLUMNS

if TYPE_CHECKING:
    import pandas as pd
    import pedpy

    from mesa_mobility.results.trajectories import Trajectories

JUPEDSIM_VERSION = 2
BEYOND = 3
"""Frames for which people walk on beyond the exit."""
# Rows handed over together: bounds the Python objects alive at a time.
CHUNK = 100_000

JUPEDSIM_TABLES = """
CREATE TABLE trajectory_data (
    frame INTEGER NOT NULL, id INTEGER NOT NULL, pos_x REAL NOT NULL, pos_y REAL NOT NULL,
    ori_x REAL NOT NULL, ori_y REAL NOT NULL);
CREATE TABLE metadata (key TEXT NOT NULL UNIQUE PRIMARY KEY, value TEXT NOT NULL);
CREATE TABLE geometry (hash INTEGER NOT NULL, wkt TEXT NOT NULL);
CREATE TABLE frame_data (frame INTEGER NOT NULL, geometry_hash INTEGER NOT NULL);
"""


def to_pandas(trajectories: Trajectories) -> pd.DataFrame:
    """Trajectories as a data frame; see ``Trajectories.to_pandas``."""
    import pandas as pd

    columns: dict[str, Any] = {name: getattr(trajectories, name) for name in COLUMNS}
    columns |= trajectories.fields
    for name, values in trajectories.person_data.items():
        if values.dtype.kind == "U":
            texts, codes = np.unique(values, return_inverse=True)
            columns[name] = pd.Categorical.from_codes(
                codes[trajectories.person], categories=pd.Index(texts.tolist())
            )
        else:
            columns[name] = values[trajectories.person]
    return pd.DataFrame(columns)


def to_pedpy(trajectories: Trajectories) -> pedpy.TrajectoryData:
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
    trajectories = _walked_on(trajectories)
    data = pd.DataFrame(
        {
            "id": trajectories.person.astype(np.int64),
            "frame": trajectories.frame.astype(np.int64),
            "x": trajectories.x,
            "y": trajectories.y,
        }
    )
    return pedpy.TrajectoryData(data=data, frame_rate=trajectories.frame_rate)


def write_jupedsim_sqlite(
    trajectories: Trajectories,
    path: str | os.PathLike[str],
    walkable: shapely.Geometry,
) -> None:
    """Write a JuPedSim trajectory database, version 2, as its viewer, jupedsim and PedPy read it.

    A table ``person_data`` beside JuPedSim's own has the type of each person and the like. People
    who left walk on for ``BEYOND`` frames, as in ``to_pedpy``.

    Args:
        trajectories: the run; the direction that each person faces goes into ori_x, ori_y.
        path: file to write.
        walkable: area that people can stand on, metres (`FloorPlan.free`).

    Raises:
        ResultsError: no rows, or the file cannot be written.
    """
    trajectories = _walked_on(trajectories)
    wkt = shapely.to_wkt(walkable, rounding_precision=-1)
    # JuPedSim only matches this number between its tables; its own, Python's hash(), changes
    # from process to process.
    geometry = zlib.crc32(wkt.encode())
    metadata = {
        "version": JUPEDSIM_VERSION,
        "fps": float(trajectories.frame_rate),
        "xmin": float(trajectories.x.min()),
        "xmax": float(trajectories.x.max()),
        "ymin": float(trajectories.y.min()),
        "ymax": float(trajectories.y.max()),
    }
    with replacing(path, ResultsError) as temporary:
        try:
            connection = sqlite3.connect(temporary)
            try:
                with connection:
                    connection.executescript(JUPEDSIM_TABLES)
                    connection.executemany("INSERT INTO metadata VALUES (?, ?)", metadata.items())
                    connection.execute("INSERT INTO geometry VALUES (?, ?)", (geometry, wkt))
                    connection.executemany(
                        "INSERT INTO frame_data VALUES (?, ?)",
                        ((frame, geometry) for frame in range(trajectories.frames)),
                    )
                    _insert_rows(connection, trajectories)
                    _insert_people(connection, trajectories)
                    connection.execute("CREATE INDEX frame_id_idx ON trajectory_data (frame, id)")
            finally:
                connection.close()
        except sqlite3.Error as error:
            raise ResultsError(f"{path}: cannot be written: {error}") from error


def _insert_rows(connection: sqlite3.Connection, trajectories: Trajectories) -> None:
    for first in range(0, len(trajectories), CHUNK):
        rows = slice(first, first + CHUNK)
        columns = (
            trajectories.frame[rows],
            trajectories.person[rows],
            trajectories.x[rows],
            trajectories.y[rows],
            np.cos(trajectories.heading[rows]),
            np.sin(trajectories.heading[rows]),
        )
        connection.executemany(
            "INSERT INTO trajectory_data VALUES (?, ?, ?, ?, ?, ?)",
            zip(*(column.tolist() for column in columns), strict=True),
        )


def _insert_people(connection: sqlite3.Connection, trajectories: Trajectories) -> None:
    names = list(trajectories.person_data)
    if not names:
        return
    # Names are identifiers: see ``checked_person_data``.
    columns = "".join(f', "{name}"' for name in names)
    connection.execute(f"CREATE TABLE person_data (id INTEGER NOT NULL PRIMARY KEY{columns})")
    people = np.unique(trajectories.person)
    values = [trajectories.person_data[name][people].tolist() for name in names]
    marks = ", ".join("?" * (1 + len(names)))
    connection.executemany(
        f"INSERT INTO person_data VALUES ({marks})", zip(people.tolist(), *values, strict=True)
    )


def write_juelich_text(trajectories: Trajectories, path: str | os.PathLike[str]) -> None:
    """Write the text form of the Juelich data archive: lines of ID, frame, x, y, z in metres.

    Coordinates are rounded to 0.1 mm and z is 0. PedPy and JPSreport read it. People who left walk
    on for ``BEYOND`` frames, as in ``to_pedpy``.

    Raises:
        ResultsError: no rows, or the file cannot be written.
    """
    trajectories = _walked_on(trajectories)
    order = trajectories.by_person
    with (
        replacing(path, ResultsError) as temporary,
        temporary.open("w", encoding="utf-8", newline="\n") as file,
    ):
        file.write(f"# framerate: {trajectories.frame_rate:g}\n# id frame x/m y/m z/m\n")
        for first in range(0, len(order), CHUNK):
            rows = order[first : first + CHUNK]
            columns = (
                trajectories.person[rows],
                trajectories.frame[rows],
                trajectories.x[rows],
                trajectories.y[rows],
            )
            file.writelines(
                f"{person} {frame} {x:.4f} {y:.4f} 0\n"
                for person, frame, x, y in zip(*(c.tolist() for c in columns), strict=True)
            )


def _walked_on(trajectories: Trajectories) -> Trajectories:
    """The rows, and those of people who walk on beyond an exit; for export alone.

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
        fields={},
        decisions=None,
    )
