"""Hand-written LLVM code, and plain Numba that takes its place.

Plain Numba does the same, to the last bit, only more slowly. It is taken for all of the
hand-written code where that cannot be compiled, with another llvmlite say, and where the
environment variable MESA_MOBILITY_PLAIN is 1. People then decide in one thread, as what several
threads need of one another is among it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from llvmlite import binding, ir
from numba.extending import intrinsic

from mesa_mobility.compiled import vectors
from mesa_mobility.compiled.cache import PLAIN_WANTED
from mesa_mobility.compiled.decorators import force_inlined

_WIDTH = 8


def _compiles() -> bool:
    """Whether LLVM compiles the instructions of hand-written code."""
    try:
        module = ir.Module()
        taken = [vectors.DOUBLE.as_pointer(), vectors.LONG.as_pointer(), vectors.LONG]
        function = ir.Function(module, ir.FunctionType(vectors.LONG, taken), "everything")
        builder = ir.IRBuilder(function.append_basic_block())
        numbers, counts, at = function.args
        numbers, counts = (
            vectors.Start(numbers, vectors.DOUBLE),
            vectors.Start(counts, vectors.LONG),
        )
        given = vectors.load(builder, numbers, at, _WIDTH)
        vectors.store(builder, vectors.more_of(builder, given, given), numbers, at)
        most = vectors.some_lanes(builder, given, range(_WIDTH // 2))
        spread = vectors.spread(builder, at, _WIDTH // 2)
        least = builder.fcmp_ordered("<", most, vectors.some_lanes(builder, given, range(4, 8)))
        lane = builder.select(least, spread, vectors.spread(builder, at, _WIDTH // 2))
        place = vectors.place_in(builder, counts, at)
        vectors.store_release(builder, vectors.take_number(builder, place), place)
        vectors.prefetch(builder, vectors.bytes_of(builder, place).pointer)
        seen = vectors.load_acquire(builder, place)
        builder.ret(builder.add(seen, builder.extract_element(lane, ir.Constant(vectors.INT, 0))))
        binding.parse_assembly(str(module)).verify()
    # Another llvmlite may raise any exception.
    except Exception:
        return False
    return True


PLAIN: bool = PLAIN_WANTED or not _compiles()
"""Whether plain Numba takes the place of hand-written code."""


def with_twin(twin: Callable[..., Any]) -> Callable[[Callable[..., Any]], Any]:
    """A decorator: ``numba.extending.intrinsic``, or the twin where plain Numba is taken.

    Args:
        twin: a function in plain Numba that does the same to the last bit.
    """

    def choose(typing: Callable[..., Any]) -> Any:
        return force_inlined()(twin) if PLAIN else intrinsic(typing)

    return choose
