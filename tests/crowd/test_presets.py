import numpy as np
import pytest
from mesa_mobility.behaviors import (
    Displacement,
    FacingDeviation,
    Interference,
    PreferredVelocity,
    TargetDistance,
)
from mesa_mobility.models import Doorway

from mesa_mobility import PedestrianModel
from mesa_mobility.crowd import PRESETS
from mesa_mobility.errors import ModelError
from mesa_mobility.plugins.registry import load_behavior
from tests.fixtures.maps import make_map, stand, straight, strider, wanderer
from tests.fixtures.oracles.counting import overlaps
from tests.fixtures.scenes import advance, corridor, model_of, put, two_doors


def weights(model):
    return {type(term): term.weight for term in model.terms}


def test_there_are_two():
    assert set(PRESETS) == {"default", "paper"}


def test_the_default_says_where_it_comes_from_has_few_rules_and_empties_a_room():
    rules = PRESETS["default"]
    assert len(rules.terms) == 8
    assert len(rules.tactics) == 5
    assert len(rules.provenance.data) == 5
    # 60 people and two doors in a row, at 0.5 to 3 persons/s.
    model = Doorway(pedestrians=60, rng=1)
    model.run(max_seconds=120.0)
    assert model.inside == 0
    assert 20.0 < model.elapsed < 120.0


def test_the_papers_terms_and_its_options_of_45_frames():
    model = model_of(corridor(), strider(), preset="paper")
    assert model.preset == "paper"
    assert set(weights(model)) == {TargetDistance, FacingDeviation, Displacement, Interference}
    # Section 6: w_P = 1 for those not behind.
    assert weights(model)[Interference] == 1.0
    person = put(model, 1.0, 2.0)
    assert person.movement_options().durations == pytest.approx([1.5])


def test_the_default_has_a_preferred_velocity_in_place_of_displacement_and_shorter_options():
    model = model_of(corridor(), strider(), preset="default")
    assert model.preset == "default"
    rules = PRESETS["default"]
    assert weights(model) == {load_behavior(name): rules.terms[name] for name in rules.terms}
    assert PreferredVelocity in weights(model)
    assert Displacement not in weights(model)
    assert min(rules.terms.values()) > 0.0
    assert min(rules.durations) < 45
    # Stand and half a metre in 12 frames, a metre in 24 and 1.875 in 45; whole, and each part of
    # those of its rank. Parts that leave nothing of the ground end in place alike: one is kept.
    options = put(model, 1.0, 2.0).movement_options()
    by_frames = {12: [0.0, 0.5], 24: [1.0], 45: [1.875]}
    ranks = [(frames / 30, by_frames[frames]) for frames in sorted(rules.durations)]
    expected = [(seconds, metres) for seconds, whole in ranks for metres in whole]
    for (seconds, whole), own in zip(ranks, rules.shares, strict=False):
        for share in own:
            kept = whole if share > 0.0 else whole[:1]
            expected += [(seconds, share * metres) for metres in kept]
    found = zip(options.durations.tolist(), options.displacements.tolist(), strict=True)
    np.testing.assert_allclose(sorted(found), sorted(expected), atol=1e-6)


def test_the_constants_of_the_paper_wherever_there_is_interference():
    found = {
        name: (term.a, term.b)
        for name, rules in PRESETS.items()
        for term in rules.make_terms()
        if isinstance(term, Interference)
    }
    assert "paper" in found
    assert set(found.values()) == {(10.5, 0.09)}


@pytest.mark.parametrize(("preset", "through"), [("paper", True), ("default", False)])
def test_bodies_are_hard_in_the_default_only(preset, through):
    # Two who can but walk straight at each other, 1.5 m apart, at 2/3 m/s.
    steps = [straight(frames / 45, frames, to=0) for frames in (12, 24, 45)]
    map_ = make_map([[stand(), stand(45), *steps]])
    model = model_of(corridor(length=8.0, both_ends=True), map_, preset=preset)
    put(model, 3.25, 2.0, 0.0, exits=["east"], preferred_speeds=[0.7])
    put(model, 4.75, 2.0, 3.141592653589793, exits=["west"], preferred_speeds=[0.7])
    advance(model, 180)
    rows = model.recorder.arrays()
    assert rows["x"][rows["person"] == 0].max() > 3.5  # they do walk
    assert (overlaps(rows, 0.15, tolerance=0.0) > 0) == through


def test_decisions_of_the_paper_last_45_frames_or_4():
    plan = two_doors()
    model = model_of(plan, wanderer(4), preset="paper", rng=4)
    people = model.add_pedestrians(plan.random_points(15, model.rng, spacing=0.6, clearance=0.3))
    lengths = set()
    for _ in range(200):
        deciding = [p for p in people if p in model.agents and p.next_decision < 1e-9]
        model.step()
        lengths |= {round(p.next_decision * 30) + 1 for p in deciding if p in model.agents}
    assert lengths <= {45, 4}
    assert 45 in lengths


def test_each_model_has_terms_of_its_own():
    one, other = (model_of(corridor(), strider(), preset="default") for _ in range(2))
    one.terms[0].weight = 99.0
    assert other.terms[0].weight == PRESETS["default"].terms[other.terms[0].name]


def test_terms_of_ones_own_replace_the_presets():
    model = model_of(corridor(), strider(), behaviors=[Displacement(3.0)])
    assert weights(model) == {Displacement: 3.0}


def test_an_unknown_preset_is_refused_with_the_names_there_are():
    with pytest.raises(ModelError, match=r"'fast'.*paper.*default|'fast'.*default.*paper") as no:
        PedestrianModel(corridor(), preset="fast", mobility_map=strider())
    assert "\n" not in str(no.value)


def test_the_paper_needs_options_of_45_frames():
    with pytest.raises(ModelError, match="45"):
        model_of(corridor(), make_map([[stand(), straight(0.5, 12, to=0)]]), preset="paper")
