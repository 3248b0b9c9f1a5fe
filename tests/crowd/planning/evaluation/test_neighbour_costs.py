"""Costs of options from neighbours, and when an approximation suffices."""

import numpy as np
import pytest
from mesa_mobility.behaviors import Headway, Interference, RightOfWay
from numba import njit

from mesa_mobility import Option, Other
from mesa_mobility.crowd.collision.sampled import Decider
from mesa_mobility.crowd.planning.evaluation.lanes import fill_lane, pick_between
from mesa_mobility.crowd.planning.evaluation.neighbour_costs import ENOUGH, pair_cost
from mesa_mobility.crowd.planning.evaluation.relevant_neighbours import select_relevant
from mesa_mobility.crowd.planning.evaluation.term_table import compile_terms
from mesa_mobility.crowd.planning.workspace import make_neighbours
from tests.fixtures.records import me

NEIGHBOURS = 21


@njit
def _cost(own, ends, count, moved, neighbours, known, enough, table):
    fill_lane(count, neighbours.others)
    return pair_cost(own, 0, ends, count, moved, neighbours, known, enough, table)


@njit
def _select(me, count, neighbours):
    return select_relevant(me, count, neighbours)


@njit
def _pick(bounds, above, up_to, first, picked):
    return pick_between(bounds, above, up_to, first, picked)


@pytest.fixture
def cost():
    """A function of what is enough, the term to begin with and what is known; costs by term."""
    rng = np.random.default_rng(8)
    record = np.array([0.0, 0.0, 5.0, 0.0, 0.0, 0.0, 0.0, 0.14, np.inf, 1.0, 0.0])
    own = Decider(0, 0, 0.0, 0.0, 1.0, 0.0, 0.14, record)
    ends = np.array([0.9, 0.1, 1.0, 0.0, 0.8, 1.1]).reshape(6, 1)
    neighbours = make_neighbours(24, 2, 0)  # pace and tread are fields of the pedestrian
    others = neighbours.others
    others[:] = 0.0
    others[:2, :NEIGHBOURS] = rng.uniform(-1.5, 2.5, (2, NEIGHBOURS))
    others[4, :NEIGHBOURS] = -1.0
    others[6, :NEIGHBOURS] = 1.0
    terms = [Interference(weight=1000.0), Headway(weight=2.0), RightOfWay(weight=3.0)]
    compiled, _ = compile_terms(terms)

    def of(enough, first, moved=0, known=(0.0, 0.0, 0.0)):
        neighbours.first[0] = first
        given = own, ends, NEIGHBOURS, moved, neighbours, np.array(known), enough, compiled.pair
        return _cost(*given), neighbours.first[0]

    ground = [1.0, 0.0]
    each = [
        term.weight
        * sum(
            term.kernel.value(
                option=Option(*ends[:, 0]),
                me=term.kernel.kinds["me"](*me(), *ground[: len(term.kernel.declared)]),
                other=Other(*others[:7, a], 0.0, 0.0, 0.0, 0.0),
                p=term,
            )
            for a in range(NEIGHBOURS)
        )
        for term in terms
    ]
    return of, each, own, neighbours


def test_the_sum_does_not_depend_on_the_term_to_begin_with(cost):
    of, each, *_ = cost
    assert min(each) > 0.1
    found = {of(np.inf, first)[0] for first in range(3)}
    assert len(found) == 1
    assert found.pop() == pytest.approx(sum(each), rel=1e-6)


def test_a_sum_ends_with_the_term_that_makes_it_enough(cost):
    of, each, *_ = cost
    for first in range(3):
        second = (first + 1) % 3
        assert of(0.9 * each[first], first) == (ENOUGH, first)
        assert of(each[first] + 0.5 * each[second], first) == (ENOUGH, second)
        assert of(0.999 * sum(each), first) == (ENOUGH, (first + 2) % 3)
        assert of(1.001 * sum(each), first)[0] == pytest.approx(sum(each), rel=1e-6)


def test_a_sum_ends_early_where_much_of_it_is_known(cost):
    of, each, *_ = cost
    for first in range(3):
        known = [0.9 * of_term for of_term in each]
        assert of(0.9 * sum(each) + 0.09 * each[first], first, 0, known) == (ENOUGH, first)
        assert of(np.inf, first, 0, known) == of(np.inf, first)


def test_a_sum_is_the_same_to_the_last_bit_where_the_relevant_come_first(cost):
    of, _, own, neighbours = cost
    before, others = of(np.inf, 0), neighbours.others[:7, :NEIGHBOURS].copy()
    relevant = _select(own, NEIGHBOURS, neighbours)
    assert 1 < relevant < NEIGHBOURS
    moved = neighbours.moved[:relevant]
    assert (np.diff(moved) > 0).all()
    assert moved[-1] >= relevant
    assert (neighbours.others[:7, :relevant] == others[:, moved]).all()
    assert sorted(neighbours.others[0, :NEIGHBOURS]) == sorted(others[0])
    assert of(np.inf, 0, relevant) == before


def test_groups_are_picked_by_their_bounds():
    bounds = np.array([3.0, 1.0, np.inf, 2.0, 1.5, 0.5, 2.5, 2.0, 1.0, 2.0, 9.0] + [2.0] * 8)
    picked = np.zeros(30, dtype=np.int64)
    # The last 8 are room to read.
    assert _pick(bounds[:11], 1.0, 2.0, 100, picked) == 4
    assert picked[:4].tolist() == [103, 104, 107, 109]
