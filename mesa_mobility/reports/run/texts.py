"""Numbers as pages of reports have them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from mesa_mobility.floorplan import FloorPlan

if TYPE_CHECKING:
    from mesa_mobility.buildings import Building


def number(value: Any, digits: int = 1, unit: str = "") -> str:
    """A number with so many digits behind the point, or a dash where there is none.

    Args:
        value: number, None or nan.
        digits: behind the point.
        unit: behind the number.
    """
    if value is None or not math.isfinite(value):
        return "-"
    return f"{value:.{digits}f}" + (f" {unit}" if unit else "")


def count(number_of: int, what: str, more: str = "") -> str:
    """How many of something: "1 exit", "2 exits".

    Args:
        number_of: how many.
        what: one of them.
        more: several of them; by default with an s.
    """
    return f"{number_of:,} {what if number_of == 1 else more or what + 's'}"


def in_words(name: str) -> str:
    """A name of the code in words: without underscores."""
    return name.replace("_", " ")


def level_words(plan: FloorPlan | Building) -> dict[int, str]:
    """What the levels of a building are called: number and name; nothing for a floor plan."""
    if isinstance(plan, FloorPlan):
        return {}
    return {
        each.number: f"{each.number} ({each.name})" if each.name else str(each.number)
        for each in plan.levels
    }
