"""The model is a Mesa model, as Mesa 3.3 to 3.5 understand one."""

import gc
import inspect
import weakref

import mesa
import numpy as np
import pytest
from mesa.datacollection import DataCollector
from mesa.experimental.continuous_space import ContinuousSpace, ContinuousSpaceAgent

from mesa_mobility import Pedestrian, PedestrianModel
from tests.fixtures.maps import strider
from tests.fixtures.scenes import advance, corridor, model_of, put


@pytest.fixture
def model():
    """Three walkers, 18, 15 and 1 m from the way out, three frames a step."""
    model = model_of(corridor(), strider(), frames_per_step=3)
    for k, x in enumerate((2.0, 5.0, 19.0)):
        put(model, x, 1.0 + k, preferred_speeds=[1.25])
    return model


def test_is_a_mesa_model_with_a_mesa_space(model):
    assert isinstance(model, mesa.Model)
    assert isinstance(model.space, ContinuousSpace)
    assert all(isinstance(agent, ContinuousSpaceAgent) for agent in model.agents)
    assert isinstance(model.datacollector, DataCollector)
    assert isinstance(model.rng, np.random.Generator)


def test_a_step_takes_no_arguments_and_is_a_tenth_of_a_second(model):
    assert list(inspect.signature(PedestrianModel.step).parameters) == ["self"]
    for k in range(1, 6):
        model.step()
        assert model.frame == 3 * k
        assert model.elapsed == pytest.approx(0.1 * k)


def test_the_space_follows_the_people_step_by_step(model):
    while model.running:
        model.step()
        assert len(model.space.active_agents) == len(model.agents) == model.inside
        for row, agent in enumerate(model.space.active_agents):
            assert model.space.agent_positions[row].tolist() == agent.position.tolist()


def test_the_space_answers_for_where_people_are_now(model):
    for _ in range(6):
        model.step()
    near, distances = model.space.get_agents_in_radius((5.75, 2.0), 0.1)
    assert [agent.row for agent in near] == [1]
    assert distances == pytest.approx([0.0], abs=1e-6)
    first = next(iter(model.agents))
    (nearest,), (distance,) = first.get_nearest_neighbors(k=1)
    assert nearest.row == 1
    assert distance == pytest.approx(np.hypot(3.0, 1.0), abs=1e-6)


def test_rows_are_of_people_alone_whatever_other_agents_there_are(model):
    mesa.Agent(model)
    places = [(8.0, 1.0), (11.0, 2.0), (14.0, 3.0)]
    people = model.add_pedestrians(places)
    assert [person.row for person in people] == [3, 4, 5]
    assert len({person.unique_id for person in model.agents_by_type[Pedestrian]}) == 6
    assert [person.position.tolist() for person in people] == [list(place) for place in places]


def test_the_space_knows_people_added_since_the_last_query(model):
    assert model.space.get_agents_in_radius((14.0, 3.0), 0.1)[0] == []
    first = next(iter(model.agents))
    assert len(first.get_neighbors_in_radius(30.0)[0]) == 2
    (person,) = model.add_pedestrians([(14.0, 3.0)])
    assert model.space.get_agents_in_radius((14.0, 3.0), 0.1)[0] == [person]
    assert len(person.get_neighbors_in_radius(30.0)[0]) == 3


def test_everybody_lies_within_the_space(model):
    while model.running:
        model.step()
        for agent in model.agents:
            assert model.space.in_bounds(agent.position)


def test_runs_until_everybody_has_left(model):
    assert model.running
    model.run()
    assert not model.running
    assert len(model.agents) == 0
    # 18 m at 1.25 m/s.
    assert model.elapsed == pytest.approx(14.4, abs=0.21)


def test_run_stops_in_time(model):
    model.run(max_seconds=2.0)
    assert model.elapsed == pytest.approx(2.0)
    assert model.running
    model.run(max_seconds=3.0)
    assert model.elapsed == pytest.approx(3.0)


def test_run_tells_of_its_progress_each_second(model):
    reports = []
    model.run(max_seconds=4.0, progress=lambda elapsed, inside: reports.append((elapsed, inside)))
    seconds, inside = zip(*reports, strict=True)
    assert seconds == pytest.approx((1.0, 2.0, 3.0, 4.0), abs=0.11)
    assert inside == (2, 2, 2, 2)


def test_agents_are_mesas_agent_set(model):
    people = model.agents_by_type[Pedestrian]
    assert len(people) == 3
    assert len({agent.unique_id for agent in people}) == 3
    assert sorted(model.agents.get("preferred_speed")) == [1.25] * 3
    assert len(model.agents.select(lambda a: a.position[0] > 4.0)) == 2


def test_data_collected_after_each_step(model):
    model.run(max_seconds=1.0)
    frame = model.datacollector.get_model_vars_dataframe()
    assert list(frame.columns) == ["elapsed", "inside", "mean_speed", "fallback_time_share"]
    assert len(frame) == 10
    assert frame["elapsed"].tolist() == pytest.approx(np.arange(1, 11) / 10)
    # The one a metre off leaves after 0.8 s.
    assert frame["inside"].tolist() == [3] * 7 + [2] * 3
    assert frame["mean_speed"].tolist() == pytest.approx([1.25] * 10)
    assert frame["fallback_time_share"].tolist() == [0.0] * 10


def test_data_collected_of_agents_are_not_changed_by_later_steps(model):
    model.datacollector = DataCollector(
        model_reporters={"radii": "core_radii"},
        agent_reporters={"position": "position", "velocity": "velocity", "target": "target"},
    )
    model.step()
    agents = model.datacollector.get_agent_vars_dataframe
    first = {k: v.copy() for k, v in agents()["position"].items()}
    for _ in range(5):
        model.step()
    now = agents()
    for key, place in first.items():
        assert now.loc[key, "position"].tolist() == place.tolist()
    x = np.array([p[0] for p in now.xs(1, level="AgentID")["position"]])
    assert np.diff(x) == pytest.approx([0.125] * 5)


def test_seeds_as_mesa_takes_them():
    def speeds(rng):
        model = model_of(corridor(), strider(), rng=rng)
        return [put(model, 1.0 + k, 1.0).preferred_speed for k in range(3)]

    assert speeds(5) == speeds(5) != speeds(6)
    assert speeds(np.random.default_rng(5)) == speeds(np.random.default_rng(5))


def test_without_a_seed_too():
    one, other = (model_of(corridor(), strider(), rng=None) for _ in range(2))
    assert one.rng.random() != other.rng.random()


def test_a_model_that_nobody_needs_any_more_is_forgotten():
    model = model_of(corridor(), strider())
    put(model, 2.0, 2.0)
    advance(model, 3)
    gone = weakref.ref(model)
    del model
    gc.collect()
    assert gone() is None
