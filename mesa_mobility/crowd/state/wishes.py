"""What people would do if nobody else were there, as behaviours get it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

NOBODY = -1


class Wishes(NamedTuple):
    """What n people would do if nobody else were there.

    Attributes:
        paths: (n, 2, 16) x and y in metres at the samples of the cheapest option that hits no wall.
        pieces: (n,) pieces of each path; 0 where every option hits a wall.
        blockers: (n,) row of the person whom each would hit first, or -1.
    """

    paths: NDArray[np.float64]
    pieces: NDArray[np.int64]
    blockers: NDArray[np.int64]
