"""Exponential decay."""

import numpy as np
import pytest
from mesa_mobility.behaviors.decay import decay

from mesa_mobility.compiled.decorators import entry_point


@entry_point()
def _all(values, found):
    for k in range(len(values)):
        found[k] = decay(values[k])


def test_it_is_exp_to_a_hundred_millionth():
    values = np.concatenate([[0.0], np.geomspace(1e-9, 40.0, 400)])
    found = np.empty_like(values)
    _all(values, found)
    assert found == pytest.approx(np.exp(-values), rel=1e-8)


def test_far_away_it_is_next_to_nothing():
    found = np.empty(3)
    _all(np.array([41.0, 1e6, np.inf]), found)
    assert (found >= 0.0).all()
    assert (found < 1e-17).all()
