"""Calls of compiled functions without looking up the types of arguments."""

import numpy as np
from numba import njit

from mesa_mobility.compiled.decorators import Entry


@njit
def weighted(factor, pair):
    values, weights = pair
    return factor * (values * weights).sum()


def test_an_entry_does_what_the_function_does():
    call = Entry(weighted)
    ones = np.ones(2)
    assert call(1, (ones, ones)) == 2
    assert call(3, (np.array([1.0, 2.0]), np.array([10.0, 1.0]))) == 36
    assert len(weighted.signatures) == 1


def test_its_first_call_tells_the_types():
    numbers, floats, ones = Entry(weighted), Entry(weighted), np.ones(2)
    assert numbers(1, (np.array([3, 4]), ones)) == 7
    assert floats(0.5, (ones[::-1], ones)) == 1.0
    assert numbers(2, (np.array([3, 4]), ones)) == 14
    assert floats(0.5, (np.array([3.0, 4.0])[::-1], np.array([1.0, 0.0]))) == 2.0
