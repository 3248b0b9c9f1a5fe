"""What people and models take when they are set, numbers that are none, and what is printed."""

from __future__ import annotations

import math

import numpy as np
import pytest
from mesa_mobility.behaviors import Counter, FamiliarExit, Headway, NearestExit, Queueing, Sign

from mesa_mobility import (
    CostTerm,
    Exit,
    FloorPlan,
    Pedestrian,
    PedestrianModel,
    PedestrianType,
    Source,
    SpeedZone,
    TargetChoice,
    Visit,
)
from mesa_mobility.distributions import Normal
from mesa_mobility.errors import MobilityError, ModelError
from tests.fixtures.maps import strider

NO_NUMBERS = [True, "1", None, math.nan]


def hall(**keywords) -> PedestrianModel:
    plan = FloorPlan(
        "POLYGON ((0 0, 10 0, 10 8, 0 8, 0 0))", exits=[Exit("door", (10, 3), (10, 5))], name="hall"
    )
    return PedestrianModel(plan, mobility_map=strider(), rng=1, **keywords)


# -- people and models -------------------------------------------------------------------------


class Guest(Pedestrian):
    """Somebody with attributes of their own, one of them much like a setting."""

    groups: int

    def __init__(self, model, row):
        super().__init__(model, row)
        self.exit, self.colour = None, "red"

    def step(self):
        self.steps = getattr(self, "steps", 0) + 1
        self.exit = self.groups = self.steps


def test_misspelt_settings_of_a_person_are_refused_and_own_attributes_are_not():
    model = hall(pedestrian_class=Guest, fields={"infected": bool})
    (guest,) = model.add_pedestrians([(2, 4)])
    model.step()
    guest.mood = 3
    assert (guest.exit, guest.groups, guest.steps, guest.mood) == (1, 1, 1, 3)
    for name, meant in (("prefered_speed", "preferred_speed"), ("infectd", "infected")):
        with pytest.raises(ModelError, match=f"pedestrian 0: no attribute '{name}'.*'{meant}'"):
            setattr(guest, name, 1)
        assert not hasattr(guest, name)


@pytest.mark.parametrize("value", [*NO_NUMBERS, [1.0]])
def test_what_is_no_number_is_refused_by_name(value):
    zone = "POLYGON ((1 1, 2 1, 2 2, 1 2, 1 1))"
    model = hall()
    (person,) = model.add_pedestrians([(2, 4)])

    def speed():
        person.preferred_speed = value

    for name, given in {
        "preferred_speed": speed,
        "headings": lambda: model.add_pedestrians([(3, 4)], headings=[value]),
        "preferred_speeds": lambda: model.add_pedestrians([(3, 4)], preferred_speeds=[value]),
        "pre_movement": lambda: model.add_pedestrians([(3, 4)], pre_movement=[value]),
        "positions|place on the floor": lambda: model.add_pedestrians([(value, "4")]),
        "wait": lambda: person.wait(value),
        "max_seconds": lambda: model.run([value] if value is None else value),
        "stay": lambda: Visit((3, 4), stay=value),
        "start": lambda: Source(area=zone, rate=1.0, start=value),
        "rate": lambda: Source(area=zone, rate=value),
        "times": lambda: Source(area=zone, times=[value, "3"]),
        "core_radius": lambda: PedestrianType(mobility_map=strider(), core_radius=value),
        "factor": lambda: SpeedZone(zone, value),
        "exit": lambda: Exit("a", (value, 1), (2, 3)),
        "spacing": lambda: Counter([(0, 0), (1, 0)], 3.0, spacing=value),
        "facing": lambda: Sign((1, 1), value, ["gate"]),
        "Normal": lambda: Normal(value, 1.0),
    }.items():
        if name in ("headings", "preferred_speeds", "pre_movement") and value == [1.0]:
            continue
        with pytest.raises(MobilityError, match=name) as refused:
            given()
        assert "\n" not in str(refused.value), name
    assert model.population.count == 1


def test_headings_whose_digits_are_lost_are_refused():
    with pytest.raises(ModelError, match=r"headings: got 1e\+308, expected radians"):
        hall().add_pedestrians([(2, 4)], headings=[1e308])


