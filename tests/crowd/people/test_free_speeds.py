"""Preferred speeds by default: those of a type's source or recordings."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from mesa_mobility import PedestrianType
from mesa_mobility.distributions import TruncatedNormal
from mesa_mobility.errors import MapError
from tests.fixtures.maps import make_map, shipped_map, stand, straight, strider
from tests.fixtures.speeds import exponential_within, normal_within


def speeds_of(n=4000, **metadata):
    map_ = strider()
    kind = PedestrianType(mobility_map=replace(map_, metadata={**map_.metadata, **metadata}))
    return kind.draw_speeds(n, np.random.default_rng(1))


def test_without_a_word_in_the_metadata_they_are_those_of_adults():
    adults = TruncatedNormal(1.34, 0.26, 0.6, 2.0)
    assert PedestrianType(mobility_map=strider()).preferred_speed == adults


def test_recorded_adults_walk_as_published_ones_do():
    """Their steady speed is 1.339 m/s; Weidmann's adults prefer 1.34."""
    assert shipped_map().metadata["walking_speed_m_s"]["p75"] == 1.339
    kind = PedestrianType(mobility_map=shipped_map())
    drawn = kind.draw_speeds(4000, np.random.default_rng(1))
    assert drawn == pytest.approx(speeds_of(), rel=0.001)


def test_published_speeds_of_adults_are_the_same():
    published = {"mean": 1.34, "standard_deviation": 0.26, "source": "Weidmann 1993"}
    assert np.array_equal(speeds_of(preferred_speed_m_s=published), speeds_of())


def test_a_published_mean_and_deviation():
    speeds = speeds_of(preferred_speed_m_s={"mean": 0.94, "standard_deviation": 0.30})
    # Cut at 0.74 / 0.26 and 0.66 / 0.26 deviations, as 0.6 and 2.0 m/s cut the speeds of adults.
    low, high = 0.94 - 0.30 * 0.74 / 0.26, 0.94 + 0.30 * 0.66 / 0.26
    assert low < speeds.min() < low + 0.01
    assert high - 0.01 < speeds.max() < high
    assert speeds.mean() == pytest.approx(0.94, abs=0.001)
    assert speeds.std() == pytest.approx(0.30, abs=0.001)


SHIPPED = {
    # Weidmann's adults, scaled to the steady walk that was recorded where no source states a speed.
    "able_bodied": (1.339, 1.339 * 0.26 / 1.34),
    "slow": (0.572, 0.572 * 0.26 / 1.34),
    "limping_left": (0.573, 0.573 * 0.26 / 1.34),
    "limping_right": (0.573, 0.573 * 0.26 / 1.34),
    "child": (1.13, 0.22),
    "older_adult": (1.23, 0.20),
    "wheelchair_powered": (0.89, 0.22),
}
"""Mean and deviation, m/s. Within these bounds normal distributions have such a deviation."""

EXTREMES = {
    # Boyce, Shields and Silcock 1999: mean, deviation, slowest and fastest.
    "cane": (0.81, 0.38, 0.26, 1.60),
    "crutches": (0.94, 0.30, 0.63, 1.35),
    "walking_frame": (0.57, 0.29, 0.10, 1.02),
    "wheelchair_manual": (0.69, 0.35, 0.13, 1.35),
    "wheelchair_assisted": (1.30, 0.34, 0.84, 1.98),
}
"""Means and deviations of which no normal distribution has both between these extremes, m/s."""


@pytest.mark.parametrize("name", SHIPPED)
def test_speeds_of_shipped_types_keep_mean_and_deviation_of_their_source(name):
    mean, sd = SHIPPED[name]
    kind, n = PedestrianType.named(name), 4000
    low = max(mean - sd * 0.74 / 0.26, 0.05)
    high = mean + sd * 0.66 / 0.26
    drawn = kind.draw_speeds(n, np.random.default_rng(3))
    assert stats.kstest(drawn, normal_within(mean, sd, low, high).cdf).pvalue > 0.01
    assert drawn.mean() == pytest.approx(mean, abs=4 * sd / n**0.5)
    assert drawn.std() == pytest.approx(sd, abs=4 * sd / (2 * n) ** 0.5)
    assert low < drawn.min()
    assert drawn.max() < high + 1e-4
    assert len(np.unique(drawn)) == n


@pytest.mark.parametrize("name", EXTREMES)
def test_nobody_with_an_aid_is_slower_or_faster_than_those_who_were_measured(name):
    mean, sd, slowest, fastest = EXTREMES[name]
    kind, n = PedestrianType.named(name), 4000
    drawn = kind.draw_speeds(n, np.random.default_rng(3))
    assert slowest <= drawn.min()
    assert drawn.max() <= fastest
    assert drawn.mean() == pytest.approx(mean, abs=4 * sd / n**0.5)
    # The widest distribution of the kind, apart from the package: exponential between the bounds.
    widest = exponential_within(mean, slowest, fastest)
    assert widest.std() < 1.001 * sd
    assert drawn.std() == pytest.approx(widest.std(), rel=0.02)
    assert stats.kstest(drawn, widest.cdf).statistic < 0.02
    assert len(np.unique(drawn)) == n


