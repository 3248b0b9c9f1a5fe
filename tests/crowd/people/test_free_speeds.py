"""Preferred speeds by default: those of a type's source or recordings."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import norm

from mesa_mobility import PedestrianType
from mesa_mobility.distributions import Clipped, Normal
from mesa_mobility.errors import MapError
from tests.fixtures.maps import shipped_map, strider


def speeds_of(n=4000, **metadata):
    map_ = strider()
    kind = PedestrianType(mobility_map=replace(map_, metadata={**map_.metadata, **metadata}))
    return kind.draw_speeds(n, np.random.default_rng(1))


def test_without_a_word_in_the_metadata_they_are_those_of_adults():
    adults = Clipped(Normal(1.34, 0.26), 0.6, 2.0)
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
    assert speeds.min() >= max(low, 0.235) - 1e-12
    assert speeds.max() <= high + 1e-12
    assert speeds.mean() == pytest.approx(0.94, abs=0.01)
    assert speeds.std() == pytest.approx(0.30, abs=0.015)


def test_where_the_deviation_is_half_the_mean_nobody_stands_still():
    speeds = speeds_of(preferred_speed_m_s={"mean": 0.57, "standard_deviation": 0.29})
    assert speeds.min() == pytest.approx(0.1425)
    # All that lies below a quarter of the mean, 1.474 deviations under it, counts as that.
    lifted = 0.29 * (norm.pdf(1.474) - 1.474 * norm.sf(1.474))
    assert speeds.mean() == pytest.approx(0.57 + lifted, abs=0.003)


def test_nobody_prefers_to_walk_faster_than_was_recorded():
    recorded = {"p5": 0.2, "p75": 0.8, "p95": 1.1}
    published = {"mean": 0.81, "standard_deviation": 0.38, "source": "a book"}
    speeds = speeds_of(preferred_speed_m_s=published, walking_speed_m_s=recorded)
    assert speeds.max() == 1.1


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
