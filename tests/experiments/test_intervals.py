"""Intervals: by hand, and how often they hold what they should."""

import numpy as np
import pytest

from mesa_mobility.errors import ModelError
from mesa_mobility.experiments import (
    Estimate,
    OccupancyConvergence,
    Precision,
    mean_interval,
    quantile_interval,
)
from mesa_mobility.experiments.convergence import (
    assess,
    converged,
    functional_changes,
    mean_curves,
)


def test_the_interval_of_a_mean_by_hand():
    # Mean 3, standard deviation sqrt(2.5); Student's t at 97.5 % with 4 degrees is 2.77645.
    found = mean_interval([1, 2, 3, 4, 5, float("nan")])
    half = 2.77645 * np.sqrt(2.5 / 5)
    assert found.value == 3.0
    assert (found.low, found.high) == pytest.approx((3 - half, 3 + half), abs=1e-4)
    assert found.half_width == pytest.approx(half, abs=1e-4)


def test_too_few_values_have_no_interval():
    assert mean_interval([]) == Estimate(None)
    assert mean_interval([2.0]) == Estimate(2.0, runs=1)
    # 0.95 ** 71 > 0.025 > 0.95 ** 72: below 72 values the greatest may lie below the percentile.
    assert quantile_interval(np.arange(71), 0.95).high is None
    assert quantile_interval(np.arange(72), 0.95).high == 71


def test_the_interval_of_a_median_by_hand():
    # Of ten values 2 to 8 lie below the median with 97.9 %: the second to the ninth in order.
    found = quantile_interval(np.arange(1, 11), 0.5)
    assert (found.value, found.low, found.high) == (5.5, 2.0, 9.0)


@pytest.mark.parametrize("n", [80, 200])
def test_intervals_hold_what_they_should(n):
    rng = np.random.default_rng(3)
    true_mean, true_p95 = np.exp(0.02), np.exp(0.2 * 1.6448536)
    held = np.zeros(2)
    for _ in range(2000):
        values = rng.lognormal(0.0, 0.2, n)
        for k, (found, true) in enumerate(
            ((mean_interval(values), true_mean), (quantile_interval(values, 0.95), true_p95))
        ):
            held[k] += found.low <= true <= found.high
    # The second has at least its confidence, since values lie apart.
    assert 0.935 < held[0] / 2000 < 0.965
    assert 0.935 < held[1] / 2000 < 0.99


def test_curves_go_on_with_their_last_value():
    means = mean_curves([[4, 2, 0], [4, 4, 2, 0]])
    assert means.tolist() == [[4, 2, 0, 0], [4, 3, 1, 0]]


def test_functional_measures_by_hand():
    # One curve is twice the other, and one is its mirror image.
    (twice,) = functional_changes(np.array([[3.0, 2.0, 1.0], [6.0, 4.0, 2.0]]))
    assert twice == pytest.approx([1.0, 2.0, 1.0])
    (mirrored,) = functional_changes(np.array([[3.0, 2.0, 1.0], [1.0, 2.0, 3.0]]))
    assert mirrored == pytest.approx([np.sqrt(8 / 14), 10 / 14, -1.0])
    (equal,) = functional_changes(np.zeros((2, 3)))
    assert equal.tolist() == [0.0, 1.0, 1.0]


def test_a_curve_that_stays_has_converged_and_one_that_changes_has_not():
    asked = OccupancyConvergence(tolerance=0.01, consecutive=3)
    assert not converged(asked, [[5, 3, 0]] * 3)
    assert converged(asked, [[5, 3, 0]] * 4)
    assert not converged(asked, [[5, 3, 0]] * 4 + [[50, 50, 0]])
    # The mean curve of 200 forgets one that differs.
    assert converged(asked, [[50, 50, 0]] + [[5, 3, 0]] * 2000)


