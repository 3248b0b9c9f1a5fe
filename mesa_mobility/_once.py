"""A cache that computes each value once, also if several threads need it at the same time."""

from __future__ import annotations

import threading
from collections.abc import Callable
from functools import lru_cache, wraps
from typing import ParamSpec, TypeVar

Given = ParamSpec("Given")
Result = TypeVar("Result")


def cached_once(maxsize: int) -> Callable[[Callable[Given, Result]], Callable[Given, Result]]:
    """``lru_cache`` for large values: no two threads compute the same one.

    Args:
        maxsize: number of values that are kept.
    """

    def decorate(function: Callable[Given, Result]) -> Callable[Given, Result]:
        # One value may be needed to compute another: a map borrows from a map.
        cached, lock = lru_cache(maxsize)(function), threading.RLock()

        @wraps(function)
        def once(*arguments: Given.args, **keywords: Given.kwargs) -> Result:
            with lock:
                return cached(*arguments, **keywords)  # type: ignore[arg-type]

        return once

    return decorate
