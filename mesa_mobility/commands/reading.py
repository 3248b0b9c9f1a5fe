"""Options of commands that read measured tracks."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from mesa_mobility.results import Trajectories


@dataclass(frozen=True)
class TracksOptions:
    """Unit and frame rate of measured tracks whose file does not tell them."""

    unit: Annotated[
        str | None, typer.Option(help="Unit, m, cm or mm, of a file that does not tell it.")
    ] = None
    frame_rate: Annotated[
        float | None,
        typer.Option(metavar="N", help="Frames a second of a file that does not tell them."),
    ] = None

    def read(self, file: Path) -> Trajectories:
        """The tracks of a file.

        Raises:
            ResultsError: a file that is no such file, or says other than the options.
        """
        from mesa_mobility.results import Trajectories

        return Trajectories.read(file, self.unit, self.frame_rate)