def test_extremes_that_leave_room_for_the_deviation():
    published = {"mean": 0.94, "standard_deviation": 0.1, "least": 0.63, "most": 1.35}
    speeds = speeds_of(preferred_speed_m_s=published)
    assert stats.kstest(speeds, normal_within(0.94, 0.1, 0.63, 1.35).cdf).pvalue > 0.01
    assert speeds.std() == pytest.approx(0.1, abs=0.001)


def test_where_the_deviation_is_half_the_mean_nobody_stands_still():
    speeds = speeds_of(preferred_speed_m_s={"mean": 0.57, "standard_deviation": 0.29})
    assert 0.05 < speeds.min() < 0.052
    assert speeds.mean() == pytest.approx(0.57, abs=0.001)


def can_walk(fastest, mean, sd, **extremes):
    """A type with options of 12 frames at a speed, m/s."""
    on = straight(fastest * 0.4, 12)
    map_ = make_map([(stand(), on), (on, stand())])
    published = {"preferred_speed_m_s": {"mean": mean, "standard_deviation": sd, **extremes}}
    return PedestrianType(mobility_map=replace(map_, metadata={**map_.metadata, **published}))


def test_nobody_prefers_to_walk_faster_than_the_fastest_option():
    speeds = can_walk(1.2, 0.81, 0.25).preferred_speed
    assert speeds.high == pytest.approx(1.2, abs=1e-6)
    assert (speeds.mean, speeds.sd) == (0.81, 0.25)


@pytest.mark.parametrize("fastest", [0.7, 0.9])
def test_options_too_slow_for_the_source_are_no_bound(fastest):
    speeds = can_walk(fastest, 0.81, 0.25).preferred_speed
    assert speeds.high == pytest.approx(0.81 + 0.25 * 0.66 / 0.26)
    assert (speeds.mean, speeds.sd) == (0.81, 0.25)


def test_an_option_slower_than_the_fastest_who_was_measured():
    """It is a bound where the deviation allows, otherwise the fastest who was measured is."""
    for sd, high in ((0.15, 1.2), (0.38, 1.6)):
        speeds = can_walk(1.2, 0.81, sd, least=0.26, most=1.6).preferred_speed
        assert (speeds.mean, speeds.low) == (0.81, 0.26)
        assert speeds.high == pytest.approx(high, abs=1e-6)


def test_one_published_speed_alone():
    assert set(speeds_of(10, preferred_speed_m_s={"mean": 0.89})) == {0.89}


def test_recorded_speeds_scale_those_of_adults():
    quantiles = {"p5": 0.1, "p25": 0.4, "p50": 0.6, "p75": 0.67, "p95": 0.8}
    speeds = speeds_of(walking_speed_m_s=quantiles)
    assert speeds == pytest.approx(speeds_of() / 2)


@pytest.mark.parametrize(
    ("metadata", "key"),
    [
        ({"preferred_speed_m_s": {"mean": -1.0}}, "preferred_speed_m_s"),
        ({"preferred_speed_m_s": {"standard_deviation": 0.2}}, "preferred_speed_m_s.*a mean"),
        ({"preferred_speed_m_s": {"mean": 0.5, "standard_deviation": 0.6}}, "made by.*at most"),
        ({"preferred_speed_m_s": {"mean": 0.5, "least": 0.1}}, "'least' and 'most' together"),
        (
            {
                "preferred_speed_m_s": {
                    "mean": 0.5,
                    "standard_deviation": 0.1,
                    "least": 0.6,
                    "most": 1,
                }
            },
            "preferred_speed_m_s.*low < mean < high",
        ),
        ({"preferred_speed_m_s": {"mean": 0.5, "most": "fast", "least": -0.1}}, "'least' of more"),
        ({"preferred_speed_m_s": 1.2}, "preferred_speed_m_s.*an object"),
        ({"preferred_speed_m_s": {"mean": [1.0]}}, "preferred_speed_m_s.*'mean'"),
        ({"walking_speed_m_s": {"p75": 1e9}}, "walking_speed_m_s.*'p75'"),
    ],
)
def test_metadata_that_hold_something_else(metadata, key):
    with pytest.raises(MapError, match=key):
        speeds_of(**metadata)


def test_a_type_by_the_name_of_its_map():
    kind = PedestrianType.named("able_bodied")
    assert kind.name == "able_bodied"
    assert kind.mobility_map.file == shipped_map().file
    with pytest.raises(MapError, match=r"no map named 'giraffe'.* able_bodied"):
        PedestrianType.named("giraffe")
