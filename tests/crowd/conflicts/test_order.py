"""Rings of people who block each other, and who of them makes way."""

import numpy as np
import pytest

from mesa_mobility.crowd.conflicts.hindrance import PATIENCE, find_hindered, wait_behind
from mesa_mobility.crowd.conflicts.notes import (
    AGREED,
    GIVES_UP,
    LATER,
    LONGEST,
    blank_notes,
    join,
    pass_on,
    resolve,
    stop_making_way,
)
from mesa_mobility.crowd.state.people_grid import build_grid
from mesa_mobility.crowd.state.records import Crowd


def crowd_of(*routes: float) -> Crowd:
    """People inside with these metres to go, who have made no progress since the start."""
    crowd = Crowd(len(routes))
    crowd.active[:] = True
    crowd.route[:] = routes
    crowd.agenda["speed"] = 1.3
    return crowd


def resolved(crowd: Crowd, blockers: list[int], notes=None, served=(), at: float = 10.0, walled=()):
    """The notes after a search for rings among all of them."""
    rows = np.arange(len(blockers))
    notes = blank_notes(len(rows)) if notes is None else notes
    held, waited_for = np.isin(rows, walled), np.isin(rows, served)
    given = np.array(blockers), held, waited_for, at, crowd.records, crowd.agenda
    resolve(rows, *given, notes)
    return notes


def test_of_a_ring_the_one_in_the_way_of_the_shortest_route_makes_way():
    notes = resolved(crowd_of(9.0, 3.0, 5.0), [1, 2, 0])
    assert notes["first"].tolist() == [-1, -1, 1]
    assert notes["asked_by"][2] == 1
    assert notes["until"][2] == 10.0 + AGREED


def test_of_two_as_far_the_first_in_the_crowd_goes_first():
    assert resolved(crowd_of(4.0, 4.0), [1, 0])["first"].tolist() == [-1, 0]


def test_a_chain_is_no_ring():
    # 2 waits for 1, who waits for 0, who is in nobody's way.
    assert (resolved(crowd_of(1.0, 2.0, 3.0), [-1, 0, 1])["first"] == -1).all()


def test_a_chain_that_leads_into_a_ring_waits():
    # 3 has the shortest route, but is in nobody's way: the ring is of 0 and 1.
    notes = resolved(crowd_of(5.0, 6.0, 7.0, 1.0), [1, 0, 1, 2])
    assert notes["first"].tolist() == [-1, 0, -1, -1]


def test_whoever_has_made_way_comes_after_those_who_follow():
    crowd, notes = crowd_of(3.0, 4.0), blank_notes(2)
    notes["later"][0] = 20.0
    assert resolved(crowd, [1, 0], notes, at=10.0)["first"].tolist() == [1, -1]
    # Later than that the shorter route counts again.
    assert resolved(crowd, [1, 0], blank_notes(2), at=21.0)["first"].tolist() == [-1, 0]


def test_those_in_the_way_of_somebody_who_makes_way_do_so_too():
    crowd = crowd_of(3.0, 4.0, 5.0)
    notes = resolved(crowd, [1, 0, -1])
    pass_on(np.array([1]), np.array([2]), 11.0, crowd.records, crowd.agenda, notes)
    assert notes["first"].tolist() == [-1, 0, 0]
    assert notes["asked_by"][2] == 1
    # But not for somebody who comes later in the order than they.
    crowd.route[2] = 1.0
    notes["first"][2], notes["later"][2] = -1, 0.0
    pass_on(np.array([1]), np.array([2]), 12.0, crowd.records, crowd.agenda, notes)
    assert notes["first"][2] == -1


@pytest.mark.parametrize(("x", "joins"), [(-1.0, False), (3.0, True)])
def test_whoever_comes_towards_somebody_who_makes_way_joins(x, joins):
    crowd = crowd_of(3.0, 4.0, 5.0)
    notes = resolved(crowd, [1, 0, -1])
    # 1 is at 0 and makes way to x = 2; 2 stands behind or ahead.
    notes["x"][1], crowd.x[2] = 2.0, x
    seen = np.array([[0.0, 0.0]])
    join(np.array([2]), np.array([1]), seen, 11.0, crowd.records, crowd.agenda, notes)
    assert (notes["first"][2] == 0) == joins


