"""Arrays, of numbers and of records."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.errors import ContentError
from mesa_mobility.schema.numbers import (
    Kind,
    Size,
    Sizes,
    check_shape,
    in_range,
    range_text,
    refuse,
    size_of,
)

_PIECE = 1 << 20


@dataclass(frozen=True)
class Array(Kind):
    """An array of exactly this type and shape.

    Attributes:
        dtype: type of the numbers.
        shape: number, name or None (any) for each axis; None for any shape.
        low: least number.
        high: greatest number.
        below: size that whole numbers are below, instead of ``high``.
        infinite: whether numbers may be infinite.
        missing: whether numbers may be nan.
        rising: whether each number is greater than the one before.
        filled: whether there must be a number at all.
    """

    dtype: str
    shape: tuple[Size | None, ...] | None = (None,)
    low: float = -math.inf
    high: float = math.inf
    below: Size = ""
    infinite: bool = False
    missing: bool = False
    rising: bool = False
    filled: bool = False

    def check(self, value: Any, where: str, sizes: Sizes) -> None:
        """Raise ContentError unless ``value`` is an array of this type, shape and range."""
        wanted = np.dtype(self.dtype)
        if not isinstance(value, np.ndarray) or value.dtype != wanted:
            found = value.dtype if isinstance(value, np.ndarray) else value
            refuse(where, found, f"an array of {wanted}")
        if self.shape is not None:
            check_shape(value.shape, self.shape, where, sizes)
        if self.filled and not value.size:
            raise ContentError(f"{where}: has no numbers, expected some")
        self.check_numbers(value, where, sizes)

    def check_numbers(self, values: NDArray[Any], where: str, sizes: Sizes) -> None:
        """Refuse numbers out of range."""
        if values.dtype.kind in "biuf" and values.size:
            limits = self
            if self.below != "":
                high = size_of(self.below, sizes) - 1
                limits = Array(self.dtype, low=self.low, high=high)
            # In pieces: large arrays must not need room for several copies.
            flat = values.reshape(-1) if values.flags.c_contiguous else values.ravel()
            for start in range(0, flat.size, _PIECE):
                fits = in_range(flat[start : start + _PIECE], limits)
                if not fits.all():
                    at = start + int(np.argmin(fits))
                    index = ", ".join(map(str, np.unravel_index(at, values.shape)))
                    refuse(f"{where}[{index}]", flat[at].item(), f"a number, {range_text(limits)}")
        if self.rising and len(values) and not (values[1:] > values[:-1]).all():
            raise ContentError(f"{where}: goes back, expected rising numbers")


@dataclass(frozen=True)
class Records(Kind):
    """An array of records.

    Attributes:
        dtype: type of the records.
        fields: what each of their fields is, without its first axis.
        shape: as of ``Array``.
    """

    dtype: np.dtype[Any]
    fields: Mapping[str, Array]
    shape: tuple[Size | None, ...]

    def check(self, value: Any, where: str, sizes: Sizes) -> None:
        """Raise ContentError unless ``value`` is an array of such records."""
        if not isinstance(value, np.ndarray) or value.dtype != self.dtype:
            refuse(where, getattr(value, "dtype", value), f"records of {self.fields.keys()}")
        check_shape(value.shape, self.shape, where, sizes)
        for name, kind in self.fields.items():
            kind.check_numbers(value[name], f"{where}, {name}", sizes)
