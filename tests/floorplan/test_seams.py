"""Seams: strips of floor that two sheets of a plan share."""

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from shapely import box

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan import Exit, FloorPlan, Router, Seam
from mesa_mobility.floorplan.floor.seams import to_own_sheets
from tests.fixtures.seams import APART, cut_corridor, room_with_corridor, true_x

metres = st.floats(-50.0, 50.0)


def seam(**changes):
    """Across a corridor along x, 2 m wide, at x = 10."""
    values = {"a": (10.0, 2.0), "b": (10.0, 0.0), "shift": (50.0, 0.0), "depth": 4.0} | changes
    return Seam("cut", **values)


def test_people_cross_with_the_first_end_on_their_left():
    own = seam()
    assert own.direction == (1.0, 0.0)
    assert own.past([(9.0, 1.0), (10.0, 1.0), (13.0, 0.0)]).tolist() == [-1.0, 0.0, 3.0]
    assert own.past([(63.0, 1.0)], second=True).tolist() == [3.0]
    here, there = own.copies
    assert here.equals(box(10, 0, 14, 2))
    assert there.equals(box(56, 0, 60, 2))


def test_steps_begin_at_two_edges_on_the_sheets_from_which_they_lead():
    own = seam(before=0.5)
    ends = [sorted([edge[:2].tolist(), edge[2:].tolist()]) for edge in own.steps]
    assert ends == [[[6.5, 0.0], [6.5, 2.0]], [[63.5, 0.0], [63.5, 2.0]]]
    places = [(6.4, 1.0), (6.6, 1.0), (13.4, 1.0), (13.6, 1.0), (10.0, 2.1)]
    assert own.on_steps(places).tolist() == [False, True, True, False, False]
    assert own.on_steps([(63.4, 1.0), (63.6, 1.0)], second=True).tolist() == [True, False]


def test_a_strip_without_steps_has_no_edges_of_them():
    assert seam(before=0.5, stepless=True).steps.shape == (0, 4)
    assert not seam(stepless=True).on_steps([(10.0, 1.0)]).any()


@pytest.mark.parametrize("before", [-0.1, 4.0, float("nan"), "a"])
def test_steps_must_reach_the_line(before):
    with pytest.raises(FloorPlanError, match=r"before must be metres, 0 or more and less than"):
        seam(before=before)


def test_gates_lie_halfway_to_the_ends_of_the_strip_on_both_sheets():
    found = {gate.name: sorted({gate.a, gate.b}) for gate in seam().gates}
    assert found == {
        "cut before": [(8.0, 0.0), (8.0, 2.0)],
        "cut after (copy)": [(12.0, 0.0), (12.0, 2.0)],
        "cut before (copy)": [(58.0, 0.0), (58.0, 2.0)],
        "cut after": [(62.0, 0.0), (62.0, 2.0)],
    }


@given(
    a=st.tuples(metres, metres),
    angle=st.floats(0.0, 6.28),
    width=st.floats(0.5, 5.0),
    depth=st.floats(0.3, 10.0),
    along=st.floats(-0.99, 0.99),
    aside=st.floats(-0.99, 0.99),
)
def test_a_place_on_the_strip_is_on_it_on_both_sheets(a, angle, width, depth, along, aside):
    right = np.array([np.cos(angle), np.sin(angle)])
    own = Seam("cut", a, tuple((np.array(a) + width * right).tolist()), (300.0, 7.0), depth)
    # People cross at right angles to the line, with its second end on their right.
    ahead = np.array([-right[1], right[0]])
    place = np.array(a) + (0.5 + 0.5 * aside) * width * right + along * depth * ahead
    for second, there in ((False, place), (True, place + np.array([300.0, 7.0]))):
        assert own.on_strip(there, second).all()
        assert own.past(there, second)[0] == pytest.approx(along * depth, abs=1e-9)
        beyond = there + 1.01 * (1.0 - along) * depth * ahead
        assert not own.on_strip(beyond, second).any()
        part = own.part(-depth, depth, second)
        assert part.distance(shapely.Point(there)) < 1e-9
        assert part.area == pytest.approx(2 * depth * width)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"b": (10.0, 2.0)}, "no length"),
        ({"shift": (1.0,)}, "shift must be two numbers"),
        ({"shift": (1.0, "x")}, "shift must be two numbers"),
        ({"depth": 0.1}, "at least 0.2 m"),
        ({"depth": float("nan")}, "at least 0.2 m"),
        ({"extra": -1.0}, "0 or more"),
    ],
)
def test_wrong_numbers_are_named(changes, said):
    with pytest.raises(FloorPlanError, match=said):
        seam(**changes)


