"""SIMD operations agree with NumPy, element by element."""

import numpy as np
import pytest
from numba import njit

from mesa_mobility.compiled.simd import (
    AT_ONCE,
    LANES,
    SAMPLES,
    WIDE,
    any_of,
    bits_set,
    compress,
    lowest_bit,
    no_more_than,
    place_of_least,
    press_numbers,
)
from mesa_mobility.crowd.collision.simd_boxes import extent, levels_within, near_box
from mesa_mobility.crowd.collision.simd_tests import (
    drop_within,
    numbers_between,
    places_near,
    places_within,
)
from mesa_mobility.crowd.collision.simd_transforms import lanes_to_world, samples_to_ego
from mesa_mobility.crowd.options.table import LEVELS


@njit
def _drop(circles, at, row, n, bodies, places, first, known, dropped):
    drop_within(circles, (at, row, n), bodies, places, (first, known), dropped)


@njit
def _within(places, at, row, bodies, which, first, known):
    return places_within(places, at, row, bodies, which, (first, known))


@njit
def _extent(circles, at, row, n, dropped):
    return extent(circles, at, row, n, dropped)


@njit
def _levels(ahead, at, row, spans):
    return levels_within(ahead, at, row, spans)


@njit
def _near(circles, at, row, x0, y0, x1, y1):
    return near_box(circles, at, row, x0, y0, x1, y1)


@njit
def _least(values, n):
    return place_of_least(values, n)


@njit
def _any(values, at):
    return any_of(values, at)


@njit
def _lowest(bits):
    return lowest_bit(bits)


@njit
def _press(given, row, at, bits, to, first, place):
    compress(given, row, at, bits, to, first, place, 2)


@njit
def _press_numbers(first, bits, to, place):
    press_numbers(first, bits, to, place)


@njit
def _set(bits):
    return bits_set(bits)


@njit
def _near_place(x, y, at, px, py, radius):
    return places_near(x, y, at, px, py, radius)


@njit
def _between(values, at, above, up_to):
    return numbers_between(values, at, above, up_to)


@njit
def _little(values, at, most):
    return no_more_than(values, at, most)


@njit
def _lay(lanes, group, ends, at, c, s, x, y, seconds):
    lanes_to_world(lanes, group, ends, at, (x, y, c, s), seconds)


@njit
def _sample(paths, path, first, share, turn, place, to, at):
    samples_to_ego(paths, path, first, share, turn, place, to, at)


@pytest.fixture
def rng():
    return np.random.default_rng(5)


def _some_bodies(rng):
    """Some of 9 bodies, and the places of their x at sample 4."""
    who = rng.permutation(9)
    return who, 3 * SAMPLES * who + 4


@pytest.mark.parametrize("n", [1, 15, 16, 17, 40])
@pytest.mark.parametrize("known", [0, 1, 7])
def test_circles_within_a_body_are_dropped(rng, n, known):
    first = 3
    row = first + n + WIDE
    circles = rng.uniform(-1.0, 1.0, (3, row)).astype(np.float32)
    circles[2] = rng.uniform(0.0, 0.6, row)
    bodies = rng.uniform(-1.0, 1.0, (9, 3, SAMPLES)).astype(np.float32)
    bodies[:, 2] = rng.uniform(0.0, 1.5, (9, SAMPLES))
    who, places = _some_bodies(rng)
    dropped = np.zeros(n + WIDE, dtype=np.int32)
    dropped[:n:5] = 1
    _drop(circles, first, row, n, bodies, places, 2, known, dropped)
    x, y, radius = circles[:, first : first + n, None]
    body_x, body_y, apart = bodies[who[2 : 2 + known], :, 4].T
    away = np.hypot(x - body_x, y - body_y)
    expected = (away + radius < apart).any(axis=1)
    expected[::5] = True
    assert dropped[:n].astype(bool).tolist() == expected.tolist()


