import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mesa_mobility.verification.scenarios.tracks.oval import Oval

OVAL = Oval(straight=15.0, radius=3.0, width=1.8)


def test_length_and_floor_are_those_of_two_straights_and_a_ring():
    assert OVAL.length == pytest.approx(30 + 6 * math.pi)
    # Straights 2 x 15 x 1.8, ring pi (3.9^2 - 2.1^2); circles have 64 corners.
    assert OVAL.floor.area == pytest.approx(54 + math.pi * (3.9**2 - 2.1**2), rel=2e-3)


@pytest.mark.parametrize(
    ("along", "across", "place"),
    [
        (0.0, 0.0, (-7.5, -3.0)),
        (15.0, 0.5, (7.5, -2.5)),
        (15.0 + 1.5 * math.pi, 0.0, (10.5, 0.0)),
        (15.0 + 1.5 * math.pi, -0.5, (11.0, 0.0)),
        (15.0 + 3.0 * math.pi, 0.0, (7.5, 3.0)),
        (22.5 + 3.0 * math.pi, 0.5, (0.0, 2.5)),
        (30.0 + 4.5 * math.pi, 0.0, (-10.5, 0.0)),
    ],
)
def test_places_along_the_track(along, across, place):
    assert OVAL.roll(np.array([along]), np.array([across]))[0] == pytest.approx(place, abs=1e-9)
    back = OVAL.unroll(np.array([place]))
    assert (back[0][0], back[1][0]) == pytest.approx((along, across), abs=1e-9)


@given(st.floats(0, OVAL.length - 1e-9), st.floats(-0.9, 0.9))
def test_unrolling_undoes_rolling(along, across):
    back, aside = OVAL.unroll(OVAL.roll(np.array([along]), np.array([across])))
    turn = (back[0] - along + OVAL.length / 2) % OVAL.length - OVAL.length / 2
    assert turn == pytest.approx(0.0, abs=1e-9)
    assert aside[0] == pytest.approx(across, abs=1e-9)


def test_boxes_lie_in_the_middle_of_the_straights():
    lower, upper = OVAL.boxes(4.0)
    assert lower.bounds == pytest.approx((-2.0, -3.9, 2.0, -2.1))
    assert upper.bounds == pytest.approx((-2.0, 2.1, 2.0, 3.9))
