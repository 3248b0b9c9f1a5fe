"""A crowd at a corner of a wide hall."""

import numpy as np
import pytest
from mesa_mobility.behaviors.steering.corner_spreading import _areas
from shapely import Polygon

from mesa_mobility import Exit, FloorPlan, PedestrianModel
from mesa_mobility.crowd.state.records import Crowd
from tests.fixtures.engine import ENGINE

SPEED = 1.5
CAPACITY = 1.22  # Weidmann's capacity of a level way, persons/(m s)
BEND = 19.8
# Alone, people aim past the bend, and so cross its line nearer to the corner than the bend is.
CUTS = 0.25


def halls() -> FloorPlan:
    """Two halls 20 m wide at a right angle; the way bends 0.2 m off the corner (20, 20)."""
    floor = Polygon([(0, 0), (40, 0), (40, 20), (20, 20), (20, 50), (0, 50)])
    return FloorPlan(floor, exits=[Exit("end", (40, 0), (40, 20))])


def passing(person) -> float:
    """How far from the corner a person means to pass it."""
    (x, y), (tx, ty) = person.position, person.target
    return BEND - (x + (y - BEND) / (y - ty) * (tx - x))


# One behind the other, straight down along x = 10: the k-th is 10.2 m + 2k from the line y = 19.8.
PLACES = [(10.0, 30.0 + 2.0 * k) for k in range(6)]


def test_people_pass_as_far_out_as_those_before_them_take_up():
    model = PedestrianModel(halls(), preset=ENGINE, rng=1)
    people = model.add_pedestrians(PLACES, preferred_speeds=SPEED)
    for k, person in enumerate(people):
        seconds = np.hypot(BEND - 10.0, PLACES[k][1] - BEND) / SPEED
        expected = min(k / (CAPACITY * seconds), BEND - 10.0)
        assert passing(person) == pytest.approx(expected, abs=0.05 if k else CUTS)


def test_who_is_behind_does_not_count():
    # The same people, put there in another order.
    model = PedestrianModel(halls(), preset=ENGINE, rng=1)
    people = model.add_pedestrians(PLACES[::-1], preferred_speeds=SPEED)
    assert passing(people[-1]) == pytest.approx(0.0, abs=CUTS)
    model = PedestrianModel(halls(), preset=ENGINE, rng=1)
    (alone,) = model.add_pedestrians(PLACES[:1], preferred_speeds=SPEED)
    assert alone.target == pytest.approx(people[-1].target)


def test_those_count_whose_way_round_the_same_corner_is_shorter():
    # At a corner each, of which the last is nobody's; ways of whole metres, so that many are equal.
    rng = np.random.default_rng(3)
    n, deciding = 60, np.arange(0, 60, 3)
    crowd = Crowd(n)
    crowd.agenda["corner"], crowd.agenda["speed"] = rng.integers(-1, 4, n), rng.uniform(1.0, 2.0, n)
    crowd.route[:n] = rng.integers(0, 9, n)
    corners = np.column_stack([crowd.agenda["corner"][deciding], np.zeros(len(deciding), int)])
    crowd.agenda["corner"][deciding] = 3  # of before
    crowd.agenda["corner"][59] = 4
    areas = np.zeros(len(deciding))
    nearest_first = np.argsort(crowd.route[deciding], kind="stable")
    inside = np.arange(n)
    assert _areas(deciding, nearest_first, corners, inside, crowd.records, crowd.agenda, areas)
    corner, route, speed = crowd.agenda["corner"], crowd.route, crowd.agenda["speed"]
    for k, i in enumerate(deciding):
        assert corner[i] == corners[k, 0]
        before = sum(
            corner[j] == corner[i] and (route[j], j) < (route[i], i) for j in range(n) if j != i
        )
        assert areas[k] == (before * speed[i] / CAPACITY if corner[i] >= 0 else 0.0)


def test_the_printed_rules_send_everybody_the_shortest_way():
    model = PedestrianModel(halls(), preset="paper", rng=1)
    people = model.add_pedestrians(PLACES, preferred_speeds=SPEED)
    assert [passing(person) for person in people] == pytest.approx([0.0] * 6, abs=CUTS)
