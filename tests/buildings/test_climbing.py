"""People in wheelchairs do not use stairs, and the model names them."""

import numpy as np
import pytest

from mesa_mobility import FloorPlan, MobilityMap, PedestrianModel, PedestrianType
from mesa_mobility.crowd.running.stall import stall_reason
from mesa_mobility.crowd.state.aggregates import EMPTY
from mesa_mobility.crowd.state.environment import Environment
from mesa_mobility.errors import ModelError
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


def test_stairs_make_no_difference_to_a_floor_plan():
    plan = FloorPlan(HALL, exits=[Exit("out", (0, 3), (0, 5))])
    model = PedestrianModel(plan, pedestrian_types=[WHEELCHAIR, ADULT], rng=1)
    model.add_pedestrians(PLACES, type_index=[0, 1])
    assert model.without_stairs == []
    assert Environment(plan, reach=2.0, core_radii=[0.2, 0.2], climbs=[True, False]).bodies == 1


def test_a_stalled_evacuation_names_those_left_upstairs():
    assert stall_reason(OFFICE.floor_plan, EMPTY, (), [2, 7]) == (
        "nobody inside has a way to go: people 2 and 7 cannot use stairs"
    )
    assert stall_reason(OFFICE.floor_plan, EMPTY) == "nobody inside has a way to go"
