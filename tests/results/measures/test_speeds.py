"""Speeds and changes of direction, on tracks drawn by hand."""

import math

import numpy as np
import pytest
from shapely import box

from mesa_mobility.errors import ResultsError
from mesa_mobility.results import direction_changes, mean_speed, speeds, speeds_along


def test_speed_is_displacement_over_the_window(walk):
    # 3-4-5: 5 m within 2 s of a detour; the detour itself is longer.
    run = walk({0: (0, [(0, 0), (9, 9), (3, 4)])}, frame_rate=1.0)
    assert speeds(run, window=2.0).tolist() == [2.5]
    assert mean_speed(run, window=2.0) == 2.5


def test_mean_speed_weighs_people_by_their_time(walk):
    # 0 walks 1 m/s for 2 s, 1 stands for 4 s: (1 + 1 + 0 + 0 + 0 + 0) / 6.
    run = walk(
        {0: (0, [(0, 0), (1, 0), (2, 0)]), 1: (0, [(0, 5)] * 5)}, frame_rate=1.0, last_frame=4
    )
    assert mean_speed(run) == pytest.approx(1 / 3)


def test_mean_speed_of_too_short_a_run_is_unknown(walk):
    assert mean_speed(walk({0: (0, [(0, 0)] * 30)})) is None


def test_window_within_a_frame_is_refused(two_leave_one_stays):
    with pytest.raises(ResultsError, match=r"window of 0\.1 s is shorter than a frame"):
        speeds(two_leave_one_stays, window=0.1)


def test_direction_turns_left_then_back(walk):
    # Steps of 1 s: east, north, north-east, a 0.1 m stand, east.
    corners = [(0, 0), (1, 0), (1, 1), (2, 2), (2.1, 2), (3.1, 2)]
    run = walk({0: (3, corners)}, frame_rate=1.0)
    assert direction_changes(run, interval=1.0).tolist() == pytest.approx(
        [math.pi / 2, -math.pi / 4]
    )


def test_direction_change_is_the_short_way_round(walk):
    # From 170 degrees to -170 degrees is 20 degrees to the left.
    first, second = math.radians(170), math.radians(-170)
    middle = (math.cos(first), math.sin(first))
    end = (middle[0] + math.cos(second), middle[1] + math.sin(second))
    run = walk({0: (0, [(0, 0), middle, end])}, frame_rate=1.0)
    assert direction_changes(run, interval=1.0).tolist() == pytest.approx([math.radians(20)])


def test_direction_changes_are_each_persons_own(walk):
    run = walk({0: (0, [(0, 0), (1, 0)]), 1: (0, [(0, 5), (0, 6)])}, frame_rate=1.0)
    assert direction_changes(run, interval=1.0).tolist() == []


def test_direction_steps_start_where_each_person_starts(walk):
    # East for two frames, north for two: with steps of two frames one right angle, whichever
    # frame the person came in.
    track = [(0, 0), (1, 0), (2, 0), (2, 1), (2, 2)]
    for first in (0, 1):
        run = walk({0: (first, track)}, frame_rate=2.0)
        assert direction_changes(run, interval=1.0).tolist() == pytest.approx([math.pi / 2])


def test_speed_along_a_direction_over_a_window(walk):
    # 0.25 m a frame of half a second along x, swinging in y; and somebody who goes back.
    ahead = [(0.25 * k, 0.1 * (-1) ** k) for k in range(7)]
    back = [(5.0 - 0.5 * k, 2.0) for k in range(4)]
    run = walk({0: (0, ahead), 1: (2, back)}, frame_rate=2.0)
    found = speeds_along(run, (3.0, 0.0), window=1.5)
    assert found.person.tolist() == [0, 0, 0, 0, 1]
    assert found.speed == pytest.approx([0.5] * 4 + [-1.0])
    assert found.time == pytest.approx([0.75, 1.25, 1.75, 2.25, 1.75])
    # The window has 3 frames; where they were one frame after its beginning.
    assert found.point[:, 0] == pytest.approx([0.25, 0.5, 0.75, 1.0, 4.5])
    assert speeds_along(run, (0.0, 1.0), window=1.0).speed[:5] == pytest.approx([0.0] * 5)
    assert speeds_along(run, (1.0, 1.0), window=1.5).speed[-1] == pytest.approx(-1 / np.sqrt(2))


def test_speed_only_of_those_in_the_area_in_the_middle_of_the_window(walk):
    run = walk({0: (0, [(float(k), 0.0) for k in range(9)])}, frame_rate=1.0)
    found = speeds_along(run, (1.0, 0.0), window=2.0, area=box(2.5, -1, 4.5, 1))
    assert found.point[:, 0].tolist() == [3.0, 4.0]
    assert found.time.tolist() == [3.0, 4.0]


def test_nobody_long_enough_inside(walk):
    run = walk({0: (0, [(0.0, 0.0), (1.0, 0.0)])}, frame_rate=1.0)
    assert len(speeds_along(run, (1.0, 0.0), window=5.0).speed) == 0


@pytest.mark.parametrize("direction", [(0.0, 0.0), (1.0,), (np.nan, 1.0)])
def test_directions_that_are_none(walk, direction):
    run = walk({0: (0, [(0.0, 0.0)] * 4)}, frame_rate=1.0)
    with pytest.raises(ResultsError, match="direction"):
        speeds_along(run, direction)
