"""Where somebody stands who makes way."""

import numpy as np
import pytest
from shapely import box, union_all

from mesa_mobility import Exit, FloorPlan
from mesa_mobility.crowd.conflicts.places import (
    ROOM,
    Body,
    Way,
    distances_to_way,
    leaves_free,
    places_aside,
    places_to_set_out,
)
from tests.fixtures.buildings import two_storeys

NOBODY = np.empty((0, 2)), np.empty(0)


def aside(height: float, taken=NOBODY, core: float = 0.2):
    """Places of somebody at x = 5 in the middle of a corridor; another comes along the middle."""
    y = height / 2
    other = Body(np.array([3.0, y]), core)
    way = Way(other, np.array([[3.0, y], [7.0, y]]))
    plan = FloorPlan(box(0, 0, 10, height), exits=[Exit("end", (10, 0), (10, height))])
    return places_aside(plan, Body(np.array([5.0, y]), core), [way], *taken)


def test_the_nearest_place_leaves_the_way_free():
    places = aside(3.0)
    # Cores of 0.2 m and room of 0.1 m are 0.5 m.
    assert abs(places[0, 1] - 1.5) >= 0.4 + ROOM
    assert np.hypot(*(places[0] - (5.0, 1.5))) < 0.8
    # Walls are kept clear of.
    assert (np.abs(places[:, 1] - 1.5) <= 1.3).all()


def test_where_there_is_no_room_aside_they_walk_ahead():
    places = aside(0.8)
    assert places[0, 0] == pytest.approx(5.0 + 2.4, abs=0.1)
    assert places[0, 1] == pytest.approx(0.4, abs=0.2)


@pytest.mark.parametrize("climbs", [True, False])
def test_who_does_not_climb_makes_no_way_onto_stairs(climbs):
    """Somebody stands 0.6 m before the head of a stair, another comes along the wall."""
    office = two_storeys()
    [head, stands, comes] = office.places([(8.0, 0.6), (7.4, 0.6), (5.0, 0.6)], 1)
    down = np.array(next(each for each in office.flights if each.name == "south").down)
    if down[0] < 0:
        stands, comes = 2 * head - stands, 2 * head - comes
    way = Way(Body(comes, 0.2), np.array([comes, head]))
    places = places_aside(office.floor_plan, Body(stands, 0.35, climbs), [way], *NOBODY)
    on_stairs = (places - head) @ down > -0.35
    beside = np.abs((places - head) @ (-down[1], down[0])) < 0.6
    assert (on_stairs & beside).any() == climbs


def test_which_places_leave_a_way_free():
    way = Way(Body(np.array([0.0, 0.0]), 0.3), np.array([[0.0, 0.0], [4.0, 0.0]]))
    # Cores of 0.3 and 0.2 m and room of 0.1 m are 0.6 m.
    places = np.array([[2.0, 0.59], [2.0, 0.61], [2.0, -0.61], [4.5, 0.0], [4.61, 0.0]])
    assert leaves_free(places, 0.2, [way]).tolist() == [False, True, True, False, True]
    assert leaves_free(places, 0.2, []).all()


def test_a_place_where_somebody_stands_is_worth_a_little_way():
    free = aside(3.0)[0]
    elsewhere = aside(3.0, taken=(free[None], np.array([0.2])))[0]
    assert np.hypot(*(elsewhere - free)) >= 0.4


def test_nobody_passes_through_those_who_come():
    for place in aside(3.0):
        leg = np.linspace((5.0, 1.5), place, 50)
        assert np.hypot(*(leg - (3.0, 1.5)).T).min() >= 0.4 - 1e-6


def test_setting_out_again_beside_a_jamb():
    rooms = box(0, 0, 4, 4).union(box(4, 1.5, 4.2, 2.5)).union(box(4.2, 0, 8, 4))
    plan = FloorPlan(rooms, exits=[Exit("end", (8, 1), (8, 3))])
    me = Body(np.array([3.7, 1.75]), 0.35)

    def through(places):
        return np.broadcast_to((6.0, 2.0), places.shape)

    places = places_to_set_out(plan, me, through, *NOBODY)
    # The way from each leads through the middle 0.2 m of the door, 1 m wide, for 0.4 m of body.
    for x, y in places[places[:, 0] < 4.0]:
        for at in (4.0, 4.2):
            assert abs(y + (2.0 - y) * (at - x) / (6.0 - x) - 2.0) <= 0.1 + 0.02
    assert places[0, 0] < 4.0


def test_where_no_way_passes_walls_with_room_the_widest_is_taken():
    door = box(4, 1.85, 4.2, 2.15)  # 0.3 m wide, for a body of 0.4 m
    floor = union_all([box(0, 0, 4, 4), door, box(4.2, 0, 8, 4)])
    plan = FloorPlan(floor, exits=[Exit("end", (8, 0), (8, 4))])

    def through(places):
        return np.broadcast_to((6.0, 2.0), places.shape)

    places = places_to_set_out(plan, Body(np.array([3.0, 1.0]), 0.2), through, *NOBODY)
    # 0.5 of 0.2 m and 0.05 m are 0.125 m: within 0.025 m of the middle of the door.
    assert len(places)
    for x, y in places[places[:, 0] < 4.0]:
        for at in (4.0, 4.2):
            assert abs(y + (2.0 - y) * (at - x) / (6.0 - x) - 2.0) <= 0.025 + 0.005


def test_distances_to_a_way():
    way = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0]])
    off, along = distances_to_way(np.array([[1.0, 0.5], [3.0, 1.0], [-1.0, 0.0]]), way)
    assert off == pytest.approx([0.5, 1.0, 1.0])
    assert along == pytest.approx([1.0, 3.0, 0.0])
