"""Weights of greatest likelihood, by Newton's method within a trust region."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from mesa_mobility.errors import ModelError
from mesa_mobility.estimation.likelihood import Value
from mesa_mobility.estimation.problem import Sample

GRADIENT = 1e-4
"""Gradient of the mean log-likelihood at which a fit ends, of terms scaled to a spread of 1."""


def fit(
    sample: Sample, start: NDArray[np.float64], free: NDArray[np.bool_]
) -> tuple[NDArray[np.float64], Value]:
    """(p,) weights of greatest likelihood, and the likelihood there.

    Args:
        sample: the choices.
        start: (p,) weights to begin with; those that are not free stay so.
        free: (p,) which are estimated.

    Raises:
        ModelError: the likelihood has no maximum: a weight grows without end.
    """
    if not free.any():
        return start.copy(), sample.value(start)
    n = len(sample.choices)
    scale = np.maximum(sample.costs[:, free].std(axis=0), 1e-12)
    known: dict[bytes, Value] = {}

    def value(scaled: NDArray[np.float64]) -> Value:
        key = scaled.tobytes()
        if key not in known:
            known.clear()
            known[key] = sample.value(_filled(start, free, scaled / scale))
        return known[key]

    def loss(scaled: NDArray[np.float64]) -> float:
        return float(-value(scaled).each.sum() / n)

    def gradient(scaled: NDArray[np.float64]) -> NDArray[np.float64]:
        return -value(scaled).scores.sum(axis=0)[free] / scale / n

    def hessian(scaled: NDArray[np.float64]) -> NDArray[np.float64]:
        return -value(scaled).hessian[np.ix_(free, free)] / np.outer(scale, scale) / n

    found = minimize(
        loss,
        start[free] * scale,
        jac=gradient,
        hess=hessian,
        method="trust-exact",
        options={"gtol": GRADIENT, "maxiter": 200},
    )
    weights = _filled(start, free, found.x / scale)
    if not found.success and np.abs(gradient(found.x)).max() > 1e-3:
        raise ModelError(
            f"estimate: no greatest likelihood after {found.nit} steps: {found.message}"
        )
    return weights, sample.value(weights)


def _filled(
    start: NDArray[np.float64], free: NDArray[np.bool_], values: NDArray[np.float64]
) -> NDArray[np.float64]:
    """(p,) the weights of ``start``, with the free ones replaced."""
    weights = start.copy()
    weights[free] = values
    return weights


def common_scale(sample: Sample, weights: NDArray[np.float64]) -> float:
    """The factor of all weights together that makes observed choices most likely."""
    one = Sample(sample.rows, (sample.costs @ weights)[:, None], sample.choices)
    found, _ = fit(one, np.ones(1), np.ones(1, dtype=np.bool_))
    return float(found[0])


def without(
    sample: Sample, weights: NDArray[np.float64], value: Value, free: NDArray[np.bool_], term: int
) -> Value:
    """The likelihood without one of the free terms, the others estimated anew.

    Args:
        sample: the choices.
        weights: (p,) of greatest likelihood with the term.
        value: the likelihood there.
        free: (p,) which are estimated.
        term: the number of the term.
    """
    others, start = free.copy(), weights.copy()
    others[term], start[term] = False, 0.0
    # Where the others go as this one goes to 0, by the Hessian.
    pull = value.hessian[others, term] * weights[term]
    start[others] += np.linalg.lstsq(value.hessian[np.ix_(others, others)], pull, rcond=None)[0]
    return fit(sample, start, others)[1]
