"""Settings of behaviours, people and models: checked when they are set, and shown."""

from __future__ import annotations

import copy
import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Annotated

import numpy as np
import pytest
from mesa_mobility.behaviors import (
    Attraction,
    Attractions,
    CongestionRouting,
    Counter,
    FamiliarExit,
    Following,
    Headway,
    Queueing,
    RightOfWay,
    Signs,
)

from mesa_mobility import (
    Exit,
    FloorPlan,
    ListOf,
    PedestrianModel,
    Range,
    SpeedRule,
    Tactic,
)
from mesa_mobility.crowd.costs.compiled_terms import numbers_of
from mesa_mobility.distributions import Normal
from mesa_mobility.errors import ModelError
from mesa_mobility.plugins.registry import behaviors, load_behavior
from mesa_mobility.plugins.settings import declared, settings_text
from tests.fixtures.maps import strider

NO_NUMBERS = [True, "1", None, math.nan]


def hall(**keywords) -> PedestrianModel:
    plan = FloorPlan(
        "POLYGON ((0 0, 10 0, 10 8, 0 8, 0 0))", exits=[Exit("door", (10, 3), (10, 5))], name="hall"
    )
    return PedestrianModel(plan, mobility_map=strider(), rng=1, **keywords)


# -- behaviours --------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "value", "says"),
    [
        ("tme", 1, "headway: no setting 'tme', did you mean 'time'?"),
        ("wieght", 1, "headway: no setting 'wieght', did you mean 'weight'?"),
        ("time", -1, "headway: time -1, expected more than 0 s"),
        ("time", 0.0, "headway: time 0.0, expected more than 0 s"),
        ("time", np.float64("nan"), "headway: time nan, expected more than 0 s"),
        ("time", math.inf, "headway: time inf, expected more than 0 s"),
        ("time", 10**400, "headway: time 1000"),
        *(("time", each, f"headway: time {each!r}, expected more than 0 s") for each in NO_NUMBERS),
        *(("weight", each, f"weight of 'headway': got {each!r}, expected") for each in NO_NUMBERS),
        ("weight_by_type", 2, "weight_by_type of 'headway': got 2, expected"),
        ("weight_by_type", {"child": "1"}, "weight of 'headway' for 'child': got '1', expected"),
        ("for_types", 2, "for_types of 'headway': got 2, expected"),
    ],
)
def test_a_setting_is_refused_in_one_line_and_the_old_one_stays(name, value, says):
    term = Headway()
    with pytest.raises(ModelError) as refused:
        setattr(term, name, value)
    assert str(refused.value).startswith(says)
    assert "\n" not in str(refused.value)
    assert term.settings() == Headway().settings()
    assert term.weight == 1.5
    assert not hasattr(term, "tme")


def test_constructors_refuse_unknown_names_and_values_out_of_range():
    with pytest.raises(ModelError, match="Headway: no setting 'tme', did you mean 'time'"):
        Headway(tme=1)
    with pytest.raises(ModelError, match="headway: time -1, expected more than 0 s"):
        Headway(time=-1)
    with pytest.raises(TypeError, match="required"):  # names that it lacks stay Python's business
        type("Needy", (SpeedRule,), {"speeds": None, "__init__": lambda self, given: None})()


def test_set_values_reach_the_kernel():
    term = Headway(time=np.float32(2.0))
    term.time = 3
    given = dict(zip(term.kernel.numbers, numbers_of(term, term.kernel), strict=True))
    assert given == {
        "distance": 0.36,
        "time": 3.0,
        "width": 0.35,
        "softness": 0.15,
        "beyond": 1.0,
    }
    assert type(term.time) is float


def test_settings_that_do_not_fit_together_are_refused():
    term = RightOfWay(width=0.4, bias=0.1)
    with pytest.raises(ModelError, match=r"width 0\.4 m, expected more than the bias, 0\.5 m"):
        term.bias = 0.5
    assert term.bias == 0.1
    with pytest.raises(ModelError, match=r"right_of_way: width 0\.1 m"):
        RightOfWay(width=0.1)


def test_a_negative_weight_is_allowed():
    assert Headway(weight=-2.0).weight == -2.0


def test_lists_take_objects_of_one_kind():
    counter = Counter([(0, 0), (1, 0)], 3.0)
    queueing = Queueing(each for each in [counter])
    assert queueing.counters == [counter]
    for wrong in (5, [5], "counter", None):
        with pytest.raises(ModelError, match=r"queueing: counters .*expected a list of Counter"):
            queueing.counters = wrong
    with pytest.raises(ModelError, match=r"expected a list of names such as \['left'\]"):
        FamiliarExit("left")
    attractions = Attractions([Attraction((1, 1), 3.0)])
    with pytest.raises(ModelError, match="attractions is set by the constructor alone"):
        attractions.attractions = []


