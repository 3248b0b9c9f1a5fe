"""The count of those who stand, on tracks made by hand in a corridor from x = 0 to 20."""

import numpy as np
import pytest
import shapely
from shapely import LineString, Point, box

from benchmarks.conflicts.__main__ import seeds_of
from benchmarks.conflicts.standing import (
    Known,
    count_crossings,
    count_overlaps,
    find_standing,
)
from benchmarks.conflicts.table import wrong_with
from benchmarks.conflicts.walking import seconds_of
from benchmarks.conflicts.ways import Ways
from mesa_mobility import Trajectories

FLOOR = box(0, 0, 20, 4)
WALLS = [(0, 0, 20, 0), (20, 4, 0, 4), (0, 4, 0, 0)]
EAST = LineString([(20, 0), (20, 4)])


def standing(tracks, *, goals=(EAST,), goal=None, excused=None, speeds=None):
    """Who stood, and who is lost, where each of ``tracks`` gives x and y by second."""
    places = np.array([np.broadcast_to(track, np.shape(track)) for track in tracks], dtype=float)
    places = places.transpose(1, 0, 2)
    seconds, people = places.shape[:2]
    inside = np.isfinite(places[:, :, 0])
    given = np.zeros((seconds, people), dtype=np.int64) if goal is None else np.array(goal)
    told = np.zeros((seconds, people), dtype=bool) if excused is None else excused
    known = Known(goals, np.where(inside, given, -1), told, np.full(people, speeds or 1.3))
    return find_standing(places, known, Ways(FLOOR, WALLS))


def still(x, y, seconds=121):
    return np.tile([float(x), float(y)], (seconds, 1))


def walk(x, y, speed, seconds=121):
    """Along x at a speed; gone beyond x = 20."""
    along = x + speed * np.arange(seconds)
    track = np.column_stack([along, np.full(seconds, float(y))])
    track[along > 20.0] = np.nan
    return track


def test_somebody_who_stands_alone_stands_and_is_lost():
    found = standing([still(5, 2)])
    assert found.stood == {0: 0}
    assert found.lost == [0]


def test_a_walker_neither_stands_nor_is_lost():
    found = standing([walk(5, 2, 1.0)])
    assert (found.stood, found.lost) == ({}, [])


@pytest.mark.parametrize(("moves", "stands"), [(0.4, True), (0.6, False)])
def test_half_a_metre_in_a_minute_is_getting_on(moves, stands):
    found = standing([walk(5, 2, moves / 60.0, 61)])
    assert bool(found.stood) == stands


def test_less_than_a_minute_is_not_standing():
    # 59 s in one place, then gone.
    track = np.vstack([still(5, 2, 60), np.full((61, 2), np.nan)])
    assert standing([track]).stood == {}


def test_pacing_to_and_fro_is_standing():
    # A circle of 1 m in 60 s ends where it began.
    turn = 2 * np.pi * np.arange(121) / 60.0
    track = np.column_stack([5 + np.cos(turn), 2 + np.sin(turn)])
    assert standing([track]).stood == {0: 0}


def test_the_first_minute_is_named():
    track = np.vstack([walk(2, 2, 0.5, 10), still(7, 2, 111)])
    # From (6.5, 2) at 9 s to (7, 2) it is 0.5 m; at 10 s they are at (7, 2).
    assert standing([track]).stood == {0: 10}


def test_a_jam_that_moves_on_ahead_is_a_reason():
    # The one 1 m ahead comes 0.6 m nearer to the exit in the minute, and leaves in the end.
    found = standing([still(5, 2, 61), walk(6, 2, 0.01, 61)])
    assert found.stood == {}
    # 0.4 m are too little: both stand.
    assert set(standing([still(5, 2, 61), walk(6, 2, 0.4 / 60, 61)]).stood) == {0, 1}


def test_who_gets_on_behind_or_far_ahead_is_no_reason():
    behind = standing([still(5, 2, 61), walk(3.5, 3, 0.012, 61)])
    assert behind.stood == {0: 0}
    far = standing([still(5, 2, 61), walk(7.5, 2, 0.2, 61)])
    assert far.stood == {0: 0}


def test_who_overtakes_later_in_the_minute_is_a_reason():
    # From x = 0 at 0.2 m/s: beside the first after 25 s.
    assert standing([still(5, 2, 61), walk(0, 3, 0.2, 61)]).stood == {}


