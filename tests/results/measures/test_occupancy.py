"""How many people are inside, and when they leave."""

import pytest

from mesa_mobility.errors import ResultsError
from mesa_mobility.results import Trajectories, departures, egress_time, occupancy


def test_occupancy_of_two_who_leave_and_one_who_stays(two_leave_one_stays):
    assert occupancy(two_leave_one_stays, every=1.0) == [[0.0, 2], [1.0, 2], [2.0, 1]]
    assert occupancy(two_leave_one_stays, every=0.5) == [
        [0.0, 2],
        [0.5, 3],
        [1.0, 2],
        [1.5, 2],
        [2.0, 1],
    ]


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
