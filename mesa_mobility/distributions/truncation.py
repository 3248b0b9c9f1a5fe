"""Normal distributions that are cut off: their quantiles, and which has a given mean and deviation.

Within bounds the normal distributions are those with a density of exp(p x + q x^2), q < 0. The sums
below stand for integrals over it (Gauss and Legendre's rule), in units of the wanted deviation from
the wanted mean.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

FAR = 12.0
"""Deviations from the mean beyond which nothing counts."""

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(100)


def normal_quantile(
    mean: float, sd: float, low: float, high: ArrayLike, share: NDArray[np.float64]
) -> NDArray[np.float64]:
    """(n,) values below which these shares of a normal distribution lie.

    Args:
        mean: before the cut, as ``sd``.
        sd: its deviation.
        low: bound below.
        high: bound above, for all or for each.
        share: (n,) in (0, 1).
    """
    from scipy.special import log_ndtr, ndtri, ndtri_exp

    values: NDArray[np.float64]
    if sd == 0.0 or (low == -np.inf and np.all(high == np.inf)):
        values = mean + sd * ndtri(share)
        return values
    if low > mean:  # in the upper tail, shares of the whole are too near to 1
        return -normal_quantile(-mean, sd, float(-np.asarray(high)), -low, 1.0 - share)
    # Logarithms reach far out, where shares themselves are 0.
    least, most = log_ndtr((low - mean) / sd), log_ndtr((np.asarray(high) - mean) / sd)
    below = np.logaddexp(np.log1p(-share) + least, np.log(share) + most)
    values = mean + sd * ndtri_exp(below)
    return np.clip(values, low, high)  # for rounding


def widest(mean: float, low: float, high: float) -> float:
    """The greatest deviation that normal distributions with a mean come near to within bounds.

    It is that of the exponential one (q = 0), which rises or falls from bound to bound.
    """
    scale = min(mean - low, high - mean)
    x, weights = _rule((low - mean) / scale, (high - mean) / scale)

    falls, rises = -FAR, FAR
    for _ in range(60):  # halving, without SciPy, since types are made when modules are loaded
        p = (falls + rises) / 2.0
        density = _density(x, weights, p, 0.0)
        falls, rises = (p, rises) if density @ x < 0.0 else (falls, p)
    return scale * float(np.sqrt(density @ x**2))


@cache
def normal_before_cut(mean: float, sd: float, low: float, high: float) -> tuple[float, float]:
    """Mean and deviation of the normal distribution that has ``mean`` and ``sd`` once it is cut.

    The deviation must be less than the ``widest``.
    """
    from scipy.optimize import root

    x, weights = _rule((low - mean) / sd, (high - mean) / sd)
    powers = np.stack([x, x**2])

    def miss(by: NDArray[np.float64]) -> NDArray[np.float64]:
        found: NDArray[np.float64] = powers @ _density(x, weights, *by) - (0.0, 1.0)
        return found

    def slope(by: NDArray[np.float64]) -> NDArray[np.float64]:
        density = _density(x, weights, *by)
        off = powers - (powers @ density)[:, None]
        return (off * density) @ off.T

    p, q = root(miss, (0.0, -0.5), jac=slope, tol=1e-12).x
    variance = -0.5 / q
    return float(mean + sd * p * variance), float(sd * np.sqrt(variance))


def _rule(low: float, high: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Nodes between bounds, and their weights."""
    low, high = max(low, -FAR), min(high, FAR)
    return low + (high - low) * (_NODES + 1.0) / 2.0, _WEIGHTS


def _density(
    x: NDArray[np.float64], weights: NDArray[np.float64], p: float, q: float
) -> NDArray[np.float64]:
    """Share of the distribution at each node."""
    power = p * x + q * x**2
    density = weights * np.exp(power - power.max())
    return density / density.sum()
