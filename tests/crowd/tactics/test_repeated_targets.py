"""A person who decides again on the same spot gets the present target, not the last one."""

import pytest

from tests.fixtures.scenes import advance, corridor, model_of, put, statues

# Exits of the corridor of 20 m lie 2 m behind the lines at x = 0 and x = 20.
WEST, EAST = -2.0, 22.0


@pytest.fixture
def statue():
    """One of those who cannot but stand, 5 m from the exit in the west, that has decided."""
    model = model_of(corridor(both_ends=True), statues())
    person = put(model, 5.0, 2.0)
    advance(model, 1)
    assert aim(person) == WEST
    return person


def aim(person) -> float:
    return float(person.model.crowd.target_x[person.row])


def decide_again(person) -> float:
    """The target after the next decision on the same spot."""
    model, row = person.model, person.row
    place, count = tuple(person.position), model.crowd.decisions[row]
    while model.crowd.decisions[row] == count:
        advance(model, 1)
    assert tuple(person.position) == place
    return aim(person)


def test_in_the_same_place_it_aims_at_the_same(statue) -> None:
    assert decide_again(statue) == WEST


def test_a_door_that_has_closed_or_opened_is_minded(statue) -> None:
    plan = statue.model.floor_plan
    plan.close_gate("west")
    assert decide_again(statue) == EAST
    plan.open_gate("west")
    assert decide_again(statue) == WEST


def test_another_destination_is_minded(statue) -> None:
    model = statue.model
    other = put(model, 6.0, 3.0, exits=["east"])
    model.crowd.destination[statue.row] = model.crowd.destination[other.row]
    assert decide_again(statue) == EAST


def test_somebody_moved_by_hand_aims_from_there(statue) -> None:
    crowd, row = statue.model.crowd, statue.row
    for field in ("x", "from_x", "to_x"):
        getattr(crowd, field)[row] = 15.0
    assert decide_again(statue) == EAST
