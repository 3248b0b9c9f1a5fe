"""Levels of service: what a density means for people who walk, climb or queue."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesa_mobility.errors import ResultsError

LETTERS = ("A", "B", "C", "D", "E", "F")

_SQUARE_FOOT = 0.3048**2

_LEAST_SPACE = {
    "walkway": (35.0, 25.0, 15.0, 10.0, 5.0),
    "stairs": (20.0, 15.0, 10.0, 7.0, 4.0),
    "queue": (13.0, 10.0, 7.0, 3.0, 2.0),
}
"""Least square feet a person of the levels A to E, as published."""


def service_limits(kind: str = "walkway") -> NDArray[np.float64]:
    """The greatest densities of the levels A to E, (5,) persons/m2; denser is F.

    J. J. Fruin, Pedestrian Planning and Design (1971), as space a person: on walkways 35, 25, 15,
    10 and 5 square feet, on stairs 20, 15, 10, 7 and 4, in queues 13, 10, 7, 3 and 2.

    Args:
        kind: "walkway", "stairs" or "queue".

    Raises:
        ResultsError: another kind.
    """
    if kind not in _LEAST_SPACE:
        raise ResultsError(
            f"level of service of {kind!r}, expected one of {', '.join(_LEAST_SPACE)}"
        )
    return 1.0 / (np.array(_LEAST_SPACE[kind]) * _SQUARE_FOOT)


def level_of_service(density: ArrayLike, kind: str = "walkway") -> NDArray[np.str_]:
    """The level of service, "A" to "F", of densities.

    Args:
        density: persons/m2, of any shape.
        kind: as for `service_limits`.

    Returns:
        A letter for each, an empty text where there is no density (nan).

    Raises:
        ResultsError: another kind.
    """
    values = np.asarray(density, dtype=np.float64)
    letters = np.array(LETTERS)[np.searchsorted(service_limits(kind), values) % len(LETTERS)]
    return np.where(np.isnan(values), "", letters)