def test_a_setting_repeated_below_keeps_its_range_with_another_default():
    assert str(declared(Signs)["interval"].range) == "more than 0 s, or inf"
    assert declared(Signs)["interval"].default == 0.5
    assert declared(CongestionRouting)["interval"].default == 2.0
    with pytest.raises(ModelError, match="congestion_routing: interval 0, expected more than 0 s"):
        CongestionRouting(interval=0)
    assert CongestionRouting(interval=math.inf).interval == math.inf


def test_all_numbers_of_all_shipped_behaviours_are_settings_with_a_default_in_range():
    for name in behaviors():
        kind = load_behavior(name)
        made = kind()
        public = {each for each in vars(made) if not each.startswith("_")}
        assert public == set(declared(kind)), name
        for row in settings_text(kind):
            assert all(row), row  # name, default, range and description
        with pytest.raises(ModelError, match="no setting 'anything'"):
            made.anything = 1


@pytest.mark.parametrize(
    ("behaviour", "settings"),
    [
        (CongestionRouting(interval=3.0, patience=0.3), {"interval": 3.0, "patience": 0.3}),
        (Signs(noticed=0.5), {"noticed": 0.5, "followed": 0.97, "interval": 0.5}),
        (Following(distance=2.0), {"distance": 2.0}),
    ],
)
def test_states_hold_settings_and_restoring_checks_them(behaviour, settings):
    state = behaviour.state()
    assert settings.items() <= state.items()
    again = type(behaviour)()
    again.restore(state)
    assert again.settings() == settings
    with pytest.raises(ModelError, match="expected"):
        again.restore({**state, next(iter(settings)): -1})


# -- behaviours of others ----------------------------------------------------------------------


class Plain(SpeedRule):
    """A rule as third parties have written them, without declarations."""

    name = "plain"
    seen: int

    def __init__(self, factor, **others):
        self.factor = factor
        for name, value in others.items():
            setattr(self, name, value)

    def bind(self, model):
        self.model = model

    def speeds(self, deciding, speeds):
        self.seen = self.calls = self.calls + 1
        return speeds * self.factor


def test_plain_attributes_of_a_users_class_go_on_working():
    rule = Plain("anything", calls=0)
    rule.factor, rule.calls = 0.5, 0
    rule.seen, rule._free = 7, object()
    model = hall()
    model.speed_rules.append(rule)
    model.add_pedestrians([(2, 4)])
    model.step()
    assert rule.seen > 0
    assert rule.model is model
    assert copy.deepcopy(Plain(2.0)).factor == 2.0
    with pytest.raises(ModelError, match="plain: no setting 'facter', did you mean 'factor'"):
        rule.facter = 1.0


class Declared(Tactic):
    """Settings in the body of a class, and in a constructor."""

    name = "declared"
    pace: Annotated[float, Range(0.0, 2.0, "m/s")] = 1.0

    def __init__(
        self,
        people: Annotated[int | None, Range(1, 9)] = None,
        wait: Annotated[float | Normal, Range(0.0, unit="s")] = 0.0,
        doors: Annotated[Iterable[str], ListOf(str)] = (),
    ) -> None:
        self.people, self.wait, self.doors = people, wait, doors

    def apply(self, deciding, desired):
        pass


def test_users_declare_settings_in_constructors_and_class_bodies():
    tactic = Declared(people=3, doors=("a", "b"))
    tactic.pace = 0
    tactic.people = None
    assert (tactic.pace, tactic.people, tactic.doors) == (0.0, None, ["a", "b"])
    for name, value, expected in (
        ("pace", 2.1, "pace 2.1, expected 0 to 2 m/s"),
        ("people", 2.0, "people 2.0, expected None, or a whole number, 1 to 9"),
        ("people", True, "people True, expected None, or a whole number, 1 to 9"),
        ("wait", None, "wait None, expected 0 s or more"),
        ("doors", ["a", 1], "doors has 1, expected a list of names"),
    ):
        with pytest.raises(ModelError, match=f"declared: {expected}"):
            setattr(tactic, name, value)
    assert list(declared(Declared)) == ["people", "wait", "doors", "pace"]


@dataclass
class AsData(Tactic):
    """A dataclass with attributes of its own."""

    name = "as_data"
    size: int = 2

    def __post_init__(self):
        self.double = 2 * self.size

    def apply(self, deciding, desired):
        pass


def test_a_behaviour_may_be_a_dataclass():
    assert (AsData(3).size, AsData(3).double) == (3, 6)
