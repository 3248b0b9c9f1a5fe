"""Exponential decay."""

import numpy as np
import pytest
from mesa_mobility.behaviors.decay import decay


def test_it_is_exp_to_a_hundred_millionth():
    values = np.concatenate([[0.0], np.geomspace(1e-9, 40.0, 400)])
    found = [decay(each) for each in values]
    assert found == pytest.approx(np.exp(-values), rel=1e-8)


def test_far_away_it_is_next_to_nothing():
    assert all(0.0 <= decay(each) < 1e-17 for each in (41.0, 1e6, np.inf))
