"""Where and when a measured crowd is measured, of crowds made up by hand."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely import LineString, Polygon, box

from mesa_mobility.results import Trajectories
from mesa_mobility.validation.tracks.windows import (
    main_direction,
    middle_area,
    narrowest_line,
    steady_frames,
)

RATE = 10.0
# 12 m x 4 m, with a neck 1 m wide from x = 8 m to 8.1 m.
NECK = box(0, 0, 12, 4).difference(box(8, -1, 8.1, 1.5)).difference(box(8, 2.5, 8.1, 5))


def crowd(walkers, angle: float = 0.0, seconds: float = 30.0) -> Trajectories:
    """People (x, y, speed along x) who walk from x = 0 m to 12 m or back, turned by an angle."""
    frames = np.arange(round(seconds * RATE) + 1)
    rows = []
    for person, (x, y, speed) in enumerate(walkers):
        along = x + speed * frames / RATE
        on = (along >= 0.0) & (along <= 12.0)
        rows += [(f, person, a, y) for f, a in zip(frames[on], along[on], strict=True)]
    frame, person, x, y = (np.array(column) for column in zip(*rows, strict=True))
    c, s = np.cos(angle), np.sin(angle)
    return Trajectories(frame, person, c * x - s * y, s * x + c * y, 0 * x, frame_rate=RATE)


@given(st.floats(-np.pi, np.pi))
def test_the_direction_is_that_in_which_most_people_go(angle):
    walkers = [(0.0, 1.0, 1.0), (0.0, 2.0, 1.2), (12.0, 3.0, -0.8)]
    x, y = main_direction(crowd(walkers, angle))
    assert (x, y) == pytest.approx((np.cos(angle), np.sin(angle)), abs=1e-9)


def test_opposite_ways_do_not_cancel():
    x, y = main_direction(crowd([(0.0, 1.0, 1.0), (12.0, 2.0, -1.0)]))
    assert abs(x) == pytest.approx(1.0)
    assert y == pytest.approx(0.0, abs=1e-9)


def test_the_line_crosses_the_narrowest_place():
    run = crowd([(0.0, 1.8 + 0.05 * k, 0.8 + 0.05 * k) for k in range(8)])
    line = LineString(narrowest_line(run, NECK, (1.0, 0.0)))
    assert 8.0 <= line.centroid.x <= 8.1
    # The neck, and 0.1 m more at either end.
    assert line.bounds[1::2] == pytest.approx((1.4, 2.6))


def test_where_all_cuts_are_equal_the_line_is_in_the_middle():
    run = crowd([(0.0, 1.0, 1.0), (12.0, 2.0, -1.0)])
    line = LineString(narrowest_line(run, box(0, 0, 12, 4), (1.0, 0.0)))
    assert line.centroid.coords[0] == pytest.approx((6.0, 2.0), abs=0.06)


def test_a_narrow_place_beside_the_crowd_is_no_line():
    # All but one stop at 7 m, before the neck.
    walkers = [(7.0 - 0.3 * k, 2.0, 0.0) for k in range(3)] + [(0.0, 2.0, 0.25)]
    run = crowd([*walkers, (0.0, 2.1, 1.0), *[(0.0, 2.0, 0.2)] * 5])
    a, _ = narrowest_line(run, NECK, (1.0, 0.0))
    assert a[0] < 7.0


def test_the_area_leaves_out_a_tenth_of_all_places_at_either_end():
    run = crowd([(0.0, 1.0, 1.0)] * 3)
    area = middle_area(run, box(0, 0, 12, 4), (1.0, 0.0))
    assert area.bounds == pytest.approx((1.2, 0.0, 10.8, 4.0))
    turned = middle_area(run, Polygon([(0, 0), (12, 0), (12, 4), (0, 4)]), (-1.0, 0.0))
    assert turned.symmetric_difference(area).area == pytest.approx(0.0, abs=1e-9)


def test_flow_is_steady_between_the_first_and_the_last_sixth():
    # Twelve people cross x = 6 m after 1, 2, ..., 12 s: the second and the tenth.
    run = crowd([(6.0 - k / 2, 1.0, 0.5) for k in range(1, 13)])
    assert steady_frames(run, ((6.0, 0.0), (6.0, 4.0))) == (20, 100)
    assert steady_frames(run.of_people(range(5)), ((6.0, 0.0), (6.0, 4.0))) is None