@pytest.mark.parametrize("seconds", [math.nan, -5, "3", True])
def test_a_run_takes_seconds(seconds):
    with pytest.raises(ModelError, match=r"max_seconds: got .*expected seconds, 0 or more"):
        hall().run(max_seconds=seconds)


@pytest.mark.parametrize(
    ("name", "value", "says"),
    [
        (
            "target_choice",
            NearestExit,
            "target_choice: got <class .*NearestExit'>, expected",
        ),
        ("target_choice", Queueing(), r"target_choice: got Queueing\(\), expected an object of a"),
        ("tactics", [Queueing], "tactics: got <class .*Queueing"),
        ("terms", Headway(), r"terms: got Headway\(weight=1.5\), expected a list"),
        ("speed_rules", 3, "speed_rules: got 3, expected a list"),
        ("frames_per_step", True, "frames_per_step: got True, expected 1 to"),
        ("frames_per_step", 0, "frames_per_step: got 0, expected 1 to"),
        ("target_choise", NearestExit(), "no attribute 'target_choise', did you mean 'target_choi"),
        ("frame_per_step", 1, "no attribute 'frame_per_step', did you mean 'frames_per_step'"),
    ],
)
def test_what_a_model_takes(name, value, says):
    model = hall()
    with pytest.raises(ModelError, match=says):
        setattr(model, name, value)
    model.own, model._tactic = 1, 2
    for argument, given in (("target_choice", NearestExit), ("behaviors", [Headway])):
        with pytest.raises(ModelError, match="got <class"):
            hall(**{argument: given})


def test_a_class_is_no_tactic():
    with pytest.raises(ModelError, match=r"add_tactic: got <class .*Queueing"):
        hall().add_tactic(Queueing)


class WithTactic(PedestrianModel):
    """A model with an attribute much like a setting."""

    def __init__(self, width=8.0):
        plan = FloorPlan(
            f"POLYGON ((0 0, 10 0, 10 {width}, 0 {width}, 0 0))",
            exits=[Exit("d", (10, 3), (10, 5))],
        )
        self.tactic = Queueing()
        super().__init__(plan, mobility_map=strider())
        self.tactics_ = [self.tactic]


def test_a_models_constructor_sets_what_it_likes():
    assert isinstance(WithTactic(6.0).tactic, Queueing)
    with pytest.raises(TypeError, match="widht"):
        WithTactic(widht=3.0)


# -- what is printed ---------------------------------------------------------------------------


class Nameless(CostTerm):
    def cost(self, candidates):
        return np.zeros(len(candidates))


class Aim(TargetChoice):
    name = "aim"

    def targets(self, deciding):
        raise NotImplementedError


def test_what_is_printed_fits_on_a_line():
    model = hall(frames_per_step=1)
    (person,) = model.add_pedestrians([(2, 4)])
    shown = {
        model: "<PedestrianModel: 1 person, 1 inside, 0.0 s>",
        person: "<Pedestrian 0 at (2.00, 4.00), 0.00 m/s>",
        model.floor_plan: "<FloorPlan 'hall': 80 m2, exits: 1, gates: 0>",
        model.floor_plan.exits[0]: "Exit(name='door', a=(10.0, 3.0), b=(10.0, 5.0))",
        Headway(weight=2.6, time=1.0): "Headway(weight=2.6, time=1.0)",
        Queueing(): "Queueing()",
        Queueing([Counter([(0, 0), (1, 0)], 3.0)]): "Queueing(counters=[1 Counter])",
        FamiliarExit(["door"]): "FamiliarExit(familiar=['door'])",
        Nameless(): "Nameless(weight=1)",
        Aim(): "Aim()",
    }
    for thing, text in shown.items():
        assert repr(thing) == text
    kind = repr(model.pedestrian_types[0])
    assert kind.startswith("<PedestrianType 'made by hand', <MobilityMap 'made by hand': ")
    assert len(kind) < 200
    person.remove()
    assert repr(person) == "<Pedestrian 0, not inside>"
    assert repr(PedestrianModel.__new__(PedestrianModel)).endswith("not made yet>")
