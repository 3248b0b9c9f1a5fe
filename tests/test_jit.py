"""Calls of compiled functions without a look at the types of what they are given."""

import numpy as np
from numba import njit

from mesa_mobility.jit import entry


@njit
def weighted(factor, pair):
    values, weights = pair
    return factor * (values * weights).sum()


def test_an_entry_does_what_the_function_does():
    ones = np.ones(2)
    call = entry(weighted, 1, (ones, ones))
    assert call(3, (np.array([1.0, 2.0]), np.array([10.0, 1.0]))) == 36
    assert len(weighted.signatures) == 1


def test_each_kind_of_arguments_has_an_entry_of_its_own():
    whole, ones = np.ones(2, dtype=np.int64), np.ones(2)
    calls = entry(weighted, 1, (whole, ones)), entry(weighted, 0.5, (ones[::-1], ones))
    assert calls[0](2, (np.array([3, 4]), ones)) == 14
    assert calls[1](0.5, (np.array([3.0, 4.0])[::-1], np.array([1.0, 0.0]))) == 2.0
