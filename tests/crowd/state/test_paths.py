"""People follow a chosen option exactly, to its end."""

import math

import numpy as np
import pytest
from mesa_mobility.behaviors import Displacement

from tests.fixtures.maps import make_map, stand, straight, strider, through
from tests.fixtures.scenes import advance, corridor, follow, model_of, put

START = np.array([2.0, 2.0, 0.0])
SWAY = [(0.25, 0.125, 0.25), (0.5, 0.0, 0.0), (0.75, -0.125, -0.25), (1.0, 0.0, 0.5)]


@pytest.fixture
def swayer():
    """Stand, or sway ahead by a metre in 12 frames, ending half a radian to the left."""
    return make_map([[stand(), through(SWAY, to=0)]])


def test_samples_are_met_and_joined_by_straight_lines(swayer):
    person = put(model_of(corridor(), swayer, behaviors=[Displacement()]), 2.0, 2.0)
    track = follow(person, 12)
    knots = np.array([(0.0, 0.0, 0.0), *SWAY])
    np.testing.assert_allclose(track[::3], knots + START, atol=1e-12)
    for k in range(4):
        for share, row in ((1 / 3, 3 * k + 1), (2 / 3, 3 * k + 2)):
            between = knots[k] + share * (knots[k + 1] - knots[k])
            np.testing.assert_allclose(track[row], between + START, atol=1e-12)


def test_the_path_turns_with_the_person(swayer):
    person = put(model_of(corridor(), swayer, behaviors=[Displacement()]), 5.0, 1.0, math.pi / 2)
    track = follow(person, 12)
    x, y, heading = np.array(SWAY).T
    expected = np.column_stack([5.0 - y, 1.0 + x, heading + math.pi / 2])
    np.testing.assert_allclose(track[3::3], expected, atol=1e-12)


def test_the_next_option_starts_where_the_last_one_ended(swayer):
    person = put(model_of(corridor(), swayer, behaviors=[Displacement()]), 2.0, 2.0)
    track = follow(person, 24)
    assert track[12] == pytest.approx((3.0, 2.0, 0.5))
    c, s = math.cos(0.5), math.sin(0.5)
    assert track[24] == pytest.approx((3.0 + c, 2.0 + s, 1.0))


def test_nothing_changes_the_movement_under_way():
    model = model_of(corridor(), strider())
    person = put(model, 1.0, 2.0, preferred_speeds=[1.25])
    advance(model, 5)
    model.terms.clear()
    model.terms.append(Displacement(-100.0))
    put(model, 6.0, 2.0)
    track = follow(person, 40)
    np.testing.assert_allclose(track[:, 0], 1.0 + 1.25 / 30 * np.arange(5, 46), atol=1e-9)


def test_the_description_of_the_committed_movement(whole):
    map_ = make_map([[straight(1.5, 24, to=1)], [straight(0.25, 12, to=0)]])
    model = model_of(corridor(), map_, preset=whole)
    person = put(model, 2.0, 2.0)
    assert person.next_decision == 0.0
    assert person.speed == 0.0
    advance(model, 10)
    # The movement under way is the first one: it ends after 24 frames, in cluster 1.
    assert person.next_decision == pytest.approx(14 / 30)
    assert person.cluster == 1
    assert person.speed == pytest.approx(1.5 / 0.8)
    assert not person.in_fallback
    advance(model, 14)
    assert person.next_decision == pytest.approx(0.0)
    advance(model, 1)
    assert person.next_decision == pytest.approx(11 / 30)
    assert person.cluster == 0
    assert person.speed == pytest.approx(0.25 / 0.4)


def test_decisions_are_counted():
    model = model_of(corridor(), make_map([[straight(0.5, 12, to=0)]]))
    put(model, 2.0, 2.0)
    advance(model, 36)
    assert model.summary()["decisions"] == 3
    advance(model, 1)
    assert model.summary()["decisions"] == 4


def test_velocity_is_the_mean_over_the_movement_not_that_of_the_moment(swayer):
    model = model_of(corridor(), swayer, behaviors=[Displacement()])
    person = put(model, 2.0, 2.0)
    advance(model, 1)
    assert person.velocity == pytest.approx((2.5, 0.0))  # 1 m in 0.4 s, straight
