"""Kernels that break their word are named, not trusted."""

import math

import numpy as np
import pytest

from mesa_mobility import (
    CompiledTerm,
    CostTerm,
    bound_kernel,
    option_kernel,
    pair_bound_kernel,
    pair_kernel,
    wall_kernel,
)
from mesa_mobility.crowd.costs.kernel_reads import parameters_read
from mesa_mobility.errors import ModelError
from tests.fixtures.maps import wanderer
from tests.fixtures.scenes import corridor, model_of


@option_kernel
def _away(x, y, ux, uy, duration, speed, sx, sy, tx, ty, preferred, p):
    return math.hypot(tx - x, ty - y)


@bound_kernel
def _nearest(x, y, radius, ux, uy, turn, duration, low, high, sx, sy, tx, ty, preferred, p):
    return max(math.hypot(tx - x, ty - y) - radius, 0.0) + p[0]


@pair_kernel
def _near(x, y, ux, uy, duration, speed, sx, sy, tx, ty, nx, ny, nvx, nvy, nex, ney, lead, p):
    return max(1.0 - math.hypot(nx - x, ny - y), 0.0) - p[0]


@pair_bound_kernel
def _near_at_least(
    x, y, radius, ux, uy, turn, duration, low, high, sx, sy, tx, ty, nx, ny, nvx, nvy, nex, ney,
    lead, p,
):  # fmt: skip
    return max(1.0 - radius - math.hypot(nx - x, ny - y), 0.0) + p[1]


@wall_kernel
def _beside(x, y, ux, uy, duration, speed, sx, sy, tx, ty, x1, y1, x2, y2, core, p):
    return 0.1 - p[0]


def term(kernel, bound=None, numbers=(0.0, 0.0)):
    class Own(CompiledTerm):
        name = "own"

        def parameters(self):
            return numbers

    Own.kernel, Own.bound = kernel, bound
    return Own()


def crowd_with(*terms):
    model = model_of(corridor(), wanderer(5, options=60), rng=3)
    model.terms += terms
    places = model.floor_plan.random_points(12, model.rng, spacing=0.6, clearance=0.3)
    model.add_pedestrians(places)
    return model


GOOD = [(_away, _nearest), (_near, _near_at_least), (_near, None), (_beside, None)]


@pytest.mark.thorough
@pytest.mark.parametrize(("kernel", "bound"), GOOD)
def test_good_ones_pass(kernel, bound):
    model = crowd_with(term(kernel, bound))
    for _ in range(30):
        model.step()


@pytest.mark.parametrize(("kernel", "bound", "numbers", "text"), [
    (_away, _nearest, (0.5, 0.0), "its bound is .* for a group with option .* which costs"),
    (_near, _near_at_least, (0.0, 0.5), "its bound is .* for a group with option"),
    (_near, None, (0.2, 0.0), r"its kernel gives -0\.2 for option 0 and a neighbour of pedestrian"),
    (_beside, None, (0.2, 0.0), r"its kernel gives -0\.1 for option 0 and a wall of pedestrian"),
])  # fmt: skip
def test_bad_ones_are_named(kernel, bound, numbers, text):
    with pytest.raises(ModelError, match=f"behaviour 'own': {text}"):
        crowd_with(term(kernel, bound, numbers)).step()


def test_one_that_is_bad_only_later_is_found_as_well():
    class Late(CompiledTerm):
        name = "late"
        kernel = _near
        less = 0.0

        def parameters(self):
            return (self.less,)

    model = crowd_with(Late())
    for _ in range(20):
        model.step()
    model.terms[-1].less = 0.3
    with pytest.raises(ModelError, match="behaviour 'late': its kernel gives"):
        model.run(max_seconds=20)


def test_parameters_past_the_end():
    assert parameters_read(_near_at_least.function) == {1}
    assert parameters_read(_away.function) == set()
    with pytest.raises(ModelError, match=r"reads parameters\[1\], but parameters\(\) gives 1 num"):
        crowd_with(term(_near, _near_at_least, (0.0,))).step()

    @option_kernel
    def before(x, y, ux, uy, duration, speed, sx, sy, tx, ty, preferred, p):
        return p[-1]

    with pytest.raises(ModelError, match=r"reads parameters\[-1\], but parameters\(\) gives 2 num"):
        crowd_with(term(before)).step()


def test_a_cost_that_is_no_number_is_said_with_its_option():
    @option_kernel
    def slow(x, y, ux, uy, duration, speed, sx, sy, tx, ty, preferred, p):
        return 1.0 / speed

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


def test_a_function_of_other_arguments_is_refused_with_their_names():
    with pytest.raises(
        ModelError,
        match=r"^kernel forgot: takes 2 arguments, expected 12: x, y, facing_x, .*parameters$",
    ):

        @option_kernel
        def forgot(x, y):
            return 0.0

    def tall(*all_of_them):
        return 0.0

    with pytest.raises(ModelError, match="kernel tall: takes 0 arguments, expected 16: x, y"):
        wall_kernel(tall)
    with pytest.raises(ModelError, match=r"expected 20: .*lead, mood, neighbour_mood, parameters"):
        pair_kernel(_near.function, fields=["mood"])
    with pytest.raises(ModelError, match=r"expected 14: .*preferred_speed, own_vx, own_vy, param"):
        option_kernel(_away.function, own_velocity=True)


@pytest.mark.parametrize("others", [0, 1])
def test_a_computed_index_past_the_end_gives_no_number(others):
    @option_kernel
    def past(x, y, ux, uy, duration, speed, sx, sy, tx, ty, preferred, p):
        total = 0.0
        for k in range(3):
            total += p[k]
        return total

    # Another term with more parameters does not lend it any.
    more = [term(_beside, None, (0.0,) * 6), term(past, None, (1.0, 1.0))]
    more[0].__class__.name = "other"
    with pytest.raises(ModelError, match=r"not a number but nan, .*'own'"):
        crowd_with(*more[1 - others :]).step()
