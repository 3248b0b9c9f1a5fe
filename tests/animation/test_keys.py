"""Frames that are left out of animations."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from mesa_mobility.animation.keys import key_frames


def test_corners_alone_are_kept():
    # Up for four frames, level for three, and a bump of 0.05 that is near enough.
    values = np.array([0.0, 1.0, 2.0, 3.0, 3.0, 3.05, 3.0])
    (kept,) = key_frames(values[None, :, None], np.array([0.1]))
    assert kept.tolist() == [0, 3, 6]
    (kept,) = key_frames(values[None, :, None], np.array([0.04]))
    assert kept.tolist() == [0, 3, 5, 6]


def test_what_stands_still_has_one_key_and_what_moves_evenly_two():
    still, even = np.full((20, 3), 7.0), np.linspace(0, 5, 20)[:, None] * np.ones(3)
    kept = key_frames(np.array([still, even]), np.array([0.01, 0.01]))
    assert [each.tolist() for each in kept] == [[0], [0, 19]]


@settings(max_examples=60, deadline=None)
@given(st.integers(2, 80), st.integers(1, 4), st.floats(0.005, 0.5), st.integers(0, 10_000))
def test_nothing_is_farther_off_than_allowed(frames, channels, tolerance, seed):
    random = np.random.default_rng(seed)
    values = np.cumsum(random.normal(0, 0.05, (channels, frames, 3)), axis=1)
    limits = tolerance * np.arange(1, channels + 1)
    for own, limit, kept in zip(values, limits, key_frames(values, limits), strict=True):
        at = np.arange(frames)
        mixed = np.column_stack([np.interp(at, kept, own[kept, k]) for k in range(3)])
        assert np.linalg.norm(mixed - own, axis=1).max() <= limit + 1e-9
        assert kept[0] == 0
        assert len(kept) == 1 or kept[-1] == frames - 1
        assert (np.diff(kept) > 0).all()


@pytest.mark.parametrize("degrees", [0.5, 2.0])
def test_turns_are_off_by_no_more_than_their_angle(degrees):
    random = np.random.default_rng(3)
    angles = np.cumsum(np.cumsum(random.normal(0, 0.004, (5, 120, 3)), axis=1), axis=1)
    turns = np.array([Rotation.from_rotvec(each).as_quat() for each in angles])
    for k in range(1, turns.shape[1]):
        turned = np.einsum("ij,ij->i", turns[:, k], turns[:, k - 1])
        turns[turned < 0, k] *= -1
    kept = key_frames(turns, np.full(5, np.radians(degrees)), turns=True)
    for own, keys in zip(turns, kept, strict=True):
        assert len(keys) < 60
        at = np.arange(120)
        mixed = np.column_stack([np.interp(at, keys, own[keys, k]) for k in range(4)])
        off = (Rotation.from_quat(mixed).inv() * Rotation.from_quat(own)).magnitude()
        assert np.degrees(off).max() <= degrees * 1.001
