"""Plain Numba agrees with hand-written code on bodies, walls and lanes, to the last bit."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from numba import njit

from mesa_mobility.compiled import simd
from mesa_mobility.compiled.simd import LANES, SAMPLES, WIDE
from mesa_mobility.crowd.collision import simd_boxes, simd_tests, simd_transforms, walls
from mesa_mobility.crowd.collision.walls import BARRIER_FIELDS

_dropped_within = njit(simd_tests._plain_drop_within)
_bits_within = njit(simd_tests._plain_places_within)
_dropped_beside = njit(walls._plain_drop_beside)
_bits_beside = njit(walls._plain_places_beside)
_path_off2 = njit(walls._plain_path_off2)
_lay = njit(simd_transforms._plain_lanes_to_world)
_little = njit(simd._plain_no_more_than)
_extent = njit(simd_boxes._plain_extent)
_near = njit(simd_tests._plain_places_near)
_between = njit(simd_tests._plain_numbers_between)
_compress = njit(simd._plain_compress)


@njit
def _by_hand(circles, row, n, bodies, which, known, barriers, far, fences, apart, marks, others):
    simd_tests.drop_within(circles, (0, row, n), bodies, which, (1, known), marks)
    walls.drop_beside(circles, (0, row, n), barriers, (0, far, fences), apart, others)
    return (
        simd_tests.places_within(circles, 1, row, bodies, which, (1, known)),
        walls.places_beside(circles, 1, row, barriers, 0, far, fences, apart),
    )


@njit
def _off2(paths, path, barriers, known):
    return walls.path_off2(paths, path, barriers, known)


@njit
def _press(given, row, at, bits, to, first, place):
    simd.compress(given, row, at, bits, to, first, place, 2)


seeds = st.integers(0, 2**32 - 1)


@given(seeds, st.integers(1, 40), st.integers(0, 6), st.integers(0, 4), st.floats(0.0, 0.6))
@settings(deadline=None)
def test_what_lies_within_bodies_and_walls(seed, n, known, fences, apart):
    rng = np.random.default_rng(seed)
    row, far = n + 2 * WIDE, 5
    circles = rng.uniform(-1.0, 1.0, (3, row)).astype(np.float32)
    circles[2] = rng.uniform(0.0, 0.3, row)
    bodies = rng.uniform(-1.0, 1.0, (8, 3, SAMPLES)).astype(np.float32)
    which = 3 * SAMPLES * rng.permutation(8) + rng.integers(0, SAMPLES, 8)
    barriers = rng.uniform(-1.0, 1.0, (BARRIER_FIELDS, far)).astype(np.float32)
    barriers[4] = 1.0 / (barriers[2] ** 2 + barriers[3] ** 2)
    marks = np.ones((4, n + WIDE), dtype=np.int32)
    marks[:, :n] = rng.integers(0, 5, n) == 0
    bits = _by_hand(
        circles, row, n, bodies, which, known, barriers, far, fences, apart, marks[0], marks[1]
    )
    _dropped_within(circles, (0, row, n), bodies, which, (1, known), marks[2])
    _dropped_beside(circles, (0, row, n), barriers, (0, far, fences), apart, marks[3])
    assert (marks[:2, :n] == marks[2:, :n]).all()
    assert bits == (
        _bits_within(circles, 1, row, bodies, which, (1, known)),
        _bits_beside(circles, 1, row, barriers, 0, far, fences, apart),
    )


@given(seeds, st.integers(0, 4))
@settings(deadline=None)
def test_how_far_a_path_is_from_walls(seed, known):
    rng = np.random.default_rng(seed)
    paths = rng.uniform(-1.0, 1.0, (2, 3, SAMPLES)).astype(np.float32)
    barriers = rng.uniform(-1.0, 1.0, (BARRIER_FIELDS, 5)).astype(np.float32)
    assert _off2(paths, 1, barriers, known) == _path_off2(paths, 1, barriers, known)


@given(seeds, st.integers(0, 2**LANES - 1), st.integers(0, 4), st.integers(0, 6))
@settings(deadline=None)
def test_which_lanes_are_pressed_together(seed, bits, at, place):
    given_ = np.random.default_rng(seed).uniform(-1.0, 1.0, (4, 12))
    one, other = np.zeros((3, 16)), np.zeros((3, 16))
    _press(given_, 1, at, bits, one, 1, place)
    _compress(given_, 1, at, bits, other, 1, place, 2)
    count = place + bits.bit_count()
    assert (one[:, :count] == other[:, :count]).all()
    assert not other[:, place + LANES :].any()


@njit
def _lay_by_hand(lanes, group, ends, at, c, s, x, y, seconds):
    simd_transforms.lanes_to_world(lanes, group, ends, at, (x, y, c, s), seconds)


@given(seeds, st.integers(0, 2), st.integers(0, 12), st.floats(-4.0, 4.0))
@settings(deadline=None)
def test_where_options_end(seed, group, at, angle):
    lanes = np.random.default_rng(seed).uniform(-2.0, 2.0, (3, 13, LANES)).astype(np.float32)
    one, other = np.zeros((6, 20)), np.zeros((6, 20))
    where = np.cos(angle), np.sin(angle), 3.25, -1.5, 0.8
    _lay_by_hand(lanes, group, one, at, *where)
    c, s, x, y, seconds = where
    _lay(lanes, group, other, at, (x, y, c, s), seconds)
    assert (one == other).all()
    assert other[4, at : at + LANES].tolist() == [0.8] * LANES


@njit
def _eight_by_hand(values, others, at, most, x, y):
    return (
        simd.no_more_than(values, at, most),
        simd_tests.numbers_between(values, at, x, y),
        simd_tests.places_near(values, others, at, x, y, most),
    )


eight = st.lists(
    st.sampled_from([0.0, -0.0, 0.5, np.inf, -np.inf, np.nan]) | st.floats(-2.0, 2.0),
    min_size=LANES + 3,
    max_size=LANES + 3,
)


@given(eight, eight, st.integers(0, 3), *[st.floats(-2.0, 2.0)] * 3)
@settings(deadline=None)
def test_what_holds_for_eight_numbers(values, others, at, most, x, y):
    values, others = np.array(values), np.array(others)
    assert _eight_by_hand(values, others, at, most, x, y) == (
        _little(values, at, most),
        _between(values, at, x, y),
        _near(values, others, at, x, y, most),
    )


@njit
def _extent_by_hand(circles, at, row, n, dropped):
    return simd_boxes.extent(circles, at, row, n, dropped)


@given(seeds, st.integers(1, 40))
@settings(deadline=None)
def test_a_box_around_circles(seed, n):
    rng = np.random.default_rng(seed)
    row = n + 2 * WIDE
    circles = rng.uniform(-1.0, 1.0, (3, row)).astype(np.float32)
    dropped = np.ones(n + WIDE, dtype=np.int32)
    dropped[:n] = rng.integers(0, 3, n) == 0
    assert _extent_by_hand(circles, 2, row, n, dropped) == _extent(circles, 2, row, n, dropped)
