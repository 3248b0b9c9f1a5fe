"""The smallest rectangle around an area, at any angle."""

from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry


class Box(NamedTuple):
    """A rectangle; metres.

    Attributes:
        corners: (4, 2) counter-clockwise.
        along: (2, 2) directions of length 1 from the first corner to the second, and from there to
            the third.
        lengths: (2,) of these sides.
    """

    corners: NDArray[np.float64]
    along: NDArray[np.float64]
    lengths: NDArray[np.float64]

    @property
    def centre(self) -> NDArray[np.float64]:
        """(2,) its middle."""
        middle: NDArray[np.float64] = self.corners.mean(axis=0)
        return middle


def box_around(area: BaseGeometry) -> Box | None:
    """The smallest rectangle around an area; None where it has no width."""
    corners = shapely.get_coordinates(shapely.oriented_envelope(area))
    if len(corners) != 5:
        return None
    (ax, ay), (bx, by) = corners[1] - corners[0], corners[2] - corners[1]
    corners = corners[:4] if ax * by - ay * bx > 0 else corners[3::-1]
    sides = np.diff(corners[:3], axis=0)
    lengths = np.hypot(*sides.T)
    if not lengths.min() > 0:
        return None
    return Box(corners, sides / lengths[:, None], lengths)
