"""Motion path editing against paths worked out by hand."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mesa_mobility.mobility.edits import EDITS, Edit, edit_paths

STRAIGHT = np.column_stack([0.1 * np.arange(1, 16), np.zeros(15), np.zeros(15)])[None]


def test_a_straight_walk_that_is_bent_becomes_an_arc():
    """1.5 m straight, turned by 90 degrees: a quarter of a circle of that length."""
    bent = edit_paths(STRAIGHT, Edit(np.pi / 2, 1.0))[0]
    radius = 1.5 / (np.pi / 2)
    angle = np.pi / 2 * np.arange(1, 16) / 15
    arc = np.column_stack([radius * np.sin(angle), radius * (1 - np.cos(angle)), angle])
    # The edit has chords of 10 cm where the circle has arcs of 10 cm.
    np.testing.assert_allclose(bent, arc, atol=1.5 * (np.pi / 30) ** 2 / 24)


def test_strides_scale_places_and_leave_headings():
    path = STRAIGHT + np.array([0.0, 0.2, 0.3])
    scaled = edit_paths(path, Edit(0.0, 0.7))
    np.testing.assert_allclose(scaled, path * [0.7, 0.7, 1.0], atol=1e-12)


def test_a_turn_is_given_over_45_frames():
    """After 12 frames, 4 samples, a turn of 45 degrees in 45 frames has come to 12 degrees."""
    bent = edit_paths(STRAIGHT, Edit(np.deg2rad(45.0), 1.0))[0]
    assert np.rad2deg(bent[3, 2]) == pytest.approx(12.0)
    assert np.rad2deg(bent[14, 2]) == pytest.approx(45.0)


@given(st.floats(-1.0, 1.0), st.floats(0.5, 1.5), st.integers(0, 2**32 - 1))
def test_edits_keep_the_gait(turn, stride, seed):
    """Each step keeps its length, times the stride, and its direction relative to the heading."""
    rng = np.random.default_rng(seed)
    path = np.cumsum(rng.normal(0, 0.1, (1, 15, 3)), axis=1)
    bent = edit_paths(path, Edit(turn, stride))
    before, after = (np.diff(each[0], axis=0, prepend=0.0) for each in (path, bent))
    lengths = np.hypot(before[:, 0], before[:, 1])
    np.testing.assert_allclose(np.hypot(after[:, 0], after[:, 1]), stride * lengths, atol=1e-9)
    # The heading turns evenly over the samples, and steps by the mean of before and after.
    np.testing.assert_allclose(after[:, 2] - before[:, 2], turn / 15, atol=1e-9)
    turned = np.arctan2(after[:, 1], after[:, 0]) - np.arctan2(before[:, 1], before[:, 0])
    expected = turn * (np.arange(15) + 0.5) / 15
    wrapped = (turned - expected + np.pi) % (2 * np.pi) - np.pi
    np.testing.assert_allclose(wrapped[lengths > 1e-3], 0.0, atol=1e-6)


def test_turns_come_in_pairs_and_no_edit_leaves_an_option_as_it_is():
    edits = {(round(float(np.rad2deg(e.turn))), e.stride) for e in EDITS}
    assert {(-turn, stride) for turn, stride in edits} == edits
    assert (0, 1.0) not in edits
    assert min(e.cost for e in EDITS) > 0