@pytest.mark.parametrize(
    ("since", "waits", "asked"), [(2.0, 0, True), (9.0, 0, False), (9.0, 600, True)]
)
def test_whoever_gets_on_need_not_make_way_for_those_who_make_way(since, waits, asked):
    crowd = crowd_of(3.0, 4.0, 5.0)
    notes = resolved(crowd, [1, 0, -1])
    # 2 has got on 9 or 2 s ago, or waits until 20 s.
    crowd.agenda["since"][2], crowd.agenda["waits_until"][2] = since, waits
    passed, joined = notes.copy(), notes.copy()
    pass_on(np.array([1]), np.array([2]), 11.0, crowd.records, crowd.agenda, passed)
    assert (passed["first"][2] == 0) == asked
    joined["x"][1], crowd.x[2], seen = 2.0, 3.0, np.array([[0.0, 0.0]])
    join(np.array([2]), np.array([1]), seen, 11.0, crowd.records, crowd.agenda, joined)
    assert (joined["first"][2] == 0) == asked


def test_whoever_goes_back_from_a_wall_makes_way_though_they_move():
    # Two at the jambs of a door go back, and each is in the way of the other.
    crowd = crowd_of(3.0, 4.0)
    notes = resolved(crowd, [1, 0], at=10.0, walled=[0, 1])
    assert notes["first"].tolist() == [0, 1]
    crowd.agenda["since"] = 10.0
    pass_on(np.array([0]), np.array([1]), 10.0, crowd.records, crowd.agenda, notes)
    assert notes["first"].tolist() == [0, 0]


def test_the_first_comes_last_if_nobody_can_make_room():
    crowd = crowd_of(3.0, 4.0)
    notes = resolved(crowd, [1, 0], at=10.0)
    crowd.agenda["since"][:] = 10.0
    at = 10.0 + GIVES_UP
    assert resolved(crowd, [1, 0], notes, served=[0], at=at)["first"].tolist() == [-1, 0]
    assert resolved(crowd, [1, 0], notes, served=[0], at=at + 0.1)["first"].tolist() == [1, -1]
    assert notes["later"][0] == pytest.approx(at + 0.1 + LATER)


def test_whoever_has_found_no_room_comes_first():
    # 0 waits for 1, who follows, and who waits for 2, who makes way and has the longest route.
    crowd, notes = crowd_of(3.0, 4.0, 9.0, 1.0), blank_notes(4)
    notes["first"][2], notes["served"][0] = 0, 10.0
    crowd.agenda["since"][:] = 10.0
    at = 10.0 + GIVES_UP + 0.1
    resolved(crowd, [1, 2, -1, -1], notes, served=[0], at=at)
    assert notes["first"].tolist() == [-1] * 4
    assert notes["sooner"].tolist() == pytest.approx([at, 0.0, at + LATER, 0.0])
    # In the ring that they are found in next, they go first, and even before who is nearly out.
    assert resolved(crowd, [1, 2, 0, -1], notes, at=at + PATIENCE)["first"].tolist()[0] == 2
    crowd.agenda["since"][:] = at
    assert resolved(crowd, [-1, -1, 3, 2], notes, at=at + PATIENCE)["first"].tolist()[3] == 2
    later = resolved(crowd, [-1, -1, 3, 2], blank_notes(4), at=at + LATER + 1.0)
    assert later["first"].tolist() == [-1, -1, 3, -1]


def test_all_who_have_found_no_room_come_first_and_those_aside_do_not():
    crowd, notes = crowd_of(3.0, 4.0, 9.0, 8.0, 7.0), blank_notes(5)
    notes["first"][1:4], notes["served"][0], notes["aside"][2] = 0, 10.0, 1
    crowd.agenda["since"][:] = 10.0
    at = 10.0 + GIVES_UP + 0.1
    resolved(crowd, [1, -1, -1, -1, -1], notes, served=[0], at=at)
    assert notes["sooner"].tolist() == pytest.approx([at, at + LATER, 0.0, at + LATER, 0.0])


