import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from mesa_mobility.bodies import Movements
from mesa_mobility.bodies.rotations import angles
from mesa_mobility.bodies.sequence import (
    FADE,
    blended,
    fading,
    pose_sequence,
    stretch_of_each,
    stretches,
)
from mesa_mobility.bodies.skeleton import JOINT, TURN_OF
from tests.bodies.conftest import make_bank

ELBOW = TURN_OF[JOINT["left_elbow"]]


def movements(starts, options, shares=None):
    shares = np.ones(len(starts)) if shares is None else np.array(shares)
    return Movements(np.array(starts), np.array(options), shares)


def test_stretches_follow_each_other(bank):
    # Option 1 plays the first clip for a frame, then the second clip.
    found = pose_sequence(bank, np.arange(6), movements([2], [1]))
    assert found.numbers.tolist() == [0, 0, 0, 4, 6, 6]
    assert found.joins.tolist() == [3]
    assert found.before.tolist() == [2]  # the first clip would have gone on
    assert found.own.tolist() == [-1, -1, 0, 0, 0, 0]


def test_who_falls_back_or_takes_nothing_of_an_option_stands(bank):
    both = movements([0, 1, 2], [1, -2, 1], [1.0, 1.0, 0.0])
    assert pose_sequence(bank, np.arange(5), both).numbers.tolist() == [0, 0, 0, 0, 0]


def test_a_join_keeps_the_difference_and_lets_it_fade():
    bank = make_bank([0.0, 10.0, 50.0, 50.0, 50.0, 50.0, 50.0, 50.0, 50.0, 50.0])
    turns, _ = blended(bank, pose_sequence(bank, np.arange(9), movements([0], [1])))
    bent = np.rad2deg(angles(turns[:, ELBOW]))
    # At the join the first clip would have 10 degrees, and has 50: 40 too many, which fade.
    np.testing.assert_allclose(bent[1:7], 50.0 - 40.0 * FADE, atol=0.02)
    np.testing.assert_allclose(bent[7:], 50.0, atol=0.02)


def test_fading_begins_with_all_and_ends_with_nothing():
    assert FADE[0] == 1.0
    assert 0.0 < FADE[-1] < 0.1
    assert (np.diff(FADE) < 0).all()


@given(st.sets(st.integers(0, 19), min_size=1, max_size=6), st.floats(-2, 2))
def test_differences_add_up(places, size):
    each = np.array(sorted(places))
    together = fading(each, np.full((len(each), 1), size), 20)
    alone = sum(fading(np.array([p]), np.full((1, 1), size), 20) for p in each)
    np.testing.assert_allclose(together, alone, atol=1e-12)


def test_stretches_begin_where_the_sequence_has_its_joins(bank):
    # Option 1 plays the first clip for a frame, then the second clip.
    both = movements([2, 6], [1, -2])
    found = stretches(bank, both, 0)
    assert found.frames.tolist() == [0, 2, 3, 6]
    assert found.poses.tolist() == [0, 0, 4, 0]
    assert found.moving.tolist() == [False, True, True, False]
    assert found.own.tolist() == [-1, 0, 0, 1]
    # Somebody who moves from its first frame on has not stood before.
    assert stretches(bank, both, 2).frames.tolist() == [2, 3, 6]


def test_the_stretch_that_each_is_in(bank):
    # Three people: in the second stretch, in the first one, falling back.
    into, poses, moving, strides = stretch_of_each(
        bank, movements([0, 0, 0], [1, 1, -2]), np.array([4, 0, 7])
    )
    assert into.tolist() == [3, 0, 7]
    assert poses.tolist() == [4, 0, 0]
    assert moving.tolist() == [True, True, False]
    assert strides.tolist() == [1.0, 1.0, 1.0]
