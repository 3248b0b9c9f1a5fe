"""How well weights tell observed choices, by measures that are the same for all models."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.estimation.problem import Problem


@dataclass(frozen=True)
class Measures:
    """Measures of choices.

    Attributes:
        nats: negative log-likelihood, per choice, of the observed end among options that are drawn
            uniformly and are the same for all models. Choices without an option near enough to the
            end count as if all options were equally likely.
        uniform: negative log-likelihood per choice if all options were equally likely.
        energy: energy score of the predicted distribution of end points, mean over all choices,
            metres (Gneiting and Raftery, JASA 102 (2007) 359-378).
        choices: number of choices.
        matched: number of choices with an option near enough to the end.
    """

    nats: float
    uniform: float
    energy: float
    choices: int
    matched: int


def measure(
    problem: Problem,
    weights: NDArray[np.float64],
    chosen: NDArray[np.bool_] | None = None,
) -> Measures:
    """Measures of choices with (p,) weights of the terms.

    Args:
        problem: the choices and terms.
        weights: (p,).
        chosen: (choices,) which; by default all.
    """
    layout = problem.layout
    picked = np.ones(len(layout.matched), dtype=np.bool_) if chosen is None else chosen
    n, matched = int(picked.sum()), int((picked & layout.matched).sum())
    drawn = np.add.reduceat((~layout.near).astype(np.float64), problem.segments)
    first = np.flatnonzero(np.diff(layout.choice, prepend=-1))
    uniform = np.log1p(drawn[first])[picked]
    told = np.where(layout.matched, 0.0, np.log1p(drawn[first]))
    if matched:
        sample = problem.sample("standard", picked)
        told[sample.choices] = -sample.value(weights).each
    return Measures(
        nats=float(told[picked].mean()),
        uniform=float(uniform.mean()),
        energy=float(energy_scores(problem, weights)[picked].mean()),
        choices=n,
        matched=matched,
    )


def energy_scores(problem: Problem, weights: NDArray[np.float64]) -> NDArray[np.float64]:
    """(choices,) energy score of each end, metres, among the options drawn uniformly.

    Mean distance of predicted from observed ends, less half the mean distance between two of them.
    """
    layout, costs, before = problem.layout, problem.costs, 0
    found = []
    for batch in problem.observations.batches:
        n = len(batch.candidates)
        total = -(costs[before : before + n] @ weights)
        points, near = batch.candidates.points, layout.near[before : before + n]
        before += n
        for choice, end in enumerate(batch.ends):
            segments = np.flatnonzero(batch.choice == choice)
            rows = [np.arange(*batch.candidates.offsets[s : s + 2]) for s in segments]
            drawn = [each[~near[each]] for each in rows]
            share = np.mean([_shares(total[each]) for each in drawn], axis=0)
            at = points[drawn[0]]
            between = np.hypot(*(at[:, None] - at[None]).transpose(2, 0, 1))
            away = np.hypot(*(at - end).T)
            found.append(share @ away - 0.5 * share @ between @ share)
    return np.array(found)


def _shares(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n,) probabilities of options from minus their costs."""
    powers = np.exp(values - values.max())
    shares: NDArray[np.float64] = powers / powers.sum()
    return shares
