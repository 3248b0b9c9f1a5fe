"""What counts as a number where users give one."""

from __future__ import annotations

import math
from numbers import Real
from typing import TypeGuard


def is_number(value: object) -> TypeGuard[float]:
    """Whether a value is a real number, and not a truth value, text or NaN.

    NumPy's numbers and infinite numbers count.  Whole numbers too large for a float do not.
    """
    if isinstance(value, bool) or not isinstance(value, Real):
        return False
    try:
        return not math.isnan(float(value))
    except OverflowError:
        return False