def test_a_strip_must_lie_on_the_floor_of_both_sheets():
    short = shapely.MultiPolygon([box(0, 0, 14, 2), box(58, 0, 70, 2)])
    with pytest.raises(FloorPlanError, match=r"'cut': 4\.00 m² of its strip, around \(57\.00, 1\."):
        FloorPlan(short, exits=[Exit("out", (70, 0), (70, 2))], seams=[seam()])


def test_without_seams_the_floor_is_one_polygon():
    with pytest.raises(FloorPlanError, match="one connected polygon, found 2 pieces"):
        FloorPlan(
            shapely.MultiPolygon([box(0, 0, 14, 2), box(56, 0, 70, 2)]),
            exits=[Exit("out", (70, 0), (70, 2))],
        )


def test_routes_are_as_long_as_on_the_whole_floor():
    whole, cut = room_with_corridor(1.6), cut_corridor(1.6)
    rng = np.random.default_rng(4)
    places = whole.random_points(200, rng, spacing=0.3, clearance=0.2)
    drawn = places + np.where(places[:, :1] > 6.0, APART, 0.0) * [1.0, 0.0]
    expected = Router(whole).targets(places, np.zeros(200))
    found = Router(cut).targets(drawn, np.zeros(200))
    # Routes lead by nodes half a metre apart in the gates of the seam, and to points in the exit:
    # differences of millimetres.
    longer = found.distances - expected.distances
    assert longer.min() > -0.005
    assert longer.max() < 0.03
    # In the corridor everybody goes straight on, in whichever drawing.
    ahead = places[:, 0] > 0.5
    assert np.abs((found.points - drawn)[ahead, 1]).max() < 0.45
    assert (true_x(found.points[ahead, 0]) > places[ahead, 0]).all()


def test_routes_count_the_extra_length_once():
    def distance(extra):
        floor = shapely.MultiPolygon([box(0, 0, 14, 2), box(56, 0, 70, 2)])
        plan = FloorPlan(floor, exits=[Exit("out", (70, 0), (70, 2))], seams=[seam(extra=extra)])
        return Router(plan).targets([(1.0, 1.0), (61.0, 1.0)], [0, 0]).distances.tolist()

    assert distance(0.0) == pytest.approx([19.0, 9.0], abs=1e-6)
    assert distance(2.5) == pytest.approx([21.5, 9.0], abs=1e-6)


def test_a_closed_gate_of_a_seam_closes_the_way():
    plan = cut_corridor(1.6)
    plan.close_gate("cut after")
    assert np.isinf(Router(plan).targets([(1.0, 0.0)], [0]).distances).all()
    plan.open_gate("cut after")
    assert np.isfinite(Router(plan).targets([(1.0, 0.0)], [0]).distances).all()


def test_nobody_stands_on_a_copied_part():
    plan = cut_corridor(1.6)
    points = plan.random_points(150, np.random.default_rng(2), spacing=0.4, clearance=0.2)
    x = points[:, 0]
    assert ((x < 6.0) | (x > 6.0 + APART)).all()
    # On both sheets, though only the second has the exit.
    assert (x < 6.0).any()
    assert (x > 6.0 + APART).any()
    plan.check_reachable(points, 0.16)


def test_a_plan_with_seams_is_not_written_as_a_floor_plan(tmp_path):
    with pytest.raises(FloorPlanError, match="expected that of its building"):
        cut_corridor(1.6).write_geojson(tmp_path / "plan.geojson")
    assert not list(tmp_path.iterdir())


def test_places_on_copied_parts_belong_to_the_other_sheet():
    found = to_own_sheets(
        np.array([[9.0, 1.0], [11.0, 1.0], [59.0, 1.0], [61.0, 1.0], [15.0, 1.0], [11.0, 3.0]]),
        [seam()],
    )
    assert found[:, 0].tolist() == [0.0, 50.0, -50.0, 0.0, 0.0, 0.0]
    assert (found[:, 1] == 0.0).all()


@pytest.mark.parametrize("width", [0.9, 2.4])
@pytest.mark.parametrize("place", [(1.0, 0.05), (2.0, -0.2), (4.5, 0.2), (5.8, -0.1)])
def test_people_cross_gates_of_seams_on_the_straight_line_to_where_they_go_next(width, place):
    """Before a seam they head as on one floor: there for the exit, here for the gate at 7.75 m."""
    (whole,), (cut,) = (
        Router(plan, clearance=0.2).targets([place], [0]).points
        for plan in (room_with_corridor(width), cut_corridor(width))
    )
    steps = np.array([whole, cut]) - place
    assert whole[0] > 12.0
    assert 7.75 < cut[0] < 10.0
    aside = steps[1] @ (steps[0, 1], -steps[0, 0]) / np.hypot(*steps[0])
    assert abs(aside) < 0.01
