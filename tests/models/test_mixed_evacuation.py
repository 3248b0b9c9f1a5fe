"""People of all types on a floor of a care home, and mixed people in the other models."""

import numpy as np
import pytest
from mesa_mobility.models import Auditorium, Doorway, MixedEvacuation, OpenSpace, StraightWalk
from mesa_mobility.models.mixed_evacuation import STORES, care_home_plan, room_floor

from mesa_mobility import PedestrianType
from mesa_mobility.distributions import Uniform
from mesa_mobility.errors import FloorPlanError, ModelError
from mesa_mobility.populations import Population
from mesa_mobility.results import Trajectories, by_type, check_safety
from tests.fixtures.maps import shipped_map


def people(wide: float = 0.25) -> Population:
    """Adults, and others as wide as a wheelchair."""
    adult = PedestrianType(mobility_map=shipped_map(), name="adult")
    chair = PedestrianType(
        mobility_map=shipped_map(), name="wide", core_radius=0.35, preferred_speed=Uniform(0.6, 1)
    )
    return Population({adult: 1.0 - wide, chair: wide})


def test_widths_of_doors():
    widths = {gate.name: round(gate.length, 9) for gate in care_home_plan().gates}
    assert len(widths) == 15
    assert {name.rsplit(" ", 1)[0] for name, width in widths.items() if width == 0.8} == {
        "store door"
    }
    assert sorted(set(widths.values())) == [0.8, 0.95, 1.2, 1.4]
    assert [round(exit_.length, 9) for exit_ in care_home_plan().exits] == [1.4, 1.8]


@pytest.mark.parametrize("seed", [1, 2])
def test_all_get_out_whole(seed):
    model = MixedEvacuation(pedestrians=40, population=people(), record=True, rng=seed)
    assert np.bincount(model.crowd.type_index[:40]).tolist() == [30, 10]
    places = np.array([person.position for person in model.agents])
    wide = model.core_radii == 0.35
    stores = [room_floor(room).bounds for room in STORES]
    for x0, y0, x1, y1 in stores:
        x, y = places[wide].T
        assert not ((x >= x0) & (x <= x1) & (y >= y0) & (y <= y1)).any()
    model.run(max_seconds=300)
    trajectories = Trajectories.of(model)
    safety = check_safety(trajectories, model.floor_plan.walls, model.floor_plan.free)
    assert (model.inside, safety.overlaps, safety.wall_crossings) == (0, 0, 0)
    table = by_type(trajectories)
    assert table["left"].tolist() == [30, 10]
    assert table.loc["wide", "mean_speed_mps"] < table.loc["adult", "mean_speed_mps"]


def test_the_ramp_slows_people_down():
    factors = care_home_plan(0.5).speed_factors(np.array([(34.0, 6.3), (20.0, 6.3)]))
    assert factors.tolist() == [0.5, 1.0]
    assert care_home_plan(1.0).zones == ()


def test_more_people_than_it_holds():
    with pytest.raises(ModelError, match="pedestrians: got 101, expected 1 to 100"):
        MixedEvacuation(pedestrians=101, population=people())


@pytest.mark.thorough
def test_in_the_auditorium_wide_people_are_before_the_seats_and_exit_doors_wider():
    model = Auditorium(pedestrians=100, population=people(0.05), rng=1)
    places = np.array([person.position for person in model.agents])
    wide = model.core_radii == 0.35
    assert wide.sum() == 5
    assert (places[wide, 1] < 3.5).all()
    doors = {gate.name: gate.length for gate in model.floor_plan.gates}
    assert doors["left exit door"] == pytest.approx(0.9)
    with pytest.raises(FloorPlanError, match=r"no way to any exit.* ways there have gaps"):
        Auditorium(pedestrians=100, population=people(0.05), exit_door=0.65, rng=1)
    narrow = Auditorium(pedestrians=20, population=people(0.0), rng=1).floor_plan
    assert {gate.name: gate.length for gate in narrow.gates}["left exit door"] == pytest.approx(0.7)


@pytest.mark.thorough
def test_in_the_auditorium_wheelchairs_are_clear_of_the_first_row():
    """Half a wheelchair, 0.35 m, and the widest person on foot, 0.25 m, from where people stand."""
    for seed in range(1, 6):
        model = Auditorium(pedestrians=600, population=people(0.04), rng=seed)
        places = np.array([person.position for person in model.agents])
        wide = model.core_radii == 0.35
        hall = places[~wide & (places[:, 1] < 24.0)]
        apart = np.hypot(*(places[wide][:, None] - hall).transpose(2, 0, 1))
        assert apart.min() > 0.6


@pytest.mark.parametrize("model", [Doorway, OpenSpace, StraightWalk])
def test_every_model_takes_a_population(model):
    made = model(pedestrians=40, population=people(), rng=1)
    assert np.bincount(made.crowd.type_index[:40]).tolist() == [30, 10]
    # Everybody has the speeds of its type.
    slow = made.crowd.agenda["speed"][:40][made.core_radii == 0.35]
    assert ((slow >= 0.6) & (slow <= 1.0)).all()