@pytest.mark.parametrize("known", [0, 1, 6])
def test_places_within_a_body_are_marked_by_bits(rng, known):
    places = rng.uniform(-1.0, 1.0, (4, 5, LANES)).astype(np.float32)
    bodies = rng.uniform(-1.0, 1.0, (9, 3, SAMPLES)).astype(np.float32)
    bodies[:, 2] = rng.uniform(0.1, 0.6, (9, SAMPLES))
    who, which = _some_bodies(rng)
    bits = _within(places, (2 * 5 + 1) * LANES, 2 * LANES, bodies, which, 0, known)
    body_x, body_y, apart = bodies[who[:known], :, 4].T
    away = np.hypot(places[2, 1, :, None] - body_x, places[2, 3, :, None] - body_y)
    within = (away < apart).any(axis=1)
    assert [bool(bits >> lane & 1) for lane in range(LANES)] == within.tolist()


def test_circles_that_reach_into_a_box_are_marked_by_bits(rng):
    circles = rng.uniform(-2.0, 2.0, (3, 50)).astype(np.float32)
    circles[2] = rng.uniform(0.0, 1.0, 50)
    bits = _near(circles, 20, 50, -0.5, -1.0, 0.75, 0.25)
    x, y, radius = circles[:, 20 : 20 + WIDE]
    off_x = np.maximum.reduce([-0.5 - x, x - 0.75, np.zeros(WIDE)])
    off_y = np.maximum.reduce([-1.0 - y, y - 0.25, np.zeros(WIDE)])
    assert [bool(bits >> k & 1) for k in range(WIDE)] == (np.hypot(off_x, off_y) < radius).tolist()


@pytest.mark.parametrize("n", [1, 16, 29])
def test_a_box_is_drawn_around_the_circles_that_are_left(rng, n):
    first, row = 5, 70
    circles = rng.uniform(-1.0, 1.0, (3, row)).astype(np.float32)
    dropped = np.ones(n + WIDE, dtype=np.int32)
    dropped[:n:3] = 0
    box = _extent(circles, first, row, n, dropped)
    x, y, radius = circles[:, first : first + n : 3]
    expected = (x - radius).min(), (y - radius).min(), (x + radius).max(), (y + radius).max()
    assert box == pytest.approx(expected, abs=1e-7)
    assert _extent(circles, first, row, n, np.ones_like(dropped)) == (np.inf,) * 2 + (-np.inf,) * 2


def test_levels_at_which_a_person_is_near_a_box_are_marked_by_bits():
    ahead = np.full((3, 3, SAMPLES), 9.0, dtype=np.float32)
    boxes = np.array([[-1.0, -2.0, 1.0, 2.0]] * len(LEVELS), dtype=np.float32)
    # Within it; 0.5 m beside it; 0.5 m off its corner either way, 0.71 m; 2 m ahead of it.
    ahead[1][:2, list(LEVELS)] = [[0.0, -1.5, 1.5, 3.0], [0.0, 1.0, 2.5, 0.0]]
    for apart, bits in ((0.6, 0b0011), (0.8, 0b0111)):
        ahead[1, 2] = apart
        assert _levels(ahead, 3 * SAMPLES, SAMPLES, np.ascontiguousarray(boxes.T)) == bits


@pytest.mark.parametrize("n", [1, 8, 31, 32, 33, 100])
def test_the_first_of_the_least_is_found(rng, n):
    values = np.full(n + AT_ONCE, np.inf)
    for _ in range(50):
        values[:n] = rng.integers(0, 6, n)
        assert _least(values, n) == np.argmin(values)


def test_whether_any_is_not_0():
    values = np.zeros(3 * LANES)
    values[9] = -1.0
    values[23] = np.nan
    assert [_any(values, at) for at in (0, 2, 10, 15, 16)] == [False, True, False, False, True]


def test_the_lowest_bit_is_found():
    assert [_lowest(bits) for bits in (1, 2, 12, 1 << 15)] == [0, 1, 2, 15]


def test_numbers_of_at_most_a_limit_are_marked_by_bits():
    values = np.array([9.0, 1.0, 2.0, 2.5, np.nan, np.inf, -np.inf, 2.0, 3.0, 0.0])
    # 2 is at most 2; nan is reported whatever the limit.
    assert _little(values, 2, 2.0) == 0b10111101
    assert _little(values, 0, np.inf) == 0b11111111


