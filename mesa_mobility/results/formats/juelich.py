"""Trajectories in the text form of the Juelich data archive."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from mesa_mobility.errors import ResultsError
from mesa_mobility.files.atomic import replacing
from mesa_mobility.results.formats.export import CHUNK, walked_on
from mesa_mobility.results.formats.output_format import OutputFormat
from mesa_mobility.results.reading.rows import Rows
from mesa_mobility.results.reading.text import ELEVATIONS, read_text
from mesa_mobility.results.tracks import Tracks

if TYPE_CHECKING:
    from mesa_mobility.results.excerpts import Excerpt


class Juelich(OutputFormat):
    """Text of the Juelich data archive, which PedPy and JPSreport read."""

    name = "juelich"
    suffixes = (".txt",)
    storeys = True

    def write(self, excerpt: Excerpt, path: Path) -> None:
        """See ``write_juelich_text``."""
        write_juelich_text(excerpt.tracks(), path)

    def read(self, path: Path) -> Rows:
        """See ``mesa_mobility.results.reading.text.read_text``."""
        return read_text(path)


def write_juelich_text(trajectories: Tracks, path: str | os.PathLike[str]) -> None:
    """Write the text form of the Juelich data archive: lines of ID, frame, x, y, z in metres.

    Coordinates are rounded to 0.1 mm. z is the elevation of the floor where people walked in a
    building, which a comment line says, and 0 elsewhere. PedPy and JPSreport read the file. People
    who left walk on for ``BEYOND`` frames, as in ``to_pedpy``.

    Raises:
        ResultsError: no rows, or the file cannot be written.
    """
    trajectories = walked_on(trajectories)
    order, elevated = trajectories.by_person, "z" in trajectories.fields
    with (
        replacing(path, ResultsError) as temporary,
        temporary.open("w", encoding="utf-8", newline="\n") as file,
    ):
        file.write(f"# framerate: {trajectories.frame_rate:g}\n# id frame x/m y/m z/m\n")
        if elevated:
            file.write(f"# {ELEVATIONS}\n")
        for first in range(0, len(order), CHUNK):
            rows = order[first : first + CHUNK]
            columns = (
                trajectories.person[rows],
                trajectories.frame[rows],
                trajectories.x[rows],
                trajectories.y[rows],
                trajectories.z[rows],
            )
            file.writelines(
                f"{person} {frame} {x:.4f} {y:.4f} {f'{z:.4f}' if elevated else 0}\n"
                for person, frame, x, y, z in zip(*(c.tolist() for c in columns), strict=True)
            )
