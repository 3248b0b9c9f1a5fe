"""Terms that see fields, groups, types, time and the generator; weights by type."""

import numpy as np
import pytest

from mesa_mobility import CompiledTerm, CostTerm, PedestrianType, option_kernel, pair_kernel
from mesa_mobility.crowd import PedestrianModel, Watch
from mesa_mobility.errors import ModelError
from tests.fixtures.engine import ENGINE
from tests.fixtures.maps import wanderer
from tests.fixtures.scenes import advance, corridor, model_of


@pair_kernel(fields=("mood", "infected"))
def _avoid(option, me, other, p):
    gap = p.distance - ((other.x - option.x) ** 2 + (other.y - option.y) ** 2) ** 0.5
    return other.infected * (1.0 + me.mood) * gap if gap > 0.0 else 0.0


class Avoid(CompiledTerm):
    name = "avoid"
    kernel = _avoid
    distance = 1.5


class AvoidInNumpy(CostTerm):
    name = "avoid_in_numpy"

    def cost(self, candidates):
        rows, neighbours = candidates.pairs()
        step = candidates.neighbour_positions[neighbours] - candidates.points[rows]
        gap = np.maximum(1.5 - np.hypot(*step.T), 0.0)
        own = 1.0 + candidates.fields["mood"][candidates.owner[rows]]
        cost = candidates.neighbour_fields["infected"][neighbours] * own * gap
        return np.bincount(rows, cost, len(candidates))


@option_kernel(fields=("mood",))
def _stay(option, me):
    return me.mood * option.speed


class Stay(CompiledTerm):
    name = "stay"
    kernel = _stay


def crowd_of(*terms, **keywords):
    keywords.setdefault("fields", {"infected": bool, "mood": float})
    model = model_of(corridor(), wanderer(5, options=60), rng=3, frames_per_step=3, **keywords)
    model.terms += terms
    places = model.floor_plan.random_points(25, model.rng, spacing=0.6, clearance=0.3)
    model.add_pedestrians(places[places[:, 0] < 15.0])
    if model.crowd.fields:
        model.crowd.fields["infected"][::3] = True
        model.crowd.fields["mood"][:] = np.arange(64) % 4
    return model


def tracks(model):
    return {name: values.tobytes() for name, values in model.recorder.arrays().items()}


def test_a_kernel_takes_the_same_values_as_a_term_in_numpy():
    model = crowd_of()
    candidates = model.candidates(model.rows)
    found = Avoid().cost(candidates)
    assert found.max() > 1.0
    np.testing.assert_allclose(found, AvoidInNumpy().cost(candidates), atol=1e-9)


def test_decisions_are_those_of_the_same_term_in_numpy():
    compiled, numpy, without = crowd_of(Avoid(2.0)), crowd_of(AvoidInNumpy(2.0)), crowd_of()
    for model in (compiled, numpy, without):
        advance(model, 90)
    assert tracks(compiled) == tracks(numpy) != tracks(without)


def test_two_kernels_share_the_fields():
    model, again = crowd_of(Avoid(2.0), Stay(3.0)), crowd_of(Stay(3.0), Avoid(2.0))
    advance(model, 60)
    advance(again, 60)
    assert tracks(model) == tracks(again)
    still = [p.row for p in model.agents if p.mood == 0]
    moody = [p.row for p in model.agents if p.mood == 3]
    walked = model.crowd.x - crowd_of().crowd.x
    assert walked[still].mean() > walked[moody].mean() + 0.5


def test_the_watched_decision_has_its_cost():
    model = crowd_of(Avoid(2.0), Stay(3.0))
    model.watch = Watch(5)
    advance(model, 45)
    decision = model.watch.decision
    assert decision.terms[-2:] == ("avoid", "stay")
    best = np.where(decision.verdicts == 0, decision.totals, np.inf).min()
    assert decision.totals[decision.chosen] == pytest.approx(best)