def test_a_point_is_known_once_all_that_is_asked_for_is():
    precision = Precision(("mean egress_s",), tolerance=0.1, occupancy=None)
    values = np.array([10.0, 11.0] * 10)
    assert assess(precision, 20, {"egress_s": values}, []).enough
    wide = assess(precision, 20, {"egress_s": np.array([1.0, 20.0] * 10)}, [])
    assert wide.met == {"mean egress_s": False}
    assert not assess(precision, 20, {}, []).enough
    both = Precision(("mean egress_s", "p95 egress_s"), tolerance=0.1)
    assert assess(both, 20, {"egress_s": values}, [[1, 0]] * 20).met == {
        "mean egress_s": True,
        "p95 egress_s": False,
        "occupancy": True,
    }


def test_the_interval_of_a_mean_that_ended_the_runs_is_the_one_asked_for():
    precision = Precision(("mean egress_s",), tolerance=0.1, least=20, occupancy=None)
    # Half-widths by Student's t: 1.04 of 10.25 for the first 20, 0.82 of 10.16 for all 25.
    values = np.array([7.0, 11.0, 13.0, 10.0] * 5 + [9.0, 10.0, 10.5, 9.5, 10.0])
    first, last = mean_interval(values[:20]), mean_interval(values)
    assert first.half_width > 0.1 * first.value
    assert last.half_width < 0.1 * last.value
    found = assess(precision, 25, {"egress_s": values}, []).estimates["mean egress_s"]
    assert found.value == last.value
    assert (found.low, found.high) == pytest.approx((0.9 * last.value, 1.1 * last.value))
    # Known from the first look on: nothing has been waited for, and the interval is Student's.
    wide = Precision(("mean egress_s",), tolerance=0.3, least=20, occupancy=None)
    assert assess(wide, 20, {"egress_s": values[:20]}, []).estimates["mean egress_s"] == first
    assert assess(wide, 25, {"egress_s": values}, []).estimates["mean egress_s"] == last
    # The same where a run has failed.
    missing = np.append(np.nan, values)[:25]
    late = assess(precision, 25, {"egress_s": missing}, []).estimates["mean egress_s"]
    assert late.half_width == pytest.approx(0.1 * late.value)


@pytest.mark.slow
def test_stopping_when_values_scatter_little_does_not_make_intervals_too_narrow():
    """Student's intervals at the end of such runs hold the mean in 93.8 % of cases."""
    precision = Precision(("mean egress_s",), tolerance=0.02, occupancy=None)
    rng, held, repetitions = np.random.default_rng(1), 0, 4000
    for _ in range(repetitions):
        values, count = rng.normal(10.0, 0.9, precision.most), 0
        while True:
            count = precision.next_count(count)
            known = assess(precision, count, {"egress_s": values[:count]}, [])
            if known.enough:
                break
        found = known.estimates["mean egress_s"]
        held += found.low <= 10.0 <= found.high
    assert 0.946 < held / repetitions < 0.966


def test_replications_grow_by_a_quarter_to_the_most():
    precision = Precision(("mean egress_s",), least=20, most=40)
    counts = [0]
    while counts[-1] < 40:
        counts.append(precision.next_count(counts[-1]))
    assert counts == [0, 20, 25, 32, 40]
    assert precision.next_count(40) == 40


@pytest.mark.parametrize(
    ("keywords", "message"),
    [
        ({"figures": ["egress_s"]}, "expected one such as"),
        ({"figures": ["p100 egress_s"]}, "expected one such as"),
        ({"tolerance": 0}, "tolerance is 0"),
        ({"confidence": 95}, "confidence is 95, expected a number between 0 and 1"),
        ({"least": 1}, "least is 1, expected a whole number, 2 or more"),
        ({"least": 10, "most": 5}, r"most is 5, expected a whole number, 10 \(least\) or more"),
    ],
)
def test_precisions_that_are_none(keywords, message):
    with pytest.raises(ModelError, match=message):
        Precision(**keywords)


@pytest.mark.parametrize("keywords", [{"tolerance": 2}, {"consecutive": 0}])
def test_convergences_that_are_none(keywords):
    with pytest.raises(ModelError):
        OccupancyConvergence(**keywords)
