"""Values that were measured, as a distribution."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesa_mobility.distributions.base import Distribution
from mesa_mobility.errors import ModelError


class Empirical(Distribution):
    """Values that were measured, each as likely as the others.

    Args:
        values: (k,) numbers.

    Raises:
        ModelError: none, or not finite.
    """

    def __init__(self, values: ArrayLike) -> None:
        try:
            self.values = np.array(values, dtype=np.float64)
        except (TypeError, ValueError):
            raise ModelError("empirical: expected numbers") from None
        if self.values.ndim != 1 or not self.values.size or not np.isfinite(self.values).all():
            raise ModelError(
                f"empirical: shape {self.values.shape}, expected a row of finite numbers"
            )

    @classmethod
    def from_csv(cls, path: str | os.PathLike[str], column: str | int = 0) -> Empirical:
        """The values in a column of a CSV file with a header line; lines with # are left out.

        Args:
            path: the file.
            column: name of the column, or its number from 0 on.

        Raises:
            ModelError: the file cannot be read, has no such column, or other things than numbers.
        """
        import csv

        try:
            with Path(path).open(encoding="utf-8", newline="") as file:
                lines = csv.reader(line for line in file if line.strip() and line[0] != "#")
                header, *rows = ([cell.strip() for cell in row] for row in lines)
        except (OSError, UnicodeDecodeError, csv.Error) as error:
            raise ModelError(f"{path}: cannot be read as CSV ({error})") from None
        except ValueError:
            raise ModelError(f"{path}: is empty, expected a header and a line of values") from None
        known = isinstance(column, int) or column in header
        at = column if isinstance(column, int) else header.index(column) if known else 0
        if not known or not 0 <= at < len(header):
            raise ModelError(f"{path}: no column {column!r}, expected one of {', '.join(header)}")
        try:
            return cls([float(row[at]) for row in rows])
        except (ValueError, IndexError):
            raise ModelError(f"{path}: column {column!r}, expected a number in each line") from None

    def quantile(self, share: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n,) values below which these shares lie."""
        at = (share * len(self.values)).astype(np.int64)
        return np.sort(self.values)[np.minimum(at, len(self.values) - 1)]

    def __repr__(self) -> str:
        return f"Empirical({len(self.values)} values)"
