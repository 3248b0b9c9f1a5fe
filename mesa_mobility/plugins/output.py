"""Checks of arrays for compiled functions: results of plug-ins, and arguments."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.errors import ModelError


def numbers_given(
    giver: str, what: str, values: Any, shape: tuple[int, ...]
) -> NDArray[np.float64]:
    """``values`` as a contiguous array of float64.

    Args:
        giver: the plug-in as the message names it, such as ``behaviour 'mine'``.
        what: name of the values.
        values: anything.
        shape: the required shape.

    Raises:
        ModelError: values that are not numbers, or of another shape.
    """
    array = _array(giver, what, values, shape)
    if array.dtype.kind not in "biuf":
        raise ModelError(f"{giver}: gave {what} of type {array.dtype}, expected numbers")
    return np.asarray(array, dtype=np.float64, order="C")


def whole_numbers_given(
    giver: str, what: str, values: Any, shape: tuple[int, ...]
) -> NDArray[np.int64]:
    """``values`` as a contiguous array of int64; otherwise as ``numbers_given``."""
    array = _array(giver, what, values, shape)
    # The conversion would silently change NaN and fractions.
    if array.dtype.kind not in "iu" and array.size:
        raise ModelError(f"{giver}: gave {what} of type {array.dtype}, expected whole numbers")
    return np.asarray(array, dtype=np.int64, order="C")


def numbers_in(what: str, values: Any, expected: str) -> NDArray[np.float64]:
    """Numbers that a user gives, as a new array of float64.

    NumPy turns texts, None and truth values into numbers in silence.

    Args:
        what: they are, as the message names it.
        values: anything.
        expected: what they should be.

    Raises:
        ModelError: values that are not numbers, or rows of unequal length.
    """
    try:
        array = np.asarray(values)
    except (TypeError, ValueError):
        array = np.array([None])
    if array.dtype.kind not in "iuf":
        raise ModelError(f"{what}: got {values!r:.80}, expected {expected}")
    return array.astype(np.float64)


def _array(giver: str, what: str, values: Any, shape: tuple[int, ...]) -> NDArray[Any]:
    try:
        array = np.asarray(values)
    except (TypeError, ValueError):
        raise ModelError(f"{giver}: gave {what} that are no array, expected {shape}") from None
    if array.shape != shape:
        raise ModelError(f"{giver}: gave {what} of shape {array.shape}, expected {shape}")
    return array
