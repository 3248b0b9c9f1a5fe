"""A format of runs: a table in CSV."""

from __future__ import annotations

from pathlib import Path

from mesa_mobility.errors import ResultsError
from mesa_mobility.results import Excerpt, OutputFormat


class Csv(OutputFormat):
    """Table in CSV: time, person, x and y."""

    name = "csv"
    suffixes = (".csv",)

    def write(self, excerpt: Excerpt, path: Path, *, every: int = 30) -> None:
        """Write a row for each person at each time.

        Args:
            excerpt: the run, or the part of it that was asked for.
            path: the file.
            every: frames from one time to the next.

        Raises:
            ResultsError: the file cannot be written.
        """
        tracks = excerpt.tracks()
        table = tracks.to_pandas()
        table = table[table["frame"] % every == 0]
        table = table.assign(time=table["frame"] / tracks.frame_rate)
        try:
            table[["time", "person", "x", "y"]].to_csv(path, index=False, float_format="%.3f")
        except OSError as error:
            raise ResultsError(f"{path}: cannot be written ({error.strerror})") from error
