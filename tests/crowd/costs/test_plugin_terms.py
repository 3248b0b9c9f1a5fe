"""Cost terms brought by others: plain NumPy or compiled, alone and beside those that ship."""

import math

import numpy as np
import pytest
from mesa_mobility.behaviors import (
    Displacement,
    FacingDeviation,
    Headway,
    Interference,
    PreferredSpeed,
    PreferredVelocity,
    RightOfWay,
    TargetDistance,
)

from mesa_mobility import Candidates, CompiledTerm, CostTerm, FloorPlan, option_kernel, pair_kernel
from mesa_mobility.errors import ModelError
from tests.fixtures.maps import make_map, shipped_map, stand, straight, strider, wanderer
from tests.fixtures.oracle import Oracle
from tests.fixtures.oracle_costs import equation_one
from tests.fixtures.scenes import advance, corridor, model_of, put, two_doors


class KeepRight(CostTerm):
    """Metres to the left of the line y = 2."""

    name = "keep_right"

    def cost(self, candidates: Candidates) -> np.ndarray:
        return np.maximum(candidates.points[:, 1] - 2.0, 0.0)


class Distance(CostTerm):
    """D of equation (1)."""

    name = "distance_in_numpy"

    def cost(self, candidates):
        return np.linalg.norm(candidates.points - candidates.targets[candidates.owner], axis=1)


class Deviation(CostTerm):
    """theta of equation (1)."""

    name = "deviation_in_numpy"

    def cost(self, candidates):
        aim = candidates.targets[candidates.owner] - candidates.points
        turn = np.arctan2(aim[:, 1], aim[:, 0]) - candidates.headings
        return np.abs(np.arctan2(np.sin(turn), np.cos(turn)))


class Speed(CostTerm):
    """|S - v0 t| 1.5 / t."""

    name = "speed_in_numpy"

    def cost(self, candidates):
        wanted = candidates.preferred_speeds[candidates.owner]
        return 1.5 * np.abs(candidates.speeds - wanted)


class Near(CostTerm):
    """P of equation (2), summed over neighbours."""

    name = "interference_in_numpy"

    def cost(self, candidates):
        rows, neighbours = candidates.pairs()
        gap = candidates.predicted(rows, neighbours) - candidates.points[rows]
        heading, speed = candidates.headings[rows], candidates.speeds[rows]
        ahead = gap[:, 0] * np.cos(heading) + gap[:, 1] * np.sin(heading) >= 0.0
        counts = ahead & (speed > 0.0)
        cost = np.zeros(len(rows))
        distance = np.hypot(*gap[counts].T)
        cost[counts] = 10.5 * np.exp(-distance / (0.09 * speed[counts]))
        return np.bincount(rows, weights=cost, minlength=len(candidates))


class Velocity(CostTerm):
    """|S - v0 e t| 1.5 / t."""

    name = "velocity_in_numpy"

    def cost(self, candidates):
        start = candidates.positions[candidates.owner]
        aim = candidates.targets[candidates.owner] - start
        away = np.linalg.norm(aim, axis=1)
        wanted = candidates.preferred_speeds[candidates.owner] / away
        velocity = (candidates.points - start) / candidates.durations[:, None]
        return 1.5 * np.linalg.norm(velocity - wanted[:, None] * aim, axis=1)


class Room(CostTerm):
    """Too fast for the room ahead, summed over neighbours."""

    name = "headway_in_numpy"

    def cost(self, candidates):
        term = Headway()
        rows, neighbours = candidates.pairs()
        gap = candidates.predicted(rows, neighbours) - candidates.points[rows]
        c, s = np.cos(candidates.headings[rows]), np.sin(candidates.headings[rows])
        me = candidates.owner[rows]
        aim = candidates.targets[me] - candidates.positions[me]
        aim = aim / np.hypot(*aim.T)[:, None]
        stands = candidates.speeds[rows] * candidates.durations[rows] <= 0.01
        c, s = np.where(stands, aim[:, 0], c), np.where(stands, aim[:, 1], s)
        ahead, aside = gap[:, 0] * c + gap[:, 1] * s, gap[:, 1] * c - gap[:, 0] * s
        share = np.maximum(1.0 - np.abs(aside) / term.width, 0.0) * (ahead > 0.0)
        excess = candidates.speeds[rows] - (ahead - term.distance) / term.time
        cost = 1.5 * share * np.maximum(excess, 0.0)
        return np.bincount(rows, weights=cost, minlength=len(candidates))


class Way(CostTerm):
    """On the way of those who come towards one or have less far to go, summed over neighbours."""

    name = "right_of_way_in_numpy"

    def cost(self, candidates):
        term = RightOfWay()
        rows, near = candidates.pairs()
        me, e = candidates.owner[rows], candidates.neighbour_directions[near]
        place = candidates.points[rows] - candidates.neighbour_positions[near]
        aim = candidates.targets[me] - candidates.positions[me]
        along = (place * e).sum(axis=1)
        aside = place[:, 1] * e[:, 0] - place[:, 0] * e[:, 1]
        oncoming = (aim * e).sum(axis=1) < -0.5 * np.hypot(*aim.T)
        first = (candidates.leads[near] > 0.0) & (along < term.ahead)
        counts = (along > 0.0) & (oncoming | first)
        off = np.where(oncoming, np.abs(aside + term.bias) / (term.width + abs(term.bias)),
                       np.abs(aside) / term.width)  # fmt: skip
        cost = np.where(counts, np.maximum(1.0 - off, 0.0), 0.0)
        cost = cost * np.where(oncoming, 1.0, term.beside)
        return np.bincount(rows, weights=cost, minlength=len(candidates))


