"""The floor plan of what somebody has drawn."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mesa_mobility.dashboard.board.drawing import plan_of
from mesa_mobility.errors import FloorPlanError


def rectangle(kind, x0, y0, x1, y1, name=""):
    return {"kind": kind, "name": name, "points": [[x0, y0], [x1, y0], [x1, y1], [x0, y1]]}


def line(kind, x0, y0, x1, y1, name=""):
    return {"kind": kind, "name": name, "points": [[x0, y0], [x1, y1]]}


ROOMS = [
    rectangle("floor", 0, 0, 6, 4),
    rectangle("floor", 6, 0, 10, 4),
    line("wall", 6, 0, 6, 4),
    line("door", 6, 1, 6, 2, "office door"),
    line("exit", 10, 1, 10, 3),
    rectangle("obstacle", 2, 2, 3, 3),
]


def test_walls_doors_and_exits_make_rooms():
    plan, notes = plan_of(ROOMS, "two rooms")
    assert plan.name == "two rooms"
    assert plan.walkable.area == pytest.approx(40.0)
    # A wall of 0.2 m takes 0.8 m2, less a door of 1 m.
    assert plan.area == pytest.approx(40.0 - 0.2 * 3 - 1.0, abs=0.01)
    assert [each.name for each in plan.gates] == ["office door"]
    assert [(each.name, each.length) for each in plan.exits] == [("exit 1", 2.0)]
    one, other = plan.rooms
    # Up to the middle of the wall in the door, and furniture included.
    assert one.area == pytest.approx(5.9 * 4 + 0.1, abs=0.01)
    assert other.area == pytest.approx(3.9 * 4 + 0.1, abs=0.01)
    assert other.doors == ("office door", "exit 1")
    assert any("joined" in each for each in notes)


def test_names_of_doors_and_exits_are_made_to_differ():
    shapes = [
        rectangle("floor", 0, 0, 6, 4),
        line("exit", 6, 1, 6, 2, "out"),
        line("exit", 0, 1, 0, 2, "out"),
        line("exit", 2, 0, 3, 0),
        line("door", 3, 0, 3, 4),
        line("door", 4, 0, 4, 4),
    ]
    plan, _ = plan_of(shapes, "")
    assert [each.name for each in plan.exits] == ["out", "out 2", "exit 1"]
    assert [each.name for each in plan.gates] == ["door 1", "door 2"]


def test_exits_beside_the_edge_are_moved_to_it():
    plan, notes = plan_of([rectangle("floor", 0, 0, 6, 4), line("exit", 6.5, 1, 6.5, 2)], "a")
    assert plan.exits[0].line.equals_exact(plan.exits[0].line, 0)
    assert {x for x, _ in (plan.exits[0].a, plan.exits[0].b)} == {6.0}
    assert any("moved to the edge" in each for each in notes)


@pytest.mark.parametrize(
    ("shapes", "said"),
    [
        (None, "expected at most"),
        ([], "no area to walk on"),
        ([3], "shape 1: expected one of floor"),
        ([{"kind": "moat", "points": []}], "shape 1: expected one of floor"),
        ([{"kind": "wall"}], "shape 1"),
        ([line("wall", 1, 1, 1, 1)], "two different ends"),
        ([{"kind": "floor", "points": [[0, 0], [1, 1]]}], "has 3 to 200 points"),
        ([{"kind": "floor", "points": [[0, 0], [1, "x"], [2, 2]]}], "shape 1"),
        ([{"kind": "floor", "points": [[0, 0], [1e300, 1], [2, 2]]}], "shape 1"),
        ([rectangle("floor", 0, 0, 6, 4)], "no exit"),
        ([rectangle("floor", 0, 0, 6, 4)] * 5001, "expected at most 5,000"),
    ],
)
def test_drawings_that_are_no_plans(shapes, said):
    with pytest.raises(FloorPlanError, match=said) as refused:
        plan_of(shapes, "plan")
    assert "\n" not in str(refused.value)


NUMBER = st.floats(-30, 30).map(lambda each: round(each, 1))
POINTS = st.lists(st.tuples(NUMBER, NUMBER).map(list), max_size=5)
SHAPE = st.fixed_dictionaries(
    {
        "kind": st.sampled_from(["floor", "wall", "obstacle", "door", "exit"]),
        "points": POINTS,
        "name": st.sampled_from(["", "a", None, 3]),
    }
)


@settings(max_examples=150, deadline=None)
@given(st.lists(SHAPE, max_size=8))
def test_any_drawing_is_a_plan_or_refused_in_one_line(shapes):
    room = [rectangle("floor", 0, 0, 6, 4), line("exit", 6, 1, 6, 3)]
    try:
        said = str(plan_of([*room, *shapes], "x")[0].area)
    except FloorPlanError as error:
        said = str(error)
    assert said
    assert "\n" not in said
