import math

import pytest

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan import Exit, Gate


def test_measures_of_an_opening() -> None:
    door = Gate("door", (1, 2), (4, 6))
    assert door.length == 5.0
    assert door.midpoint == (2.5, 4.0)
    assert list(door.line.coords) == [(1.0, 2.0), (4.0, 6.0)]


def test_an_opening_cannot_be_changed() -> None:
    with pytest.raises(AttributeError):
        Exit("out", (0, 0), (1, 0)).name = "in"


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: Exit("", (0, 0), (1, 0)), "exit name must be a text"),
        (lambda: Gate(3, (0, 0), (1, 0)), "gate name must be a text"),
        (lambda: Gate("d", (0, 0), (0, 0)), "gate 'd' has no length"),
        (lambda: Exit("e", (0, math.nan), (1, 0)), "exit 'e': a must be finite"),
        (lambda: Exit("e", (0, 0), (1, math.inf)), "exit 'e': b must be finite"),
        (lambda: Gate("d", (0, 0, 0), (1, 0)), r"gate 'd': a must be two numbers"),
        (lambda: Gate("d", "ab", (1, 0)), r"gate 'd': a must be two numbers"),
        (lambda: Gate("d", None, (1, 0)), r"gate 'd': a must be two numbers"),
    ],
)
def test_bad_openings(make, says: str) -> None:
    with pytest.raises(FloorPlanError, match=says):
        make()
