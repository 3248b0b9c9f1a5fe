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
        assert "for 8.0 m" in found["dead end"].text


def test_a_corridor_to_an_exit_is_no_dead_end():
    corridor = union_all([HALL, box(-8, 3, 0, 5)])
    assert odd(corridor, exits=[DOOR, Exit("back", (-8, 3.5), (-8, 4.5))]) == {}


def test_gaps_and_thin_walls():
    found = odd(HALL, exits=[DOOR], obstacles=[box(2, 0.15, 4, 2), box(5, 6, 5.03, 8)])
    assert found["gap"].text == "a gap 0.14 m wide and 2.0 m long, too narrow to walk in"
    assert found["gap"].place[1] == pytest.approx(0.075, abs=0.01)
    assert found["thin wall"].text == "floor is parted by 0.030 m for 2.0 m"
