"""Options of commands that read a floor plan."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

import typer


@dataclass(frozen=True)
class ExitOptions:
    """Exits of a floor plan whose file has none."""

    exit_lines: Annotated[
        list[str] | None,
        typer.Option(
            "--exit",
            metavar="'X Y, X Y'",
            help="Both ends of an exit of a floor plan whose file has none, within 1.2 m of the "
            "edge, metres; repeatable.",
        ),
    ] = None
    exits: Annotated[
        str | None,
        typer.Option(
            "--exits",
            metavar="longest|FILE",
            help="longest: a door of 1.2 m in the middle of the longest straight outer edge; or a "
            "file with a line NAME X Y, X Y for each exit. Ignored if the plan has exits.",
        ),
    ] = None

    @property
    def text(self) -> str | None:
        """What is asked for, as ``FloorPlan.from_file`` takes it."""
        if self.exit_lines and self.exits is not None:
            raise typer.BadParameter("--exits: got --exit as well, expected one of the two")
        return "; ".join(self.exit_lines) if self.exit_lines else self.exits

    def keywords(self) -> dict[str, Any]:
        """Arguments of a model of a floor plan: ``exits``, if something is asked for."""
        return {} if self.text is None else {"exits": self.text}
