"""Common properties of all models that ship."""

import inspect

import numpy as np
import pytest
from mesa_mobility.models import (
    Auditorium,
    Doorway,
    MixedEvacuation,
    OfficeTower,
    OpenSpace,
    StraightWalk,
)

from mesa_mobility import FloorPlan, PedestrianModel
from mesa_mobility.errors import FloorPlanError, MapError, MobilityError, ModelError
from mesa_mobility.plugins.registry import load_model
from tests.fixtures.maps import shipped_map, strider
from tests.fixtures.scenes import same_rows

MODELS = {
    "straight_walk": StraightWalk,
    "open_space": OpenSpace,
    "doorway": Doorway,
    "auditorium": Auditorium,
    "mixed_evacuation": MixedEvacuation,
    "office_tower": OfficeTower,
}

models = pytest.mark.parametrize("model", MODELS.values())


def small(model, **keywords):
    return model(pedestrians=12, mobility_map=strider(), **keywords)


@pytest.mark.parametrize("name", MODELS)
def test_registered(name):
    assert load_model(name) is MODELS[name]


@models
def test_parameters_are_keywords_with_defaults_and_say_their_types(model):
    parameters = inspect.signature(model).parameters
    assert all(p.kind is p.POSITIONAL_OR_KEYWORD for p in parameters.values())
    assert all(p.default is not p.empty for p in parameters.values())
    assert all(p.annotation is not p.empty for p in parameters.values())
    defaults = {name: parameter.default for name, parameter in parameters.items()}
    assert defaults["preset"] == "default"
    assert defaults["mobility_map"] is None
    assert defaults["frames_per_step"] == 3
    assert defaults["record"] is False
    assert defaults["rng"] is None
    assert "scenario" not in defaults


@pytest.mark.thorough
@models
@pytest.mark.parametrize("preset", ["default", "paper"])
def test_starts_with_everybody_standing_clear_of_walls_and_each_other(model, preset):
    made = small(model, preset=preset, rng=1)
    assert isinstance(made, PedestrianModel)
    assert isinstance(made.floor_plan, FloorPlan)
    assert made.preset == preset
    assert made.running
    assert made.elapsed == 0.0
    assert made.inside == 12
    assert same_rows(made)
    places = np.array([person.position for person in made.agents])
    assert made.floor_plan.contains(places).all()
    gaps = np.hypot(*(places[:, None] - places).transpose(2, 0, 1))
    core = made.core_radii[0]
    assert gaps[~np.eye(12, dtype=bool)].min() > 2 * core
    walls = made.floor_plan.walls
    a, b = walls[:, :2], walls[:, 2:]
    for place in places:
        share = np.clip(((place - a) * (b - a)).sum(1) / ((b - a) ** 2).sum(1), 0.0, 1.0)
        nearest = a + share[:, None] * (b - a)
        assert np.hypot(*(place - nearest).T).min() > core


@models
def test_steps_by_the_frames_asked_for(model):
    made = small(model, rng=1, frames_per_step=5)
    made.step()
    assert made.frame == 5
    assert made.recorder is None


@models
def test_the_map_may_be_a_file(model, tmp_path):
    strider().save(tmp_path / "small.npz")
    made = model(pedestrians=3, mobility_map=str(tmp_path / "small.npz"), rng=1)
    assert made.pedestrian_types[0].name == "made by hand"
    assert made.capabilities[0].map.n_options == 8


@pytest.mark.thorough
@pytest.mark.parametrize(
    "model", [each for each in MODELS.values() if each not in (MixedEvacuation, OfficeTower)]
)
def test_the_map_that_ships_is_the_default(model):
    made = model(pedestrians=1, rng=1)
    assert made.pedestrian_types[0].name == "able_bodied"
    assert made.capabilities[0].map.n_options == shipped_map().n_options


BAD = [
    *((model, {"pedestrians": n}, "pedestrians") for model in MODELS.values() for n in (0, -5)),
    *((model, {"preset": "quick"}, "preset 'quick'.*paper") for model in MODELS.values()),
    *((model, {"frames_per_step": 0}, "frames_per_step") for model in MODELS.values()),
    (StraightWalk, {"slowest": 0.0}, "slowest"),
    (StraightWalk, {"slowest": float("nan")}, "slowest"),
    (StraightWalk, {"slowest": 1.6}, "slowest"),
    (StraightWalk, {"fastest": float("nan")}, "fastest"),
    (StraightWalk, {"fastest": float("inf")}, "fastest"),
    (StraightWalk, {"length": 2.0}, "length"),
    (StraightWalk, {"length": float("nan")}, "length"),
    (OpenSpace, {"size": 5.0}, "size"),
    (OpenSpace, {"size": float("nan")}, "size"),
    (Doorway, {"door_width": 0.3}, "door_width"),
    (Doorway, {"door_width": 9.0}, "door_width"),
    (Doorway, {"door_width": float("nan")}, "door_width"),
    (Auditorium, {"pedestrians": 5000}, "pedestrians: got 5000"),
    (Auditorium, {"exit_door": 0.3}, "exit_door: got 0.3"),
    (OfficeTower, {"storeys": 1}, "storeys: got 1"),
    (OfficeTower, {"pedestrians": 2000}, "pedestrians: got 2000"),
    (MixedEvacuation, {"ramp_factor": 0.0}, "ramp_factor: got 0"),
    (MixedEvacuation, {"ramp_factor": 1.5}, "ramp_factor: got 1.5"),
    (MixedEvacuation, {"ramp_factor": float("nan")}, "ramp_factor: got nan"),
]


@pytest.mark.parametrize(("model", "wrong", "match"), BAD)
def test_parameters_out_of_range_are_refused_in_one_line(model, wrong, match):
    with pytest.raises(ModelError, match=match) as refused:
        model(**{"mobility_map": strider(), **wrong})
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("model", "wrong"),
    [
        (Doorway, {"pedestrians": 2000}),
        (OpenSpace, {"pedestrians": 400, "size": 10.0}),
    ],
)
def test_more_people_than_fit_are_refused_with_how_many_would(model, wrong):
    with pytest.raises(FloorPlanError, match=r"room for \d+ of \d+") as refused:
        model(mobility_map=strider(), rng=1, **wrong)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("model", "wrong"),
    [(StraightWalk, {"length": float("inf")}), (OpenSpace, {"size": float("inf")})],
)
def test_floors_without_end_are_refused_in_one_line(model, wrong):
    with pytest.raises(MobilityError) as refused:
        model(mobility_map=strider(), **wrong)
    assert "\n" not in str(refused.value)


@models
def test_a_map_that_is_not_there(model):
    with pytest.raises(MapError, match=r"nowhere\.npz"):
        model(mobility_map="nowhere.npz")


@models
def test_names_that_no_parameter_has(model):
    with pytest.raises(TypeError):
        model(crowd=10)
