"""How the functions of the hot path are compiled.

Without counting references to arrays: they neither make nor keep any. The crowd's state alone is
some 30 arrays, and to count references to them all at each call of a function of a few
nanoseconds took longer than what the function does.  A division by zero gives inf or nan, as
in NumPy: the test for it would keep a loop from running several items at once.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial, update_wrapper
from typing import Any

from numba import njit, typeof

called = partial(
    njit, cache=True, error_model="numpy", nogil=True, _nrt=False, no_cfunc_wrapper=True
)
"""For functions that Python calls, from several threads at a time if need be."""

lean = partial(called, cache=False, no_cpython_wrapper=True)
"""For functions that only compiled ones call: a call from Python would crash it. They are kept on
disk with whatever calls them."""

woven = partial(lean, inline="always")
"""For long functions that one place in compiled code calls: they are compiled as part of it, which
takes a sixth less. More than one level of it, or several in one function, takes Numba longer."""

part = partial(lean, forceinline=True)
"""For parts of a larger function, called from one place: they get hundreds of numbers, as each
array is some eight, and to hand them on takes longer than much of what is done with them."""


class Entry:
    """A compiled function that is always given arguments of the types of its first call.

    For one of a module that is the first call in the process, whoever makes it. That spares Numba
    the look-up of these types, which for tuples of arrays takes longer than all else about a call.
    Nobody looks at them any more: other ones crash it, arrays less contiguous than the first ones
    are misread.

    Args:
        function: one that Numba compiles; ``__wrapped__`` is it.
    """

    __wrapped__: Any

    def __init__(self, function: Any) -> None:
        update_wrapper(self, function, updated=())
        self._call: Callable[..., Any] | None = None

    def __call__(self, *arguments: Any) -> Any:
        """What the function gives."""
        if self._call is None:
            self._call = self.__wrapped__.compile(tuple(map(typeof, arguments)))
        return self._call(*arguments)
