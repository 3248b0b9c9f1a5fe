"""Metres from degrees of longitude and latitude."""

import math
from collections.abc import Sequence

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

_EQUATOR, _FLATTENING = 6_378_137.0, 1 / 298.257223563
"""Radius in metres and flattening of the ellipsoid WGS 84."""


def as_metres(whole: BaseGeometry, in_degrees: bool, notes: list[str]) -> Sequence[BaseGeometry]:
    """The parts of a collection in metres.

    Degrees become metres east and north of the middle of the collection, on the plane that touches
    the ellipsoid there. Across 2 km this is right within 1 in 10,000.

    Args:
        whole: all geometries of a file.
        in_degrees: whether coordinates are degrees of longitude and latitude.
        notes: takes that they were.
    """
    parts = shapely.get_parts(whole)
    if not in_degrees or whole.is_empty:
        return list(parts)
    west, south, east, north = whole.bounds
    longitude, latitude = (west + east) / 2, (south + north) / 2
    scale = metres_in_degree(latitude)
    notes.append(
        f"degrees became metres east and north of longitude {longitude:.6f}, latitude "
        f"{latitude:.6f}"
    )

    def moved(xy: NDArray[np.float64]) -> NDArray[np.float64]:
        return (xy - (longitude, latitude)) * scale

    return list(shapely.transform(parts, moved))


def metres_in_degree(latitude: float) -> tuple[float, float]:
    """Metres in a degree of longitude and in one of latitude."""
    phi = math.radians(latitude)
    squared = _FLATTENING * (2 - _FLATTENING)
    root = math.sqrt(1 - squared * math.sin(phi) ** 2)
    across = _EQUATOR / root
    along = _EQUATOR * (1 - squared) / root**3
    return math.radians(1) * across * math.cos(phi), math.radians(1) * along
