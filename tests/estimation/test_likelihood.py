"""Likelihoods and their derivatives beside sums written out, and beside differences."""

import math

import numpy as np
import pytest

from mesa_mobility.estimation.errors import blocks_of, bootstrapped, clustered
from mesa_mobility.estimation.fitting import common_scale, fit, without
from mesa_mobility.estimation.likelihood import Rows, Value, evaluate
from mesa_mobility.estimation.problem import Sample

UNSEEN = -np.inf


def rows_of(sizes: list[list[int]], rng: np.random.Generator) -> Rows:
    """Rows of choices with segments of these sizes; some of each segment fit."""
    counts = np.array([size for choice in sizes for size in choice])
    choice = np.repeat(np.arange(len(sizes)), [len(each) for each in sizes])
    starts = np.cumsum(counts) - counts
    n = int(counts.sum())
    fit_ = np.where(rng.random(n) < 0.3, rng.normal(size=n), UNSEEN)
    fit_[starts] = 0.5
    return Rows(
        starts=starts,
        segment=np.repeat(np.arange(len(counts)), counts),
        choice=choice,
        first=np.flatnonzero(np.diff(choice, prepend=-1)),
        weight=-np.log([len(sizes[c]) for c in choice]),
        fit=fit_,
        counts=rng.normal(size=n),
    )


def test_the_likelihood_is_the_sum_over_free_speeds_and_options():
    rng = np.random.default_rng(1)
    rows = rows_of([[4, 3], [5]], rng)
    costs, weights = rng.normal(size=(12, 2)), np.array([0.7, -1.2])

    value = evaluate(rows, costs, weights)

    def probability(rows_: range) -> float:
        total = [math.exp(-float(costs[r] @ weights)) for r in rows_]
        fits = [t * math.exp(rows.fit[r]) for t, r in zip(total, rows_, strict=True)]
        return sum(fits) / sum(
            t * math.exp(rows.counts[r]) for t, r in zip(total, rows_, strict=True)
        )

    first = 0.5 * (probability(range(4)) + probability(range(4, 7)))
    expected = [math.log(first), math.log(probability(range(7, 12)))]
    np.testing.assert_allclose(value.each, expected, rtol=1e-12)


def test_derivatives_are_those_of_differences():
    rng = np.random.default_rng(2)
    rows = rows_of([[6, 5, 7], [8], [3, 9]], rng)
    costs, weights = rng.normal(size=(38, 3)), np.array([0.4, -0.8, 1.5])

    value = evaluate(rows, costs, weights)

    step = 1e-6
    ups = [evaluate(rows, costs, weights + step * e) for e in np.eye(3)]
    downs = [evaluate(rows, costs, weights - step * e) for e in np.eye(3)]
    scores = np.array([(u.each - d.each) / (2 * step) for u, d in zip(ups, downs, strict=True)]).T
    hessian = np.array(
        [(u.scores.sum(0) - d.scores.sum(0)) / (2 * step) for u, d in zip(ups, downs, strict=True)]
    )
    np.testing.assert_allclose(value.scores, scores, atol=1e-7)
    np.testing.assert_allclose(value.hessian, hessian, atol=1e-6)


def drawn(n: int, options: int, weights: np.ndarray, seed: int) -> Sample:
    """Choices drawn from a logit, each observed without error."""
    rng = np.random.default_rng(seed)
    costs = rng.normal(size=(n * options, len(weights)))
    utility = -(costs @ weights) + rng.gumbel(size=n * options)
    best = utility.reshape(n, options).argmax(axis=1) + options * np.arange(n)
    seen = np.full(n * options, UNSEEN)
    seen[best] = 0.0
    number = np.arange(n)
    rows = Rows(
        starts=options * number,
        segment=np.repeat(number, options),
        choice=number,
        first=number,
        weight=np.zeros(n),
        fit=seen,
        counts=np.zeros(n * options),
    )
    return Sample(rows, costs, number)


def test_a_fit_finds_the_weights_of_a_logit_whatever_it_begins_with():
    truth = np.array([1.0, -0.5, 2.0])
    sample = drawn(3000, 12, truth, seed=3)
    free = np.ones(3, dtype=bool)

    near, value = fit(sample, truth, free)
    far, _ = fit(sample, np.array([-8.0, 9.0, 0.0]), free)

    np.testing.assert_allclose(near, far, atol=2e-3)
    errors = np.sqrt(np.diag(np.linalg.inv(-value.hessian)))
    assert (np.abs(near - truth) < 3.5 * errors).all()
    assert (errors < 0.1).all()


def test_a_fixed_weight_stays_and_the_others_move():
    truth = np.array([1.0, 2.0])
    sample = drawn(2000, 10, truth, seed=4)

    weights, _ = fit(sample, np.array([1.0, 0.0]), np.array([False, True]))

    assert weights[0] == 1.0
    assert weights[1] == pytest.approx(2.0, abs=0.25)


def test_a_term_that_matters_loses_likelihood_and_one_of_noise_does_not():
    sample = drawn(1500, 10, np.array([1.5, 0.0]), seed=5)
    free = np.ones(2, dtype=bool)
    weights, value = fit(sample, np.ones(2), free)

    lost = [
        2.0 * (value.each.sum() - without(sample, weights, value, free, k).each.sum())
        for k in range(2)
    ]

    assert lost[0] > 500.0
    assert 0.0 <= lost[1] < 7.9  # the 99.5 % quantile of chi squared with one degree of freedom


def test_the_common_scale_of_weights_twice_too_large_is_a_half():
    sample = drawn(3000, 10, np.array([1.0, -1.0]), seed=6)

    assert common_scale(sample, np.array([2.0, -2.0])) == pytest.approx(0.5, abs=0.04)


def test_clustered_errors_are_those_of_sums_by_group():
    rng = np.random.default_rng(7)
    scores = rng.normal(size=(6, 2))
    value = Value(np.zeros(6), scores, -np.array([[4.0, 1.0], [1.0, 3.0]]))
    groups = np.array([5, 5, 2, 2, 2, 9])

    found = clustered(value, np.ones(2, dtype=bool), groups)

    sums = [scores[:2].sum(0), scores[2:5].sum(0), scores[5]]
    meat = sum(np.outer(s, s) for s in sums)
    bread = np.linalg.inv(-value.hessian)
    np.testing.assert_allclose(found, bread @ meat @ bread * 3 / 2, rtol=1e-12)


def test_choices_repeated_in_a_cluster_have_larger_errors():
    """Ten copies of each choice say no more than the choice."""
    once = drawn(300, 8, np.array([1.0]), seed=8)
    free = np.ones(1, dtype=bool)
    weights, value = fit(once, np.ones(1), free)
    tenfold = Value(
        np.repeat(value.each, 10), np.repeat(value.scores, 10, axis=0), 10.0 * value.hessian
    )
    person = np.repeat(np.arange(300), 10)

    alone = clustered(value, free, np.arange(300))[0, 0]
    copies = clustered(tenfold, free, person)[0, 0]
    steps = bootstrapped(tenfold, free, person, 4000, np.random.default_rng(1))

    assert weights[0] == pytest.approx(1.0, abs=0.3)
    assert copies == pytest.approx(alone, rel=1e-9)
    assert steps.std() == pytest.approx(math.sqrt(alone), rel=0.06)


def test_blocks_are_of_one_run_and_one_time():
    run = np.array([0, 0, 0, 1, 1])
    second = np.array([0.5, 4.9, 5.1, 0.5, 11.0])

    assert blocks_of(run, second, 5.0).tolist() == [0, 0, 1, 2, 3]
