"""Tactics and presets of one's own."""

from dataclasses import replace

import numpy as np
import pytest

from mesa_mobility import Preset, Tactic
from mesa_mobility.crowd import PRESETS
from mesa_mobility.errors import ModelError
from tests.fixtures.engine import ENGINE
from tests.fixtures.maps import strider
from tests.fixtures.scenes import advance, corridor, model_of, put


class Halve(Tactic):
    name = "halve"

    def apply(self, deciding, desired):
        desired.speeds = desired.speeds * 0.5


class GoUp(Tactic):
    name = "go_up"

    def apply(self, deciding, desired):
        desired.points = deciding.positions + np.array([0.0, 5.0])


class Bad(Tactic):
    name = "bad"

    def __init__(self, **given):
        self.given = given

    def apply(self, deciding, desired):
        vars(desired).update(self.given)


def names(model):
    return [tactic.name for tactic in model.tactics]


def test_those_of_the_presets():
    # Without these, places to visit, zones, rules, waiting times and closing doors mean nothing.
    needed = ["visits", "lifts", "speed_zones", "speed_rules", "waiting", "stepping_off"]
    assert names(model_of(corridor(), strider(), preset="paper")) == needed
    default = names(model_of(corridor(), strider(), preset="default"))
    assert [name for name in default if name not in needed] == [
        name for name in PRESETS["default"].tactics if name not in needed
    ]
    assert [name for name in default if name in needed] == needed
    everything = [
        "lifts",
        "corner_spreading",
        "visits",
        "speed_zones",
        "speed_rules",
        "giving_way",
        "waiting",
        "speed_compensation",
        "anticipation",
        "speed_adaptation",
        "stepping_off",
    ]
    assert names(model_of(corridor(), strider(), preset=ENGINE)) == everything


def test_those_of_the_scene_come_around_those_of_a_preset_unless_it_names_their_place():
    mine = replace(PRESETS["paper"], tactics=("giving_way", "stepping_off", "anticipation"))
    assert names(model_of(corridor(), strider(), preset=mine)) == [
        "visits",
        "lifts",
        "speed_zones",
        "speed_rules",
        "giving_way",
        "stepping_off",
        "anticipation",
        "waiting",
    ]


def test_they_apply_in_order_and_may_be_taken_out():
    model = model_of(corridor(), strider())
    model.tactics[:] = [Halve(), Halve(), GoUp()]
    person = put(model, 1.0, 1.0, preferred_speeds=1.2)
    advance(model, 1)
    assert model.crowd.preferred[person.row] == pytest.approx(0.3)
    assert person.target == pytest.approx([1.0, 6.0])
    person.wait(10.0)  # without the tactic of that name nobody heeds it
    model.tactics.clear()
    advance(model, 90)
    assert person.position[0] > 3.0


def test_one_that_is_added_goes_behind_the_one_that_it_names():
    model = model_of(corridor(), strider())
    before = names(model)
    model.add_tactic(Halve())
    assert names(model) == [*before, "halve"]
    behind = GoUp()
    behind.after = "speed_zones"
    model.add_tactic(behind)
    assert names(model)[4:6] == ["go_up", "speed_rules"]


def test_what_a_tactic_gives_is_checked():
    n = 1
    for given, text in (
        ({"speeds": np.full(n, np.nan)}, "out of range"),
        ({"speeds": np.full(n, -1.0)}, "out of range"),
        ({"points": np.full((n, 2), np.inf)}, "out of range"),
        ({"points": np.zeros((n, 3))}, r"points of shape \(1, 3\)"),
        ({"speeds": ["fast"]}, "expected numbers"),
    ):
        model = model_of(corridor(), strider())
        model.tactics.append(Bad(**given))
        with pytest.raises(ModelError, match=f"behaviour 'bad': gave .*{text}"):
            put(model, 1.0, 1.0)


def test_a_preset_of_ones_own_is_saved_with_the_figures():
    tactics = ("visits", "stepping_off")
    mine = replace(PRESETS["default"], name="mine", terms={"target_distance": 2.0}, tactics=tactics)
    model = model_of(corridor(), strider(), preset=mine)
    assert model.preset == "mine"
    assert [(term.name, term.weight) for term in model.terms] == [("target_distance", 2.0)]
    assert names(model) == [
        "lifts",
        "speed_zones",
        "speed_rules",
        "visits",
        "stepping_off",
        "waiting",
    ]
    rules = model.summary()["rules"]
    assert (rules["name"], rules["terms"], rules["tactics"]) == (
        "mine",
        {"target_distance": 2.0},
        ["visits", "stepping_off"],
    )
    assert Preset(**rules) == mine


@pytest.mark.parametrize(
    ("changed", "text"),
    [
        ({"name": ""}, "preset: name ''"),
        ({"durations": ()}, r"durations \(\), expected frames"),
        ({"durations": (12, 0.5)}, "durations"),
        ({"terms": {"headway": float("nan")}}, "for the name of each a finite number"),
        ({"tactics": "visits"}, "tactics 'visits', expected names of registered tactics"),
        ({"tactics": ("visits", 1)}, "expected names of registered tactics"),
        ({"shares": ((1.0,),)}, "share 1.0, expected 0 or more and less than 1"),
    ],
)
def test_presets_that_are_refused(changed, text):
    with pytest.raises(ModelError, match=text):
        replace(PRESETS["default"], **changed)


def test_what_is_no_preset():
    with pytest.raises(ModelError, match="preset: got 7, expected a name, a TOML file or a Preset"):
        model_of(corridor(), strider(), preset=7)
