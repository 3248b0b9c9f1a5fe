"""What the members of a file are: a declaration for each, and one checker for all.

Checkpoints, maps and pose banks hold arrays and numbers that compiled code trusts.  Each reader
declares them here, by name: type, shape, range, and what a number refers to.  Behaviours declare
their saved state in the same words (``Plugin.saved``).

Sizes have names.  ``Array("i8", ("people", 2), below="rows")`` has a row for each of the people,
and numbers of rows.  A name of a shape that is not known yet stands for the size that is found
first; ``"people+1"`` is one more.
"""

from __future__ import annotations

from collections import ChainMap
from typing import Any

from mesa_mobility.errors import ContentError, MobilityError
from mesa_mobility.schema.arrays import Array, Records
from mesa_mobility.schema.nested import Each, Either, Maybe, Members, Object, Several
from mesa_mobility.schema.numbers import (
    MOST,
    Anything,
    Flag,
    Kind,
    Real,
    Size,
    Sizes,
    Text,
    Whole,
    check_shape,
)

__all__ = [
    "MOST",
    "Anything",
    "Array",
    "Each",
    "Either",
    "Flag",
    "Kind",
    "Maybe",
    "Members",
    "Object",
    "Real",
    "Records",
    "Several",
    "Size",
    "Sizes",
    "Text",
    "Whole",
    "check",
    "check_shape",
]


def check(
    value: Any,
    kind: Kind,
    where: str,
    sizes: Sizes | None = None,
    error: type[MobilityError] = ContentError,
) -> None:
    """Raise an error of one line unless a value is of a kind.

    Args:
        value: anything.
        kind: what it must be.
        where: what the value is called, for the error.
        sizes: what names of sizes stand for.
        error: what is raised.
    """
    try:
        kind.check(value, where, ChainMap({}, dict(sizes or {})))
    except ContentError as fault:
        raise error(str(fault)) from None