@option_kernel
def _left(x, y, ux, uy, duration, speed, sx, sy, tx, ty, preferred, p):
    return p[0] * max(y - p[1], 0.0)


class CompiledKeepRight(CompiledTerm):
    """``KeepRight`` as a kernel with parameters: cost per metre, and where the line is."""

    name = "keep_right_compiled"
    kernel = _left

    def __init__(self, weight=None, per_metre: float = 1.0, line: float = 2.0) -> None:
        super().__init__(weight)
        self.per_metre, self.line = per_metre, line

    def parameters(self) -> tuple[float, ...]:
        return (self.per_metre, self.line)


@pair_kernel
def _alike(x, y, ux, uy, duration, speed, sx, sy, tx, ty, nx, ny, nvx, nvy, nex, ney, lead, p):
    return abs(speed - math.hypot(nvx, nvy))


class SameSpeed(CompiledTerm):
    """Difference between the option's speed and each neighbour's."""

    name = "same_speed"
    kernel = _alike


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


def walk(plan: FloorPlan, map_, terms, people: int = 12, seconds: float = 40.0) -> bytes:
    """All positions and headings of a run, as bytes."""
    model = model_of(plan, map_, behaviors=terms, rng=7, frames_per_step=3)
    model.add_pedestrians(plan.random_points(people, model.rng, spacing=0.6, clearance=0.3))
    model.run(max_seconds=seconds)
    rows = model.recorder.arrays()
    assert len(rows["x"]) > 500
    return b"".join(rows[name].tobytes() for name in ("frame", "person", "x", "y", "heading"))


def ours() -> list[CostTerm]:
    return [TargetDistance(1.0), FacingDeviation(0.5), PreferredSpeed(2.0), Interference(1.0)]


def test_the_order_of_terms_changes_nothing():
    runs = {walk(two_doors(), shipped_map(), [*ours()[k:], *ours()[:k]]) for k in range(4)} | {
        walk(two_doors(), shipped_map(), ours()[::-1])
    }
    assert len(runs) == 1


def test_the_order_of_terms_changes_nothing_where_some_are_plain_numpy():
    terms = [KeepRight(0.3), TargetDistance(), Near(), Speed(2.0), FacingDeviation(0.5)]
    runs = {walk(two_doors(), shipped_map(), order) for order in (terms, terms[::-1])}
    assert len(runs) == 1


@pytest.mark.parametrize(
    ("place", "twin"), [(0, Distance(1.0)), (1, Deviation(0.5)), (2, Speed(2.0)), (3, Near(1.0))]
)
def test_the_same_term_compiled_and_in_numpy_give_the_same_trajectories(place, twin):
    terms = ours()
    compiled = walk(two_doors(), shipped_map(), ours())
    terms[place] = twin
    assert walk(two_doors(), shipped_map(), terms) == compiled


def test_all_terms_in_numpy_give_the_same_trajectories():
    plain = [Distance(1.0), Deviation(0.5), Speed(2.0), Near(1.0)]
    compiled = walk(two_doors(), shipped_map(), ours())
    assert walk(two_doors(), shipped_map(), plain) == compiled


@pytest.mark.parametrize(("place", "twin"), [(2, Velocity(2.0)), (4, Room(2.0)), (5, Way(1.0))])
def test_terms_of_the_default_give_the_same_trajectories_in_numpy(place, twin):
    def terms():
        return [TargetDistance(1.0), FacingDeviation(0.5), PreferredVelocity(2.0),
                Interference(1.0), Headway(2.0), RightOfWay(1.0)]  # fmt: skip

    compiled = walk(two_doors(), shipped_map(), terms())
    others = terms()
    others[place] = twin
    assert walk(two_doors(), shipped_map(), others) == compiled
    del others[place]
    assert walk(two_doors(), shipped_map(), others) != compiled


def test_costs_add_up():
    # A term twice at half its weight is the term once.
    terms = [TargetDistance(0.5), FacingDeviation(0.5), TargetDistance(0.5), PreferredSpeed(2.0),
             Interference(0.5), Interference(0.5)]  # fmt: skip
    assert walk(two_doors(), shipped_map(), terms) == walk(two_doors(), shipped_map(), ours())


def test_a_term_of_weight_nought_counts_for_nothing():
    terms = [*ours(), KeepRight(0.0), CompiledKeepRight(0.0), SameSpeed(0.0)]
    assert walk(two_doors(), shipped_map(), terms) == walk(two_doors(), shipped_map(), ours())


@pytest.mark.parametrize("near", [Interference, Near])
@pytest.mark.parametrize("weight", [-0.5, 3.0])
def test_interference_of_any_weight_is_chosen_by_the_whole_sum(near, weight):
    # A negative weight (people who flock) makes the sum of the other terms an upper bound.
    plan = two_doors()
    terms = [TargetDistance(), FacingDeviation(0.5), PreferredSpeed(2.0), near(weight)]
    model = model_of(plan, wanderer(31), behaviors=terms, rng=3)
    model.add_pedestrians(plan.random_points(12, model.rng, spacing=0.5, clearance=0.3))
    oracle = Oracle(model, equation_one(w_d=1.0, w_theta=0.5, w_v=2.0, w_p=weight))
    while model.running and model.frame < 120:
        for decision in oracle.step():
            assert decision.fault() is None, (decision.frame, decision.person.row)


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
