"""N-t curves, flow over time, and speeds along a direction, on tracks drawn by hand."""

import numpy as np
import pytest
from shapely import box

from mesa_mobility.errors import ResultsError
from mesa_mobility.results import crossings, flow_over_time, passed_by, speeds_along

LINE = ((5.0, 0.0), (5.0, 4.0))


@pytest.fixture
def three(walk):
    """At 1 frame a second: 0 crosses x = 5 m after 2.5 s, 1 after 6.5 s and back, 2 back only."""
    return walk(
        {
            0: (0, [(3.0, 1.0), (4.0, 1.0), (4.5, 1.0), (5.5, 1.0), (7.0, 1.0)]),
            1: (5, [(4.0, 2.0), (4.5, 2.0), (5.5, 2.0), (4.5, 2.0), (5.5, 2.0), (6.0, 2.0)]),
            2: (2, [(6.0, 3.0), (5.5, 3.0), (4.5, 3.0)]),
        },
        frame_rate=1.0,
    )


def test_everybody_counts_once_at_its_first_passage(three):
    found = crossings(three, *LINE)
    # To the right is from the left-hand to the right-hand side of a line that goes up.
    assert passed_by(found, -1) == [[2.5, 1], [6.5, 2]]
    assert passed_by(found, 1) == [[3.5, 1], [7.5, 2]]
    assert passed_by(found) == [[2.5, 1], [3.5, 2], [6.5, 3]]


def test_flow_in_windows(three):
    found = crossings(three, *LINE)
    assert three.duration == 10.0
    assert flow_over_time(found, 10.0, window=4.0) == [[2.0, 0.5], [6.0, 0.25]]
    assert flow_over_time(found, 10.0, window=5.0, direction=-1) == [[2.5, 0.2], [7.5, 0.2]]
    assert flow_over_time(found, 10.0, window=2.5) == [[1.25, 0.0], [3.75, 0.8], [6.25, 0.4],
                                                       [8.75, 0.0]]  # fmt: skip
    assert flow_over_time(found, 10.0, window=20.0) == []


def test_lines_that_nobody_crosses(three):
    found = crossings(three, (50.0, 0.0), (50.0, 1.0))
    assert passed_by(found) == []
    assert flow_over_time(found, 10.0, window=5.0) == [[2.5, 0.0], [7.5, 0.0]]


@pytest.mark.parametrize("direction", [0, 2, "left"])
def test_other_directions_are_refused(three, direction):
    found = crossings(three, *LINE)
    for measure in (lambda: passed_by(found, direction),
                    lambda: flow_over_time(found, 10.0, direction=direction)):  # fmt: skip
        with pytest.raises(ResultsError, match="direction"):
            measure()


def test_a_window_must_last(three):
    with pytest.raises(ResultsError, match="window"):
        flow_over_time(crossings(three, *LINE), 10.0, window=0.0)


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
