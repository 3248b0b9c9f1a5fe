"""Cost terms brought by others change what people choose."""

import math

import numpy as np
import pytest
from mesa_mobility.behaviors import Displacement, TargetDistance

from mesa_mobility import CompiledTerm, CostTerm, option_kernel
from tests.fixtures.maps import make_map, stand, straight, strider
from tests.fixtures.plugin_terms import CompiledKeepRight, KeepOff, KeepRight, SameSpeed
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


def test_settings_reach_the_kernel():
    # The line at y = 1: of 1.72 and 0.28 m beyond it only the right option's are cheap.
    assert turns_to([TargetDistance(), CompiledKeepRight(per_metre=0.5, line=1.0)]) == -1.0
    assert turns_to([TargetDistance(), CompiledKeepRight(per_metre=-0.5, line=1.0)]) == +1.0
    # Beyond y = 9 there is nothing to pay for: as without the term.
    assert turns_to([TargetDistance(), CompiledKeepRight(line=9.0)]) == turns_to([TargetDistance()])


def test_kernels_can_be_evaluated_as_any_term(whole):
    options = put(model_of(corridor(), fork(), preset=whole), 5.0, 2.0).movement_options()
    expected = np.zeros(len(options))
    expected[np.argmax(options.points[:, 1])] = 1.5 * math.sin(0.5)  # all others stand or go right
    assert CompiledKeepRight().cost(options) == pytest.approx(expected, abs=1e-6)
    assert KeepRight().cost(options) == pytest.approx(expected, abs=1e-6)


def test_pair_kernels_are_summed_over_neighbours(in_parts):
    model = model_of(corridor(), strider(), preset=in_parts)
    person = put(model, 5.0, 2.0)
    put(model, 6.0, 1.0)
    put(model, 7.0, 3.0)
    # Options at 0 and 1.25 m/s, a half and a quarter of that; two neighbours that stand.
    expected = [0.0] * 4 + [0.625, 1.25] + [2.5] * 3
    costs = sorted(SameSpeed().cost(person.movement_options()))
    assert costs == pytest.approx(expected, abs=1e-6)


def by_reach(term, person) -> list[float]:
    """Costs of somebody's options, that of the shortest first."""
    options = person.movement_options()
    return term.cost(options)[np.argsort(options.displacements)].tolist()


def test_wall_kernels_count_for_the_worst_wall(whole):
    # From (0.4, 1) to the right by 0, 0.5, 1 and 1.875 m. The core of 0.15 m has 0.85 m to the wall
    # below all the time, and 0.25, 0.75, 1.25 and 2.125 m to the one behind; a metre is wanted.
    person = put(model_of(corridor(), strider(), preset=whole), 0.4, 1.0)
    assert by_reach(KeepOff(), person) == pytest.approx([0.75, 0.25, 0.15, 0.15], abs=1e-6)
    assert by_reach(KeepOff(wanted=0.5), person) == pytest.approx([0.5, 0.0, 0.0, 0.0], abs=1e-6)


def test_wall_kernels_see_walls_that_an_option_could_touch(whole):
    # The longest option leads 1.875 m, the core is 0.15 m: a wall is seen from 2.035 m on.
    model = model_of(corridor(), strider(), preset=whole)
    near, far = (put(model, x, y, math.pi / 2) for x, y in ((5.0, 1.97), (8.0, 1.96)))
    assert by_reach(KeepOff(), near) == pytest.approx([0.0, 0.0, 0.12, 0.995], abs=1e-6)
    assert by_reach(KeepOff(), far) == [0.0] * 4
    # In the open there is nothing to pay for.
    wide = model_of(corridor(length=20.0, width=20.0), strider(), preset=whole)
    assert by_reach(KeepOff(), put(wide, 10.0, 10.0)) == [0.0] * 4


def test_an_exit_that_does_not_lead_out_is_a_wall_to_wall_kernels(whole):
    model = model_of(corridor(both_ends=True), strider(), preset=whole)
    closed = put(model, 0.9, 1.8, exits=["east"])
    open_ = put(model, 0.9, 2.2)
    # The core has 0.75 m to it and more; to the walls beside it more than a metre.
    assert by_reach(KeepOff(), closed) == pytest.approx([0.25, 0.0, 0.0, 0.0])
    assert by_reach(KeepOff(), open_) == [0.0] * 4


@pytest.mark.parametrize(("weight", "side"), [(0.5, 1.0), (-0.5, -1.0)])
def test_a_wall_term_changes_the_choice(weight, side):
    # 1.5 m from the wall on the right. Either way is as far from the target.
    terms = [TargetDistance(), KeepOff(weight)]
    person = put(model_of(corridor(), fork(), behaviors=terms), 5.0, 1.5)
    advance(person.model, 45)
    assert np.sign(person.position[1] - 1.5) == side


@option_kernel
def _as_fast(option, me, p):
    return p.factor * abs(option.speed - math.hypot(me.vx, me.vy))


class AsFast(CompiledTerm):
    """Difference between the speed of the option and that of the movement before."""

    name = "as_fast"
    kernel = _as_fast
    factor = 2.0


def test_kernels_may_take_the_velocity_of_the_movement_before(whole):
    # At 1.25 m/s from the first step on; people who have not moved yet have no velocity.
    model = model_of(corridor(), strider(), behaviors=[TargetDistance(), AsFast(9.0)], preset=whole)
    person = put(model, 1.0, 2.0)
    assert by_reach(AsFast(), person) == pytest.approx([0.0, 2.5, 2.5, 2.5], abs=1e-6)
    # Setting off would cost more than it gains, so it stands; nothing stops one who walks.
    advance(model, 96)
    assert person.position.tolist() == [1.0, 2.0]
    model.terms[1].weight = 0.0
    advance(model, 45)
    model.terms[1].weight = 9.0
    assert by_reach(AsFast(), person) == pytest.approx([2.5, 0.0, 0.0, 0.0], abs=1e-6)
    advance(model, 90)
    assert person.position[0] == pytest.approx(1.0 + 4.5 * 1.25, abs=1e-5)


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