def test_ahead_is_by_the_way_and_not_by_the_goal_of_others():
    west = LineString([(0, 0), (0, 4)])
    goal = np.tile([0, 1], (61, 1))
    # Face to face for ever: neither is a reason for the other.
    both = standing([still(5, 2, 61), still(6, 2, 61)], goals=(EAST, west), goal=goal)
    assert both.stood == {0: 0, 1: 0}
    assert both.lost == [0, 1]


def test_who_was_told_to_stand_does_not_count_until_a_minute_after():
    told = np.zeros((121, 1), dtype=bool)
    told[:31] = True
    assert standing([still(5, 2)], excused=told).stood == {0: 31}
    told[:] = True
    found = standing([still(5, 2)], excused=told)
    assert (found.stood, found.lost) == ({}, [])


def test_the_slow_who_are_on_their_way_are_not_lost():
    # 18 m at 0.05 m/s are 360 s; the run has 120 s.
    assert standing([walk(2, 2, 0.05)], speeds=0.05).lost == []
    assert standing([walk(2, 2, 0.05)], speeds=1.3).lost == [0]


def test_ways_go_round_walls():
    # A wall from (10, 0) to (10, 3): from (6, 1) to the corner at (10, 3) and to (20, 3).
    floor = box(0, 0, 20, 4) - box(9.9, 0, 10.1, 3)
    walls = [*WALLS, (9.9, 0, 9.9, 3), (9.9, 3, 10.1, 3), (10.1, 3, 10.1, 0)]
    ways = Ways(floor, walls)
    there, beyond = ways.lengths([[6, 1], [12, 2]], EAST)
    assert there == pytest.approx(np.hypot(3.9, 2.1) + 10.1, abs=0.3)
    assert beyond == pytest.approx(8.0, abs=0.15)
    assert ways.lengths([[1, 1]], Point(4, 1)) == pytest.approx(3.0)
    assert ways.lengths([[1, 1], [5, 1]], box(4, 0, 6, 2)) == pytest.approx([3.0, 0.0], abs=0.2)
    closed = Ways(box(0, 0, 5, 4), [*WALLS, (5, 0, 5, 4)])
    assert np.isinf(closed.lengths([[1, 1]], Point(9, 1))).all()


def test_exits_can_be_seen_along_their_wall():
    walls = [(0, 0, 8, 0), (10, 0, 20, 0), *WALLS[1:], (20, 0, 20, 4)]
    [length] = Ways(FLOOR, walls).lengths([[2, 0.2]], LineString([(8, 0), (10, 0)]))
    assert length == pytest.approx(6.1, abs=0.15)


def test_overlaps_of_more_than_a_millimetre_count():
    radii = np.array([0.14, 0.14, 0.35])
    # 0.28 m and 0.49 m are touching.
    points = np.array([[0, 0], [0.2785, 0], [0, 0.4895]])
    assert count_overlaps(points, radii) == 1
    assert count_overlaps(points[:1], radii[:1]) == 0


def test_a_step_through_a_wall_is_found_wherever_it_is():
    wall = shapely.STRtree([LineString([(5, 0), (5, 4)])])
    track = np.column_stack([np.linspace(0, 4.9, 100), np.full(100, 2.0)])
    assert count_crossings(track, wall) == 0
    track[57, 0] = 5.1  # there and back, within one piece of ten steps
    assert count_crossings(track, wall) == 1


def test_places_at_whole_seconds():
    frame = np.repeat(np.arange(46), 2)
    person = np.tile([0, 1], 46)
    tracks = Trajectories(
        frame=frame, person=person, x=frame / 30.0, y=person * 1.0, heading=np.zeros(92)
    )
    places = seconds_of(tracks, 3, 3)
    assert places[:2, 0].tolist() == [[0.0, 0.0], [1.0, 0.0]]
    # The last of them is the end of the run, at 1.5 s.
    assert places[2, 1].tolist() == [1.5, 1.0]
    assert np.isnan(places[:, 2]).all()


def test_seeds_and_reasons_in_words():
    assert seeds_of("3,5,8-10") == [3, 5, 8, 9, 10]
    assert wrong_with({"lost": 0, "stood": 2, "overlaps": 0}) == "stood 2"
    assert wrong_with({"error": "no way"}) == "no way"
    assert wrong_with({"lost": 0}) == ""
