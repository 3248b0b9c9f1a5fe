"""Cost terms brought by others change what people choose."""

import math

import numpy as np
import pytest
from mesa_mobility.behaviors import Displacement, TargetDistance

from mesa_mobility import CostTerm
from tests.fixtures.maps import make_map, stand, straight, strider
from tests.fixtures.plugin_terms import CompiledKeepRight, KeepRight, SameSpeed
from tests.fixtures.scenes import advance, corridor, model_of, put


def fork():
    """Stand, or 1.5 m half a radian to the left or to the right."""
    return make_map([[stand(), *(straight(1.5, 45, towards=t, to=0) for t in (0.5, -0.5))]])


def turns_to(terms) -> float:
    """To which side somebody goes whose options lead left and right."""
    person = put(model_of(corridor(), fork(), behaviors=terms), 5.0, 2.0)
    advance(person.model, 45)
    return float(np.sign(person.position[1] - 2.0))


@pytest.mark.parametrize("term", [KeepRight, CompiledKeepRight])
def test_a_term_changes_the_choice(term):
    assert turns_to([TargetDistance(), term(+0.5)]) == -1.0
    assert turns_to([TargetDistance(), term(-0.5)]) == +1.0


def test_parameters_reach_the_kernel():
    # The line at y = 1: of 1.72 and 0.28 m beyond it only the right option's are cheap.
    assert turns_to([TargetDistance(), CompiledKeepRight(per_metre=0.5, line=1.0)]) == -1.0
    assert turns_to([TargetDistance(), CompiledKeepRight(per_metre=-0.5, line=1.0)]) == +1.0
    # Beyond y = 9 there is nothing to pay for: as without the term.
    assert turns_to([TargetDistance(), CompiledKeepRight(line=9.0)]) == turns_to([TargetDistance()])


def test_kernels_can_be_evaluated_as_any_term():
    options = put(model_of(corridor(), fork()), 5.0, 2.0).movement_options()
    expected = np.zeros(len(options))
    expected[np.argmax(options.points[:, 1])] = 1.5 * math.sin(0.5)  # all others stand or go right
    assert CompiledKeepRight().cost(options) == pytest.approx(expected, abs=1e-6)
    assert KeepRight().cost(options) == pytest.approx(expected, abs=1e-6)


def test_pair_kernels_are_summed_over_neighbours():
    model = model_of(corridor(), strider())
    person = put(model, 5.0, 2.0)
    put(model, 6.0, 1.0)
    put(model, 7.0, 3.0)
    # Options at 0 and 1.25 m/s, a half and a quarter of that; two neighbours that stand.
    expected = [0.0] * 4 + [0.625, 1.25] + [2.5] * 3
    costs = sorted(SameSpeed().cost(person.movement_options()))
    assert costs == pytest.approx(expected, abs=1e-6)


def test_weights_may_change_while_a_model_runs():
    term = KeepRight(+5.0)
    model = model_of(corridor(length=60.0, width=20.0), fork(), behaviors=[Displacement(), term])
    person = put(model, 5.0, 10.0)
    advance(model, 45)
    assert person.position[1] < 10.0
    lowest = person.position[1]
    term.weight = -5.0
    advance(model, 45)
    assert person.position[1] > lowest


def test_terms_may_come_and_go_while_a_model_runs():
    model = model_of(corridor(length=60.0, width=20.0), fork(), behaviors=[Displacement()])
    person = put(model, 5.0, 10.0)
    term = KeepRight()
    for sign in (-1.0, 1.0):
        model.terms.append(term)
        term.weight = -10.0 * sign
        before = person.position[1]
        advance(model, 45)
        assert np.sign(person.position[1] - before) == sign
        model.terms.remove(term)


def test_a_model_without_terms_still_walks_within_its_walls():
    model = model_of(corridor(), strider(), behaviors=[])
    person = put(model, 19.0, 2.0, exits=None)
    advance(model, 12)
    assert model.inside == 0 or person.position[0] >= 19.0


def test_a_term_sees_everybody_who_decides_once():
    seen: list[np.ndarray] = []

    class Witness(CostTerm):
        name = "witness"

        def cost(self, candidates):
            seen.append(candidates.pedestrians.copy())
            return np.zeros(len(candidates))

    model = model_of(corridor(length=60.0, width=30.0), strider(), behaviors=[Witness()])
    places = [(1.0 + x, 1.0 + y) for x in range(20) for y in range(28)]
    model.add_pedestrians(places, headings=np.zeros(len(places)))
    advance(model, 1)
    assert sorted(np.concatenate(seen).tolist()) == list(range(560))
