"""Velocities and directions of tracks, from earlier frames alone."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from mesa_mobility.bodies.velocities import headings, velocities

RATE = 10.0


def rows(*tracks):
    """Person, frame and places of tracks: (person, first frame, x of each frame)."""
    person = np.concatenate([np.full(len(x), number) for number, _, x in tracks])
    frame = np.concatenate([first + np.arange(len(x)) for _, first, x in tracks])
    x = np.concatenate([np.asarray(x, dtype=float) for *_, x in tracks])
    return person, frame, np.column_stack([x, np.zeros(len(x))])


def test_velocity_is_the_way_of_the_last_eight_tenths_of_a_second():
    x = [0.0] * 10 + [0.1 * k for k in range(1, 11)]
    velocity, seconds = velocities(*rows((3, 5, x), (7, 0, [5.0, 5.2])), RATE)
    # 0.8 s are 8 frames: row 12 has gone 0.3 m in them, row 19 all of 0.8 m.
    np.testing.assert_allclose(velocity[[0, 9, 12, 19], 0], [0.0, 0.0, 0.375, 1.0])
    np.testing.assert_allclose(seconds[[0, 1, 8, 19, 20, 21]], [0.0, 0.1, 0.8, 0.8, 0.0, 0.1])
    np.testing.assert_allclose(velocity[20:, 0], [0.0, 2.0])


def test_ahead_it_is_that_of_the_next():
    velocity, seconds = velocities(*rows((1, 0, [0.1 * k**2 for k in range(12)])), RATE, ahead=True)
    np.testing.assert_allclose(velocity[0], [6.4 / 0.8, 0.0])
    np.testing.assert_allclose(seconds[[0, 3, 10, 11]], [0.8, 0.8, 0.1, 0.0])


def test_frames_that_are_missing_shorten_the_time():
    person, frame, places = rows((1, 0, np.arange(20) * 0.1))
    kept = ~np.isin(frame, [9, 10, 11])
    velocity, seconds = velocities(person[kept], frame[kept], places[kept], RATE)
    at = np.flatnonzero(frame[kept] == 17)[0]
    np.testing.assert_allclose(velocity[at], [1.0, 0.0])
    assert seconds[at] == 0.5  # from frame 12 on


@given(st.lists(st.floats(-3.0, 3.0), min_size=2, max_size=30), st.integers(1, 29))
def test_later_frames_change_nothing(steps, until):
    until = min(until, len(steps))
    person, frame, places = rows((2, 0, np.cumsum(steps)))
    whole = velocities(person, frame, places, RATE)
    part = velocities(person[:until], frame[:until], places[:until], RATE)
    np.testing.assert_array_equal(whole[0][:until], part[0])
    np.testing.assert_array_equal(whole[1][:until], part[1])


def test_headings_are_kept_by_those_who_stand_and_known_from_the_first_way_on():
    person, frame, places = rows((1, 0, [0.0, 0.0, -0.2, *[-0.2] * 12]), (2, 0, [0.0] * 5))
    found = headings(person, frame, places, RATE)
    np.testing.assert_allclose(np.abs(found[:15]), np.pi)
    np.testing.assert_allclose(found[15:], 0.0)


def test_nobody_has_no_velocity():
    nobody = np.empty(0, dtype=np.int64)
    velocity, seconds = velocities(nobody, nobody, np.empty((0, 2)), RATE)
    assert (velocity.shape, seconds.shape) == ((0, 2), (0,))
    assert headings(nobody, nobody, np.empty((0, 2)), RATE).shape == (0,)
