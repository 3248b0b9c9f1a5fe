"""Likelihood on runs that the weights have not seen."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.costs.terms import CostTerm
from mesa_mobility.errors import ModelError
from mesa_mobility.estimation.choices.observations import Observations
from mesa_mobility.estimation.estimating import free_terms
from mesa_mobility.estimation.fitting import common_scale, fit
from mesa_mobility.estimation.measures import Measures, measure
from mesa_mobility.estimation.problem import Problem


@dataclass(frozen=True, eq=False)
class LeftOut:
    """A fold told by weights that were estimated on all others.

    Attributes:
        fold: its name.
        terms: names of the terms.
        weights: (p,) estimated on the other folds.
        measures: of the fold with these weights.
        given: of the fold with the weights that the terms have, times the common factor that suits
            the other folds best.
        scale: that factor.
    """

    fold: str
    terms: tuple[str, ...]
    weights: NDArray[np.float64]
    measures: Measures
    given: Measures
    scale: float


def leave_out(
    terms: Sequence[CostTerm | str], observations: Observations, *, fixed: Sequence[str] = ()
) -> list[LeftOut]:
    """Each fold, told by weights that were estimated on the others.

    Args:
        terms: cost terms, or names of registered ones.
        observations: of two folds or more.
        fixed: names of terms that keep their weights.

    Raises:
        ModelError: a single fold, or what ``estimate`` refuses.
    """
    problem = Problem.of(terms, observations)
    free = free_terms(problem, fixed)
    problem.with_terms(np.flatnonzero(free).tolist()).check()
    folds = list(dict.fromkeys(observations.folds))
    if len(folds) < 2:
        raise ModelError(f"leave_out: got the fold {folds[0]!r} alone, expected two or more")
    of_run = np.array([folds.index(each) for each in observations.folds])
    of_choice, found = of_run[observations.run], []
    for number, name in enumerate(folds):
        own = of_choice == number
        sample = problem.sample(chosen=~own)
        weights, _ = fit(sample, problem.given, free)
        scale = common_scale(problem.sample("standard", ~own), problem.given)
        found.append(
            LeftOut(
                fold=name,
                terms=problem.names,
                weights=weights,
                measures=measure(problem, weights, own),
                given=measure(problem, scale * problem.given, own),
                scale=scale,
            )
        )
    return found
