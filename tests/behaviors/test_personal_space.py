"""Room between bodies."""

import math

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from mesa_mobility.behaviors import PersonalSpace
from shapely import LineString, Point

from mesa_mobility.errors import ModelError
from tests.fixtures.options import Chooser, Ending, candidates, shifts, turned_and_moved, turns

# All cores are 0.15 m, so 0.3 m of room are 0.6 m between middles.
NEIGHBOURS = [((1.2, 0.3), (-0.5, 0.0)), ((0.0, 0.5), (0.0, 0.0))]
WALL = (0.0, 0.0, 4.0, 0.0)


def costs(endings, neighbours, room=0.3):
    chooser = Chooser(endings, target=(9.0, 0.0), neighbours=neighbours)
    return PersonalSpace(room=room).cost(candidates(chooser))


def beside(point, *walls, core=0.15, room=0.7):
    chooser = Chooser([Ending(point)], position=(2.0, 2.0), core=core, walls=walls)
    return float(PersonalSpace(room=room).cost(candidates(chooser))[0])


def test_what_an_option_costs():
    # After 1 s the first neighbour is at (0.7, 0.3), 0.36 m from (0.5, 0): 0.6 - 0.36 of 0.3 m are
    # missing; the other is 0.71 m away. The place of somebody who stays is 0.76 m from the first
    # and 0.5 m from the other.
    endings = [Ending((0.5, 0.0), 0.0, 0.5, 1.0), Ending((0.0, 0.0), 0.0, 0.0, 1.0)]
    found = costs(endings, NEIGHBOURS)
    assert found == pytest.approx([(0.6 - math.hypot(0.2, 0.3)) / 0.3, 0.1 / 0.3])


def test_it_adds_up_over_neighbours():
    ending = [Ending((0.5, 0.0), 0.0, 0.5, 1.0)]
    wide = costs(ending, NEIGHBOURS, room=0.7)
    assert wide == pytest.approx([(2.0 - math.hypot(0.2, 0.3) - math.hypot(0.5, 0.5)) / 0.7])


@pytest.mark.parametrize(
    ("point", "expected"),
    [
        ((2.0, 0.6), 0.0),
        # 0.35 m are wanted between the core and a wall.
        ((2.0, 0.325), 0.5),
        ((2.0, 0.15), 1.0),
        ((2.0, -0.325), 0.5),
        # Beside the end of the wall: 0.25 m away by 0.2 m and 0.15 m.
        ((4.2, 0.15), 0.25 / 0.35),
        ((9.0, 0.0), 0.0),
    ],
)
def test_what_a_wall_costs(point, expected):
    assert beside(point, WALL) == pytest.approx(expected, abs=1e-12)


def test_wide_bodies_keep_as_much_room():
    assert beside((2.0, 0.525), WALL, core=0.35) == pytest.approx(0.5)


def test_the_nearest_wall_counts_alone():
    assert beside((2.0, 0.325), WALL, (2.4, -1.0, 2.4, 1.0)) == pytest.approx(0.5)


def test_people_and_walls_add_up():
    chooser = Chooser(
        [Ending((0.0, 0.0), 0.0, 0.0, 1.0)],
        target=(9.0, 0.0),
        core=0.15,
        neighbours=[((0.5, 0.0), (0.0, 0.0))],
        walls=[(-1.0, 0.2, 1.0, 0.2)],
    )
    found = PersonalSpace(room=0.3).cost(candidates(chooser))
    assert found == pytest.approx([0.1 / 0.3 + 0.1 / 0.15])


near = st.floats(-1.0, 1.0)


@given(near, near, near, near, near, near)
def test_the_distance_to_a_wall_is_shapelys(x, y, x1, y1, x2, y2):
    assume(math.hypot(x2 - x1, y2 - y1) > 1e-6)
    away = LineString([(x1, y1), (x2, y2)]).distance(Point(x, y))
    expected = max(1.0 - (away - 0.15) / 0.35, 0.0)
    assert beside((x, y), (x1, y1, x2, y2)) == pytest.approx(expected, abs=1e-6)


@given(turns, shifts)
def test_it_does_not_depend_on_where_and_how_all_this_is_turned(turn, shift):
    ending = Ending((0.5, 0.0), 0.0, 0.5, 1.0)
    here = candidates(Chooser([ending], target=(9.0, 0.0), neighbours=NEIGHBOURS))
    there = turned_and_moved(here, turn, shift)
    assert PersonalSpace().cost(there) == pytest.approx(PersonalSpace().cost(here), abs=1e-9)


@given(st.floats(0.01, 3.0))
def test_nobody_farther_than_the_room_costs_anything(beyond):
    ending = [Ending((0.0, 0.0), 0.0, 0.0, 1.0)]
    assert costs(ending, [((0.6 + beyond, 0.0), (0.0, 0.0))])[0] == 0.0


@pytest.mark.parametrize("room", [0.0, -1.0, math.nan])
def test_room_is_positive(room):
    with pytest.raises(ModelError, match="personal_space"):
        PersonalSpace(room=room)
