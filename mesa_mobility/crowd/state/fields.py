"""Fields that a model declares for its people, an array each."""

from __future__ import annotations

import keyword
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesa_mobility.errors import ModelError

KINDS: dict[type, np.dtype[Any]] = {
    bool: np.dtype(np.bool_),
    int: np.dtype(np.int64),
    float: np.dtype(np.float64),
}
"""Types that a field may have, and those of its array."""

_EXPECTED = {"b": "true or false", "i": "a whole number", "f": "a number"}

_FITTING = {"b": "b", "i": "iu", "f": "fiu"}


def read_fields(
    declared: Mapping[str, type] | None, taken: Iterable[str]
) -> dict[str, np.dtype[Any]]:
    """The types of the arrays of declared fields.

    Args:
        declared: type of each field by its name: bool, int or float.
        taken: names that people have already.

    Raises:
        ModelError: no such declaration, a name that is taken, or another type.
    """
    if declared is None:
        return {}
    if not isinstance(declared, Mapping):
        raise ModelError(f"fields: got {declared!r}, expected a type for each name")
    names = set(taken)
    for name, kind in declared.items():
        if not isinstance(name, str) or not name.isidentifier() or keyword.iskeyword(name):
            raise ModelError(f"fields: got {name!r}, expected a name such as 'infected'")
        if name in names or name.startswith("_"):
            raise ModelError(f"fields: people have {name!r} already, expected another name")
        if kind not in KINDS:
            raise ModelError(f"field {name!r}: got {kind!r}, expected bool, int or float")
    return {name: KINDS[kind] for name, kind in declared.items()}


def field_column(name: str, kind: np.dtype[Any], values: ArrayLike, n: int) -> NDArray[Any]:
    """(n,) values for n people; a single one stands for all.

    Raises:
        ModelError: another length, or values of another type.
    """
    column = np.asarray(values)
    if column.shape not in ((n,), ()) or (
        column.size and column.dtype.kind not in _FITTING[kind.kind]
    ):
        got = f"shape {column.shape}" if column.ndim else repr(values)
        raise ModelError(f"field {name!r}: got {got}, expected {_EXPECTED[kind.kind]} for each")
    return np.broadcast_to(column.astype(kind), (n,))
