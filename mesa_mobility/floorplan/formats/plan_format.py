"""The base class of formats of floor plan files, and all that are installed."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.formats.content import Content
from mesa_mobility.floorplan.formats.storeys import Storeys
from mesa_mobility.plugins.formats import READ, Format, Formats
from mesa_mobility.plugins.registry import PLAN_FORMATS

if TYPE_CHECKING:
    from mesa_mobility.floorplan.floor.floor import Floor


class PlanFormat(Format):
    """A kind of file that holds a floor plan: a class with ``read``, ``write`` or both.

    Keyword-only parameters of these methods are the options of the format.

    """

    def has_people(self, path: Path) -> bool:
        """Whether a file is a scenario with people, which ``read`` puts into the content.

        Raises:
            FloorPlanError: the file cannot be read.
        """
        return False

    def read(self, path: Path) -> Content | Storeys:
        """The content of a file: one floor, or several storeys and what joins them.

        Args:
            path: the file.

        Raises:
            FloorPlanError: the file cannot be read, or is no floor plan; the message names the
                file and the place in it.
        """
        raise NotImplementedError

    def write(self, plan: Floor, path: Path) -> None:
        """Write a plan to a file, complete or not at all.

        Args:
            plan: the plan.
            path: the file.

        Raises:
            FloorPlanError: the file cannot be written.
        """
        raise NotImplementedError


PLANS = Formats(PLAN_FORMATS, PlanFormat, FloorPlanError)
"""The installed formats of floor plans."""


def plan_suffixes() -> list[str]:
    """The usual suffix of each format that a floor plan can be read from, such as ".wkt"."""
    return PLANS.usual(READ)
