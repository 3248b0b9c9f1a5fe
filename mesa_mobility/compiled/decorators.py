"""Decorators with which functions of the hot path are compiled.

They do not count references to arrays, so functions must neither make nor keep arrays. The crowd's
state alone is some 30 arrays, and counting references at each call took longer than what a
function of a few nanoseconds does.  A division by zero gives inf or nan, as in NumPy: a test for it
would prevent vectorised loops.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial, update_wrapper
from typing import Any

from numba import njit, typeof

from mesa_mobility.compiled.cache import keep


def kept(**options: Any) -> Callable[[Callable[..., Any]], Any]:
    """A decorator like ``numba.njit`` with these options, with compiled code kept on disk."""

    def decorate(function: Callable[..., Any]) -> Any:
        return keep(njit(**options)(function))

    return decorate


_CALLED = {"error_model": "numpy", "nogil": True, "_nrt": False, "no_cfunc_wrapper": True}

entry_point = partial(kept, **_CALLED)
"""For functions that Python calls, possibly from several threads at once."""

internal = partial(njit, **_CALLED, no_cpython_wrapper=True)
"""For functions that only compiled ones call: a call from Python crashes the process. They are kept
on disk with their callers."""

inlined = partial(internal, inline="always")
"""For long functions with one caller, compiled as part of it, which takes a sixth less time.
Several in one function, or several levels of them, take Numba longer."""

force_inlined = partial(internal, forceinline=True)
"""For parts of a larger function with one caller. An array is passed as some eight numbers, and
passing hundreds of them takes longer than much of what is done with them."""


class Entry:
    """A compiled function that is always given arguments of the types of its first call.

    That spares Numba the look-up of these types, which for tuples of many arrays takes longer than
    all else about a call. Other types crash it, and arrays less contiguous than the first ones are
    misread: it is for decisions alone, where it is worth 3 in 100 of a run.

    Args:
        function: a function compiled by Numba, available as ``__wrapped__``.
    """

    __wrapped__: Any

    def __init__(self, function: Any) -> None:
        update_wrapper(self, function, updated=())
        self._call: Callable[..., Any] | None = None

    def __deepcopy__(self, memo: dict[int, Any]) -> Entry:
        """An entry of the same function that takes the types of its own first call."""
        return Entry(self.__wrapped__)

    def __call__(self, *arguments: Any) -> Any:
        """Call the function."""
        if self._call is None:
            self._call = self.__wrapped__.compile(tuple(map(typeof, arguments)))
        return self._call(*arguments)
