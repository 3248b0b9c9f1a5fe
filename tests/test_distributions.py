"""Distributions against their closed forms, and the texts that they are read from."""

import math
import re

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from scipy import stats

from mesa_mobility.distributions import (
    Constant,
    Empirical,
    Gamma,
    LogNormal,
    Normal,
    TruncatedNormal,
    Uniform,
    Weibull,
    parse,
)
from mesa_mobility.errors import ModelError
from tests.fixtures.speeds import normal_within

MANY = 20_000


def drawn(distribution, n=MANY, seed=1):
    return distribution.draw(n, np.random.default_rng(seed))


@pytest.mark.parametrize(
    ("distribution", "cdf"),
    [
        (Uniform(10.0, 100.0), lambda x: (x - 10.0) / 90.0),
        (Weibull(139.285, 1.195), lambda x: 1.0 - np.exp(-((x / 139.285) ** 1.195))),
        (Normal(1.2, 0.2), lambda x: 0.5 + 0.5 * np.vectorize(math.erf)((x - 1.2) / 0.2 / 2**0.5)),
        (
            LogNormal(4.586, 0.967),
            lambda x: 0.5 + 0.5 * np.vectorize(math.erf)((np.log(x) - 4.586) / 0.967 / 2**0.5),
        ),
        # An Erlang distribution has a closed form: two exponential times of mean 3 in a row.
        (Gamma(2.0, 3.0), lambda x: 1.0 - np.exp(-x / 3.0) * (1.0 + x / 3.0)),
    ],
)
def test_draws_follow_the_closed_form(distribution, cdf):
    assert stats.kstest(drawn(distribution), cdf).pvalue > 0.01


@given(n=st.integers(1, 300), seed=st.integers(0, 2**32 - 1))
@example(n=1, seed=0)
def test_a_crowd_shares_out_its_distribution(n, seed):
    # Of 1 - exp(-(x / 2)^3), one lies in each nth part: between 0 and 1/n, 1/n and 2/n, ...
    below = 1.0 - np.exp(-((np.sort(drawn(Weibull(2.0, 3.0), n, seed)) / 2.0) ** 3))
    part = np.arange(n)
    assert (below * n >= part - 1e-6).all()
    assert (below * n <= part + 1 + 1e-6).all()


def test_who_gets_which_part_is_random():
    x = np.array([drawn(Uniform(0.0, 1.0), 4, seed) for seed in range(2_000)])
    # Each of four people gets each quarter in 500 of 2,000 crowds, 19 being one deviation.
    counts = [np.histogram(column, 4, (0.0, 1.0))[0] for column in x.T]
    assert np.abs(np.array(counts) - 500).max() < 90
    # Within its quarter a value may be anywhere.
    assert stats.kstest((x * 4 % 1).ravel(), "uniform").pvalue > 0.01


def test_draws_for_two_things_have_nothing_to_do_with_each_other():
    rng = np.random.default_rng(7)
    speed, time = Normal(1.3, 0.2).draw(5_000, rng), Weibull(60.0, 1.2).draw(5_000, rng)
    assert abs(stats.spearmanr(speed, time).statistic) < 0.05


def test_nobody_draws_nothing():
    assert Normal(1.3, 0.2).draw(0, np.random.default_rng(1)).shape == (0,)


def test_a_constant_draws_nothing_from_the_generator():
    rng = np.random.default_rng(3)
    assert Constant(2.5).draw(3, rng).tolist() == [2.5] * 3
    assert rng.random() == np.random.default_rng(3).random()


def test_gamma_has_mean_shape_times_scale_as_nist_gives_it():
    assert drawn(Gamma(1.291, 103.901)).mean() == pytest.approx(1.291 * 103.901, rel=0.03)


def test_imo_response_times_by_day_are_cut_off_at_300_s():
    # Of lognormal(3.44, 0.94), Phi((ln 300 - 3.44) / 0.94) = Phi(2.408) = 0.9920 lie below 300 s.
    x = drawn(LogNormal(3.44, 0.94, 0.0, 300.0))
    assert x.max() <= 300.0
    assert np.mean(x < math.exp(3.44)) == pytest.approx(0.5 / 0.9920, abs=0.012)


