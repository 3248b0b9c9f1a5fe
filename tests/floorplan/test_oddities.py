"""What is odd about a floor plan for an evacuation."""

import pytest
from shapely import box, union_all

from mesa_mobility import Exit, FloorPlan, Gate
from mesa_mobility.floorplan import oddities_of

HALL = box(0, 0, 10, 8)
DOOR = Exit("street", (10, 3), (10, 5))


def odd(*args, **options):
    return {each.kind: each for each in oddities_of(FloorPlan(*args, **options))}


def test_nothing_is_odd_about_a_hall():
    assert odd(HALL, exits=[DOOR]) == {}


def test_narrow_doors():
    found = oddities_of(
        FloorPlan(
            HALL, exits=[DOOR, Exit("slit", (0, 1), (0, 1.3))], gates=[Gate("g", (5, 0), (5, 0.7))]
        )
    )
    assert {(each.kind, each.place) for each in found} == {
        ("narrow door", (0.0, 1.15)),
        ("narrow door", (5.0, 0.35)),
    }
    texts = sorted(each.text for each in found)
    assert texts == [
        "exit slit is 0.30 m wide: nobody passes",
        "gate g is 0.70 m wide: wheelchairs need 0.80 m",
    ]


def test_an_exit_wider_than_the_floor_before_it():
    """A table stands before 1 m of the exit's 2 m."""
    found = odd(HALL, exits=[DOOR], obstacles=[box(9, 4, 10, 6)])
    (each,) = found.values()
    assert each.kind == "exit wider than its floor"
    assert each.text == "exit street is 2.00 m wide, the floor before it 1.00 m"


@pytest.mark.parametrize(
    ("width", "kind"), [(0.2, "no way out"), (0.6, "no way out for wheelchairs"), (1.0, None)]
)
def test_rooms_behind_gaps(width, kind):
    """A room of 4 m by 4 m, which a gap in a wall 0.2 m thick joins to the hall."""
    floor = union_all([HALL, box(-4.2, 2, -0.2, 6), box(-0.3, 3, 0.1, 3 + width)])
    found = odd(floor, exits=[DOOR])
    if kind is None:
        assert found == {}
    else:
        assert found[kind].place[0] < 0
        assert float(found[kind].text.split()[0]) == pytest.approx(16, abs=0.3)


@pytest.mark.parametrize(("length", "is_odd"), [(5.0, False), (8.0, True)])
def test_dead_ends(length, is_odd):
    found = odd(union_all([HALL, box(-length, 3, 0, 5)]), exits=[DOOR])
    assert ("dead end" in found) is is_odd
    if is_odd:
        assert found["dead end"].place[0] == pytest.approx(-length, abs=0.01)
        assert found["dead end"].text == "a corridor 2.0 m wide leads nowhere for 8.0 m"


def with_a_long_room(*more, exits=(DOOR,)):
    """A room 2.2 m wide and 8 m long beside the hall, behind a door; ``more`` has a second room
    behind a door at its other end."""
    floor = [HALL, box(-8.2, 3, -0.2, 5.2), box(-0.3, 3.5, 0.1, 4.5)]
    gates = [Gate("first", (-0.1, 3.5), (-0.1, 4.5))]
    if more:
        floor += [box(-9, 0, -4, 2.8), box(-8, 2.7, -7, 3.1)]
        gates += [Gate("second", (-8, 2.9), (-7, 2.9))]
    return odd(union_all(floor), exits=exits, gates=gates)


def test_rooms_and_ways_to_rooms():
    """A room behind one door is no dead end. One with another room behind it is the only way from
    there: a corridor that leads nowhere where there are two exits, both beyond its first door, but
    not where there is one, since then every way is the only one."""
    back = Exit("back", (0, 0.5), (0, 2))
    assert "dead end" not in with_a_long_room()
    assert "dead end" not in with_a_long_room(exits=[DOOR, back])
    assert "dead end" not in with_a_long_room("second")
    found = with_a_long_room("second", exits=[DOOR, back])["dead end"]
    # From the door to the far corner at (-8.2, 3 or 5.2).
    assert found.text == "a corridor 2.2 m wide leads nowhere for 8.1 m"
    assert found.place[0] == -8.2
    side = Exit("side", (-9, 1), (-9, 2))
    assert "dead end" not in with_a_long_room("second", exits=[DOOR, side])


@pytest.mark.parametrize(("width", "is_odd"), [(2.4, True), (2.49, False)])
def test_short_wide_recesses_are_no_dead_ends(width, is_odd):
    """6.2 m long: 2.4 m wide is 2.58 times as long as wide, 2.49 m is 2.49 times."""
    found = odd(union_all([HALL, box(-6.2, 3, 0, 3 + width)]), exits=[DOOR])
    assert ("dead end" in found) is is_odd


def test_a_corridor_to_an_exit_is_no_dead_end():
    corridor = union_all([HALL, box(-8, 3, 0, 5)])
    assert odd(corridor, exits=[DOOR, Exit("back", (-8, 3.5), (-8, 4.5))]) == {}


def test_gaps_and_thin_walls():
    found = odd(HALL, exits=[DOOR], obstacles=[box(2, 0.15, 4, 2), box(5, 6, 5.03, 8)])
    assert found["gap"].text == "a gap 0.15 m wide and 2.0 m long, too narrow to walk in"
    assert found["gap"].place[1] == pytest.approx(0.075, abs=0.01)
    assert found["thin wall"].text == "floor is parted by 0.030 m for 2.0 m"
