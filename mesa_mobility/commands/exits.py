"""Options of commands that read a floor plan."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from mesa_mobility.floorplan import FloorPlan


@dataclass(frozen=True)
class ExitOptions:
    """Exits of a floor plan whose file has none, and the level of a file that has several."""

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
    level: Annotated[
        str | None,
        typer.Option(
            help="Number or name of one level of a file that has several, which is then the plan."
        ),
    ] = None

    @property
    def text(self) -> str | None:
        """What is asked for, as ``FloorPlan.from_file`` takes it."""
        if self.exit_lines and self.exits is not None:
            raise typer.BadParameter("--exits: got --exit as well, expected one of the two")
        return "; ".join(self.exit_lines) if self.exit_lines else self.exits

    def keywords(self) -> dict[str, Any]:
        """Arguments of a model of a floor plan: ``exits`` and ``level``, if they are given."""
        given = {"exits": self.text, "level": self.level}
        return {name: value for name, value in given.items() if value is not None}

    def floor_plan(self, path: Path) -> FloorPlan:
        """The floor plan of a file.

        Raises:
            FloorPlanError: the file cannot be read, or has several levels and none is named.
        """
        from mesa_mobility.buildings import Building, read_floor
        from mesa_mobility.errors import FloorPlanError

        found = read_floor(path, self.text, level=self.level)
        if isinstance(found, Building):
            numbers = ", ".join(str(each.number) for each in found.levels)
            raise FloorPlanError(f"{path}: has the levels {numbers}, expected --level with one")
        return found
