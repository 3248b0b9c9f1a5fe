"""Feet of people on stairs bear for as long as they stand on a tread, at every cadence."""

import numpy as np
import pytest

from mesa_mobility.bodies.retargeting import retarget
from mesa_mobility.mobility.preparing.stairs import CADENCES, on_long_stairs
from tests.fixtures.climber import climber

RISER, TREAD = 0.18, 0.3


@pytest.mark.parametrize("tread", [TREAD, 0.25])
def test_feet_bear_on_treads(tread):
    recorded = climber(steps=5, riser=RISER, tread=TREAD, frames=20)
    repeated, _ = on_long_stairs([recorded], up=True, tread=tread)
    for each, cadence in zip(repeated, CADENCES * 3, strict=True):
        assert each.slope == pytest.approx(RISER / tread, rel=0.02)
        clip = retarget(each, np.zeros(each.frames))
        # Of two steps each foot swings for 0.8 of one; it is slow just before and after.
        toes = clip.contacts[:, [1, 3]]
        assert toes.mean() == pytest.approx(0.6, abs=0.1), cadence
        assert toes.any(axis=1).mean() > 0.9
        # The hips are 0.65 m above the tread on which the ankle is 0.4 treads ahead, and the middle
        # of the foot half of 0.15 m more: so much above the slope through it.
        height = 0.65 + RISER / TREAD * (0.4 * TREAD + 0.075)
        ratio = clip.heights.mean() / height
        assert 0.9 < ratio < 1.1


def test_a_level_floor_has_no_slope():
    assert climber(steps=2, riser=0.0, tread=0.5, frames=20).slope == 0.0
