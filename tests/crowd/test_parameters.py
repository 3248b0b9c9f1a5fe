"""Names of a model's numbers, and rules that are given to models."""

import math
from copy import deepcopy
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from mesa_mobility.behaviors import Headway, KeepDistance

from mesa_mobility.crowd import PRESETS, model_rules
from mesa_mobility.crowd.presets.naming import number_named
from mesa_mobility.errors import ModelError
from mesa_mobility.plugins.settings import declared
from tests.fixtures.maps import strider
from tests.fixtures.scenes import corridor, model_of, put


def made(preset="default", **keywords):
    return model_of(corridor(), strider(), preset=preset, **keywords)


def test_every_weight_and_every_setting_of_the_default_preset_has_a_name():
    model = made()
    found = model.parameters()
    terms = PRESETS["default"].terms
    assert {name: found[f"{name}.weight"].value for name in terms} == terms
    for behaviour in (*model.terms, *model.tactics, model.target_choice):
        for setting, known in declared(type(behaviour)).items():
            if known.range is not None:
                assert found[f"{behaviour.name}.{setting}"].value == getattr(behaviour, setting)
    time = found["headway.time"]
    assert (time.unit, str(time.bounds)) == ("s", "more than 0 s")
    most = PRESETS["default"].most_acceleration
    assert found["options.most_acceleration"].value == most
    assert {each.source for each in found.values()} == {"preset default"}
    assert str(time) == f"headway.time = {time.value:g} s (preset default)"


def test_the_source_of_a_number_follows_it():
    with model_rules(parameters={"headway.width": 0.4}):
        model = made()
    put(model, 1.0, 2.0)
    model.set_parameters({"right_of_way.width": "0.5"}, "command line")
    term = next(each for each in model.terms if each.name == "headway")
    term.distance = 0.3
    keep = KeepDistance(weight=0.2)
    model.terms.append(keep)
    found = model.parameters()
    assert {name: each.source for name, each in found.items() if "preset" not in each.source} == {
        "headway.width": "code",
        "headway.distance": "code",
        "right_of_way.width": "command line",
        "keep_distance.weight": "code",
        "keep_distance.distance": "code",
    }
    assert (term.width, found["right_of_way.width"].value) == (0.4, 0.5)
    copied = deepcopy(model)
    assert copied.parameters() == found
    assert model.rules_used() == {
        "preset": f"default, sha256 {PRESETS['default'].digest}",
        "changed numbers": "headway.distance = 0.3 m (code); headway.width = 0.4 m (code); "
        "right_of_way.width = 0.5 m (command line); keep_distance.weight = 0.2 (code); "
        "keep_distance.distance = 1.5 m (code)",
    }


def test_a_term_for_some_types_alone_has_numbers_of_its_own():
    for_all, slow = Headway(), Headway(weight=0.5, time=2.0)
    for_all.for_types, slow.for_types = ["adult"], ["child", "older"]
    model = made(behaviors=[for_all, slow])
    assert model.parameters()["headway[adult].time"].value == 1.2
    model.set_parameters({"headway[child,older].time": 2.5})
    assert (for_all.time, slow.time) == (1.2, 2.5)


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"headwy.time": 1.0}, "unknown parameter 'headwy.time', did you mean 'headway.time'?"),
        ({"headway.ti": 1.0}, "unknown parameter 'headway.ti', did you mean 'headway.time'?"),
        ({"headway.time": 0.0}, "headway.time: 0.0, expected more than 0 s"),
        ({"headway.time": "fast"}, "headway.time: got 'fast', expected a number"),
        ({"headway.weight": math.inf}, "headway.weight: inf, expected -1e+09 to 1e+09"),
        ({"velocity_change.turning": True}, "velocity_change.turning: True, expected 1 or more"),
    ],
)
def test_bad_numbers_are_one_line_and_leave_the_model_as_it_was(values, said):
    model = made()
    before = model.parameters()
    with pytest.raises(ModelError) as no:
        model.set_parameters({"headway.width": 0.5, **values})
    assert str(no.value) == said
    assert model.parameters() == before
    for refused in (
        lambda: PRESETS["default"].with_parameters(values),
        lambda: model_rules(parameters=values).__enter__(),
    ):
        with pytest.raises(ModelError) as no:
            refused()
        assert str(no.value) == said


