"""The rooms of a plan: given, or found between its doors."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mesa_mobility.models.auditorium import auditorium_plan
from shapely import box, union_all

from mesa_mobility import Building, Exit, FloorPlan, Gate, Level, Room, Stairs
from mesa_mobility.errors import FloorPlanError


def two_rooms(**more) -> FloorPlan:
    """5 m x 4 m and 3 m x 4 m with a wall of 0.2 m between them, and a door 1 m wide through it."""
    area = union_all([box(0, 0, 5, 4), box(5, 1, 5.2, 2), box(5.2, 0, 8.2, 4)])
    given_ = {"gates": [Gate("door", (5.1, 1), (5.1, 2))], **more}
    return FloorPlan(area, exits=[Exit("street", (8.2, 1), (8.2, 3))], **given_)


def test_rooms_are_found_between_doors():
    one, other = two_rooms().rooms
    # Half the doorway, 0.1 m x 1 m, belongs to each room.
    assert (one.name, other.name) == ("room 1", "room 2")
    assert one.area == pytest.approx(20.1)
    assert other.area == pytest.approx(12.1)
    assert one.doors == ("door",)
    assert other.doors == ("door", "street")
    assert (one.level, one.use) == (0, "")


def test_closed_doors_and_short_gates_part_rooms_as_well():
    plan = two_rooms(gates=[Gate("door", (5.1, 1.04), (5.1, 1.96))])
    plan.close_gate("door")
    assert [round(each.area, 6) for each in plan.rooms] == [20.1, 12.1]
    # A line that ends half a metre before the wall is no door.
    open_ = two_rooms(gates=[Gate("line", (2.0, 0.5), (2.0, 4.0))])
    assert [round(each.area, 6) for each in open_.rooms] == [32.2]
    assert open_.rooms[0].doors == ("line", "street")


def test_furniture_is_part_of_a_room_and_walls_are_not():
    desk, shelf = box(2, 2, 3, 3), box(0, 3.5, 2, 4)
    one, other = two_rooms(obstacles=[desk, shelf]).rooms
    assert one.area == pytest.approx(20.1)
    assert other.area == pytest.approx(12.1)
    # A wall drawn as an obstacle, with a door in it.
    halves = FloorPlan(
        box(0, 0, 8, 4),
        exits=[Exit("street", (8, 1), (8, 3))],
        gates=[Gate("door", (5, 1), (5, 2))],
        obstacles=[box(4.9, 0, 5.1, 1), box(4.9, 2, 5.1, 4)],
    )
    assert [each.area for each in halves.rooms] == pytest.approx([19.7, 11.7])


def test_rooms_follow_what_is_put_in_the_way():
    plan = two_rooms()
    wall = plan.add_obstacle(box(2, 0, 2.2, 4), cut_off=True)
    assert [each.area for each in plan.rooms] == pytest.approx([12.1, 11.3, 8.0])
    plan.remove_obstacle(wall)
    assert len(plan.rooms) == 2
    assert plan.rooms is plan.rooms


def test_a_doorway_between_two_gates_is_no_room():
    plan = two_rooms(gates=[Gate("in", (5, 1), (5, 2)), Gate("out", (5.2, 1), (5.2, 2))])
    one, other = plan.rooms
    assert (one.area, other.area) == pytest.approx((20.0, 12.0))
    assert (one.doors, other.doors) == (("in",), ("out", "street"))


def test_given_rooms_keep_names_uses_and_areas():
    hall = Room("hall", "POLYGON ((0 0, 5 0, 5 4, 0 4, 0 0))", use="chairs")
    lobby = Room("lobby", box(5.2, 0, 8.2, 4))
    one, other = two_rooms(rooms=[hall, lobby]).rooms
    assert (one.name, one.use, one.area, one.doors) == ("hall", "chairs", 20.0, ("door",))
    assert (other.name, other.use, other.area) == ("lobby", "", pytest.approx(12.0))
    assert other.doors == ("door", "street")
    assert str(one) == "hall (20.00 m\u00b2, chairs)"


def test_rooms_go_through_files(tmp_path):
    hall = Room("hall", box(0, 0, 5, 4), use="office", stated_area=23.5)
    plan = two_rooms(rooms=[hall])
    plan.write_geojson(tmp_path / "plan.geojson")
    assert FloorPlan.from_file(tmp_path / "plan.geojson").rooms == plan.rooms
    (tmp_path / "plan.wkt").write_text(
        "walkable POLYGON ((0 0, 6 0, 6 4, 0 4, 0 0))\n"
        "exit street LINESTRING (6 1, 6 3)\n"
        "room long hall use=office stated_area=30.5 POLYGON ((0 0, 6 0, 6 4, 0 4, 0 0))\n"
    )
    [read] = FloorPlan.from_file(tmp_path / "plan.wkt").rooms
    assert (read.name, read.use, read.area) == ("long hall", "office", 24.0)
    assert read.gross_area == 30.5


def test_the_auditorium_has_its_hall_foyer_offices_and_forecourts():
    rooms = {each.name: each for each in auditorium_plan().rooms}
    areas = {name: each.area for name, each in rooms.items()}
    # 28 m x 24 m, 31 m x 5 m, (28 / 6 - 0.2) m x 4 m, 3 m x 8 m.
    offices = {f"office {k}": (28 / 6 - 0.2) * 4 for k in range(1, 7)}
    expected = {"hall": 672.0, "foyer": 155.0, "left forecourt": 24.0, "right forecourt": 24.0}
    assert areas == pytest.approx({**expected, **offices})
    assert rooms["hall"].doors == ("hall door 1", "hall door 2")
    assert rooms["office 3"].doors == ("office door 3",)
    assert len(rooms["foyer"].doors) == 10
    assert rooms["left forecourt"].doors == ("left exit door", "left exit")


def test_rooms_found_in_the_auditorium_are_right_within_a_hundredth():
    plan = auditorium_plan()
    bare = FloorPlan(
        plan.walkable,
        exits=plan.exits,
        gates=plan.gates,
        obstacles=list(plan.obstacles.values()),
    )
    given_ = {each.doors: each.area for each in plan.rooms}
    found = {each.doors: each.area for each in bare.rooms}
    assert found.keys() == given_.keys()
    for doors, area in found.items():
        assert area == pytest.approx(given_[doors], rel=0.01)


def building(**rooms) -> Building:
    """Two levels of 20 m x 6 m; upstairs a door parts off the left 4 m."""
    hall = "POLYGON ((0 0, 20 0, 20 6, 0 6, 0 0))"
    ground = Level(0, hall, exits=[Exit("street", (0, 2), (0, 4))], rooms=rooms.get("ground", ()))
    upper = box(0, 0, 4, 6).union(box(4, 2, 4.2, 3)).union(box(4.2, 0, 20, 6))
    gates = [Gate("door", (4.1, 2), (4.1, 3))]
    first = Level(1, upper, elevation=3.06, gates=gates, rooms=rooms.get("first", ()))
    main = Stairs.straight("main", first, ground, head=((12, 5), (12, 3)), risers=18, tread=0.29)
    return Building([ground, first], [main])


def test_rooms_of_a_building_know_their_level_and_stairs():
    office = building()
    assert [each.level for each in office.rooms] == [0, 1, 1]
    names = [each.name for each in office.rooms]
    assert names == ["level 0 room 1", "level 1 room 1", "room 2"]
    assert office.rooms[2].area == pytest.approx(24.1)
    assert office.rooms[2].doors == ("door",)
    assert set(office.rooms[1].doors) == {"door", "main"}
    with pytest.raises(FloorPlanError, match="those of its building"):
        _ = office.floor_plan.rooms


def test_given_rooms_of_levels_go_through_files(tmp_path):
    lobby, desk = Room("lobby", box(0, 0, 8, 6)), Room("lobby", box(0, 0, 4, 6), use="office")
    office = building(ground=[lobby], first=[desk])
    assert [(e.name, e.level, e.use) for e in office.rooms] == [
        ("level 0 lobby", 0, ""),
        ("level 1 lobby", 1, "office"),
    ]
    assert office.rooms[0].doors == ("street",)
    office.write_geojson(tmp_path / "office.geojson")
    assert Building.from_geojson(tmp_path / "office.geojson").rooms == office.rooms


@pytest.mark.parametrize(
    ("given_", "said"),
    [
        ({"name": ""}, "expected a name"),
        ({"name": 3}, "expected a name"),
        ({"polygon": "POINT (1 1)"}, "must be a Polygon"),
        ({"use": 3}, "use must be a text"),
        ({"level": 1.5}, "level must be a whole number"),
    ],
)
def test_rooms_that_cannot_be(given_, said):
    with pytest.raises(FloorPlanError, match=said) as refused:
        Room(**{"name": "hall", "polygon": box(0, 0, 1, 1), **given_})
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("rooms", "said"),
    [
        ([Room("hall", box(0, 0, 1, 1)), Room("hall", box(1, 0, 2, 1))], "'hall' is there twice"),
        ([Room("moon", box(50, 0, 51, 1))], "'moon' has no floor"),
        (["hall"], "must be Room objects"),
    ],
)
def test_rooms_that_do_not_fit_a_plan(rooms, said):
    with pytest.raises(FloorPlanError, match=said):
        two_rooms(rooms=rooms)


@settings(max_examples=40, deadline=None)
@given(
    st.lists(st.floats(1.5, 9.0), min_size=1, max_size=6),
    st.floats(2.0, 8.0),
    st.floats(0.05, 0.4),
)
def test_rooms_in_a_row_share_out_the_floor(widths, depth, wall):
    """Doors of 0.9 m lead from room to room; rooms add up to the floor."""
    parts, gates, x = [], [], 0.0
    for k, width in enumerate(widths):
        parts.append(box(x, 0, x + width, depth))
        x += width
        if k + 1 < len(widths):
            parts.append(box(x, 0.5, x + wall, 1.4))
            gates.append(Gate(f"door {k}", (x + wall / 2, 0.5), (x + wall / 2, 1.4)))
            x += wall
    plan = FloorPlan(union_all(parts), exits=[Exit("out", (x, 0.5), (x, 1.4))], gates=gates)
    assert len(plan.rooms) == len(widths)
    assert sum(each.area for each in plan.rooms) == pytest.approx(plan.walkable.area)
    inner = np.array(
        [0.45 * wall * (k > 0) + 0.45 * wall * (k < len(widths) - 1) for k in range(len(widths))]
    )
    expected = np.array(widths) * depth + inner
    assert sorted(each.area for each in plan.rooms) == pytest.approx(sorted(expected))
