"""Shares of types, and walking speed by age against the table that it comes from."""

import numpy as np
import pytest

from mesa_mobility.errors import ModelError
from mesa_mobility.populations import Population, presets, walking_speed

# Rows of the curve (Weidmann 1993, RiMEA test 7): years, mean and deviation in m/s.
CURVE = [(3, 0.60, 0.12), (20, 1.61, 0.31), (50, 1.41, 0.27), (80, 0.69, 0.13)]


@pytest.mark.parametrize(("age", "mean", "sd"), [*CURVE, (35 / 2, 1.535, 0.295)])
def test_mean_and_deviation_by_age(age, mean, sd):
    speeds = walking_speed(np.full(4000, age), np.random.default_rng(1))
    # Cut at three deviations, a normal curve's deviation is 1.3 % less.
    assert speeds.mean() == pytest.approx(mean, abs=0.015)
    assert speeds.std() == pytest.approx(sd, rel=0.04)
    assert np.abs(speeds - mean).max() <= 3 * sd


def test_each_has_the_speed_of_its_own_age():
    ages = np.repeat([5.0, 25.0], 500)
    speeds = walking_speed(ages, np.random.default_rng(2))
    assert speeds[:500].mean() == pytest.approx(0.78, abs=0.03)
    assert speeds[500:].mean() == pytest.approx(1.58, abs=0.05)


def test_nobody_is_drawn_faster_than_bodies_are():
    speeds = walking_speed(np.full(4000, 20.0), np.random.default_rng(3), fastest=1.85)
    # 1.61 and 0.31 m/s, cut 0.774 deviations above the mean and 3 below: that takes the mean down
    # by (0.2957 - 0.0044) / (0.7806 - 0.0013) deviations.
    assert speeds.max() <= 1.85
    assert speeds.mean() == pytest.approx(1.61 - 0.31 * 0.3738, abs=0.015)
    with pytest.raises(ModelError, match="fastest"):
        walking_speed([20.0], np.random.default_rng(0), fastest=1.6)


@pytest.mark.parametrize("ages", [[2.0], [81.0], [np.nan], 30.0])
def test_ages_that_the_curve_does_not_have(ages):
    with pytest.raises(ModelError, match="3 to 80"):
        walking_speed(ages, np.random.default_rng(0))


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("n", [0, 1, 7, 100])
def test_each_type_gets_its_share_rounded_up_or_down(seed, n):
    population = Population({"a": 0.6, "b": 0.25, "c": 0.15})
    counts = np.bincount(population.draw(n, np.random.default_rng(seed)), minlength=3)
    assert counts.sum() == n
    assert (np.abs(counts - n * np.array([0.6, 0.25, 0.15])) < 1.0 + 1e-9).all()


def test_a_rare_type_comes_as_often_as_its_share():
    population, rng = Population({"a": 0.99, "b": 0.01}), np.random.default_rng(1)
    many = sum(int(population.draw(10, rng).sum()) for _ in range(20_000))
    # 2,000 expected, each draw has one at most: a standard deviation of 42.
    assert many == pytest.approx(2000, abs=170)


def test_types_come_in_random_order():
    drawn = Population({"a": 0.5, "b": 0.5}).draw(1000, np.random.default_rng(1))
    # Runs of equal types: 501 expected, with a deviation of 16.
    assert 1 + np.count_nonzero(np.diff(drawn)) == pytest.approx(501, abs=64)


def test_of_one_type_nothing_is_drawn():
    rng = np.random.default_rng(1)
    assert Population({"a": 1.0, "b": 0}).draw(5, rng).tolist() == [0] * 5
    assert rng.random() == np.random.default_rng(1).random()


def test_texts():
    assert Population.of("mixed") is presets()["mixed"]
    assert Population.of("child").shares == {"child": 1.0}
    assert Population.of("able_bodied: 0.9,child:0.1").shares == {"able_bodied": 0.9, "child": 0.1}
    assert str(Population.of("able_bodied: 0.9, child: 0.1")) == "able_bodied: 0.9, child: 0.1"


def test_presets_say_where_they_come_from():
    for population in presets().values():
        assert sum(population.shares.values()) == pytest.approx(1.0, abs=1e-12)
        assert population.source.endswith((".", "a twelfth."))
    # Thousands of users among 260 million people (National Center for Health Statistics 1997).
    shares = presets()["mixed"].shares
    users = {"cane": 4762, "walking_frame": 1799, "crutches": 575}
    for kind, thousands in users.items():
        assert shares[kind] == pytest.approx(thousands / 260_000, abs=0.0005)
    wheelchairs = shares["wheelchair_manual"] + shares["wheelchair_powered"]
    assert wheelchairs == pytest.approx((1564 + 140) / 260_000, abs=0.0006)
    # Over 70 % of residents, three quarters of all, use an aid, over 50 % a wheelchair.
    home = presets()["care_home"].shares
    chairs = sum(share for kind, share in home.items() if kind.startswith("wheelchair"))
    assert 0.5 < chairs / 0.75 < 0.52
    assert (chairs + home["cane"] + home["walking_frame"]) / 0.75 > 0.7
    assert len(presets()["every_type"].shares) == 12


@pytest.mark.parametrize(
    ("value", "match"),
    [
        ({}, "add up to 0, expected 1"),
        ({"a": 0.5, "b": 0.4}, "add up to 0.9, expected 1"),
        ({"a": 1.5, "b": -0.5}, "share of 'a' is 1.5, expected 0 to 1"),
        ({"a": float("nan")}, "share of 'a' is nan"),
        ({"a": "1"}, "share of 'a' is '1'"),
        ({"a": True}, "share of 'a' is True"),
        ({3: 1.0}, "3, expected names of types"),
        ([("a", 1.0)], "expected a share for each type"),
        (7, "expected a share for each type"),
        ("", "mixed, care_home, every_type, the name of a type, or shares"),
        ("a b", "expected mixed"),
        ("a: 0.5, b", "got 'b', expected mixed"),
        ("a: 0.5, a: 0.5", "got 'a: 0.5', expected mixed"),
        ("a: x", "got 'a: x', expected mixed"),
        ("a: 0.9", "add up to 0.9"),
    ],
)
def test_shares_that_are_none(value, match):
    with pytest.raises(ModelError, match=match) as raised:
        Population.of(value)
    assert "\n" not in str(raised.value)
