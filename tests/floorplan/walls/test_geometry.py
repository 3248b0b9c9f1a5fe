import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from mesa_mobility.floorplan.floor.geometry import (
    point_segment_distance2,
    segment_box_distance2,
    segment_segment_distance2,
    segments_cross,
)

coordinate = st.one_of(st.integers(-5, 5).map(float), st.floats(-50, 50).map(lambda v: round(v, 6)))
segment = st.tuples(coordinate, coordinate, coordinate, coordinate)


def line(s: tuple[float, float, float, float]) -> shapely.Geometry:
    return shapely.Point(s[:2]) if s[:2] == s[2:] else shapely.LineString([s[:2], s[2:]])


@pytest.mark.parametrize(
    ("point", "expected"),
    [
        ((2, 3), 9.0),  # above the middle
        ((-3, 4), 25.0),  # 3-4-5 from the left end
        ((7, 4), 25.0),  # 3-4-5 from the right end
        ((1, 0), 0.0),  # on it
    ],
)
def test_point_to_segment(point: tuple[float, float], expected: float) -> None:
    assert point_segment_distance2(*point, 0.0, 0.0, 4.0, 0.0) == expected


def test_a_segment_without_length_is_a_point() -> None:
    assert point_segment_distance2(3.0, 4.0, 0.0, 0.0, 0.0, 0.0) == 25.0


@pytest.mark.parametrize(
    ("other", "cross", "distance2"),
    [
        ((1, -1, 1, 1), True, 0.0),
        ((0, 1, 4, 1), False, 1.0),  # parallel
        ((4, 0, 4, 3), False, 0.0),  # ends on the end
        ((2, 0, 2, 3), False, 0.0),  # ends on the middle
        ((1, 0, 3, 0), False, 0.0),  # lies on it
        ((7, 4, 7, 9), False, 25.0),  # 3-4-5 from the end
        ((5, 0, 9, 0), False, 1.0),  # farther along the same line
    ],
)
def test_segment_to_segment(other: tuple[float, ...], cross: bool, distance2: float) -> None:
    one = (0.0, 0.0, 4.0, 0.0)
    assert segments_cross(*one, *map(float, other)) is cross
    assert segment_segment_distance2(*one, *map(float, other)) == distance2


@pytest.mark.parametrize(
    ("one", "distance2"),
    [
        ((0.2, 0.2, 0.4, 0.3), 0.0),  # inside
        ((-1, 0.5, 2, 0.5), 0.0),  # right through
        ((4, 5, 9, 5), 25.0),  # 3-4-5 from the corner (1, 1)
        ((-2, -3, -2, 5), 4.0),
    ],
)
def test_segment_to_box(one: tuple[float, ...], distance2: float) -> None:
    assert segment_box_distance2(*map(float, one), 0.0, 0.0, 1.0, 1.0) == distance2


@settings(deadline=None)
@given(one=segment, other=segment)
def test_segment_distance_is_that_of_shapely(one: tuple, other: tuple) -> None:
    expected = line(one).distance(line(other))
    assert segment_segment_distance2(*one, *other) ** 0.5 == pytest.approx(expected, abs=1e-7)


@settings(deadline=None)
@given(one=segment, other=segment)
def test_segment_distance_does_not_depend_on_the_order(one: tuple, other: tuple) -> None:
    forth = segment_segment_distance2(*one, *other)
    assert segment_segment_distance2(*other, *one) == pytest.approx(forth, abs=1e-9)
    turned = (*one[2:], *one[:2])
    assert segment_segment_distance2(*turned, *other) == pytest.approx(forth, abs=1e-9)
