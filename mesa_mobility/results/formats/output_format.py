"""What a format of files of a run is, and all that are installed."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

from mesa_mobility.errors import ResultsError
from mesa_mobility.plugins.formats import Format, Formats
from mesa_mobility.plugins.registry import OUTPUT_FORMATS

if TYPE_CHECKING:
    from mesa_mobility.results.excerpts import Excerpt
    from mesa_mobility.results.reading.rows import Rows
    from mesa_mobility.results.tracks import Tracks


class OutputFormat(Format):
    """A kind of file that a run is written to, or that tracks are read from.

    It is a class with ``write``, ``read`` or both. Keyword-only parameters of ``write`` are the
    options of the format.

    Attributes:
        storeys: whether ``write`` takes runs in buildings of several levels as a whole; others take
            one level.
    """

    storeys: ClassVar[bool] = False

    def write(self, excerpt: Excerpt, path: Path) -> None:
        """Write a run or a part of it, complete or not at all.

        Args:
            excerpt: what to write.
            path: the file, or the folder where a format has several files.

        Raises:
            ResultsError: the file cannot be written, or the run lacks what it takes.
        """
        raise NotImplementedError

    def read(self, path: Path) -> Rows | Tracks:
        """Read the tracks of a file, for ``Trajectories.read``.

        Args:
            path: the file, which exists.

        Returns:
            Rows as the file has them, whose unit and headings are found afterwards; or tracks,
            if the file says everything itself.

        Raises:
            ResultsError: the file cannot be read.
        """
        raise NotImplementedError


OUTPUTS = Formats(OUTPUT_FORMATS, OutputFormat, ResultsError)
"""The installed formats of runs."""