@pytest.mark.parametrize(
    "given", [(1.34, 0.26, 0.6, 2.0), (0.69, 0.35, 0.05, 1.4), (0.57, 0.19, 0.05, 0.83)]
)
def test_a_truncated_normal_has_the_mean_and_deviation_that_are_given(given):
    x = drawn(TruncatedNormal(*given))
    assert stats.kstest(x, normal_within(*given).cdf).pvalue > 0.01
    # Draws in strata hardly miss them.
    assert (x.mean(), x.std()) == pytest.approx(given[:2], abs=1e-4)
    assert x.min() > given[2]
    assert x.max() < given[3]


@given(
    low=st.floats(-5.0, 5.0),
    below=st.floats(0.1, 5.0),
    above=st.floats(0.1, 5.0),
    share=st.floats(0.02, 0.99),
)
def test_any_truncated_normal_that_can_be_is_found(low, below, above, share):
    mean, high = low + below, low + below + above
    with pytest.raises(ModelError, match="an sd of at most") as refused:
        TruncatedNormal(mean, 10.0, low, high)
    most = float(re.search(r"at most ([\d.e+-]+)", str(refused.value))[1])
    # Nothing is wider than half at either bound, nor narrower than even between the nearer ones.
    assert min(below, above) / 3**0.5 * 0.998 < most < math.sqrt(below * above)
    made = TruncatedNormal(mean, share * most, low, high)
    middles = made.quantile((np.arange(20_000) + 0.5) / 20_000)
    assert middles.mean() == pytest.approx(mean, abs=1e-3 * most)
    assert middles.std() == pytest.approx(share * most, rel=2e-3)


@pytest.mark.parametrize("sd", [0.1, 0.2887, 0.5, math.inf])
def test_nearest_keeps_the_mean_and_as_much_of_the_deviation_as_bounds_allow(sd):
    """Within 0 and 1 around their middle no normal distribution is wider than the uniform one."""
    nearest = TruncatedNormal.nearest(0.5, sd, 0.0, 1.0)
    widest = 1 / math.sqrt(12)
    assert nearest.sd == pytest.approx(min(sd, widest), rel=0.002)
    x = drawn(nearest)
    assert x.mean() == pytest.approx(0.5, abs=0.001)
    assert x.std() == pytest.approx(min(sd, widest), rel=0.005)
    for bounds in ((0.6, 1.0), (0.0, 0.5), (1.0, 0.0), (math.nan, 1.0)):
        with pytest.raises(ModelError, match="low < mean < high"):
            TruncatedNormal.nearest(0.5, 0.1, *bounds)


def test_nearest_has_no_digits_in_which_versions_of_scipy_differ():
    """Published figures of walking frames: SciPy 1.10 and 1.16 differ in the 15th digit."""
    assert TruncatedNormal.nearest(0.57, 0.4, 0.1, 1.02).sd == 0.265202


def test_a_cut_normal_has_no_lumps_at_its_bounds():
    x = drawn(Normal(0.0, 1.0, -1.0, 1.0))
    # One deviation either side holds 68.27 %; the middle of that, from -0.5 to 0.5, 38.29 %.
    assert np.mean(abs(x) < 0.5) == pytest.approx(0.3829 / 0.6827, abs=1e-3)
    assert -1.0 < x.min() < -0.999
    assert 0.999 < x.max() < 1.0


def test_a_cut_far_out_in_the_tail_is_drawn_all_the_same():
    x = drawn(Normal(0.0, 1.0, 12.0, 13.0), n=100)
    assert ((x >= 12.0) & (x <= 13.0)).all()
    assert stats.kstest(x, stats.truncnorm(12.0, 13.0).cdf).pvalue > 0.01


