import numpy as np
import pytest
import shapely
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from shapely import box

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan import Exit, FloorPlan, line_of_sight, lines_of_sight

coordinate = st.one_of(st.integers(0, 12).map(float), st.floats(0, 12).map(lambda v: round(v, 6)))
point = st.tuples(coordinate, coordinate)
walls = st.lists(st.tuples(coordinate, coordinate, coordinate, coordinate), max_size=10)


def plan() -> FloorPlan:
    return FloorPlan(
        box(0, 0, 10, 8), exits=[Exit("e", (4, 0), (5, 0))], obstacles=[box(2, 2, 3, 3)]
    )


@pytest.mark.parametrize(
    ("p", "q", "clearance", "seen"),
    [
        ((1, 2.5), (4, 2.5), 0.0, False),  # through the obstacle
        ((1, 1.9), (4, 1.9), 0.0, True),  # 0.1 m beside it
        ((1, 1.9), (4, 1.9), 0.09, True),
        ((1, 1.9), (4, 1.9), 0.11, False),
        ((1, 2), (4, 2), 0.0, False),  # along its edge: touches
        ((1, 1), (4, 4), 0.0, False),  # through two of its corners exactly
        ((1, 3), (3, 5), 0.7, True),  # 1/sqrt(2) = 0.707 m from its corner (2, 3)
        ((1, 3), (3, 5), 0.71, False),
        ((4.5, 1), (4.5, -1), 0.4, True),  # out of the exit, 0.5 m from either end
        ((4.5, 1), (4.5, -1), 0.6, False),
        ((6, 6), (6, 6), 1.9, True),  # a point, 2 m from the upper wall
        ((6, 6), (6, 6), 2.1, False),
        ((6, 1), (60, 1), 0.0, False),  # far outside
    ],
)
def test_views_by_hand(p: tuple, q: tuple, clearance: float, seen: bool) -> None:
    assert line_of_sight(plan(), p, q, clearance) is seen
    assert line_of_sight(plan(), q, p, clearance) is seen
    assert line_of_sight(plan().walls, p, q, clearance) is seen


def test_views_follow_changes_of_the_plan() -> None:
    room = plan()
    assert not line_of_sight(room, (1, 2.5), (4, 2.5))
    room.remove_obstacle(0)
    assert line_of_sight(room, (1, 2.5), (4, 2.5))
    assert line_of_sight(room, (1, 2.5), (4, 2.5), 0.9)
    room.close_gate("e")
    assert not line_of_sight(room, (4.5, 1), (4.5, -1))


def test_nothing_hides_anything_without_walls() -> None:
    assert line_of_sight([], (0, 0), (5, 5), 1.0)


def test_many_views_at_once() -> None:
    p, q = np.array([[1, 2.5], [1, 1.9]]), np.array([[4, 2.5], [4, 1.9]])
    assert lines_of_sight(plan(), p, q).tolist() == [False, True]
    assert lines_of_sight(plan(), np.empty((0, 2)), np.empty((0, 2))).shape == (0,)


@pytest.mark.parametrize(
    ("p", "q", "clearance", "says"),
    [
        ([[0, 0]], [[1, 1], [2, 2]], 0.0, "found 1 and 2 points"),
        ([[0, np.nan]], [[1, 1]], 0.0, "finite points"),
        ([[0, 0]], [[1, 1]], -0.1, "clearance must be at least 0 m, found -0.1"),
    ],
)
def test_bad_questions(p: list, q: list, clearance: float, says: str) -> None:
    with pytest.raises(FloorPlanError, match=says):
        lines_of_sight(plan(), p, q, clearance)


@settings(deadline=None, max_examples=300)
@given(segments=walls, p=point, q=point, clearance=st.sampled_from([0.0, 0.17, 0.5, 2.0]))
def test_views_are_those_of_shapely(segments: list, p: tuple, q: tuple, clearance: float) -> None:
    line = shapely.Point(p) if p == q else shapely.LineString([p, q])
    lines = shapely.linestrings(np.array(segments, dtype=float).reshape(-1, 2, 2))
    away = shapely.distance(line, lines).min() if segments else np.inf
    # Only where rounding decides may the two differ.
    assume(abs(away - clearance) > 1e-7 or away == 0.0)
    assert line_of_sight(segments, p, q, clearance) is bool(away > 0 and away >= clearance)
