"""Weights of cost terms from observed choices."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.stats import chi2, norm

from mesa_mobility.crowd.costs.terms import CostTerm
from mesa_mobility.errors import ModelError, ResultsError
from mesa_mobility.estimation.choices.observations import Observations
from mesa_mobility.estimation.errors import blocks_of, bootstrapped, clustered, information
from mesa_mobility.estimation.estimates import Estimate
from mesa_mobility.estimation.fitting import fit, without
from mesa_mobility.estimation.identification import unidentified
from mesa_mobility.estimation.measures import measure
from mesa_mobility.estimation.problem import Problem

BLOCK = 5.0
"""Seconds of a block of the bootstrap."""

REPEATS = 1000
"""Draws of blocks."""

SEED = 1
"""Of the bootstrap."""


def estimate(
    terms: Sequence[CostTerm | str],
    observations: Observations,
    *,
    fixed: Sequence[str] = (),
    tests: bool = True,
) -> Estimate:
    """Weights of terms that make observed choices most likely.

    Args:
        terms: cost terms, or names of registered ones; their weights are where the search begins.
        observations: of ``observe``.
        fixed: names of terms that keep their weights.
        tests: whether each term is left out once, for a likelihood-ratio test.

    Raises:
        ModelError: terms that cannot be told apart, which are named, or unknown names.
        ResultsError: no choice has an option near enough.
    """
    problem = Problem.of(terms, observations)
    free = free_terms(problem, fixed)
    if not problem.layout.matched.any():
        raise ResultsError("estimate: no choice has an option near enough")
    problem.with_terms(np.flatnonzero(free).tolist()).check()
    sample = problem.sample()
    weights, value = fit(sample, problem.given, free)
    chosen = sample.choices
    person = clustered(value, free, observations.person[chosen])
    blocks = blocks_of(observations.run[chosen], observations.second[chosen], BLOCK)
    steps = bootstrapped(value, free, blocks, REPEATS, np.random.default_rng(SEED))
    by_person, by_time, errors = np.zeros((3, len(weights)))
    by_person[free] = np.sqrt(np.diag(person))
    by_time[free] = steps.std(axis=0, ddof=1)
    errors = np.maximum(by_person, by_time)
    half = norm.ppf(0.975) * errors
    ratios, p_values = np.full((2, len(weights)), np.nan)
    naive = np.zeros(len(weights))
    naive[free] = np.diag(information(value, free))
    for k in np.flatnonzero(free) if tests else []:
        less = without(sample, weights, value, free, int(k))
        ratios[k] = 2.0 * (value.each.sum() - less.each.sum())
        # Choices depend on each other, so that the ratio grows by as much as the variance
        # (Rotnitzky and Jewell, Biometrika 77 (1990) 485-497).
        p_values[k] = chi2.sf(ratios[k] * naive[k] / errors[k] ** 2, 1)
    return Estimate(
        terms=problem.names,
        weights=weights,
        free=free,
        errors=errors,
        by_person=by_person,
        by_time=by_time,
        intervals=np.column_stack([weights - half, weights + half]),
        likelihood_ratios=ratios,
        p_values=p_values,
        assumed=unidentified(problem),
        log_likelihood=float(value.each.sum()),
        measures=measure(problem, weights),
    )


def free_terms(problem: Problem, fixed: Sequence[str]) -> NDArray[np.bool_]:
    """(p,) which terms are not fixed.

    Raises:
        ModelError: an unknown name, or no term left.
    """
    for name in fixed:
        if name not in problem.names:
            raise ModelError(f"fixed: no term {name!r}, there are {', '.join(problem.names)}")
    free = np.array([name not in fixed for name in problem.names])
    if not free.any():
        raise ModelError("fixed: all terms, expected one at least to estimate")
    return free
