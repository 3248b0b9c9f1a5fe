"""Shapes of bodies: one to three discs along the direction of facing."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any, TypeAlias

import numpy as np

from mesa_mobility.errors import ModelError

MOST_DISCS = 3

Discs: TypeAlias = "tuple[tuple[float, float], ...]"
"""For each disc of a body its offset from the person's position along the facing, forwards, and its
radius."""

SHAPE = np.dtype(
    [("overhang", "f8"), ("discs", "i8"), ("offset", "f8", (3,)), ("radius", "f8", (3,))],
    align=True,
)
"""Record of the shape of a type's bodies, in units of the core radius.

The core is the largest disc about the person's position that lies in the body.  Fields:
``overhang``, by how much a circle about that position that holds the whole body exceeds the core,
0 for a body of one disc; ``discs``, their number; ``offset`` and ``radius`` of each.
"""

ShapeRecords: TypeAlias = "np.recarray[Any, Any]"
"""(types,) records of ``SHAPE``, as compiled functions take them."""


def core_of(discs: Discs) -> float:
    """Radius in metres of the largest disc about a person's position within one of its discs."""
    return max(radius - abs(offset) for offset, radius in discs)


def check_discs(discs: Sequence[Sequence[float]], of: str) -> Discs:
    """The discs of a body, from the rearmost to the foremost.

    Args:
        discs: offset and radius of each, metres.
        of: name of the pedestrian type, for the error.

    Raises:
        ModelError: not one to three pairs of numbers, a body in several parts, or one that the
            person's position lies outside of.
    """
    try:
        found = tuple(sorted((float(offset), float(radius)) for offset, radius in discs))
    except (TypeError, ValueError):
        found = ()
    if not 1 <= len(found) <= MOST_DISCS:
        raise ModelError(
            f"type {of!r}: discs {discs!r}, expected an offset and a radius in metres for each of "
            f"one to {MOST_DISCS}"
        )
    if not all(abs(offset) < 2.0 and 0.0 < radius < 1.0 for offset, radius in found):
        raise ModelError(
            f"type {of!r}: discs {found}, expected offsets within 2 m and radii of 0 to 1 m"
        )
    gap = any(b[0] - a[0] > a[1] + b[1] for a, b in pairwise(found))
    if gap or core_of(found) <= 0.0:
        raise ModelError(
            f"type {of!r}: discs {found}, expected discs that touch one another, one of them over "
            "the person's position"
        )
    return found


def shapes_of(bodies: Sequence[Discs]) -> ShapeRecords:
    """(types,) records of ``SHAPE`` of these bodies."""
    shapes = np.zeros(len(bodies), dtype=SHAPE)
    for shape, discs in zip(shapes, bodies, strict=True):
        core = core_of(discs)
        shape["discs"] = len(discs)
        for k, (offset, radius) in enumerate(discs):
            shape["offset"][k], shape["radius"][k] = offset / core, radius / core
        if len(discs) > 1 or discs[0][0] != 0.0:
            shape["overhang"] = max(abs(o) + r for o, r in discs) / core - 1.0
    return shapes.view(np.recarray)


ONE_DISC: Discs = ((0.0, 1.0),)
"""A single disc about the person's position."""
