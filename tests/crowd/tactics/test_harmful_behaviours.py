"""What behaviours must not do is refused, and names them."""

import numpy as np
import pytest

from mesa_mobility import CostTerm, SpeedRule, Tactic, TargetChoice
from mesa_mobility.errors import ModelError
from tests.fixtures.maps import strider
from tests.fixtures.scenes import corridor, model_of, put


class Meddling(Tactic):
    """Does something to what it is given."""

    name = "meddling"

    def __init__(self, do):
        self.do = do

    def apply(self, deciding, desired):
        self.do(deciding, desired)


class MeddlingRule(SpeedRule):
    """Takes all rows for another's."""

    name = "meddling"

    def speeds(self, deciding, speeds):
        deciding.pedestrians[:] = 10**6
        return speeds


class MeddlingChoice(TargetChoice):
    """Takes all rows for another's."""

    name = "meddling"

    def targets(self, deciding):
        deciding.pedestrians[:] = 10**6
        return deciding.site.targets(deciding.positions, deciding.destinations)


def fill(get, value):
    def do(deciding, desired):
        get(deciding)[:] = value

    return do


@pytest.mark.parametrize(
    ("get", "name"),
    [
        (lambda deciding: deciding.pedestrians, "pedestrians"),
        (lambda deciding: deciding.positions, "positions"),
        (lambda deciding: deciding.destinations, "destinations"),
        (lambda deciding: deciding.inside.pedestrians, "inside.pedestrians"),
    ],
)
def test_what_a_tactic_is_given_stays_as_it_is(get, name):
    model = model_of(corridor(), strider())
    model.add_tactic(Meddling(fill(get, 10**6)))
    with pytest.raises(ModelError, match=rf"^behaviour 'meddling': changed deciding\.{name} in "):
        put(model, 2.0, 2.0)


def test_the_same_for_speed_rules_and_target_choices():
    model = model_of(corridor(), strider())
    model.speed_rules.append(MeddlingRule())
    with pytest.raises(ModelError, match=r"^behaviour 'meddling': changed deciding\.pedestrians"):
        put(model, 2.0, 2.0)
    model = model_of(corridor(), strider(), target_choice=MeddlingChoice())
    with pytest.raises(ModelError, match=r"^behaviour 'meddling': changed deciding\.pedestrians"):
        put(model, 2.0, 2.0)


@pytest.mark.parametrize("what", ["points", "speeds"])
def test_wishes_changed_in_place_are_looked_at_too(what):
    def do(deciding, desired):
        getattr(desired, what)[:] = np.nan

    model = model_of(corridor(), strider())
    model.add_tactic(Meddling(do))
    with pytest.raises(ModelError, match=r"^behaviour 'meddling': gave points or speeds out of"):
        put(model, 2.0, 2.0)


class Zero(CostTerm):
    """Costs nothing."""

    name = "zero"

    def bind(self, model):
        self.model = model

    def cost(self, candidates):
        return np.zeros(len(candidates))


class Nameless(CostTerm):
    """Costs nothing either."""

    def cost(self, candidates):
        return np.zeros(len(candidates))


@pytest.mark.parametrize(
    ("term", "text"),
    [
        (Zero, "terms: got <class .*Zero'>, expected an object of a CostTerm"),
        ("zero", "terms: got 'zero', expected an object of a CostTerm"),
        (Nameless(), "terms: Nameless has the name None, expected a text"),
    ],
)
def test_what_is_no_behaviour_is_refused(term, text):
    model = model_of(corridor(), strider())
    model.terms.append(term)
    with pytest.raises(ModelError, match=f"^{text}"):
        put(model, 2.0, 2.0)


def test_one_that_keeps_its_model_serves_one_model_at_a_time():
    term = Zero()
    first, second = (model_of(corridor(), strider()) for _ in range(2))
    for model in (first, second):
        model.terms.append(term)
        put(model, 2.0, 2.0)
        model.run(max_seconds=1)
    second.run(max_seconds=3)
    with pytest.raises(ModelError, match=r"^behaviour 'zero': serves another model by now"):
        first.run(max_seconds=3)
