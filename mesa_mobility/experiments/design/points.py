"""Points of the parameter space: their values, keys, and the seeds of their runs."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Mapping
from typing import Any, TypeAlias

import numpy as np

from mesa_mobility.errors import ModelError

Value: TypeAlias = bool | int | float | str | None
Point: TypeAlias = dict[str, Value]

ARROW_TYPES: dict[type, str] = {bool: "bool", int: "int64", float: "double", str: "string"}
"""Name of the Arrow type of each type of value."""


def plain_value(name: str, value: Any) -> Value:
    """A parameter's value as the store keeps it.

    Raises:
        ModelError: neither a finite number of at most 64 bits nor text, yes or no, or None.
    """
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float) and not math.isfinite(value):
        raise ModelError(f"parameter {name}: got {value}, expected a finite number")
    if isinstance(value, int) and not -(2**63) <= value < 2**63:
        raise ModelError(f"parameter {name}: got {value}, expected a number of at most 64 bits")
    if isinstance(value, str):
        try:
            value.encode()
        except UnicodeEncodeError:  # a file's name in another encoding, for instance
            raise ModelError(
                f"parameter {name}: got {value!r}, expected text that UTF-8 can hold"
            ) from None
    if value is None or isinstance(value, bool | int | float | str):
        return value
    raise ModelError(
        f"parameter {name}: got {type(value).__name__}, expected a number, text, true or false, "
        "or nothing"
    )


def check_whole(name: str, value: Any, least: int, most: float, expected: str) -> None:
    """Raise ModelError unless a value is a whole number from ``least`` to ``most``.

    Args:
        name: of the value, for the message.
        value: to be checked.
        least: smallest number.
        most: largest number, which may be infinite.
        expected: what the message says of both.
    """
    if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= most:
        raise ModelError(f"{name} is {value!r}, expected a whole number, {expected}")


def point_key(point: Mapping[str, Value]) -> str:
    """The name of a point: 16 hexadecimal digits of a hash of its names and values.

    It depends on nothing else, neither on the order of the names nor on other points. Whole numbers
    count the same with and without a decimal point.
    """
    values = {
        name: int(value) if isinstance(value, float) and value.is_integer() else value
        for name, value in point.items()
    }
    text = json.dumps(values, sort_keys=True, ensure_ascii=True, allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def run_name(key: str, replication: int) -> str:
    """The name of a run, by which it is known in a store."""
    return f"{key}-{replication}"


def seed_of_run(seed: int, key: str | None, replication: int) -> int:
    """The seed of a run, from 0 to 2**63 - 1.

    Args:
        seed: of the experiment.
        key: of the point; None where runs of one number have the same seed at all points.
        replication: number of the replication, from 0 on.
    """
    entropy = [seed, replication] if key is None else [seed, int(key, 16), replication]
    sequence = np.random.SeedSequence(entropy)
    return int(sequence.generate_state(1, np.uint64)[0] >> np.uint64(1))
