import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import box

from mesa_mobility.errors import ResultsError
from mesa_mobility.results import Trajectories
from mesa_mobility.results.measures.motion import (
    Selection,
    accelerations,
    facing_angles,
    lateral_correlation,
    speed_jumps,
    steps_between,
    walked_back,
)

RATE = 30.0


def tracks(*people, headings=None):
    """One track for each (n, 2) array of places, a place a frame."""
    frame = np.concatenate([np.arange(len(p)) for p in people])
    person = np.concatenate([np.full(len(p), k) for k, p in enumerate(people)])
    x, y = np.concatenate(people).T
    heading = np.zeros(len(x)) if headings is None else np.concatenate(headings)
    return Trajectories(
        frame=frame, person=person, x=x, y=y, heading=heading, frame_rate=RATE, core_radius=0.14
    )


def corners(*places, seconds=1.5):
    """A walk from place to place at constant speeds."""
    n = round(seconds * RATE)
    share = np.arange(n)[:, None] / n
    legs = [np.array(a) + share * (np.array(b) - a) for a, b in pairwise(places)]
    return np.vstack([*legs, [places[-1]]])


def test_steps_by_hand():
    # 2 m along x, then 1 m along y, then 1 m back along x.
    run = tracks(corners((0, 0), (2, 0), (2, 1), (1, 1)))
    steps = steps_between(run, (3.0, 0.0))
    assert steps.across.tolist() == pytest.approx([0.0, 1.0, 0.0])
    assert steps.turns.tolist() == pytest.approx([math.pi / 2, math.pi / 2])
    assert steps.speed_changes.tolist() == pytest.approx([-1 / 1.5, 0.0])
    assert steps.successive.ravel().tolist() == pytest.approx([0.0, 1.0, 1.0, 0.0])


def test_a_zigzag_has_a_correlation_of_minus_one():
    run = tracks(corners((0, 0), (2, 0.1), (4, -0.1), (6, 0.1), (8, -0.1)))
    steps = steps_between(run, (1, 0))
    assert lateral_correlation(steps.successive) == pytest.approx(-1.0, abs=0.06)


def test_steps_start_and_end_in_the_area_and_after_the_given_time():
    straight = corners((0, 0), (2, 0), (4, 0), (6, 0))
    run = tracks(straight)
    assert len(steps_between(run, (1, 0)).across) == 3
    near = Selection(area=box(-1, -1, 4.5, 1))
    assert len(steps_between(run, (1, 0), selection=near).across) == 2
    assert len(steps_between(run, (1, 0), selection=Selection(after=1.6)).across) == 1


def test_a_track_that_leaves_the_area_and_comes_back_is_two():
    there_and_back = corners((0, 0), (4, 0), (0, 0), seconds=3.0)
    run = tracks(there_and_back)
    # 1.33 m/s: inside x < 2 for the first and the last 1.5 s, with 1.5 s outside between.
    near = Selection(area=box(-1, -1, 2.01, 1))
    assert len(steps_between(run, (1, 0), selection=near).turns) == 0


@given(radius=st.floats(1.0, 5.0), speed=st.floats(0.4, 1.8))
@settings(max_examples=30, deadline=None)
def test_on_a_circle_the_acceleration_is_that_of_the_textbook(radius, speed):
    # Smoothing shrinks a circle by exp(-(omega s)^2 / 2).
    t, omega = np.arange(300) / RATE, speed / radius
    circle = radius * np.column_stack([np.cos(omega * t), np.sin(omega * t)])
    wanted = speed**2 / radius * math.exp(-((omega * 0.3) ** 2) / 2)
    found = accelerations(tracks(circle))
    assert found == pytest.approx(wanted, rel=0.02)


def test_the_jump_of_a_sudden_turn_is_root_two_of_the_speed():
    # A corner on the grid of 0.1 s.
    jumps = speed_jumps(tracks(corners((0, 0), (1.5, 0), (1.5, 1.5))))
    assert jumps.max() == pytest.approx(math.sqrt(2.0))
    assert np.count_nonzero(jumps > 1e-9) == 1


def test_people_who_stand_have_no_jumps():
    assert len(speed_jumps(tracks(np.zeros((60, 2))))) == 0
    # One who stops at once: no interval after the stop counts.
    assert speed_jumps(tracks(corners((0, 0), (1.5, 0), (1.5, 0)))).max() == pytest.approx(0.0)


@pytest.mark.parametrize(
    ("heading", "off"), [(0.0, 0.0), (1.0, 1.0), (-3.0, 3.0), (9.0, 9 - 2 * math.pi)]
)
def test_angle_between_facing_and_travel(heading, off):
    walk = corners((0, 0), (2, 0))
    angles = facing_angles(tracks(walk, headings=[np.full(len(walk), heading)]))
    assert angles.tolist() == pytest.approx([off] * 3)


def test_ways_back_from_a_door():
    # Both pass the door at the origin; the second goes back half a metre before it does.
    straight = corners((-3, 0), (0, 0), (3, 0))
    hesitant = corners((-3, 0), (-1, 0), (-1.5, 0), (0, 0), (3, 0))
    assert walked_back(tracks(straight, hesitant), (0.0, 0.0)).tolist() == pytest.approx([0.0, 0.5])


def test_bad_input_is_refused():
    run = tracks(corners((0, 0), (2, 0)))
    with pytest.raises(ResultsError, match="shorter than a frame"):
        steps_between(run, (1, 0), interval=0.01)
    with pytest.raises(ResultsError, match="expected a direction"):
        steps_between(run, (0, 0))


def test_no_tracks_give_no_figures():
    run = tracks(corners((0, 0), (2, 0)))
    nowhere = Selection(area=box(10, 10, 11, 11))
    assert len(accelerations(run, selection=nowhere)) == 0
    assert steps_between(run, (1, 0), selection=nowhere).successive.shape == (0, 2)
