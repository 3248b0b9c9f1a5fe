"""Stairs made out from the level faces of their body."""

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from shapely.affinity import rotate, translate

from mesa_mobility.floorplan.formats.ifc.flights import way_of
from mesa_mobility.floorplan.formats.ifc.records import Step


def steps_of(boxes, riser, angle=0.0):
    return [
        Step(
            round((k + 1) * riser, 4),
            rotate(shapely.box(*each), angle, origin=(0, 0), use_radians=True),
        )
        for k, each in enumerate(boxes)
    ]


@given(
    angle=st.floats(0, 2 * np.pi),
    risers=st.integers(8, 24),
    tread=st.floats(0.22, 0.4),
    width=st.floats(0.8, 3.0),
)
def test_a_straight_flight_at_any_angle(angle, risers, tread, width):
    """It leads up along x before it is turned: who walks down has smaller y on their left."""
    boxes = [(k * tread, 0, (k + 1) * tread, width) for k in range(risers - 1)]
    found = way_of(steps_of(boxes, 0.17, angle), 0.0, risers * 0.17, None)
    top = (risers - 1) * tread
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    assert found.risers == risers
    assert found.tread == pytest.approx(tread, abs=2e-3)
    assert np.allclose(found.head, np.array([(top, 0), (top, width)]) @ turn, atol=5e-3)
    assert found.given == {}
    assert not found.guessed


def test_two_flights_beside_a_landing():
    """Eight risers up along x at y from 0 to 1, a landing 1.2 m deep, eight back at 1.2 to 2.2."""
    lower = [(k * 0.3, 0, (k + 1) * 0.3, 1) for k in range(7)]
    landing = [(2.1, 0, 3.3, 2.2)]
    upper = [(2.1 - (k + 1) * 0.3, 1.2, 2.1 - k * 0.3, 2.2) for k in range(7)]
    found = way_of(steps_of([*lower, *landing, *upper], 0.17), 0.0, 16 * 0.17, 16)
    assert found.risers == 16
    # Who walks down walks along x, and turns to the right, where y is smaller.
    assert found.given["turn"] == "right"
    assert found.given["well"] == pytest.approx(0.2)
    assert found.given["landing"] == pytest.approx(1.2)
    assert np.allclose(found.head, [(0, 2.2), (0, 1.2)])
    assert found.tread == pytest.approx(0.3)
    assert not found.guessed


def test_winding_stairs_become_two_flights_in_their_place():
    wedge = shapely.Polygon([(0.1, 0), (0.9, 0), (0.9 * np.cos(0.4), 0.9 * np.sin(0.4))])
    steps = [
        Step((k + 1) * 0.18, translate(rotate(wedge, k * 0.4, origin=(0, 0), use_radians=True), 5))
        for k in range(14)
    ]
    found = way_of(steps, 0.0, 15 * 0.18, None)
    assert found.risers == 15
    assert found.given["type"] == "dog_leg"
    assert found.guessed == "two flights side by side"
    whole = shapely.union_all([each.area for each in steps])
    assert shapely.LineString(found.head).distance(whole) < 0.2


@pytest.mark.parametrize("count", [0, 1, 2])
def test_too_few_steps_are_none(count):
    boxes = [(k * 0.3, 0, (k + 1) * 0.3, 1) for k in range(count)]
    assert way_of(steps_of(boxes, 0.17), 0.0, 3.0, None) is None
    assert way_of(steps_of(boxes, 0.17), 0.0, 90.0, None) is None
