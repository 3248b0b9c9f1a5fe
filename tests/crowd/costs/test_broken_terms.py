"""Terms that give no usable costs are refused."""

import math

import numpy as np
import pytest
from mesa_mobility.behaviors import Stepping, TargetDistance

from mesa_mobility import CompiledTerm, CostTerm, option_kernel, pair_kernel
from mesa_mobility.errors import ModelError
from tests.fixtures.maps import strider
from tests.fixtures.plugin_terms import SameSpeed
from tests.fixtures.scenes import corridor, model_of, put


@pytest.mark.parametrize(
    "wrong",
    [
        lambda c: np.zeros(len(c) + 1),
        lambda c: np.zeros((len(c), 2)),
        lambda c: np.full(len(c), np.nan),
        lambda c: np.where(np.arange(len(c)) == 0, np.inf, 0.0),
        lambda c: 1.0,
    ],
)
def test_costs_that_are_not_one_finite_number_an_option_are_refused(wrong):
    class Broken(CostTerm):
        name = "broken_term"

        def cost(self, candidates):
            return wrong(candidates)

    model = model_of(corridor(), strider(), behaviors=[TargetDistance(), Broken()])
    n = len(put(model, 1.0, 2.0).movement_options())
    with pytest.raises(ModelError, match=rf"broken_term.*\b{n}\b") as refused:
        model.step()
    assert "\n" not in str(refused.value)


@pair_kernel
def _broken_beside_others(other):
    return math.sqrt(-1.0 - other.lead * other.lead)


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_the_error_of_a_cost_that_is_no_number_names_term_and_option(value):
    class Broken(CostTerm):
        name = "broken_term"

        def cost(self, candidates):
            costs = np.zeros(len(candidates))
            costs[2:] = value
            return costs

    model = model_of(corridor(), strider(), behaviors=[TargetDistance(), Broken()])
    put(model, 1.0, 2.0)
    says = rf"'broken_term': gave a cost of {value} for option 2 of \d+, expected finite numbers"
    with pytest.raises(ModelError, match=says):
        model.step()


@pytest.mark.parametrize("away", [0.8, 4.0])
def test_a_kernel_over_neighbours_that_gives_no_number_is_refused(away):
    # Near ones are looked at before, far ones once an option may win.
    class Broken(CompiledTerm):
        name = "broken_kernel"
        kernel = _broken_beside_others

    model = model_of(corridor(), strider(), behaviors=[TargetDistance(), Broken()])
    put(model, 1.0, 2.0)
    put(model, 1.0 + away, 2.0)
    with pytest.raises(ModelError, match=r"not a number.*broken_kernel"):
        model.step()


@option_kernel
def _broken_beside_walls(wall, p):
    return 1.0 / math.sqrt(p.sign * (wall.y1 - 2.0))


@pytest.mark.parametrize("weight", [1.0, -1.0])
@pytest.mark.parametrize("sign", [1.0, -1.0, 0.0])
def test_a_kernel_over_walls_that_gives_no_number_is_refused(sign, weight):
    # Of the walls at y = 0 and y = 4 one gives no number and the other 0.71; or both infinity.
    class Broken(CompiledTerm):
        name = "broken_kernel"
        kernel = _broken_beside_walls

    Broken.sign = sign
    model = model_of(corridor(), strider(), behaviors=[TargetDistance(), Broken(weight)])
    person = put(model, 5.0, 2.0)
    assert not np.isfinite(Broken().cost(person.movement_options())).any()
    with pytest.raises(ModelError, match=r"pedestrian 0: not a number.*broken_kernel") as refused:
        model.step()
    assert "\n" not in str(refused.value)


def test_a_term_must_say_what_it_costs():
    class Vague(CostTerm):
        name = "vague"

    with pytest.raises(TypeError):
        Vague()


@pytest.mark.parametrize(
    ("kernel", "bound", "says"),
    [
        (Stepping.kernel, Stepping.kernel, "its bound is a OptionKernel, expected a BoundKernel"),
        (SameSpeed.kernel, Stepping.bound, "has a bound and a PairKernel, expected an Option"),
        (Stepping.bound, None, "its kernel is a BoundKernel, expected what option_kernel or pair"),
        (abs, None, "its kernel is a builtin_function_or_method, expected what option_kernel"),
    ],
)
def test_kernels_of_another_kind_are_refused(kernel, bound, says):
    class Mixed(CompiledTerm):
        name = "mixed"
        length = 0.4

    Mixed.kernel, Mixed.bound = kernel, bound
    model = model_of(corridor(), strider(), behaviors=[Mixed()])
    put(model, 2.0, 2.0)
    with pytest.raises(ModelError, match=rf"^behaviour 'mixed': {says}"):
        model.step()
