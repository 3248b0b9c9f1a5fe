"""Profiles of a term's own numbers: the likelihood where one of them is set and the rest fitted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import cast

import numpy as np
from numpy.typing import NDArray
from scipy.stats import chi2

from mesa_mobility.crowd.costs.terms import CostTerm
from mesa_mobility.errors import ModelError
from mesa_mobility.estimation.choices.observations import Observations
from mesa_mobility.estimation.estimating import free_terms
from mesa_mobility.estimation.fitting import fit
from mesa_mobility.estimation.problem import Problem
from mesa_mobility.plugins.settings import declared


@dataclass(frozen=True, eq=False)
class Profile:
    """The likelihood along the values of one number.

    Attributes:
        name: of the number, such as ``headway.time``.
        values: (k,) that it was set to.
        log_likelihoods: (k,) of all matched choices, all weights fitted anew, nats.
        weights: (k,) of its term.
    """

    name: str
    values: NDArray[np.float64]
    log_likelihoods: NDArray[np.float64]
    weights: NDArray[np.float64]

    @property
    def best(self) -> float:
        """The value of greatest likelihood, m, s or m/s as the number is."""
        return float(self.values[np.argmax(self.log_likelihoods)])

    @property
    def within(self) -> tuple[float, float]:
        """Least and greatest of the values that a likelihood-ratio test does not reject at 5 %, as
        if choices were independent."""
        lost = 2.0 * (self.log_likelihoods.max() - self.log_likelihoods)
        kept = self.values[lost <= chi2.ppf(0.95, 1)]
        return float(kept.min()), float(kept.max())


def profile(
    name: str,
    values: Sequence[float],
    terms: Sequence[CostTerm | str],
    observations: Observations,
    *,
    fixed: Sequence[str] = (),
) -> Profile:
    """The likelihood where a number of a term takes some values, all weights fitted to each.

    Args:
        name: the term and its setting, as ``headway.time``.
        values: of the setting, one or more.
        terms: cost terms, or names of registered ones; the term's setting is as before afterwards.
        observations: of ``observe``.
        fixed: names of terms that keep their weights.

    Raises:
        ModelError: no such term or setting, a value out of its range, or what ``estimate`` refuses.
    """
    problem = Problem.of(terms, observations)
    free = free_terms(problem, fixed)
    of, _, setting = name.partition(".")
    if of not in problem.names:
        raise ModelError(f"{name}: no term {of!r}, there are {', '.join(problem.names)}")
    number = problem.names.index(of)
    term = problem.terms[number]
    if setting not in declared(type(term)) or not len(values):
        known = ", ".join(f"{of}.{each}" for each in declared(type(term)))
        raise ModelError(
            f"{name}: expected a setting and values of it, there are {known or 'none'}"
        )
    before, found, weights = getattr(term, setting), [], problem.given
    try:
        for value in values:
            setattr(term, setting, value)
            costs = problem.costs.copy()
            costs[:, number] = observations.costs(term)
            with_value = Problem(observations, problem.terms, costs)
            weights, likelihood = fit(with_value.sample(), weights, free)
            found.append((float(likelihood.each.sum()), float(weights[number])))
    finally:
        setattr(term, setting, before)
    likelihoods, own = np.array(found).T
    return Profile(name, np.array(values, dtype=np.float64), likelihoods, cast("NDArray", own))
