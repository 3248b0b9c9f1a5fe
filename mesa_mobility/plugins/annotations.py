"""Annotations of a model's parameters, for controls on a page."""

from __future__ import annotations

import math
from dataclasses import dataclass

from mesa_mobility.errors import ModelError


@dataclass(frozen=True)
class Range:
    """The range of a number's slider: ``people: Annotated[int, Range(1, 500)] = 60``.

    The field beside the slider takes other values as well; the model may refuse them.

    Attributes:
        low: least value.
        high: greatest value.

    Raises:
        ModelError: a bound that is not finite, or ``low`` not below ``high``.
    """

    low: float
    high: float

    def __post_init__(self) -> None:
        if not (math.isfinite(self.low) and math.isfinite(self.high) and self.low < self.high):
            raise ModelError(f"Range: got {self.low} to {self.high}, expected a low and a high end")


@dataclass(frozen=True, init=False)
class Files:
    """The files that a page offers: ``plan: Annotated[Path | None, Files("*.geojson")] = None``.

    Args:
        patterns: shell patterns of the file names.
    """

    patterns: tuple[str, ...]

    def __init__(self, *patterns: str) -> None:
        object.__setattr__(self, "patterns", patterns)