def test_names_that_are_like_no_other_list_the_behaviours():
    first = next(iter(PRESETS["default"].terms))
    with pytest.raises(ModelError, match=rf"'zzz', there are {first}, .*, options$"):
        made().set_parameters({"zzz": 1.0})


def test_numbers_of_options_are_given_before_a_model_is_made():
    free, limited = made(), None
    with model_rules(parameters={"options.most_acceleration": "none"}):
        limited = made()
    assert free.parameters()["options.most_acceleration"].source == "preset default"
    assert limited.rules.most_acceleration is None
    assert limited.parameters()["options.most_acceleration"].source == "code"
    limited.set_parameters({"options.most_acceleration": None})
    with pytest.raises(ModelError, match=r"^options\.most_acceleration: options are made with"):
        limited.set_parameters({"options.most_acceleration": 1.0})


def test_rules_of_a_block_replace_the_default_preset_and_end_with_it():
    mine = replace(PRESETS["default"], name="mine", durations=(12,))
    with model_rules(mine, {"headway.weight": 1.0}):
        inside, other = made(), made(preset="paper")
        with model_rules():
            innermost = made()
    outside = made()
    assert [each.preset for each in (inside, other, innermost, outside)] == [
        "mine",
        "paper",
        "default",
        "default",
    ]
    assert (inside.rules.durations, inside.rules.terms["headway"]) == ((12,), 1.0)
    assert inside.parameters()["headway.weight"].value == 1.0
    assert other.rules == PRESETS["paper"]
    assert outside.rules == PRESETS["default"]


def test_a_preset_with_other_numbers_is_another_one():
    default = PRESETS["default"]
    values = default.parameters()
    other = default.with_parameters({"headway.time": "0.6", "right_of_way.weight": 2})
    headway = {**default.settings.get("headway", {}), "time": 0.6}
    assert other.settings == {**default.settings, "headway": headway}
    assert other.terms == default.terms | {"right_of_way": 2.0}
    assert (default.source, other.source) == ("preset default", "code")
    assert default.digest != other.digest
    names = ("headway.time", "right_of_way.weight")
    back = other.with_parameters({name: values[name] for name in names})
    # What is said is as it is by default: the rules are the same.
    assert back.digest == default.digest
    assert [each.time for each in other.make_terms() if each.name == "headway"] == [0.6]
    assert default.with_parameters({}) is default


def test_settings_that_do_not_fit_together_are_refused():
    with pytest.raises(
        ModelError, match=r"right_of_way: width 0\.4 m, expected more than the bias"
    ):
        PRESETS["default"].with_parameters({"right_of_way.bias": 0.5, "right_of_way.width": 0.4})
    wider = {"right_of_way.bias": 0.5, "right_of_way.width": 0.6}
    assert PRESETS["default"].with_parameters(wider).settings["right_of_way"]["bias"] == 0.5


def test_settings_for_behaviours_that_a_preset_lacks_are_refused():
    wrong = replace(PRESETS["default"], settings={"headwy": {"time": 1.0}})
    with pytest.raises(ModelError, match="'headwy' is no behaviour of the preset, did you"):
        wrong.behaviours()
    tactic = replace(PRESETS["default"], tactics=("headway",))
    with pytest.raises(ModelError, match="tactics: 'headway' is no Tactic"):
        tactic.behaviours()


TOGETHER = ("options.most_acceleration", "right_of_way.bias", "right_of_way.width")
"""Of right_of_way, the one must exceed the other."""

NUMBERS = sorted(PRESETS["default"].parameters().keys() - TOGETHER)


def value_of(name):
    """A name and a number from 1 to 50 that it takes."""
    bounds = number_named(name).range
    high = 50.0 if bounds.high is None else min(bounds.high, 50.0)
    return st.tuples(st.just(name), st.floats(1.0, high, exclude_max=bounds.below))


@given(st.lists(st.sampled_from(NUMBERS).flatmap(value_of), max_size=6).map(dict))
def test_any_numbers_in_range_are_those_of_the_preset_afterwards(values):
    changed = PRESETS["default"].with_parameters(values)
    expected = PRESETS["default"].parameters() | values
    assert changed.parameters() == expected
    again = changed.with_parameters({name: repr(value) for name, value in values.items()})
    assert again.digest == changed.digest
