"""People in wheelchairs do not use stairs, and the model names them."""

import numpy as np
import pytest

from mesa_mobility import FloorPlan, MobilityMap, PedestrianModel, PedestrianType
from mesa_mobility.crowd.running.stall import stall_reason
from mesa_mobility.crowd.state.aggregates import EMPTY
from mesa_mobility.crowd.state.environment import Environment
from mesa_mobility.crowd.tactics.tactic import Tactic
from mesa_mobility.errors import FloorPlanError, ModelError
from mesa_mobility.floorplan import Exit
from tests.fixtures.buildings import HALL, two_storeys

OFFICE = two_storeys()
PLACES = [(3.0, 4.0), (6.0, 4.0)]
WHEELCHAIR, ADULT = PedestrianType.named("wheelchair_manual"), PedestrianType.named("able_bodied")


def model_with_people():
    """Somebody in a wheelchair and an adult on each level; the lower level comes first."""
    model = PedestrianModel(OFFICE, pedestrian_types=[WHEELCHAIR, ADULT], rng=1)
    for level in (0, 1):
        model.add_pedestrians(OFFICE.places(PLACES, level), type_index=[0, 1])
    return model


def test_maps_of_wheelchairs_do_not_climb():
    assert not WHEELCHAIR.climbs
    assert ADULT.climbs
    map_ = MobilityMap.named("able_bodied")
    assert not PedestrianType(mobility_map=map_, climbs=False).climbs
    with pytest.raises(ModelError, match="type 'x': climbs 1, expected a bool"):
        PedestrianType(mobility_map=map_, name="x", climbs=1)


def test_who_cannot_use_stairs_has_a_way_on_the_level_of_the_exits_alone():
    model = model_with_people()
    assert np.isinf(model.crowd.route[:4]).tolist() == [False, False, True, False]
    assert model.without_stairs == [2]


FLIGHT = next(each for each in OFFICE.flights if each.name == "south")
FOOT = np.array(FLIGHT.foot).mean(axis=0)


class ToTheStair(Tactic):
    """Everybody aims at a place 2 m up the straight stair, as drawn on the lower level."""

    name = "to_the_stair"

    def apply(self, deciding, desired):
        desired.points = np.tile(FOOT - 2.0 * FLIGHT.down, (len(desired.points), 1))


@pytest.mark.parametrize("kind", [WHEELCHAIR, ADULT])
def test_steps_are_walls_for_those_who_do_not_climb(kind):
    model = PedestrianModel(OFFICE, pedestrian_types=[kind], rng=1)
    model.tactics.append(ToTheStair())
    model.bind()
    model.add_pedestrians([FOOT + 1.5 * FLIGHT.down])
    past = []
    for _ in range(80):
        model.step()
        past.append((FOOT - (model.crowd.x[0], model.crowd.y[0])) @ FLIGHT.down)
    # A wheelchair comes as near as its core of 0.35 m allows.
    if kind is ADULT:
        assert max(past) > 1.0
    else:
        assert -0.6 < max(past) < -0.35


def test_nobody_is_put_on_stairs_who_does_not_use_them():
    model = PedestrianModel(OFFICE, pedestrian_types=[WHEELCHAIR, ADULT], rng=1)
    on = [FOOT - 0.5 * FLIGHT.down]
    with pytest.raises(FloorPlanError, match="1 of 1 people have no way to any exit") as refused:
        model.add_pedestrians(on, type_index=[0])
    assert "\n" not in str(refused.value)
    model.add_pedestrians(on, type_index=[1])


def test_stairs_make_no_difference_to_a_floor_plan():
    plan = FloorPlan(HALL, exits=[Exit("out", (0, 3), (0, 5))])
    model = PedestrianModel(plan, pedestrian_types=[WHEELCHAIR, ADULT], rng=1)
    model.add_pedestrians(PLACES, type_index=[0, 1])
    assert model.without_stairs == []
    around = model._scene.environment.surroundings
    assert (len(around.steps), around.most_walls) == (0, len(around.segments) + 1)
    assert Environment(plan, reach=2.0, core_radii=[0.2, 0.2], climbs=[True, False]).bodies == 1


def test_a_stalled_evacuation_names_those_left_upstairs():
    assert stall_reason(OFFICE.floor_plan, EMPTY, (), [2, 7]) == (
        "nobody inside has a way to go: people 2 and 7 cannot use stairs"
    )
    assert stall_reason(OFFICE.floor_plan, EMPTY) == "nobody inside has a way to go"
