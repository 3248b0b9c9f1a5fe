"""Lines of stairs and lifts: two points, the first on the left of somebody who crosses them."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from shapely import Polygon

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan import Gate

Line = tuple[tuple[float, float], tuple[float, float]]
"""A line (left, right), each (x, y) in metres."""


def line_of(what: str, name: str, part: str, given: Sequence[Sequence[float]]) -> Line:
    """A line as it was given.

    Args:
        what: "stairs" or "lift", for the message.
        name: of the stairs or the lift.
        part: the part that the line is.
        given: two points.

    Raises:
        FloorPlanError: no name, or no line of two different points.
    """
    if not isinstance(name, str) or not name:
        raise FloorPlanError(f"{what}: expected a name of at least one letter, found {name!r:.60}")
    try:
        a, b = given
        line = Gate(part, tuple(a), tuple(b))  # type: ignore[arg-type]
    except (TypeError, ValueError):
        raise FloorPlanError(
            f"{what} {name!r}: {part} must be two points (x, y), found {given!r:.60}"
        ) from None
    except FloorPlanError as error:
        raise FloorPlanError(f"{what} {name!r}: {error}") from None
    return line.a, line.b


def right_angle(line: Line) -> NDArray[np.float64]:
    """(2,) unit vector in which people cross a line with its first point on their left."""
    (ax, ay), (bx, by) = line
    return np.array([ay - by, bx - ax]) / math.dist(*line)


def moved(line: Line, by: NDArray[np.float64]) -> Line:
    """A line shifted by (2,) metres."""
    a, b = np.array(line) + by
    return pair(a), pair(b)


def pair(point: NDArray[np.float64]) -> tuple[float, float]:
    """A (2,) point as a pair of numbers."""
    return float(point[0]), float(point[1])


def middle_of(line: Line) -> NDArray[np.float64]:
    """(2,) the middle of a line."""
    middle: NDArray[np.float64] = np.array(line).mean(axis=0)
    return middle


def width_of(line: Line) -> float:
    """Length of a line, metres."""
    return math.dist(*line)


def strip(line: Line, first: float, last: float, half: float) -> Polygon:
    """The rectangle from `first` to `last` metres behind a line, straight behind its middle.

    Args:
        line: its first point is on the left of somebody who looks that way.
        first: metres; below 0 before the line.
        last: metres.
        half: half its width, metres.
    """
    into, middle = right_angle(line), middle_of(line)
    aside = half * np.array([into[1], -into[0]])
    near, far = middle + first * into, middle + last * into
    return Polygon([near - aside, near + aside, far + aside, far - aside])