@pytest.mark.parametrize("bits", [0, 0b1, 0b10110010, 0b11111111])
@pytest.mark.parametrize("kind", [np.float64, np.int64])
def test_lanes_are_pressed_side_by_side(bits, kind):
    given = np.arange(48).reshape(4, 12).astype(kind)
    to = np.full((3, 20), -1, dtype=kind)
    _press(given, 1, 3, bits, to, 1, 5)
    lanes = [3 + lane for lane in range(LANES) if bits >> lane & 1]
    assert _set(bits) == len(lanes)
    assert (to[1:, 5 : 5 + len(lanes)] == given[1:3, lanes]).all()
    # Whole vectors are written, and nothing else.
    outside = np.ones(20, dtype=bool)
    outside[5 : 5 + LANES] = False
    assert (to[0] == -1).all()
    assert (to[:, outside] == -1).all()


def test_lanes_are_pressed_together_without_an_instruction_for_it(monkeypatch):
    monkeypatch.setattr("mesa_mobility.compiled.simd._PRESSES", 10**6)

    @njit
    def press(given, bits, to):
        compress(given, 0, 0, bits, to, 0, 1, 1)

    to = np.zeros(12)
    press(np.arange(1.0, 9.0), 0b11000101, to)
    assert to[:5].tolist() == [0.0, 1.0, 3.0, 7.0, 8.0]


def test_numbers_of_bits_are_written_side_by_side():
    to = np.zeros(12, dtype=np.int64)
    _press_numbers(100, 0b11000101, to, 2)
    assert to[:6].tolist() == [0, 0, 100, 102, 106, 107]


def test_places_near_another_are_marked_by_bits(rng):
    x, y = rng.uniform(-2.0, 2.0, (2, 20))
    x[5], y[5] = 0.5 + 3.0 * 0.25, 0.25 + 4.0 * 0.25
    bits = _near_place(x, y, 4, 0.5, 0.25, 1.25)
    near = np.hypot(x - 0.5, y - 0.25) <= 1.25
    assert near[5]  # at that very distance
    assert [bool(bits >> lane & 1) for lane in range(LANES)] == near[4:12].tolist()


def test_numbers_between_two_are_marked_by_bits():
    values = np.array([9.0, 1.0, 2.0, 2.5, np.inf, -np.inf, 3.0, 1.5, 1.0, 9.0])
    assert _between(values, 1, 1.0, 2.5) == 0b01000110
    assert _between(values, 1, -np.inf, 1e300) == 0b11100111


def test_options_of_a_group_are_turned_and_moved(rng):
    lanes = rng.uniform(-1.0, 1.0, (3, 13, LANES)).astype(np.float32)
    ends = np.zeros((6, 20))
    c, s = np.cos(0.7), np.sin(0.7)
    _lay(lanes, 1, ends, 4, c, s, 2.0, -3.0, 0.8)
    x, y, ux, uy, speed = lanes[1, :5].astype(float)
    expected = [2.0 + c * x - s * y, -3.0 + s * x + c * y, c * ux - s * uy, s * ux + c * uy]
    expected += [np.full(LANES, 0.8), speed]
    assert ends[:, 4 : 4 + LANES] == pytest.approx(np.array(expected))
    assert not ends[:, :4].any()
    assert not ends[:, 4 + LANES :].any()


@pytest.mark.parametrize(("first", "share"), [(0, 0.0), (4, 1 / 3), (14, 2 / 3), (15, 0.0)])
def test_samples_to_come_lie_between_those_of_the_path(rng, first, share):
    paths = rng.uniform(-1.0, 1.0, (3, 3, SAMPLES)).astype(np.float32)
    to = np.zeros((2, 2, SAMPLES), dtype=np.float32)
    c, s = np.cos(-2.0), np.sin(-2.0)
    _sample(paths, 1, first, share, (c, s), (0.5, 1.5), to, 2 * SAMPLES)
    when = np.minimum(first + share + np.arange(SAMPLES), SAMPLES - 1.0)
    x, y = (np.interp(when, np.arange(SAMPLES), paths[1, axis]) for axis in (0, 1))
    expected = [0.5 + c * x - s * y, 1.5 + s * x + c * y]
    assert to[1] == pytest.approx(np.array(expected), abs=1e-6)
    assert not to[0].any()
