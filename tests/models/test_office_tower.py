"""People of all types leave an office tower."""

import numpy as np
import pytest
from mesa_mobility.models import OfficeTower
from mesa_mobility.models.office_tower import office_tower

from mesa_mobility.results import Trajectories, check_safety
from mesa_mobility.results.engineering.summary import figures_of_storeys


def test_the_tower_has_two_stairs_between_storeys_and_a_lift_to_all():
    tower = office_tower(4)
    assert [level.elevation for level in tower.levels] == pytest.approx([0.0, 3.4, 6.8, 10.2])
    assert len(tower.stairs) == 2 * 3
    assert tower.lifts[0].numbers == (0, 1, 2, 3)
    assert tower.exits(0) == ("exit 1", "exit 2")


def test_every_storey_has_its_share_of_people():
    model = OfficeTower(pedestrians=50, storeys=4, rng=1)
    _, levels = model.building.true_places([person.position for person in model.agents])
    assert sorted(np.unique(levels, return_counts=True)[1].tolist()) == [12, 12, 13, 13]


def test_all_get_out_those_in_wheelchairs_by_the_lift():
    population = "able_bodied: 0.85, wheelchair_powered: 0.15"
    model = OfficeTower(pedestrians=40, storeys=3, population=population, record=True, rng=2)
    _, levels = model.building.true_places([person.position for person in model.agents])
    upstairs = levels > 0
    climbs = np.array([person.pedestrian_type.climbs for person in model.agents])
    model.run(max_seconds=600)
    assert model.inside == 0
    assert model.lifts.carried.tolist() == [int((upstairs & ~climbs).sum())]
    assert model.lifts.carried[0] > 2
    plan = model.floor_plan
    tracks = Trajectories.of(model)
    assert check_safety(tracks, plan.walls, plan.free, building=model.building).passed
    figures = figures_of_storeys(tracks, model.building)
    assert [each["level"] for each in figures["by_level"]] == [2, 1, 0]
    assert len(figures["by_stairs"]) == 4
    [lift] = figures["by_lift"]
    assert lift["people"] == lift["down"] == model.lifts.carried[0]
    assert (lift["lift"], lift["up"]) == ("lift", 0)
    assert lift["most"] <= model.building.lifts[0].capacity
    log = model.lifts.log.begun
    assert lift["rides"] == len(log)
    # The doors close and open in 3 s each; the car takes as long as its way at full speed.
    assert lift["mean_ride_s"] > 6.0 + 3.4 / model.building.lifts[0].speed
    assert lift["longest_wait_s"] >= lift["mean_wait_s"] > 0.0
