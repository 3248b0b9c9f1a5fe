"""Spots in the car of a lift."""

import numpy as np
import pytest

from mesa_mobility.crowd.lifts.spots import APART, free_spot, swapped_spots
from mesa_mobility.floorplan import Shaft, Stop

NOBODY = np.empty((0, 2)), np.empty(0)


def shaft(width=1.1, depth=1.4):
    """A lift with its door along x at y = 0, (0, 0) to (0.9, 0), and the car from y = 0.05 on."""
    stops = tuple(
        Stop(f"level {k}", ((9.0 * k, 0.0), (9.0 * k + 0.9, 0.0)), 3.0 * k) for k in (0, 1)
    )
    return Shaft("car", stops, 0.05, width, depth, 8, 1.0, 3.0, False)


def test_the_first_goes_to_the_far_end_and_keeps_off_the_walls():
    x, y = free_spot(shaft(), 0, 0.2, *NOBODY)
    assert y == pytest.approx(0.05 + 1.4 - 0.2 - APART)
    # The car is 1.1 m wide about x = 0.45.
    assert abs(x - 0.45) == pytest.approx(0.55 - 0.2 - APART)


def test_nobody_gets_a_spot_too_near_to_others_until_the_car_is_full():
    taken, cores = NOBODY
    while (spot := free_spot(shaft(), 1, 0.15, taken, cores)) is not None:
        assert shaft().in_car(1, spot[None])[0]
        if len(taken):
            assert np.hypot(*(taken - spot).T).min() >= 0.3 + APART - 1e-9
        taken, cores = np.vstack([taken, spot]), np.append(cores, 0.15)
    assert 4 <= len(taken) <= 8


def test_a_wheelchair_fits_alone():
    spot = free_spot(shaft(), 0, 0.35, *NOBODY)
    assert spot is not None
    assert free_spot(shaft(), 0, 0.35, spot[None], np.array([0.35])) is None


@pytest.mark.parametrize(("width", "depth"), [(0.6, 1.4), (1.1, 0.6)])
def test_a_body_larger_than_the_car_fits_nowhere(width, depth):
    assert free_spot(shaft(width, depth), 0, 0.35, *NOBODY) is None


def test_who_comes_in_first_gets_the_spot_behind():
    cores, spots = np.array([0.2, 0.2]), np.array([(0.45, 1.15), (0.45, 0.6)])
    # The second stands at their spot, before that of the first, who is still outside.
    points = np.array([(0.45, -1.0), (0.45, 0.65)])
    found = swapped_spots(shaft(), 0, points, cores, spots)
    # 1.4 m deep, and as far from the wall as the body with its distance.
    assert found[1, 1] == pytest.approx(0.05 + 1.4 - 0.2 - APART)
    assert found[0, 1] <= found[1, 1]
    assert np.hypot(*(found[0] - found[1])) >= 0.4 + APART - 1e-9


def test_spots_stay_where_nobody_is_in_the_way():
    cores, spots = np.array([0.2, 0.2]), np.array([(0.45, 1.15), (0.45, 0.6)])
    # In the order of their spots; not there yet; and side by side, in any order.
    for points, given in (
        ([(0.45, 0.8), (0.45, -1.0)], spots),
        ([(0.45, -1.0), (0.45, 0.1)], spots),
        ([(0.45, -1.0), (0.7, 1.1)], np.array([(0.2, 1.15), (0.7, 1.1)])),
    ):
        assert swapped_spots(shaft(), 0, np.array(points), cores, given) is given


def test_spots_stay_where_others_do_not_fit():
    cores, spots = np.array([0.35, 0.35]), np.array([(0.45, 1.0), (0.45, 0.4)])
    points = np.array([(0.45, -1.0), (0.45, 0.45)])
    assert swapped_spots(shaft(), 0, points, cores, spots) is spots
