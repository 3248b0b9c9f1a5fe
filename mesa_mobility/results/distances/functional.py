"""How far two curves are from each other, as a whole: functional analysis.

Three numbers compare a simulated curve m with a measured one E, which have a value each at the same
points. The relative difference is about size, the projection coefficient about a factor, the secant
cosine about shape. Curves of evacuations have the time at which each person left, in order.

Sources: R. D. Peacock, P. A. Reneke, W. D. Davis and W. W. Jones, Quantifying fire model evaluation
using functional analysis, Fire Safety Journal 33 (1999); E. Ronchi, E. D. Kuligowski, P. A. Reneke,
R. D. Peacock and D. Nilsson, The process of verification and validation of building fire evacuation
models, NIST Technical Note 1822 (2013).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray = NDArray[np.float64]


def relative_difference(measured: ArrayLike, simulated: ArrayLike) -> FloatArray:
    """Euclidean relative difference, ERD = ``|E - m| / |E|``: 0 for equal curves.

    Args:
        measured: (..., n).
        simulated: (..., n).

    Returns:
        (...); not a number if the measured curve is 0.
    """
    e, m = _pair(measured, simulated)
    return _ratio(np.linalg.norm(e - m, axis=-1), np.linalg.norm(e, axis=-1))


def projection_coefficient(measured: ArrayLike, simulated: ArrayLike) -> FloatArray:
    """Euclidean projection coefficient, EPC = ``<E, m> / |m|^2``: 1 for equal curves.

    It is the factor by which the simulated curve comes nearest to the measured one.

    Args:
        measured: (..., n).
        simulated: (..., n).

    Returns:
        (...); not a number if the simulated curve is 0.
    """
    e, m = _pair(measured, simulated)
    return _ratio(np.sum(e * m, axis=-1), np.sum(m * m, axis=-1))


def secant_cosine(measured: ArrayLike, simulated: ArrayLike, step: int | None = None) -> FloatArray:
    """Secant cosine, SC: cosine of the angle between the curves' changes; 1 for the same shape.

    Args:
        measured: (..., n), at points of equal distance.
        simulated: (..., n), at the same points.
        step: points over which changes are taken, which smooths noise; a twentieth by default.

    Returns:
        (...); not a number if a curve does not change.
    """
    e, m = _pair(measured, simulated)
    over = max(1, e.shape[-1] // 20) if step is None else step
    rise_e, rise_m = (each[..., over:] - each[..., :-over] for each in (e, m))
    size = np.sqrt(np.sum(rise_e**2, axis=-1) * np.sum(rise_m**2, axis=-1))
    return _ratio(np.sum(rise_e * rise_m, axis=-1), size)


def _pair(measured: ArrayLike, simulated: ArrayLike) -> tuple[FloatArray, FloatArray]:
    return np.asarray(measured, dtype=np.float64), np.asarray(simulated, dtype=np.float64)


def _ratio(above: ArrayLike, below: ArrayLike) -> FloatArray:
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.divide(above, below)