def test_built_in_fields():
    @pair_kernel
    def kernel(me, other):
        return 1000.0 * other.group + 100.0 * me.core + me.heading + other.heading

    class Sum(CompiledTerm):
        name = "sum"

    Sum.kernel = kernel
    model = model_of(corridor(), wanderer(5))
    (one,) = model.add_pedestrians([(5.0, 1.0)], headings=[0.5])
    (other,) = model.add_pedestrians([(6.0, 1.0)], headings=[0.25], group="g")
    cost = Sum().cost(model.candidates(np.array([one.row, other.row])))
    core = 100.0 * model.crowd.core[0] + 0.75
    assert set(np.round(cost, 6)) == {round(1000.0 + core, 6), round(core, 6)}


class Seeing(CostTerm):
    name = "seeing"

    def __init__(self):
        super().__init__()
        self.bound, self.times, self.groups, self.types = [], [], [], []

    def bind(self, model):
        self.bound.append(model)

    def cost(self, candidates):
        self.times.append(candidates.time)
        self.groups += candidates.neighbour_groups.tolist()
        self.types += candidates.neighbour_types.tolist()
        return candidates.rng.random(len(candidates))


def test_a_term_is_bound_once_and_sees_time_groups_and_types():
    term = Seeing()
    maps = [wanderer(5), wanderer(6)]
    model = model_of(corridor(), maps, frames_per_step=3)
    model.terms.append(term)
    model.add_pedestrians([(5.0, 1.0)], group="a")
    model.add_pedestrians([(6.0, 1.0)], group="b", type_index=1)
    model.step()
    assert term.bound == [model]
    assert term.times[0] == 0.0
    assert (set(term.groups), set(term.types)) == ({1, 2}, {0, 1})
    advance(model, 60)
    assert term.bound == [model]
    assert max(term.times) > 1.0


def test_to_explain_draws_nothing_from_the_models_generator():
    model = crowd_of()
    model.terms.append(Seeing())
    advance(model, 3)
    before = model.rng.bit_generator.state
    model.explain(0)
    model.candidates(np.array([0])).rng.random()
    assert model.rng.bit_generator.state == before


class Down(CostTerm):
    name = "down"

    def cost(self, candidates):
        return candidates.points[:, 1]


@pytest.mark.parametrize("term", [Stay, Down])
def test_weights_by_type(term):
    """Of two types with one map, the term holds for one as if the others were not there."""

    def model_with(**weights):
        same = wanderer(5, options=60)
        types = [PedestrianType(mobility_map=same, name=name) for name in ("adult", "child")]
        model = PedestrianModel(
            corridor(),
            pedestrian_types=types,
            preset=ENGINE,
            rng=1,
            fields={"mood": float},
            record=True,
        )
        made = term(weights.pop("weight", 0.0))
        made.weight_by_type = weights
        model.terms.append(made)
        for kind in (0, 1):  # too far apart to see each other
            model.add_pedestrians([(2.0 + 12.0 * kind, 2.0)], type_index=kind, fields={"mood": 1.0})
        return model

    paths = {}
    for name, weights in (
        ("none", {}),
        ("all", {"weight": 20.0}),
        ("child", {"child": 20.0}),
        ("adult", {"weight": 20.0, "child": 0.0}),
    ):
        model = model_with(**weights)
        model.run(max_seconds=2.0)
        rows = model.recorder.arrays()
        paths[name] = [
            [rows[axis][rows["person"] == k].tolist() for axis in ("x", "y")] for k in (0, 1)
        ]
    assert paths["child"] == [paths["none"][0], paths["all"][1]]
    assert paths["adult"] == [paths["all"][0], paths["none"][1]]
    assert paths["none"][0] != paths["all"][0]
    explained = model.explain(1)
    assert explained.weights[-1] == 0.0
    with pytest.raises(ModelError, match="has a weight for the type 'elder'; the model has adult"):
        model_with(elder=1.0).step()
    with pytest.raises(ModelError, match="of 'stay' for 'child': got nan"):
        Stay().weight_by_type = {"child": float("nan")}


