"""The paper's straight walk, on the map that ships: speeds kept, and a real walker's sway."""

import numpy as np
import pytest
from mesa_mobility.models import StraightWalk

from tests.fixtures.maps import shipped_map
from tests.fixtures.oracles.counting import overlaps, track, wall_crossings
from tests.fixtures.scenes import core_of

PREFERRED = np.linspace(0.9, 1.5, 50)


@pytest.fixture(scope="module")
def walk():
    model = StraightWalk(mobility_map=shipped_map(), record=True, rng=1)
    model.run(max_seconds=120)
    return model


@pytest.fixture(scope="module")
def tracks(walk):
    rows = walk.recorder.arrays()
    return [track(rows, person) for person in range(50)]


def test_everybody_arrives(walk):
    assert walk.inside == 0
    assert walk.population.count == 50
    # The slowest, at 0.9 m/s, needs 44.4 s for 40 m, give or take 5 % and a start.
    assert walk.elapsed == pytest.approx(44.4, abs=3.5)


def test_preferred_speeds_lie_evenly_between_the_slowest_and_the_fastest():
    model = StraightWalk(mobility_map=shipped_map(), slowest=0.8, fastest=1.6, pedestrians=5)
    assert [p.preferred_speed for p in model.agents] == pytest.approx([0.8, 1.0, 1.2, 1.4, 1.6])
    assert [p.position.tolist() for p in model.agents] == [[0.0, 3.0 * k + 1.5] for k in range(5)]
    assert {p.heading for p in model.agents} == {0.0}


def test_each_walks_within_five_percent_of_its_own_speed(tracks):
    for preferred, t in zip(PREFERRED, tracks, strict=True):
        # From the fifth metre on, the start from standing left out.
        first, last = np.searchsorted(t[:, 1], [5.0, 39.0])
        speed = (t[last, 1] - t[first, 1]) / ((t[last, 0] - t[first, 0]) / 30)
        assert speed == pytest.approx(preferred, rel=0.05)


def test_the_whole_walk_from_standing_stays_within_five_percent_too(tracks):
    for preferred, t in zip(PREFERRED, tracks, strict=True):
        speed = (t[-1, 1] - t[0, 1]) / ((t[-1, 0] - t[0, 0]) / 30)
        assert speed == pytest.approx(preferred, rel=0.05)


def test_the_pelvis_sways_three_to_twelve_centimetres(tracks):
    assert 0.03 <= np.median([sway(t) for t in tracks]) <= 0.12


def test_the_pelvis_of_each_walker_sways_three_to_twelve_centimetres(tracks):
    outside = {
        round(float(speed), 3): round(sway(t), 4)
        for speed, t in zip(PREFERRED, tracks, strict=True)
        if not 0.03 <= sway(t) <= 0.12
    }
    assert outside == {}


def sway(t: np.ndarray) -> float:
    """Metres from side to side, peak to peak, that a walker sways in the middle of strides."""
    y = t[(t[:, 1] > 5.0) & (t[:, 1] < 39.0), 2]
    # A stride is about 1.2 s; the running mean over one takes the slow drift out.
    stride = 37
    drift = np.convolve(y, np.ones(stride) / stride, "valid")
    rest = y[stride // 2 : len(y) - stride // 2] - drift
    cycles = [rest[k : k + stride] for k in range(0, len(rest) - stride, stride)]
    return float(np.median([np.ptp(cycle) for cycle in cycles]))


def test_goes_straight(tracks):
    for t in tracks:
        across, along = np.abs(t[-1, 2] - t[0, 2]), t[-1, 1] - t[0, 1]
        assert np.degrees(np.arctan2(across, along)) < 5.0


def test_lone_walkers_need_no_fallback(walk):
    assert walk.statistics.fallback_decision_share == 0.0


def test_nobody_overlaps_or_crosses_a_wall(walk):
    rows = walk.recorder.arrays()
    assert overlaps(rows, core_of(walk)) == 0
    assert wall_crossings(rows, walk.floor_plan.walls) == 0
