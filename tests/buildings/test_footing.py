"""Bodies and feet on stairs. The stair has 18 risers of 0.17 m and 17 treads of 0.29 m."""

import numpy as np
import pytest

from tests.fixtures.buildings import two_storeys

OFFICE = two_storeys()
# The head of the straight stair is at x = 8, its foot at x = 8 + 17 * 0.29 = 12.93.
MIDDLE = (8 + 4.93 / 2, 0.6)


def test_mid_flight_is_half_a_storey_up():
    (place,) = OFFICE.plane_places([(*MIDDLE, 1.53)])
    (true,), _ = OFFICE.true_places([place])
    assert true == pytest.approx([*MIDDLE, 1.53])


@pytest.mark.parametrize(
    ("x", "tread"),
    [(7.9, 3.06), (8.1, 2.89), (8.4, 2.72), (MIDDLE[0], 1.53), (12.8, 0.17), (13.0, 0.0)],
)
def test_feet_are_on_treads(x, tread):
    along = float(np.clip(x, 8.0, 12.93))
    place = np.array([[along, 0.6, 3.06 * (12.93 - along) / 4.93]])
    heights, edges = OFFICE.footing.beneath(place, np.array([[x, 0.5]]))
    assert heights == pytest.approx([tread])
    assert (edges >= heights - 1e-9).all()


def test_the_floor_below_a_flight_is_not_the_flight():
    below = np.array([[MIDDLE[0], 1.4, 0.0]])
    heights, _ = OFFICE.footing.beneath(below, np.array([[MIDDLE[0], 1.1]]))
    assert heights.tolist() == [0.0]
    assert OFFICE.footing.carried(np.array([[*MIDDLE, 0.0]])).tolist() == [0.0]


def test_bodies_are_carried_evenly():
    x = np.linspace(7.5, 13.5, 601)
    z = np.interp(x, [8.0, 12.93], [3.06, 0.0])
    carried = OFFICE.footing.carried(np.column_stack([x, np.full(601, 0.6), z]))
    assert (carried[0], carried[-1]) == (3.06, 0.0)
    # A centimetre is at most 1.5 * 0.17 / 0.29 of its length down: no step as high as a riser.
    assert -np.diff(carried).min() < 0.0089
    assert np.diff(carried).max() < 1e-9
    middle = np.interp(MIDDLE[0], x, carried)
    assert middle == pytest.approx(1.53, abs=1e-3)
    # Above the middle of the second tread, and of the last but one.
    assert np.interp([8.0 + 1.5 * 0.29, 12.93 - 1.5 * 0.29], x, carried) == pytest.approx(
        [3.06 - 2 * 0.17, 2 * 0.17], abs=1e-3
    )


def test_a_flight_of_two_risers_is_left_at_its_foot():
    stairs = OFFICE.flights[0]
    short = type(stairs)(**{**vars(stairs), "going": 0.29, "top": 0.34, "risers": 2})
    carried = type(OFFICE.footing)([short]).carried(
        np.array([[8.0 + 0.2899, 0.6, 0.34 * 0.0001 / 0.29]])
    )
    assert carried == pytest.approx([0.0], abs=1e-3)
