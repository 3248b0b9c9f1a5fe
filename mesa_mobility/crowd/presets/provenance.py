"""Where the numbers of a preset come from."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import date

from mesa_mobility._numbers import is_number
from mesa_mobility.errors import ModelError

_DIGEST = re.compile(r"[0-9a-f]{64}")


@dataclass(frozen=True, kw_only=True)
class Provenance:
    """What the numbers of a preset were made from, and how well they do.

    Attributes:
        date: of the day on which they were made, as 2026-11-26.
        command: the command or function that made them.
        data: sha256 of each file of measurements, by its name.
        likelihoods: negative log-likelihood a choice, in nats, by the data's name.
        figures: other figures, such as distances between measured and simulated crowds, by name.

    Raises:
        ModelError: one of them is something else.
    """

    date: str = ""
    command: str = ""
    data: Mapping[str, str] = field(default_factory=dict)
    likelihoods: Mapping[str, float] = field(default_factory=dict)
    figures: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if not isinstance(self.command, str):
            _refuse("command", self.command, "a text")
        try:
            assert self.date == "" or date.fromisoformat(self.date).isoformat() == self.date
        except (AssertionError, TypeError, ValueError):
            _refuse("date", self.date, "such as 2026-11-26")
        for name in ("data", "likelihoods", "figures"):
            values = getattr(self, name)
            if not isinstance(values, Mapping) or not all(isinstance(key, str) for key in values):
                _refuse(name, values, "values by name")
            object.__setattr__(self, name, dict(values))
        for key, digest in self.data.items():
            if not (isinstance(digest, str) and _DIGEST.fullmatch(digest)):
                _refuse(f"data, {key}", digest, "a sha256 of 64 digits, 0 to 9 and a to f")
        for name in ("likelihoods", "figures"):
            for key, value in getattr(self, name).items():
                if not (is_number(value) and math.isfinite(value)):
                    _refuse(f"{name}, {key}", value, "a finite number")


def _refuse(what: str, got: object, expected: str) -> None:
    raise ModelError(f"provenance: {what} {got!r:.80}, expected {expected}")
