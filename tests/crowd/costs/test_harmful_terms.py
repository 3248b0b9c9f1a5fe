"""Kernels that break their word are named, not trusted."""

import math

import numpy as np
import pytest

from mesa_mobility import CompiledTerm, CostTerm, option_kernel, pair_kernel
from mesa_mobility.errors import ModelError
from tests.fixtures.maps import wanderer
from tests.fixtures.scenes import corridor, model_of


@option_kernel
def _away(option, me):
    return math.hypot(me.target_x - option.x, me.target_y - option.y)


@option_kernel
def _nearest(options, me, p):
    away = math.hypot(me.target_x - options.x, me.target_y - options.y)
    return max(away - options.radius, 0.0) + p.off


@pair_kernel
def _near(option, other, p):
    return max(1.0 - math.hypot(other.x - option.x, other.y - option.y), 0.0) - p.off


@option_kernel
def _beside(wall, p):
    return 0.1 - p.off


def term(kernel, bound=None, off=0.0):
    class Own(CompiledTerm):
        name = "own"

        def __init__(self):
            super().__init__()
            self.off = off

    Own.kernel, Own.bound = kernel, bound
    return Own()


def crowd_with(*terms):
    model = model_of(corridor(), wanderer(5, options=60), rng=3)
    model.terms += terms
    places = model.floor_plan.random_points(12, model.rng, spacing=0.6, clearance=0.3)
    model.add_pedestrians(places)
    return model


GOOD = [(_away, _nearest), (_near, None), (_beside, None)]


@pytest.mark.thorough
@pytest.mark.parametrize(("kernel", "bound"), GOOD)
def test_good_ones_pass(kernel, bound):
    model = crowd_with(term(kernel, bound))
    for _ in range(30):
        model.step()


@pytest.mark.parametrize(
    ("kernel", "bound", "off", "text"),
    [
        (_away, _nearest, 0.5, "its bound is .* for a group with option .* which costs"),
        (_near, None, 0.2, r"its kernel gives -0\.2 for option 0 and a neighbour of pedestrian"),
        (_beside, None, 0.2, r"its kernel gives -0\.1 for option 0 and a wall of pedestrian"),
    ],
)
def test_bad_ones_are_named(kernel, bound, off, text):
    with pytest.raises(ModelError, match=f"behaviour 'own': {text}"):
        crowd_with(term(kernel, bound, off)).step()


def test_one_that_is_bad_only_later_is_found_as_well():
    class Late(CompiledTerm):
        name = "late"
        kernel = _near
        off = 0.0

    model = crowd_with(Late())
    for _ in range(20):
        model.step()
    model.terms[-1].off = 0.3
    with pytest.raises(ModelError, match="behaviour 'late': its kernel gives"):
        model.run(max_seconds=20)


def test_a_cost_that_is_no_number_is_said_with_its_option():
    @option_kernel
    def slow(option):
        return 1.0 / option.speed

    with pytest.raises(
        ModelError,
        match=r"cost of option \d+ of \d+ of pedestrian \d+: not a number but inf, .*'own'",
    ):
        crowd_with(term(slow)).step()


def test_the_shipped_ones_and_those_in_numpy_are_not_looked_at(monkeypatch):
    class Zero(CostTerm):
        name = "zero"

        def cost(self, candidates):
            return np.zeros(len(candidates))

    monkeypatch.setattr(
        "mesa_mobility.crowd.planning.scheduler.check_terms", lambda *_: pytest.fail("looked at")
    )
    crowd_with(Zero()).step()
