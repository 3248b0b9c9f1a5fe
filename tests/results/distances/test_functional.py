"""Numbers of two curves, worked out by hand."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mesa_mobility.results.distances import (
    projection_coefficient,
    relative_difference,
    secant_cosine,
)

CURVES = st.lists(st.floats(0.5, 100.0), min_size=3, max_size=30)


def test_a_curve_that_is_too_slow_by_a_factor():
    measured, simulated = [1.0, 2.0, 4.0], [2.0, 4.0, 8.0]
    assert relative_difference(measured, simulated) == pytest.approx(1.0)
    assert projection_coefficient(measured, simulated) == pytest.approx(0.5)
    assert secant_cosine(measured, simulated) == pytest.approx(1.0)


def test_curves_of_another_shape():
    measured, simulated = [3.0, 4.0, 4.0], [0.0, 4.0, 3.0]
    # |(3, 0, 1)| / |(3, 4, 4)|; (16 + 12) / 25; changes (1, 0) and (4, -1).
    assert relative_difference(measured, simulated) == pytest.approx(np.sqrt(10 / 41))
    assert projection_coefficient(measured, simulated) == pytest.approx(28 / 25)
    assert secant_cosine(measured, simulated) == pytest.approx(4 / np.sqrt(17))
    assert secant_cosine(measured, simulated, step=2) == pytest.approx(1.0)
    assert secant_cosine(measured, [5.0, 4.0, 3.0], step=2) == pytest.approx(-1.0)


@given(CURVES, st.floats(0.1, 10.0))
def test_the_coefficient_is_the_factor_that_brings_a_curve_nearest(curve, factor):
    e = np.array(curve)
    m = factor * e + np.sin(np.arange(len(e)))
    best = float(projection_coefficient(e, m))
    for other in (0.99 * best, 1.01 * best):
        assert np.linalg.norm(e - best * m) <= np.linalg.norm(e - other * m) + 1e-9


def test_several_curves_at_once_and_those_without_a_number():
    e = np.array([[1.0, 2.0], [0.0, 0.0]])
    assert np.isnan(relative_difference(e, e)[1])
    assert np.isnan(projection_coefficient(e, e)[1])
    assert np.isnan(secant_cosine(e, e)[1])
    assert relative_difference(e, e)[0] == 0.0
