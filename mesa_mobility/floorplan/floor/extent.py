"""Limits on the size of floor plans, and hints at coordinates in another unit."""

import warnings
from collections.abc import Sequence

import numpy as np
import shapely
from numpy.typing import ArrayLike
from shapely import Polygon

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.floor.openings import Opening

LARGEST_COORDINATE = 1e8
"""Metres.  Zones of national grids reach 6e7; doubles resolve 15 nanometres there."""

LARGEST_EXTENT = 20_000.0
"""Metres from one side of a walkable area to the other: a large city."""

SMALLEST_EXTENT = 0.2
"""Metres: nobody can stand in an area that is smaller in both directions."""

_MILLIMETRES = 1000.0, 400.0
"""Extent and narrowest opening from which on a plan is hardly in metres."""

_DEGREES = 1.0
"""Extent below which a plan is hardly in metres."""


def check_coordinates(xy: ArrayLike, what: str) -> None:
    """Coordinates must be finite and within ``LARGEST_COORDINATE``; FloorPlanError otherwise.

    `what` names them in the error.
    """
    values = np.abs(np.asarray(xy, dtype=np.float64))
    if not np.isfinite(values).all():
        raise FloorPlanError(f"{what} has coordinates that are not finite")
    if values.size and values.max() > LARGEST_COORDINATE:
        raise FloorPlanError(
            f"{what} has coordinates up to {values.max():.6g}, "
            f"expected metres, at most {LARGEST_COORDINATE:g}"
        )


def check_extent(walkable: Polygon) -> None:
    """Raise FloorPlanError unless the walkable area has a size for people, in metres.

    Raises:
        FloorPlanError: the area is more than 20 km wide or high, or less than 0.2 m in both
            directions.
    """
    width, height = _size(walkable)
    size = f"the walkable area is {width:.6g} by {height:.6g} m"
    if max(width, height) > LARGEST_EXTENT:
        raise FloorPlanError(
            f"{size}, expected at most {LARGEST_EXTENT:g} m either way "
            "(are its coordinates millimetres?)"
        )
    if max(width, height) < SMALLEST_EXTENT:
        raise FloorPlanError(
            f"{size}, too small to stand in: expected metres"
            + (_FOUND_DEGREES if _may_be_degrees(walkable) else "")
        )


_FOUND_DEGREES = ", found what look like degrees of longitude and latitude"


def warn_of_other_units(walkable: Polygon, openings: Sequence[Opening]) -> None:
    """Warn where an area of kilometres has no opening narrower than some hundred metres, and where
    an area of less than a metre could be in degrees."""
    width, height = _size(walkable)
    narrowest = min((opening.length for opening in openings), default=0.0)
    large, wide = _MILLIMETRES
    size = f"the walkable area is {width:.6g} by {height:.6g} m"
    if max(width, height) >= large and narrowest >= wide:
        warnings.warn(
            f"{size} and its narrowest opening {narrowest:.6g} m wide: expected metres, found what "
            "look like millimetres",
            stacklevel=3,
        )
    elif max(width, height) < _DEGREES and _may_be_degrees(walkable):
        warnings.warn(f"{size}: expected metres{_FOUND_DEGREES}", stacklevel=3)


def _may_be_degrees(walkable: Polygon) -> bool:
    x, y = np.abs(shapely.get_coordinates(walkable)).max(axis=0)
    return bool(x <= 180.0 and y <= 90.0)


def _size(walkable: Polygon) -> tuple[float, float]:
    xmin, ymin, xmax, ymax = walkable.bounds
    return xmax - xmin, ymax - ymin
