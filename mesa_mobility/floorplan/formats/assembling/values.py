"""Values of JSON that other programs wrote, checked as they are taken."""

import math
from collections.abc import Mapping
from typing import Any

import shapely
from shapely.geometry.base import BaseGeometry

from mesa_mobility.errors import FloorPlanError

MOST_CORNERS = 100_000
"""Corners of a shape."""


def mapping_of(value: Any, at: str) -> Mapping[str, Any]:
    """A value that must be an object of JSON; none counts as empty."""
    if value is None:
        return {}
    if not isinstance(value, Mapping):
        raise FloorPlanError(f"{at}: expected an object, found {type(value).__name__}")
    return value


def list_of(value: Any, at: str) -> list[Any]:
    """A value that must be a list; none counts as empty."""
    if value is None:
        return []
    if not isinstance(value, list):
        raise FloorPlanError(f"{at}: expected a list, found {type(value).__name__}")
    return value


def number_of(value: Any, at: str, default: float | None = None) -> float:
    """A value that must be a finite number of a size that coordinates have."""
    if value is None and default is not None:
        return default
    # Integers may have more digits than a float.
    fits = isinstance(value, int | float) and not isinstance(value, bool) and abs(value) <= 1e8
    if not fits or not math.isfinite(value):
        raise FloorPlanError(f"{at}: got {value!r:.40}, expected a number")
    return float(value)


def ring_of(points: Any, at: str) -> BaseGeometry:
    """The area in a list of corners, each [x, y] or {x, y}; mended where it crosses itself."""
    xy = []
    for each in list_of(points, at)[: MOST_CORNERS + 1]:
        pair = [each.get("x"), each.get("y")] if isinstance(each, Mapping) else each
        if not isinstance(pair, list | tuple) or len(pair) < 2:
            raise FloorPlanError(f"{at}: expected corners of two numbers")
        xy.append((number_of(pair[0], at), number_of(pair[1], at)))
    if not 3 <= len(xy) <= MOST_CORNERS:
        raise FloorPlanError(f"{at}: {len(xy)} corners, expected 3 to {MOST_CORNERS:,}")
    area = shapely.Polygon(xy)
    return area if area.is_valid else shapely.make_valid(area)
