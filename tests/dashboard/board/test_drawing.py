"""The floor plan of what somebody has drawn."""

import json

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mesa_mobility import FloorPlan
from mesa_mobility.dashboard.board.drawing import drawing_of
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.scenario import has_people, read_scenario


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

CROSSED = {"kind": "source", "name": "", "points": [[0, 0], [1, 1], [0, 1], [1, 0]]}
"""An outline that crosses itself."""


def test_walls_doors_and_exits_make_rooms():
    plan, _, notes = drawing_of(ROOMS, "two rooms")
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
    plan, *_ = drawing_of(shapes, "")
    assert [each.name for each in plan.exits] == ["out", "out 2", "exit 1"]
    assert [each.name for each in plan.gates] == ["door 1", "door 2"]


def test_people_of_sources_go_to_the_counters_in_turn(tmp_path):
    shapes = [
        *ROOMS,
        {**rectangle("source", 0, 0, 2, 2, "bus"), "number": 5, "seconds": 10},
        {**rectangle("source", 0, 2, 2, 4), "number": 2, "seconds": 0},
        {**rectangle("counter", 4, 0, 5, 1), "stay": 3, "capacity": 2},
        {**rectangle("counter", 4, 3, 5, 4), "stay": 4, "capacity": 1},
    ]
    path = tmp_path / "plan.geojson"
    path.write_text(json.dumps(drawing_of(shapes, "hall").to_geojson()))
    assert has_people(path)
    plan, people = read_scenario(path)
    assert len(plan.exits) == 1
    # Five in 10 s: at 0, 2, 4, 6 and 8 s, to the two counters by turns, and then two more.
    found = [(each.name, each.number, each.times, each.stops[0].stay) for each in people]
    assert found == [
        ("bus", 3, (0.0, 4.0, 8.0), 3.0),
        ("bus", 2, (2.0, 6.0), 4.0),
        ("source 1", 1, (), 3.0),
        ("source 1", 1, (), 4.0),
    ]
    assert [each.stops[0].capacity for each in people] == [2, 1, 2, 1]
    with pytest.warns(UserWarning, match="left out people of 2 sources"):
        FloorPlan.from_file(path)


def test_counters_without_sources_are_named():
    assert (
        drawing_of([*ROOMS, rectangle("counter", 1, 1, 2, 2)], "a").notes[-1].startswith("nobody")
    )


def test_exits_beside_the_edge_are_moved_to_it():
    plan, _, notes = drawing_of([rectangle("floor", 0, 0, 6, 4), line("exit", 6.5, 1, 6.5, 2)], "a")
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
        (
            [*ROOMS, {**rectangle("source", 1, 1, 2, 2), "number": -1}],
            "number: got -1, expected 0 to",
        ),
        ([*ROOMS, {**rectangle("source", 1, 1, 2, 2), "seconds": "a"}], "seconds: got 'a'"),
        ([*ROOMS, {**rectangle("counter", 1, 1, 2, 2), "capacity": 0.5}], "capacity: got 0.5"),
        ([*ROOMS, rectangle("source", 20, 1, 22, 2)], "source 1 has no floor in it"),
        ([*ROOMS, CROSSED], "source 7 is not valid: Self-intersection"),
        ([rectangle("floor", 0, 0, 6, 4)] * 5001, "expected at most 5,000"),
    ],
)
def test_drawings_that_are_no_plans(shapes, said):
    with pytest.raises(FloorPlanError, match=said) as refused:
        drawing_of(shapes, "plan")
    assert "\n" not in str(refused.value)


NUMBER = st.floats(-30, 30).map(lambda each: round(each, 1))
POINTS = st.lists(st.tuples(NUMBER, NUMBER).map(list), max_size=5)
SHAPE = st.fixed_dictionaries(
    {
        "kind": st.sampled_from(["floor", "wall", "obstacle", "door", "exit", "source", "counter"]),
        "number": st.sampled_from([None, 3, -1, 2.5, "x", 1e300]),
        "capacity": st.sampled_from([None, 1, 0, 0.5, True]),
        "points": POINTS,
        "name": st.sampled_from(["", "a", None, 3]),
    }
)


@settings(max_examples=150, deadline=None)
@given(st.lists(SHAPE, max_size=8))
def test_any_drawing_is_a_plan_or_refused_in_one_line(shapes):
    room = [rectangle("floor", 0, 0, 6, 4), line("exit", 6, 1, 6, 3)]
    try:
        said = str(drawing_of([*room, *shapes], "x").plan.area)
    except FloorPlanError as error:
        said = str(error)
    assert said
    assert "\n" not in said
