"""Numbers as pages of reports have them."""

from __future__ import annotations

import math
from typing import Any


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
