"""Crossings of lines, N-t curves and flow, on tracks drawn by hand."""

import pytest

from mesa_mobility.errors import ResultsError
from mesa_mobility.results import crossings, flow, flow_over_time, passed_by

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
    assert flow_over_time(found, 10.0, window=2.5) == [
        [1.25, 0.0],
        [3.75, 0.8],
        [6.25, 0.4],
        [8.75, 0.0],
    ]
    assert flow_over_time(found, 10.0, window=20.0) == []


def test_lines_that_nobody_crosses(three):
    found = crossings(three, (50.0, 0.0), (50.0, 1.0))
    assert passed_by(found) == []
    assert flow_over_time(found, 10.0, window=5.0) == [[2.5, 0.0], [7.5, 0.0]]


@pytest.mark.parametrize("direction", [0, 2, "left"])
def test_other_directions_are_refused(three, direction):
    found = crossings(three, *LINE)
    for measure in (
        lambda: passed_by(found, direction),
        lambda: flow_over_time(found, 10.0, direction=direction),
    ):
        with pytest.raises(ResultsError, match="direction"):
            measure()


def test_a_window_must_last(three):
    with pytest.raises(ResultsError, match="window"):
        flow_over_time(crossings(three, *LINE), 10.0, window=0.0)


def test_crossings_say_when_who_and_which_way(walk):
    # The line runs up from (0, 0) to (0, 2): its left-hand side is x < 0.
    run = walk(
        {
            0: (0, [(-1, 1), (-1, 1), (3, 1)]),  # to the right, a quarter of a frame after 1
            1: (0, [(1, 1), (0.5, 1), (-0.5, 1)]),  # to the left, half a frame after 1
            2: (0, [(-1, 3), (1, 3), (2, 3)]),  # past its upper end
        },
        frame_rate=2.0,
    )
    passages = crossings(run, (0, 0), (0, 2))
    assert passages.time.tolist() == [0.625, 0.75]
    assert passages.person.tolist() == [0, 1]
    assert passages.direction.tolist() == [-1, 1]


def test_standing_on_the_line_counts_once(walk):
    run = walk({0: (0, [(1, 1), (0, 1), (0, 1), (-1, 1)])}, frame_rate=1.0)
    passages = crossings(run, (0, 0), (0, 2))
    assert passages.time.tolist() == [1.0]
    assert passages.direction.tolist() == [1]


def test_a_line_needs_two_ends(two_leave_one_stays):
    with pytest.raises(ResultsError, match="two ends"):
        crossings(two_leave_one_stays, (1, 1), (1, 1))


def test_flow_starts_with_the_first_passage():
    assert flow([10.0, 12.0, 11.0, 14.0]) == 0.75
    assert flow([10.0]) is None
    assert flow([]) is None


def test_flow_over_an_exit(two_leave_one_stays):
    # 0 passes x = 10 at 1/1.1 of a frame after 1, 2 at 1/1.5 after 3; frames last 0.5 s.
    passages = crossings(two_leave_one_stays, (10, 1), (10, 3))
    first, second = (1 + 1 / 1.1) / 2, (3 + 1 / 1.5) / 2
    assert passages.time.tolist() == pytest.approx([first, second])
    assert flow(passages.time) == pytest.approx(1 / (second - first))
