"""Trajectories as a database of JuPedSim."""

from __future__ import annotations

import os
import sqlite3
import zlib
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import shapely

from mesa_mobility.errors import ResultsError
from mesa_mobility.files.atomic import replacing
from mesa_mobility.results.formats.export import CHUNK, walked_on
from mesa_mobility.results.formats.output_format import OutputFormat
from mesa_mobility.results.reading.rows import Rows
from mesa_mobility.results.tracks import Tracks

if TYPE_CHECKING:
    from mesa_mobility.results.excerpts import Excerpt

JUPEDSIM_VERSION = 2

JUPEDSIM_TABLES = """
CREATE TABLE trajectory_data (
    frame INTEGER NOT NULL, id INTEGER NOT NULL, pos_x REAL NOT NULL, pos_y REAL NOT NULL,
    ori_x REAL NOT NULL, ori_y REAL NOT NULL);
CREATE TABLE metadata (key TEXT NOT NULL UNIQUE PRIMARY KEY, value TEXT NOT NULL);
CREATE TABLE geometry (hash INTEGER NOT NULL, wkt TEXT NOT NULL);
CREATE TABLE frame_data (frame INTEGER NOT NULL, geometry_hash INTEGER NOT NULL);
"""


class JuPedSim(OutputFormat):
    """Trajectory database that JuPedSim's viewer and PedPy read."""

    name = "jupedsim"
    suffixes = (".sqlite",)

    def write(self, excerpt: Excerpt, path: Path) -> None:
        """See ``write_jupedsim_sqlite``."""
        write_jupedsim_sqlite(excerpt.tracks(), path, excerpt.floor_plan.free)

    def read(self, path: Path) -> Rows:
        """See ``read_jupedsim_sqlite``."""
        return read_jupedsim_sqlite(path)


def read_jupedsim_sqlite(path: Path) -> Rows:
    """Read a JuPedSim trajectory database.

    Returns:
        Positions in metres, and as ``heading`` the directions that people face, in radians.
        ``frame_rate`` is None if the metadata have no ``fps``.

    Raises:
        ResultsError: the file cannot be read, lacks tables or columns, or has a frame rate that is
            no number.
    """
    # An absent file would be created, and a file of another kind is no reason to write beside it.
    try:
        with closing(sqlite3.connect(f"{path.resolve().as_uri()}?mode=ro", uri=True)) as database:
            rows = database.execute(
                "SELECT id, frame, pos_x, pos_y, ori_x, ori_y FROM trajectory_data"
            ).fetchall()
            rate = database.execute("SELECT value FROM metadata WHERE key = 'fps'").fetchone()
        person, frame, x, y, ori_x, ori_y = np.array(rows, dtype=np.float64).reshape(-1, 6).T
        frame_rate = None if rate is None else float(rate[0])
    except (sqlite3.Error, ValueError, TypeError) as error:
        raise ResultsError(f"{path}: not a readable JuPedSim database: {error}") from error
    heading = np.arctan2(ori_y, ori_x)
    return Rows(person, frame, x, y, heading, unit="m", frame_rate=frame_rate)


def write_jupedsim_sqlite(
    trajectories: Tracks,
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
    trajectories = walked_on(trajectories)
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


def _insert_rows(connection: sqlite3.Connection, trajectories: Tracks) -> None:
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


def _insert_people(connection: sqlite3.Connection, trajectories: Tracks) -> None:
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