def test_measured_values_are_drawn_alike():
    x = drawn(Empirical([1.0, 2.0, 4.0]))
    assert [np.mean(x == v) for v in (1.0, 2.0, 4.0)] == pytest.approx([1 / 3] * 3, abs=0.015)


def test_measured_values_from_a_file(tmp_path):
    file = tmp_path / "times.csv"
    file.write_text("# measured\nwho, seconds\na, 3\nb, 5\n\n")
    assert Empirical.from_csv(file, "seconds").values.tolist() == [3.0, 5.0]
    assert Empirical.from_csv(file, 1).values.tolist() == [3.0, 5.0]
    for column, match in (("minutes", "seconds"), (2, "who"), ("who", "number"), (-1, "who")):
        with pytest.raises(ModelError, match=match):
            Empirical.from_csv(file, column)
    with pytest.raises(ModelError, match=r"nobody\.csv"):
        Empirical.from_csv(tmp_path / "nobody.csv")
    (tmp_path / "empty.csv").write_text("")
    with pytest.raises(ModelError, match="empty"):
        Empirical.from_csv(tmp_path / "empty.csv")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("lognormal(3.44, 0.94)", LogNormal(3.44, 0.94)),
        ("LogNormal( 3.95,0.84 , 0, 300 )", LogNormal(3.95, 0.84, 0.0, 300.0)),
        ("uniform(10,100)", Uniform(10.0, 100.0)),
        ("normal(1.2, 0.2)", Normal(1.2, 0.2)),
        ("truncatednormal(1.2, 0.2, 0.6, 2)", TruncatedNormal(1.2, 0.2, 0.6, 2.0)),
        ("weibull(139.285, 1.195)", Weibull(139.285, 1.195)),
        ("gamma(1.291, 103.901)", Gamma(1.291, 103.901)),
        ("constant(5)", Constant(5.0)),
        (" 12.5 ", Constant(12.5)),
    ],
)
def test_texts(text, expected):
    assert parse(text) == expected


@pytest.mark.parametrize(
    "text",
    [
        "",
        "poisson(3)",
        "normal",
        "normal(1)",
        "normal(1,2,3,4,5)",
        "uniform(a,b)",
        "uniform(2,1)",
        "(3)",
        "3)",
        "lognormal(3.44, 0.94",
        "normal(nan, 1)",
        "weibull(0, 1)",
        "gamma(1, -1)",
    ],
)
def test_texts_that_are_none(text):
    with pytest.raises(ModelError, match="distribution") as refused:
        parse(text)
    assert "\n" not in str(refused.value)


@pytest.mark.thorough
@given(st.text(max_size=30).filter(lambda text: not any(c.isdigit() for c in text)))
def test_texts_without_numbers_are_refused_in_one_line(text):
    with pytest.raises(ModelError) as refused:
        parse(text)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    "make",
    [
        lambda: Constant(math.inf),
        lambda: Constant("three"),
        lambda: Uniform(0.0, math.inf),
        lambda: Normal(0.0, -1.0),
        lambda: Normal("0", 1.0),
        lambda: Normal(0.0, 1.0, 2.0, 2.0),
        lambda: Normal(5.0, 0.0, 0.0, 1.0),
        lambda: LogNormal(0.0, 0.0),
        lambda: LogNormal(0.0, 1.0, -1.0),
        lambda: Weibull(math.nan, 1.0),
        lambda: TruncatedNormal(1.0, 0.0, 0.0, 2.0),
        lambda: TruncatedNormal(2.0, 0.1, 0.0, 2.0),
        lambda: TruncatedNormal(1.0, 0.6, 0.0, 2.0),
        lambda: TruncatedNormal(1.0, math.nan, 0.0, 2.0),
        lambda: TruncatedNormal(1.0, 0.2, 2.0, 0.0),
        lambda: Empirical([]),
        lambda: Empirical([[1.0]]),
        lambda: Empirical([math.nan]),
        lambda: Empirical("abc"),
    ],
)
def test_what_cannot_be_is_refused(make):
    with pytest.raises(ModelError):
        make()