def test_nobody_waits_for_ever_for_those_who_make_room_in_turns():
    crowd = crowd_of(3.0, 4.0)
    notes = resolved(crowd, [1, 0], at=10.0)
    for at, first in ((LONGEST, [-1, 0]), (LONGEST + 0.1, [1, -1])):
        notes["served"][0] = at  # somebody has just got on with making room
        assert resolved(crowd, [1, 0], notes, served=[0], at=at)["first"].tolist() == first


def test_whoever_is_held_by_a_wall_goes_back_though_others_make_way():
    crowd, notes = crowd_of(3.0, 4.0), blank_notes(2)
    notes["first"][1], notes["served"][0] = 0, 10.0
    resolved(crowd, [-1, -1], notes, served=[0], at=10.0, walled=[0])
    assert notes["first"].tolist() == [0, 0]


def test_whoever_is_held_by_a_wall_comes_first_and_so_has_others_move():
    crowd = crowd_of(4.0, 3.0)  # the other one comes first
    asked = resolved(crowd, [1, 0], at=10.0, walled=[0])
    pass_on(np.array([0]), np.array([1]), 10.0, crowd.records, crowd.agenda, asked)
    assert asked["first"].tolist() == [0, 0]


def test_people_stop_making_way_in_time_and_for_people_who_are_gone():
    crowd = crowd_of(3.0, 4.0, 5.0)
    notes = blank_notes(3)
    notes["first"][1:], notes["until"][1], notes["until"][2] = 0, 5.0, 20.0
    stop_making_way(np.arange(3), 10.0, crowd.records, notes)
    assert notes["first"].tolist() == [-1, -1, 0]
    crowd.active[0] = False
    stop_making_way(np.arange(3), 10.0, crowd.records, notes)
    assert notes["first"].tolist() == [-1, -1, -1]


def hindered(crowd: Crowd, speeds: list[float], at: float) -> list[bool]:
    found = np.zeros(len(crowd.route), bool)
    rows, speeds = np.arange(len(found)), np.array(speeds)
    find_hindered(rows, speeds, at, crowd.records, crowd.agenda, found)
    return found.tolist()


def test_who_is_hindered():
    crowd = crowd_of(5.0, 5.0, 5.0, np.inf)
    # A slow person takes 2 x 0.25 / 0.05 = 10 s for the progress that counts.
    speeds = [1.0, 0.05, 1.0, 1.0]
    crowd.agenda["nearest"] = 5.0
    crowd.agenda["waits_until"][2] = 300
    assert hindered(crowd, speeds, PATIENCE) == [False] * 4
    assert hindered(crowd, speeds, PATIENCE + 0.1) == [True, False, False, False]
    assert hindered(crowd, speeds, 10.1) == [True, True, False, False]
    # 0.3 m nearer is progress, 0.2 m is none.
    crowd.route[:2] = 4.7, 4.8
    assert hindered(crowd, speeds, 11.0) == [False, True, False, False]


@pytest.mark.parametrize(
    ("ahead", "target", "since", "waits"),
    # They are at 0, walk along x, and have not got on since 0 s; it is 10 s.
    [
        ((1.5, 0.5), 20.0, 9.0, True),
        ((2.1, 0.0), 20.0, 9.0, False),
        ((-0.5, 0.0), 20.0, 9.0, False),
        ((1.5, 0.5), -20.0, 9.0, False),
        ((1.5, 0.5), 20.0, 7.5, False),
    ],
)
def test_nobody_is_hindered_in_a_jam_that_moves_on(ahead, target, since, waits):
    crowd = crowd_of(5.0, 4.0)
    crowd.x[1], crowd.y[1] = ahead
    crowd.target_x[:] = 20.0, target
    crowd.agenda["since"][1] = since
    people, found = build_grid(np.arange(2), crowd.x, crowd.y), np.array([True, False])
    wait_behind(np.arange(2), 10.0, people, crowd.records, crowd.agenda, found)
    assert found.tolist() == [not waits, False]
