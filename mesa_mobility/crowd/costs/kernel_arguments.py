"""What a kernel asks for: the records that it takes, and the fields that it reads of them."""

from __future__ import annotations

import dis
from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

from mesa_mobility.crowd.costs.records import RECORDS
from mesa_mobility.errors import ModelError
from mesa_mobility.plugins.registry import did_you_mean

NUMBERS = "p"
"""The argument by which a kernel reads attributes of its term."""

_TAKES_MORE = 0x0C
"""Flags of functions that take ``*args`` or ``**keywords``."""

_IDLE = {"CACHE", "NOP", "EXTENDED_ARG", "RESUME"}

_READS = {"LOAD_ATTR", "LOAD_METHOD"}

_LOOSE = 3
"""From this many arguments that are no records on, a kernel is taken for one of loose numbers."""


class Reads(NamedTuple):
    """How a function uses one of its arguments.

    Attributes:
        fields: names of the attributes that it reads, in the order of the code.
        whole: whether it also uses the argument in another way, such as in a call.
    """

    fields: tuple[str, ...]
    whole: bool


def arguments_of(function: Callable[..., float], known: Sequence[str]) -> tuple[str, ...]:
    """Names of the arguments of a kernel's function.

    Args:
        function: the function.
        known: arguments that the function may ask for.

    Raises:
        ModelError: the function asks for something else.
    """
    code = function.__code__
    names = code.co_varnames[: code.co_argcount]
    unknown = [name for name in names if name not in known]
    called, form = f"kernel {function.__name__}", ", ".join(known)
    if len(unknown) >= _LOOSE:
        raise ModelError(
            f"{called}: takes loose numbers ({', '.join(unknown[:_LOOSE])}, ...), expected "
            f"records: def {function.__name__}({form}), with option.x, me.target_x, p.name"
        )
    if unknown:
        meant = did_you_mean(unknown[0], dict.fromkeys(known))
        raise ModelError(
            f"{called}: no record {unknown[0]!r}{meant or f', expected any of {form}'}"
        )
    if code.co_kwonlyargcount or code.co_flags & _TAKES_MORE:
        raise ModelError(f"{called}: expected arguments of its own, any of {form}")
    return names


def reads_of(function: Callable[..., float], name: str) -> Reads:
    """How a function uses its argument of this name."""
    fields: dict[str, None] = {}
    whole = False
    for field in _uses(function, name):
        if field is None:
            whole = True
        else:
            fields[field] = None
    return Reads(tuple(fields), whole)


def _uses(function: Callable[..., float], name: str) -> Iterator[str | None]:
    """The attribute that each use of a local variable reads; None for another use."""
    steps = [step for step in dis.get_instructions(function) if step.opname not in _IDLE]
    # Code ends with a return, which uses no name.
    for step, following in pairwise(steps):
        names = step.argval if isinstance(step.argval, tuple) else (step.argval,)
        local = any(word in step.opname for word in ("FAST", "CELL", "DEREF", "CLOSURE"))
        if not local or name not in names:
            continue
        # Of two variables in one instruction the second is the one that is read next.
        last = names[-1] == name and "LOAD" in step.opname
        if last and following.opname in _READS:
            yield following.argval
        if names.count(name) > 1 or not (last and following.opname in _READS):
            yield None


def check_fields_read(
    function: Callable[..., float], arguments: Sequence[str], declared: Sequence[str]
) -> None:
    """Raise ModelError where a kernel reads a field that a record does not have.

    Args:
        function: of the kernel.
        arguments: its arguments.
        declared: fields of people that it takes from the model.
    """
    for name in arguments:
        fields, whole = reads_of(function, name)
        if name == NUMBERS:
            if whole or any(field.startswith("_") for field in fields):
                raise ModelError(
                    f"kernel {function.__name__}: reads p otherwise than by a name, expected such "
                    "as p.width for the term's attribute width"
                )
            continue
        known = list(RECORDS[name]._fields)
        if name in ("me", "other"):
            known += declared
        wrong = next((field for field in fields if field not in known), None)
        if wrong is not None:
            meant = did_you_mean(wrong, dict.fromkeys(known)) or f", it has {', '.join(known)}"
            if name in ("me", "other"):
                meant += f"; a field of the model is asked for by fields=({wrong!r},)"
            raise ModelError(f"kernel {function.__name__}: no field {wrong!r} of {name}{meant}")