class ForChildren(Down):
    """A term that has nothing to say of adults."""

    def cost(self, candidates):
        assert set(candidates.types.tolist()) <= {1}
        return super().cost(candidates)


@pytest.mark.parametrize("term", [Stay, ForChildren])
def test_terms_by_type(term):
    """A term for children is as if it had weight 0 for adults, and sees no adult in NumPy."""

    def paths_of(*terms):
        same = wanderer(5, options=60)
        types = [PedestrianType(mobility_map=same, name=name) for name in ("adult", "child")]
        model = PedestrianModel(
            corridor(),
            pedestrian_types=types,
            preset=ENGINE,
            rng=1,
            fields={"mood": float},
            record=True,
        )
        model.terms += terms
        for kind in (0, 1):
            model.add_pedestrians(
                [(2.0 + 0.7 * k, 1.0 + kind) for k in range(3)],
                type_index=kind,
                fields={"mood": [1.0] * 3},
            )
        model.run(max_seconds=2.0)
        return model, tracks(model)

    limited = term(4.0)
    limited.for_types = ["child"]
    weighed = (Stay if term is Stay else Down)(0.0)
    weighed.weight_by_type = {"child": 4.0}
    model, found = paths_of(limited)
    assert found == paths_of(weighed)[1] != paths_of()[1]
    assert limited.name in model.explain(3).terms
    assert limited.name not in model.explain(0).terms


def test_one_term_with_other_numbers_for_each_type():
    def model_with(*kinds):
        same = wanderer(5)
        types = [PedestrianType(mobility_map=same, name=name) for name in ("adult", "child")]
        model = PedestrianModel(corridor(), pedestrian_types=types, preset=ENGINE, rng=1)
        model.add_pedestrians([(2.0, 2.0), (5.0, 2.0)], type_index=[0, 1])
        for weight, names in enumerate(kinds, start=1):
            term = Down(weight)
            term.for_types = names
            model.terms.append(term)
        return model

    model = model_with(["adult"], ["child"])
    model.step()
    assert [model.explain(row).weights[-1] for row in (0, 1)] == [1.0, 2.0]
    with pytest.raises(ModelError, match="terms: two of them are named 'down'"):
        model_with(["adult"], None).step()
    with pytest.raises(ModelError, match="'down': is for the type 'elder'; the model has adult"):
        model_with(["elder"]).step()
    with pytest.raises(ModelError, match=r"got 'child', expected a list such as \['child'\]"):
        Down().for_types = "child"


@pytest.mark.parametrize("weight", [1e308, -1e10, float("inf"), float("nan")])
def test_a_weight_with_which_sums_overflow_is_refused(weight):
    with pytest.raises(ModelError, match=r"weight of 'stay': got .*, expected a finite number, 1e"):
        Stay(weight=weight)
    with pytest.raises(ModelError, match=r"weight of 'stay' for 'child': got"):
        Stay().weight_by_type = {"child": weight}
    Stay(weight=1e9), Stay(weight=-1e9)


def test_what_is_refused():
    with pytest.raises(ModelError, match="takes the field 'mood', which is not declared"):
        advance(crowd_of(Stay(), fields={}), 3)
    with pytest.raises(ModelError, match="terms: two of them are named 'stay'"):
        crowd_of(Stay(), Stay()).step()
    with pytest.raises(ModelError, match=r"fields \('mood', 'mood'\), expected their names"):
        pair_kernel(fields=("mood", "mood"))(lambda me: 0.0)
    with pytest.raises(ModelError, match=r"expected none that people have .*, such as me\.group"):
        pair_kernel(fields=("mood", "group"))(lambda me: 0.0)


@option_kernel(fields=("mood",))
def _stay_at_least(options, me):
    return me.mood * options.slowest


class Bounded(Stay):
    """With a bound that takes the field as well."""

    bound = _stay_at_least


def test_a_bound_may_take_fields():
    bounded, without = crowd_of(Bounded(3.0)), crowd_of(Stay(3.0))
    for model in (bounded, without):
        advance(model, 60)
    assert tracks(bounded) == tracks(without)
