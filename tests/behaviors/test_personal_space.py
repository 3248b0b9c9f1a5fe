"""Room between bodies."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from mesa_mobility.behaviors import PersonalSpace

from mesa_mobility.errors import ModelError
from tests.fixtures.options import Chooser, Ending, candidates, shifts, turned_and_moved, turns

# All cores are 0.15 m, so 0.3 m of room are 0.6 m between middles.
NEIGHBOURS = [((1.2, 0.3), (-0.5, 0.0)), ((0.0, 0.5), (0.0, 0.0))]


def costs(endings, neighbours, room=0.3):
    chooser = Chooser(endings, target=(9.0, 0.0), neighbours=neighbours)
    return PersonalSpace(room=room).cost(candidates(chooser))


def test_what_an_option_costs():
    # After 1 s the first neighbour is at (0.7, 0.3), 0.36 m from (0.5, 0): 0.6 - 0.36; the other is
    # 0.71 m away. The place of somebody who
    # stays is 0.76 m from the first and 0.5 m from the other.
    endings = [Ending((0.5, 0.0), 0.0, 0.5, 1.0), Ending((0.0, 0.0), 0.0, 0.0, 1.0)]
    found = costs(endings, NEIGHBOURS)
    assert found == pytest.approx([0.6 - math.hypot(0.2, 0.3), 0.1])


def test_it_adds_up_over_neighbours():
    ending = [Ending((0.5, 0.0), 0.0, 0.5, 1.0)]
    wide = costs(ending, NEIGHBOURS, room=0.7)
    assert wide == pytest.approx([2.0 - math.hypot(0.2, 0.3) - math.hypot(0.5, 0.5)])


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
