"""Terms that give no usable costs are refused."""

import math

import numpy as np
import pytest
from mesa_mobility.behaviors import TargetDistance

from mesa_mobility import CompiledTerm, CostTerm, pair_kernel
from mesa_mobility.errors import ModelError
from tests.fixtures.maps import strider
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
    put(model, 1.0, 2.0)
    with pytest.raises(ModelError, match=r"broken_term.*9") as refused:
        model.step()
    assert "\n" not in str(refused.value)


@pair_kernel
def _broken_beside_others(
    x, y, ux, uy, duration, speed, sx, sy, tx, ty, nx, ny, nvx, nvy, nex, ney, lead, p
):
    return math.sqrt(-1.0 - lead * lead)


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_a_cost_that_is_no_number_is_told_with_term_and_option(value):
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


def test_a_term_must_say_what_it_costs():
    class Vague(CostTerm):
        name = "vague"

    with pytest.raises(TypeError):
        Vague()
