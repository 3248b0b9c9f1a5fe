"""Likelihood of observed choices, with exact gradients and Hessians.

The probability of an option falls with its cost, ``exp(-cost)`` over the sum of all options (a
conditional logit, McFadden 1974). What is observed is not the option but where the person was when
it ended, with an error, and neither the option nor the free speed is known. So the likelihood of a
choice is a sum over both:

    L = sum over speeds q of w_q  sum over options o of P(o | q) f(o),

where f(o) says how well an option fits what was observed. Its logarithm is a difference of two
log-sums over options, whose derivatives are means and covariances of the attributes.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import internal, kept
from mesa_mobility.estimation.choices.observations import Batch, Observations
from mesa_mobility.estimation.choices.poses import STANDS

UNSEEN = -np.inf

ALONG, ACROSS = 0.02, 0.03
"""Standard deviations of how far heads are from where a movement leads, metres along and across the
way on which people came: heads sway to the side by up to 5 cm when a movement begins and when it
ends."""

TURNED = np.deg2rad(25.0)
"""Standard deviation of the facing of people who walk from the direction in which they walk,
radians. It is assumed: heads do not show it."""

SWAY = 0.2
"""Speed at which heads sway, m/s."""


class Rows(NamedTuple):
    """Options of choices in segments, one for each choice and free speed.

    Attributes:
        starts: (segments,) first row of each.
        segment: (rows,) the segment.
        choice: (segments,) the choice.
        first: (choices,) first segment of each.
        weight: (segments,) log of the probability of the free speed.
        fit: (rows,) log of how well an option fits the observation; -inf where it does not.
        counts: (rows,) log of how many available options a row stands for.
    """

    starts: NDArray[np.int64]
    segment: NDArray[np.int64]
    choice: NDArray[np.int64]
    first: NDArray[np.int64]
    weight: NDArray[np.float64]
    fit: NDArray[np.float64]
    counts: NDArray[np.float64]


class Value(NamedTuple):
    """Log-likelihoods and their derivatives by p weights.

    Attributes:
        each: (choices,) log-likelihood, nats.
        scores: (choices, p) their gradients.
        hessian: (p, p) of the sum.
    """

    each: NDArray[np.float64]
    scores: NDArray[np.float64]
    hessian: NDArray[np.float64]


class Layout(NamedTuple):
    """Rows of observations as they are stored, and which choices are matched.

    Attributes:
        sizes: (segments,) rows of each segment.
        choice: (segments,) the choice.
        near: (rows,) whether an option ends near the observed end.
        off: (rows,) minus the logarithm of the density of the observation if an option was taken.
        stands_for: (rows,) how many available options each stands for.
        matched: (choices,) whether an option is near enough.
    """

    sizes: NDArray[np.int64]
    choice: NDArray[np.int64]
    near: NDArray[np.bool_]
    off: NDArray[np.float64]
    stands_for: NDArray[np.float64]
    matched: NDArray[np.bool_]


def layout_of(observations: Observations) -> Layout:
    """The rows of all batches, one after the other."""
    batches, before, choices = observations.batches, 0, []
    for batch in batches:
        choices.append(batch.choice + before)
        before += len(batch.people)
    choice = np.concatenate(choices)
    sizes = np.concatenate([np.diff(each.candidates.offsets) for each in batches])
    near = np.concatenate([each.near for each in batches])
    matched = np.zeros(before, dtype=np.bool_)
    matched[np.repeat(choice, sizes)[near]] = True
    return Layout(
        sizes,
        choice,
        near,
        np.concatenate([misfit(each) for each in batches]),
        np.concatenate([each.stands_for for each in batches]),
        matched,
    )


def misfit(batch: Batch) -> NDArray[np.float64]:
    """(rows,) minus the logarithm of the density of what was observed if an option was taken.

    Of the end, 1/m2, and, where people walk, of the direction in which they walked then, 1/rad:
    they are taken to face where they walk, with a normal error of ``TURNED``, and more the slower
    they are.
    """
    along, across = batch.off.T
    off = 0.5 * ((along / ALONG) ** 2 + (across / ACROSS) ** 2) + np.log(
        2.0 * np.pi * ALONG * ACROSS
    )
    speeds = np.hypot(*batch.leaving.T)
    ways = np.arctan2(batch.leaving[:, 1], batch.leaving[:, 0])
    errors = np.hypot(TURNED, SWAY / np.maximum(speeds, 1e-9))
    seen = (speeds > STANDS)[batch.choice][batch.candidates.owner]
    way, error = (each[batch.choice][batch.candidates.owner] for each in (ways, errors))
    turned = np.angle(np.exp(1j * (batch.candidates.headings - way)))
    facing = 0.5 * (turned / error) ** 2 + np.log(np.sqrt(2.0 * np.pi) * error)
    return off + np.where(seen, facing, 0.0)


def rows_of(
    layout: Layout,
    chosen: NDArray[np.bool_],
    fit: NDArray[np.float64],
    counts: NDArray[np.float64],
) -> tuple[Rows, NDArray[np.int64]]:
    """Rows of some choices, and their (n,) numbers among all rows.

    Args:
        layout: all rows.
        chosen: (choices,) matched choices alone.
        fit: (rows,) as in ``Rows``.
        counts: (rows,) as in ``Rows``.
    """
    segment = np.repeat(np.arange(len(layout.sizes)), layout.sizes)
    at = np.flatnonzero(chosen[layout.choice[segment]])
    seen, own = np.unique(segment[at], return_inverse=True)
    _, choice = np.unique(layout.choice[seen], return_inverse=True)
    first = np.flatnonzero(np.diff(choice, prepend=-1))
    segments = np.diff([*first, len(choice)])
    rows = Rows(
        starts=np.flatnonzero(np.diff(own, prepend=-1)),
        segment=own,
        choice=choice,
        first=first,
        weight=-np.log(segments)[choice],
        fit=fit[at],
        counts=counts[at],
    )
    return rows, at


def standard(layout: Layout) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """``fit`` and ``counts`` of the standard measure: the observed end is one option among those
    drawn uniformly, as likely as the options near it on average.

    The average is weighted by how well each fits. That of the nearest option alone would depend on
    its facing, which is not observed.
    """
    near = np.where(layout.near, -layout.off, UNSEEN)
    starts = np.cumsum(layout.sizes) - layout.sizes
    sums = np.add.reduceat(np.exp(near), starts)
    logs = np.log(np.where(sums > 0.0, sums, 1.0))
    fit = near - np.repeat(logs, layout.sizes)
    return fit, np.where(layout.near, fit, 0.0)


def latent(layout: Layout) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """``fit`` and ``counts`` of the likelihood of ends; the fit is a density."""
    return np.where(layout.near, -layout.off, UNSEEN), np.log(layout.stands_for)


def evaluate(rows: Rows, costs: NDArray[np.float64], weights: NDArray[np.float64]) -> Value:
    """The log-likelihoods of choices.

    Args:
        rows: the options.
        costs: (rows, p) cost of each term, without weights.
        weights: (p,).
    """
    n, p, segments = len(rows.first), costs.shape[1], len(rows.starts)
    found = _Found(
        each=np.empty(n),
        scores=np.zeros((n, p)),
        factors=np.empty(len(costs)),
        shares=np.empty(segments),
        of_all=np.zeros((segments, p)),
        of_fit=np.zeros((segments, p)),
    )
    starts, first = np.append(rows.starts, len(costs)), np.append(rows.first, segments)
    _evaluate(starts, first, rows.weight, costs @ -weights, rows.fit, rows.counts, costs, found)
    share, gradients = found.shares[:, None], found.of_all - found.of_fit
    hessian = costs.T @ (found.factors[:, None] * costs)
    for each in (found.of_all, gradients):
        hessian += each.T @ (share * each)
    hessian -= found.of_fit.T @ (share * found.of_fit) + found.scores.T @ found.scores
    return Value(found.each, found.scores, hessian)


class _Found(NamedTuple):
    """What one pass over the rows gives.

    Attributes:
        each: as in ``Value``.
        scores: as in ``Value``.
        factors: (rows,) of the products of two attributes in the Hessian.
        shares: (segments,) probability of each segment of a choice, given the observation.
        of_all: (segments, p) mean attributes of all options.
        of_fit: (segments, p) mean attributes of the options, given the observation.
    """

    each: NDArray[np.float64]
    scores: NDArray[np.float64]
    factors: NDArray[np.float64]
    shares: NDArray[np.float64]
    of_all: NDArray[np.float64]
    of_fit: NDArray[np.float64]


@kept(error_model="numpy")
def _evaluate(
    starts: NDArray[np.int64],
    first: NDArray[np.int64],
    weight: NDArray[np.float64],
    total: NDArray[np.float64],
    fit: NDArray[np.float64],
    counts: NDArray[np.float64],
    costs: NDArray[np.float64],
    found: _Found,
) -> None:
    """Write the values of ``_Found``."""
    each, scores, factors, shares, of_all, of_fit = found
    p = costs.shape[1]
    for c in range(len(each)):
        top = -np.inf
        for s in range(first[c], first[c + 1]):
            all_sum = _log_sum(total, counts, starts[s], starts[s + 1])
            fit_sum = _log_sum(total, fit, starts[s], starts[s + 1])
            shares[s] = weight[s] + fit_sum - all_sum
            top = max(top, shares[s])
            for r in range(starts[s], starts[s + 1]):
                in_all = math.exp(total[r] + counts[r] - all_sum)
                in_fit = math.exp(total[r] + fit[r] - fit_sum) if fit[r] > -np.inf else 0.0
                factors[r] = in_fit - in_all
                for i in range(p):
                    of_all[s, i] += in_all * costs[r, i]
                if in_fit > 0.0:
                    for i in range(p):
                        of_fit[s, i] += in_fit * costs[r, i]
        summed = 0.0
        for s in range(first[c], first[c + 1]):
            summed += math.exp(shares[s] - top)
        each[c] = top + math.log(summed)
        for s in range(first[c], first[c + 1]):
            shares[s] = math.exp(shares[s] - each[c])
            for r in range(starts[s], starts[s + 1]):
                factors[r] *= shares[s]
            for i in range(p):
                scores[c, i] += shares[s] * (of_all[s, i] - of_fit[s, i])


@internal()
def _log_sum(total: NDArray[np.float64], more: NDArray[np.float64], first: int, last: int) -> float:
    """Logarithm of the sum of exponentials of both together, from row ``first`` to ``last``."""
    top = -np.inf
    for r in range(first, last):
        top = max(top, total[r] + more[r])
    summed = 0.0
    for r in range(first, last):
        summed += math.exp(total[r] + more[r] - top) if more[r] > -np.inf else 0.0
    return top + math.log(summed)
