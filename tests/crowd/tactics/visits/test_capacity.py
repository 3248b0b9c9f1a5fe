"""Places that hold a number of people at once."""

import copy

import numpy as np
import pytest
from shapely import Point, box

from mesa_mobility import PedestrianModel, Visit
from mesa_mobility.errors import ModelError
from mesa_mobility.results import Trajectories, check_safety
from tests.crowd.tactics.visits.test_visits import shop
from tests.fixtures.maps import shipped_map
from tests.fixtures.scenes import model_of

STARTS = [(x, y) for x in (2.0, 3.0, 4.0) for y in (2.0, 3.0, 4.0, 5.0)]


def visitors(visit: Visit, people: int = 8, **more) -> PedestrianModel:
    model = model_of(shop(), shipped_map(), **{"rng": 3, "frames_per_step": 3, **more})
    model.add_pedestrians(STARTS[:people], route=[visit])
    return model


@pytest.mark.parametrize("place", [box(14, 3, 16, 5), (15.0, 4.0)])
def test_no_more_than_its_capacity_stay_at_once(place):
    model = visitors(Visit(place, stay=6.0, capacity=2))
    most = 0
    while model.inside and model.elapsed < 120:
        model.step()
        there = model.journeys.stays._place[:8] >= 0
        most = max(most, int((there & model.crowd.active[:8]).sum()))
    assert model.inside == 0
    assert most == 2
    # Four pairs of 6 s after a way of more than 10 m.
    assert model.elapsed > 4 * 6 + 10 / 2
    assert check_safety(Trajectories.of(model), model.floor_plan.walls).overlaps == 0


def test_those_who_came_first_go_in_first():
    model = visitors(Visit(box(14, 3, 15.5, 5), stay=5.0, capacity=1), people=6)
    came, went = [], []
    while model.inside and model.elapsed < 150:
        model.step()
        stays = model.journeys.stays
        for row in range(len(stays._line[:6])):
            if (stays._line[row] >= 0 or stays._place[row] >= 0) and row not in came:
                came.append(row)
            if stays._place[row] >= 0 and row not in went:
                went.append(row)
    assert len(went) == 6
    assert went == came


def test_those_who_wait_do_so_beside_the_place():
    area = box(14, 3, 15.5, 5)
    model = visitors(Visit(area, stay=60.0, capacity=1), people=5)
    model.run(max_seconds=40)
    people = list(model.agents)
    rows = np.array([each.row for each in people])
    assert sorted(model.journeys.stays.in_line(rows).tolist()) == [False, True, True, True, True]
    inside = [bool(area.contains(Point(each.position))) for each in people]
    assert sum(inside) >= 1
    assert all(area.distance(Point(each.position)) < 2.2 for each in people)
    assert model.blocked == []


def test_a_person_sent_elsewhere_leaves_the_line():
    model = visitors(Visit(box(14, 3, 15.5, 5), stay=20.0, capacity=1), people=3)
    model.run(max_seconds=20)
    stays = model.journeys.stays
    [first, second] = np.flatnonzero(stays._line[:3] >= 0).tolist()
    people = {each.row: each for each in model.agents}
    people[first].exits = ["street"]
    assert stays._line[first] == -1
    model.run(max_seconds=120)
    assert model.inside == 0
    assert stays._line[second] == -1


def test_trajectories_do_not_depend_on_the_length_of_a_step_and_checkpoints_go_on(tmp_path):
    visit = Visit(box(14, 3, 16, 5), stay=4.0, capacity=2)
    found = []
    for frames_per_step in (1, 3, 8):
        model = visitors(visit, frames_per_step=frames_per_step)
        while model.frame < 24 * 30:
            model.step()
            if model.frame == 24 * 15:
                model.save(tmp_path / "at")
                other = copy.deepcopy(model)
        found.append(model.recorder.arrays())
        loaded = PedestrianModel.load(tmp_path / "at", pedestrian_types=model.pedestrian_types)
        for again in (loaded, other):
            while again.frame < 24 * 30:
                again.step()
            for name, column in found[0].items():
                np.testing.assert_array_equal(column, again.recorder.arrays()[name])
    for other in found[1:]:
        for name, column in found[0].items():
            np.testing.assert_array_equal(column, other[name])


@pytest.mark.parametrize("capacity", [0, -1, 1.5, True, "two"])
def test_capacities_that_cannot_be(capacity):
    with pytest.raises(ModelError, match="visit: capacity"):
        Visit((1.0, 1.0), stay=1.0, capacity=capacity)
