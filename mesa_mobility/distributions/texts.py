"""Distributions read from texts, as commands and parameters give them."""

from __future__ import annotations

import inspect
import re
from dataclasses import fields
from typing import Any

from mesa_mobility.distributions.base import Distribution
from mesa_mobility.distributions.parametric import (
    Constant,
    Gamma,
    LogNormal,
    Normal,
    TruncatedNormal,
    Uniform,
    Weibull,
)
from mesa_mobility.errors import ModelError

_BY_NAME: dict[str, type[Any]] = {
    kind.__name__.lower(): kind
    for kind in (Constant, Uniform, Normal, TruncatedNormal, LogNormal, Weibull, Gamma)
}

FORMS = "a number, " + ", ".join(
    f"{name}({', '.join(each.name for each in fields(kind))})" for name, kind in _BY_NAME.items()
)
"""The texts that ``parse`` reads."""


def parse(text: str) -> Distribution:
    """The distribution that a text stands for, such as ``lognormal(3.44, 0.94)`` or ``12.5``.

    Names and the order of their numbers are those of the classes here; a number alone is a
    constant.

    Raises:
        ModelError: the text is none of these, or its numbers are out of range.
    """
    found = re.fullmatch(r"\s*(?:([A-Za-z]+)\s*\()?([^()]*?)(\))?\s*", text)
    kind = _BY_NAME.get((found[1] or "constant").lower()) if found else None
    if found is None or kind is None or bool(found[1]) != bool(found[3]):
        raise ModelError(f"distribution {text!r}: expected {FORMS}")
    try:
        numbers = [float(part) for part in found[2].split(",")]
        inspect.signature(kind).bind(*numbers)
    except (TypeError, ValueError):
        raise ModelError(f"distribution {text!r}: expected {FORMS}") from None
    made: Distribution = kind(*numbers)
    return made
