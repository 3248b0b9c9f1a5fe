"""The target choice that ships: everybody to the nearest of the exits it may leave by."""

import pytest
from mesa_mobility.behaviors import NearestExit
from shapely import LineString, Point

from mesa_mobility.crowd import PRESETS, TargetChoice
from mesa_mobility.plugins.registry import load_behavior
from tests.fixtures.maps import strider
from tests.fixtures.scenes import advance, corridor, model_of, put, two_doors


def test_registered_under_its_name():
    assert load_behavior("nearest_exit") is NearestExit
    assert issubclass(NearestExit, TargetChoice)


@pytest.mark.parametrize("preset", PRESETS)
def test_what_both_presets_use(preset):
    model = model_of(corridor(), strider(), preset=preset)
    assert type(model.target_choice) is NearestExit


@pytest.mark.parametrize(("place", "name"), [((6.0, 4.5), "right"), ((2.0, 3.5), "left")])
def test_the_target_lies_beyond_the_nearest_exit(place, name):
    model = model_of(two_doors(), strider())
    person = put(model, *place)
    way = LineString([person.position, person.target])
    assert way.crosses(model.floor_plan.gate(name).line)
    other = {"right": "left", "left": "right"}[name]
    assert not way.intersects(model.floor_plan.gate(other).line)


def test_nearest_among_those_one_may_leave_by():
    model = model_of(two_doors(), strider())
    person = put(model, 6.0, 4.5, exits=["left"])
    assert LineString([person.position, person.target]).crosses(model.floor_plan.gate("left").line)


def test_a_corner_first_where_the_exit_is_out_of_view():
    # A wall from the lower side to y = 5, its tip between the person and the exit.
    plan = corridor(length=10.0, width=8.0, obstacles=["POLYGON((5 0,5.2 0,5.2 5,5 5,5 0))"])
    model = model_of(plan, strider())
    person = put(model, 3.0, 1.0)
    way = LineString([person.position, person.target])
    assert 0.15 <= way.distance(Point(5.0, 5.0)) < 0.5
    assert person.target[0] < 6.0
    # To the tip, 0.2 m clear of it, over it, and 4.6 m on: 4.57 + 0.6 + 4.6 m.
    assert model.crowd.route[person.row] == pytest.approx(9.77, abs=0.2)


def test_targets_are_asked_for_anew_with_each_decision():
    model = model_of(corridor(both_ends=True), strider())
    person = put(model, 12.0, 2.0, preferred_speeds=[1.25])
    assert person.target[0] > 20.0
    model.floor_plan.close_gate("east")
    advance(model, 1)
    assert person.target[0] < 0.0
