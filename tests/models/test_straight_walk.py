"""The paper's straight walk, on the map that ships: speeds kept, and a real walker's sway."""

import numpy as np
import pytest

from mesa_mobility.models import StraightWalk
from tests.fixtures.counting import overlaps, track, wall_crossings
from tests.fixtures.maps import shipped_map
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
    assert walk.count == 50
    # The slowest, at 0.9 m/s, needs 44.4 s for 40 m, give or take 5 % and a start.
    assert walk.elapsed == pytest.approx(44.4, abs=3.5)


def test_preferred_speeds_lie_evenly_between_the_slowest_and_the_fastest():
    model = StraightWalk(mobility_map=shipped_map(), slowest=0.8, fastest=1.6, pedestrians=5)
    assert [p.preferred_speed for p in model.agents] == pytest.approx([0.8, 1.0, 1.2, 1.4, 1.6])
    assert [p.position.tolist() for p in model.agents] == [
        [0.0, 3.0 * k + 1.5] for k in range(5)
    ]
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
    for t in tracks:
        steady = t[(t[:, 1] > 5.0) & (t[:, 1] < 39.0)]
        sway = []
        # Windows of 1.2 s, somewhat over a stride; the drift within each is left out.
        for start in range(0, len(steady) - 36, 12):
            frame, y = steady[start : start + 36, 0], steady[start : start + 36, 2]
            sway.append(np.ptp(y - np.polyval(np.polyfit(frame, y, 1), frame)))
        assert 0.03 <= np.median(sway) <= 0.12


def test_goes_straight(tracks):
    for k, t in enumerate(tracks):
        assert np.abs(t[:, 2] - (3.0 * k + 1.5)).max() < 1.0


def test_lone_walkers_need_no_fallback(walk):
    assert walk.fallback_decision_share == 0.0


def test_nobody_overlaps_or_crosses_a_wall(walk):
    rows = walk.recorder.arrays()
    assert overlaps(rows, core_of(walk)) == 0
    assert wall_crossings(rows, walk.floor_plan.walls) == 0
