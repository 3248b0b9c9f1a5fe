"""What counts as a number where users give one."""

from __future__ import annotations

import math
from numbers import Real
from typing import TypeGuard


def is_number(value: object) -> TypeGuard[float]:
    """Whether this is a real number: neither a truth value nor text, and not NaN.

    NumPy's numbers count, and infinite ones; whole numbers too large for a float do not.
    """
    if isinstance(value, bool) or not isinstance(value, Real):
        return False
    try:
        return not math.isnan(float(value))
    except OverflowError:
        return False
