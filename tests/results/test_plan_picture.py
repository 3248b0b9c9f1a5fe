"""Names on the picture of a plan: rooms, stairs, doors, and numbers of exits."""

import pytest

from mesa_mobility import Exit, FloorPlan, Gate, Room
from mesa_mobility.results.plan_picture import plan_figure
from tests.fixtures.buildings import two_storeys


def named(axes):
    """Place and turn of each text on a panel, by what it says."""
    return {text.get_text(): (text.get_position(), text.get_rotation()) for text in axes.texts}


@pytest.fixture
def plan():
    """A hall of 10 m by 4 m with a stage, and a corridor 2 m wide and 8 m long beside it."""
    return FloorPlan(
        "POLYGON ((0 0, 12 0, 12 8, 10 8, 10 4, 0 4, 0 0))",
        obstacles=["POLYGON ((1 1, 6 1, 6 3, 1 3, 1 1))"],
        exits=[Exit("out", (12, 3), (12, 5))],
        gates=[Gate("door", (10, 1), (10, 3))],
        rooms=[
            Room("hall", "POLYGON ((0 0, 10 0, 10 4, 0 4, 0 0))"),
            Room("corridor", "POLYGON ((10 0, 12 0, 12 8, 10 8, 10 0))"),
        ],
    )


def test_rooms_are_named_on_free_floor_and_narrow_ones_upright(plan):
    found = named(plan_figure(plan).axes[0])
    (x, y), turned = found["hall"]
    # The largest circle of free floor lies between the stage and the corridor.
    assert (x, y) == (pytest.approx(8.0, abs=0.2), pytest.approx(2.0, abs=0.2))
    assert turned == 0
    assert found["corridor"][1] == 90


def test_numbers_of_exits_are_outside_and_names_inside(plan):
    # Offsets in points from the middle of the exit, which is on the right.
    assert named(plan_figure(plan).axes[0])["out"][0] == (-6.0, 0.0)
    found = named(plan_figure(plan, labels={"out": "2", "door": "1"}).axes[0])
    assert found["2"][0] == (6.0, 0.0)
    assert found["1"][0] == (-6.0, 0.0)


def test_stairs_have_their_own_names_on_both_levels():
    first, ground = plan_figure(two_storeys(), labels={"west": "1", "east": "2"}).axes[:2]
    assert first.get_title() == "level 1"
    assert set(named(first)) == {"south", "north", "room 1"}
    assert set(named(ground)) == {"south", "north", "room 1", "1", "2"}
