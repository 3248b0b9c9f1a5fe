"""A copy of a running model goes on just as the model does, each by itself."""

import copy
import pickle
import subprocess
import sys

import numpy as np
import pytest
from mesa_mobility.models import Doorway
from shapely import box

from mesa_mobility import Exit, FloorPlan, Gate, PedestrianModel, Source, SpeedZone
from mesa_mobility.compiled.threads import MANY
from mesa_mobility.errors import FloorPlanError, ModelError
from tests.fixtures.maps import wanderer
from tests.fixtures.scenes import advance, corridor, model_of


def state(model):
    """Everything that moves, to the last bit."""
    rows = model.rows
    return (
        model.frame,
        rows.tobytes(),
        fields(model.crowd.records[: model.population.count]),
        fields(model.crowd.agenda[: model.population.count]),
        model.space.agent_positions.tobytes(),
        [agent.unique_id for agent in model.space.active_agents],
        model.statistics.occupancy,
        model.rng.bit_generator.state,
    )


def fields(records):
    """The bytes of each field, without what lies between them."""
    return {name: records[name].tobytes() for name in records.dtype.names}


def doorway():
    return Doorway(pedestrians=60, rng=3)


def all_there_is():
    """Sources, journeys, groups, zones, doors, waiting, people of two types."""
    plan = FloorPlan(
        box(0, 0, 16, 8),
        exits=[Exit("east", (16, 3), (16, 5)), Exit("west", (0, 3), (0, 5))],
        gates=[Gate("a", (8, 0), (8, 4)), Gate("b", (8, 4), (8, 8))],
        zones=[SpeedZone(box(4, 0, 6, 8), 0.5)],
        obstacles=[box(11, 2, 12, 3)],
    )
    model = model_of(plan, [wanderer(5, options=30), wanderer(6, options=20)], rng=8, record=True)
    points = plan.random_points(24, model.rng, spacing=0.6, clearance=0.3)
    model.add_pedestrians(points[:8], route=["a", "b"], loop=True)
    model.add_pedestrians(points[8:16], type_index=1, group="friends", exits=["east"])
    people = model.add_pedestrians(points[16:], pre_movement=2.0)
    people[0].wait(3.0)
    model.add_source(Source(area=box(0.5, 0.5, 3, 2), times=[0.5 * k for k in range(40)]))
    return model


def a_free_place(model):
    """With 1 m to everybody and 0.3 m to every wall."""
    return model.floor_plan.random_points(
        1, np.random.default_rng(1), spacing=1.0, clearance=0.3, avoid=model.space.agent_positions
    )


@pytest.mark.parametrize("make", [doorway, all_there_is])
def test_a_copy_goes_on_as_the_model_does(make):
    model = make()
    advance(model, 60)
    copied, again = copy.deepcopy(model), copy.deepcopy(model)
    before = state(model)
    assert state(copied) == before
    advance(copied, 150)
    assert state(model) == before
    advance(model, 150)
    assert state(copied) == state(model) != before
    # And a copy of a copy, made meanwhile, too.
    third = copy.deepcopy(again)
    for each in (again, third):
        advance(each, 150)
        assert state(each) == state(model)


def test_each_has_people_and_a_floor_plan_of_its_own():
    model = doorway()
    advance(model, 30)
    copied = copy.deepcopy(model)
    ours, theirs = set(model.agents), set(copied.agents)
    assert len(ours) == len(theirs) == 60
    assert not ours & theirs
    assert all(agent.model is copied and agent.space is copied.space for agent in theirs)
    kept = state(model)
    copied.remove_pedestrians(list(copied.agents)[:10])
    x, y = a_free_place(copied)[0]
    copied.floor_plan.add_obstacle(box(x - 0.1, y - 0.1, x + 0.1, y + 0.1))
    newcomer = copied.add_pedestrians(a_free_place(copied))[0]
    assert newcomer.unique_id == 61
    assert (model.inside, copied.inside) == (60, 51)
    assert len(model.floor_plan.obstacles) == len(copied.floor_plan.obstacles) - 1
    assert state(model) == kept
    advance(copied, 60)
    advance(model, 60)


def test_no_obstacle_is_put_where_people_of_the_copy_stand():
    copied = copy.deepcopy(doorway())
    x, y = copied.space.agent_positions[0]
    with pytest.raises(FloorPlanError, match="pedestrian 0 stands there"):
        copied.floor_plan.add_obstacle(box(x - 0.1, y - 0.1, x + 0.1, y + 0.1))
    assert not copied.floor_plan.obstacles


def test_changes_of_plan_after_the_copy():
    models = [all_there_is()]
    advance(models[0], 45)
    models.append(copy.deepcopy(models[0]))
    for model in models:
        model.floor_plan.add_obstacle(box(9, 5, 10, 7))
        model.floor_plan.close_gate("a")
        advance(model, 45)
        model.floor_plan.remove_obstacle(0)
        advance(model, 45)
    assert state(models[0]) == state(models[1])


def test_a_crowd_shared_among_threads():
    plan = FloorPlan(box(0, 0, 40, 40), exits=[Exit("east", (40, 10), (40, 30))])
    model = model_of(plan, wanderer(7, options=20), rng=4)
    model.add_pedestrians(plan.random_points(MANY + 50, model.rng, spacing=0.6, clearance=0.3))
    advance(model, 15)
    copied = copy.deepcopy(model)
    for each in (model, copied):
        advance(each, 30)
    assert state(model) == state(copied)


class Counting(PedestrianModel):
    """A user's model with something of its own."""

    def __init__(self, rng=None):
        super().__init__(corridor(), mobility_map=wanderer(5, options=10), rng=rng)
        self.add_pedestrians([[1.0, 1.0], [2.0, 2.0]])
        self.steps_seen = []

    def step(self):
        super().step()
        self.steps_seen.append(self.frame)


def test_what_a_subclass_adds_is_copied_too():
    model = Counting(rng=1)
    model.step()
    copied = copy.deepcopy(model)
    copied.step()
    assert (model.steps_seen, copied.steps_seen) == ([3], [3, 6])
    assert (model.steps, copied.steps) == (1, 2)


@pytest.mark.parametrize("way", [copy.copy, pickle.dumps])
def test_other_ways_are_refused(way):
    with pytest.raises(ModelError, match=r"^Counting: a model can be copied by copy\.deepcopy"):
        way(Counting(rng=1))


@pytest.mark.slow
def test_copies_live_on_without_the_model():
    """In a process of its own: were memory to be spoilt, it would be that one's."""
    done = subprocess.run(
        [
            sys.executable,
            "-c",
            "import copy, gc\n"
            "from mesa_mobility.models import Auditorium\n"
            "model = Auditorium(rng=1)\n"
            "for _ in range(12):\n"
            "    for _ in range(20): model.step()\n"
            "    model = copy.deepcopy(model); gc.collect()\n"
            "other = Auditorium(rng=1)\n"
            "for _ in range(240): other.step()\n"
            "assert (model.crowd.records == other.crowd.records).all()\n",
        ],
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr
