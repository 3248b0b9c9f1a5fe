"""Which parameters a kernel reads: compiled code does not notice an index past the end."""

from __future__ import annotations

import dis
from collections.abc import Callable, Iterator
from typing import Any

_IDLE = {"CACHE", "NOP", "EXTENDED_ARG", "RESUME"}


def parameters_read(function: Callable[..., float]) -> set[int]:
    """Constant indices at which a kernel reads its last argument, ``parameters``."""
    code = function.__code__
    last = code.co_varnames[code.co_argcount - 1]
    steps = [step for step in dis.get_instructions(code) if step.opname not in _IDLE]
    return set(_indices(steps, last))


def _indices(steps: list[Any], last: str) -> Iterator[int]:
    for loaded, index, read in zip(steps, steps[1:], steps[2:], strict=False):
        names = loaded.argval if isinstance(loaded.argval, tuple) else (loaded.argval,)
        subscript = read.opname == "BINARY_SUBSCR" or read.argrepr == "[]"
        if (
            loaded.opname.startswith("LOAD_FAST")
            and names[-1] == last
            and index.opname in ("LOAD_CONST", "LOAD_SMALL_INT")
            and isinstance(index.argval, int)
            and subscript
        ):
            yield index.argval
