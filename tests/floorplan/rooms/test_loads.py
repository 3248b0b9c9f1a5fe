"""How many people rooms hold."""

import math
from dataclasses import replace

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from shapely import box

from mesa_mobility import Room
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan import load_tables, occupant_numbers
from mesa_mobility.floorplan.rooms.loads import shared_out


def rooms_of(*areas: float, **uses: str) -> list[Room]:
    """Rooms ``a``, ``b``, ... of these areas, 1 m deep."""
    return [
        Room(name, box(0, 0, area, 1), use=uses.get(name, ""))
        for name, area in zip("abcdefghijklmnopqrstuvwxyz", areas, strict=False)
    ]


def numbers(rooms, loads=None) -> list[int]:
    return [n for _, n in occupant_numbers(rooms, loads)]


@given(st.lists(st.floats(0.0, 1e4), max_size=40))
def test_shares_add_up_and_each_is_rounded(shares):
    found = shared_out(shares)
    assert sum(found) == math.floor(math.fsum(shares) + 0.5)
    for number, share in zip(found, shares, strict=True):
        assert math.floor(share) <= number <= math.ceil(share)


@given(st.lists(st.floats(0.0, 100.0), min_size=2, max_size=20), st.data())
def test_a_larger_remainder_is_never_rounded_down_while_a_smaller_one_is_rounded_up(shares, data):
    one, other = (data.draw(st.integers(0, len(shares) - 1)) for _ in range(2))
    assume(shares[one] % 1.0 > shares[other] % 1.0 > 0.0)
    found = shared_out(shares)
    up = [found[k] > math.floor(shares[k]) for k in (one, other)]
    assert up[0] or not up[1]


@given(
    st.lists(st.floats(0.5, 500.0), min_size=1, max_size=26),
    st.integers(0, 5000),
)
def test_people_shared_by_area_are_all_there(areas, people):
    rooms = rooms_of(*areas)
    found = numbers(rooms, people)
    assert sum(found) == people
    whole = sum(areas)
    for room, number in zip(rooms, found, strict=True):
        assert abs(number - people * room.area / whole) < 1.0


@given(st.lists(st.floats(0.5, 500.0), min_size=1, max_size=26), st.floats(0.01, 9.0))
def test_densities_hold_for_rooms_together(areas, density):
    found = numbers(rooms_of(*areas), f"{density:.4f}/m2")
    assert abs(sum(found) - round(density, 4) * sum(areas)) <= 0.5 + 1e-6


def test_loads_by_number_density_space_and_use():
    rooms = rooms_of(10.0, 25.0, 15.0)
    assert numbers(rooms, 10) == [2, 5, 3]
    assert numbers(rooms, "10") == [2, 5, 3]
    # 5, 12.5 and 7.5 add up to 25: the first of equal remainders is rounded up.
    assert numbers(rooms, "0.5/m2") == [5, 13, 7]
    assert numbers(rooms, "2 m2") == [5, 13, 7]
    # 150 ft2 are 13.935 m2: 0.7176, 1.794 and 1.0764 add up to 3.588.
    assert numbers(rooms, "office") == [1, 2, 1]
    assert numbers(rooms, "adb:office") == [2, 4, 2]  # 1.67, 4.17 and 2.5: 8.33


def test_rooms_have_the_loads_of_their_own_uses():
    rooms = rooms_of(30.0, 30.0, 30.0, a="office", b="standing")
    # 30 / 13.935 = 2.15, 30 / 0.4645 = 64.58: 66.74; none without a use.
    assert numbers(rooms) == [2, 65, 0]
    assert numbers(rooms, "ibc") == [2, 65, 0]
    # 30 / 6 = 5, 30 / 0.3 = 100.
    assert numbers(rooms, "adb") == [5, 100, 0]


def test_gross_areas_are_those_that_the_file_states():
    """Of 25 m2 inside and 30 m2 to the middle of the walls, IBC counts gross areas of offices, net
    ones of classrooms; a density is of the floor."""
    room = Room("a", box(0, 0, 5, 5), stated_area=30.0)
    assert numbers([room], "office") == [2]  # 30 / 13.935 = 2.15; 25 would be 1.79
    assert numbers([room], "classroom") == [13]  # 25 / 1.858 = 13.45
    assert numbers([room], "ibc:warehouse") == [1]  # 30 / 46.45 = 0.65
    assert numbers([room], "1/m2") == [25]
    assert numbers([room], "adb:office") == [4]  # 25 / 6
    assert numbers([replace(room, stated_area=31.0, use="residential")]) == [2]  # 31 / 18.58 = 1.67


@pytest.mark.parametrize("stated", [0, -1.0, math.nan, math.inf, True, "20", 1e9])
def test_stated_areas_that_cannot_be(stated):
    with pytest.raises(FloorPlanError, match="room 'a': stated_area must be a number of square"):
        Room("a", box(0, 0, 5, 5), stated_area=stated)


def test_a_room_says_both_areas_where_they_differ():
    assert str(Room("a", box(0, 0, 5, 5), stated_area=25.2)) == "a (25.00 m\u00b2)"
    assert str(Room("a", box(0, 0, 5, 5), stated_area=30.0, use="office")) == (
        "a (25.00 m\u00b2, stated 30.00 m\u00b2, office)"
    )


def test_a_room_gets_the_first_load_whose_pattern_fits_it():
    rooms = [Room(name, box(0, 0, 10, 1)) for name in ("hall", "office 1", "office 2", "store")]
    assert numbers(rooms, {"hall": 7, "office*": "0.25/m2", "*": 0}) == [7, 3, 2, 0]
    assert numbers(rooms, {"*": 4, "hall": 7}) == [1, 1, 1, 1]
    assert numbers(rooms, {"office 2": 3}) == [0, 0, 3, 0]


@pytest.mark.parametrize(
    ("loads", "said"),
    [
        ({"cellar": 3}, "there is no room 'cellar'; there are a, b"),
        ("bazaar", "there is no use 'bazaar' in table ibc"),
        ("din:office", "there is no table 'din'"),
        ("99/m2", "at most 10 people"),
        ("0 m2", "at most 10 people"),
        (-1, "expected 0 to"),
        ("1" * 30, "expected 0 to"),
        ("1" * 5000, "expected 0 to"),
        ("\u00b2", "there is no use"),
        (1.5, "expected a number of people"),
        (True, "expected a number of people"),
        (None, "no use is known"),
        ("nan/m2", "there is no use"),
    ],
)
def test_loads_that_cannot_be(loads, said):
    with pytest.raises(FloorPlanError, match=said) as refused:
        occupant_numbers(rooms_of(10.0, 20.0), loads)
    assert "\n" not in str(refused.value)


def test_a_use_that_a_table_does_not_have_is_named_with_its_room():
    with pytest.raises(FloorPlanError, match="room 'a': there is no use 'attic'"):
        occupant_numbers(rooms_of(10.0, a="attic"))


def test_tables_say_where_their_figures_come_from():
    tables = load_tables()
    assert set(tables) == {"ibc", "nfpa101", "adb", "mvstaettvo"}
    for table in tables.values():
        assert table.title
        assert table.page
        for each in table.uses.values():
            assert 0.01 < each.density < 4.0
            assert each.words
    # 7 square feet are 0.65 square metres, as the table of NFPA 101 says.
    assert 1 / tables["nfpa101"].uses["chairs"].density == pytest.approx(0.65, abs=0.005)
    assert tables["mvstaettvo"].uses["chairs"].density == 2
