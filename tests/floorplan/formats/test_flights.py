"""Stairs made out from the level faces of their body."""

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from shapely.affinity import rotate, translate

from mesa_mobility.buildings.connections import stairs
from mesa_mobility.buildings.features import part_of
from mesa_mobility.floorplan.formats.ifc import flights as recognised
from mesa_mobility.floorplan.formats.ifc.flights import RISERS, TREADS, way_of
from mesa_mobility.floorplan.formats.ifc.records import Step
from mesa_mobility.floorplan.formats.ifc.way import NEWEL, Way


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
    assert found.given == {"risers": risers, "tread": round(found.tread, 4)}
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
    assert found.given["risers"] == 15
    assert found.guessed == "two flights side by side"
    whole = shapely.union_all([each.area for each in steps])
    assert shapely.LineString(found.head).distance(whole) < 0.2


def turned(flights, turns, tread, width, landing):
    """Steps and landings, from the bottom, of stairs that begin along x, and the middles of their
    lower and upper edges. Landings that turn are squares."""
    boxes, at, way = [], np.zeros(2), np.array([1.0, 0.0])
    foot = at
    for count, turn in zip(flights, [*turns, None], strict=True):
        left = np.array([-way[1], way[0]]) * width / 2
        for _ in range(count - 1):
            boxes.append([at - left, at + left, at + left + tread * way, at - left + tread * way])
            at = at + tread * way
        if turn is not None:
            deep = landing if turn == "on" else width
            boxes.append([at - left, at + left, at + left + deep * way, at - left + deep * way])
            if turn == "on":
                at = at + deep * way
            else:
                side = 1.0 if turn == "left" else -1.0
                at = at + width / 2 * way + side * left
                way = side * left / (width / 2)
    return [shapely.Polygon(each) for each in boxes], foot, at


@given(
    angle=st.floats(0, 2 * np.pi),
    flights=st.lists(st.integers(3, 9), min_size=2, max_size=4),
    data=st.data(),
)
def test_flights_with_landings(angle, flights, data):
    """The turns on the way up are the other way round on the way down; where they turn, the flight
    below begins 0.1 m later, for the post of the handrail."""
    ways = st.lists(st.sampled_from(["on", "left", "right"]), min_size=9, max_size=9)
    turns = data.draw(ways)[: len(flights) - 1]
    risers, tread, width = sum(flights), 0.28, 1.1
    areas, foot, top = turned(flights, turns, tread, width, 1.3)
    steps = [
        Step(round((k + 1) * 0.17, 4), rotate(each, angle, origin=(0, 0), use_radians=True))
        for k, each in enumerate(areas)
    ]
    found = way_of(steps, 0.0, risers * 0.17, None)
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    other = {"left": "right", "right": "left", "on": "on"}
    assert found.flights == tuple(flights[::-1])
    assert found.turns == tuple(other[each] for each in turns[::-1])
    assert found.tread == pytest.approx(tread, abs=1e-3)
    assert found.width == pytest.approx(width, abs=1e-3)
    assert np.allclose(found.head.mean(axis=0), top @ turn, atol=5e-3)
    quarter = sum(each != "on" for each in turns)
    lower = found.ends()[1].middle
    assert np.hypot(*(lower - foot @ turn)) <= NEWEL * quarter + 5e-3
    # The same stairs in a building have their ends there.
    given = {**found.given, "from": 1, "to": 0, "name": "stairs"}
    line = {"geometry": {"type": "LineString", "coordinates": found.head.tolist()}}
    parts, _ = part_of("stairs", line, given, "stairs").parts(risers * 0.17, 0.0)
    assert np.allclose(np.mean(parts[-1].foot, axis=0), lower, atol=2e-3)
    assert np.allclose(parts[-1].down, found.ends()[1].away, atol=1e-6)


@pytest.mark.parametrize("turn", ["left", "right"])
def test_what_is_blocked_before_stairs_that_turn_is_taken_off_their_outer_side(turn):
    """Two flights of 1.2 m; 0.2 m are blocked on the outer side of the lower one. The inner side of
    both stays where it is, and so does the lower end along the way."""
    way = Way(np.array([(0.0, 0.0), (1.2, 0.0)]), 12, 0.3, flights=(6, 6), turns=(turn,))
    outer = (0.0, 0.2) if turn == "left" else (0.2, 0.0)
    found = way.narrowed((0.0, 0.0), outer)
    assert found.width == pytest.approx(1.0)
    (_, end), (_, before) = found.ends(), way.ends()
    shift = end.middle - before.middle
    assert shift @ before.away == pytest.approx(0.0)
    assert shift @ before.across == pytest.approx(-0.1 if turn == "left" else 0.1)


def test_numbers_are_those_of_stairs():
    assert (RISERS, TREADS, NEWEL) == (stairs.RISERS, stairs.TREADS, stairs.NEWEL)
    assert recognised.LEAST_RISERS == stairs.LEAST_RISERS


@pytest.mark.parametrize("count", [0, 1, 2])
def test_too_few_steps_are_none(count):
    boxes = [(k * 0.3, 0, (k + 1) * 0.3, 1) for k in range(count)]
    assert way_of(steps_of(boxes, 0.17), 0.0, 3.0, None) is None
    assert way_of(steps_of(boxes, 0.17), 0.0, 90.0, None) is None
