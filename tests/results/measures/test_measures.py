import math

import pytest
import shapely

from mesa_mobility.errors import ResultsError
from mesa_mobility.results import (
    Trajectories,
    crossings,
    density,
    departures,
    direction_changes,
    egress_time,
    flow,
    mean_speed,
    occupancy,
    speeds,
)


def test_occupancy_of_two_who_leave_and_one_who_stays(two_leave_one_stays):
    assert occupancy(two_leave_one_stays, every=1.0) == [[0.0, 2], [1.0, 2], [2.0, 1]]
    assert occupancy(two_leave_one_stays, every=0.5) == [
        [0.0, 2], [0.5, 3], [1.0, 2], [1.5, 2], [2.0, 1],
    ]  # fmt: skip


def test_occupancy_goes_on_over_an_empty_floor(walk):
    run = walk({0: (0, [(0.0, 0.0)] * 4)}, frame_rate=2.0, last_frame=7)
    assert occupancy(run) == [[0.0, 1], [1.0, 1], [2.0, 0], [3.0, 0]]


def test_occupancy_within_a_frame_is_refused(two_leave_one_stays):
    with pytest.raises(ResultsError, match=r"every 0\.4 s"):
        occupancy(two_leave_one_stays, every=0.4)


def test_people_leave_in_the_frame_that_finds_them_outside(two_leave_one_stays):
    assert departures(two_leave_one_stays).tolist() == [1.0, 2.0]
    assert egress_time(two_leave_one_stays) is None


def test_egress_ends_with_the_last_one(walk):
    run = walk({0: (0, [(0, 0)] * 3), 1: (0, [(5, 0)] * 6)}, frame_rate=2.0, last_frame=8)
    assert egress_time(run) == 2.5
    nobody = Trajectories(frame=[], person=[], x=[], y=[], heading=[])
    assert egress_time(nobody) is None


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


def test_density_is_people_over_area(walk):
    run = walk(
        {0: (0, [(1, 1), (1, 1)]), 1: (0, [(1.5, 1), (9, 9)]), 2: (0, [(9, 9), (9, 9)])},
        frame_rate=1.0,
    )
    assert density(run, shapely.box(0, 0, 2, 2)) == [[0.0, 0.5], [1.0, 0.25]]


def test_density_needs_an_area(walk):
    with pytest.raises(ResultsError, match="no size"):
        density(walk({0: (0, [(0, 0)])}), shapely.Polygon())
