"""Scenarios of JuPedSim and Vadere as models that run."""

import json
import warnings
from copy import deepcopy

import numpy as np
import pytest
from mesa_mobility.models import Scenario
from shapely import Point, box

from mesa_mobility import FloorPlan
from mesa_mobility.errors import FloorPlanError, ModelError
from mesa_mobility.floorplan.scenario import read_scenario
from tests.floorplan.formats.test_scenarios import CONFIG, VADERE, element, rectangle, zipped


def area(x, y, width, height):
    return [[x, y], [x + width, y], [x + width, y + height], [x, y + height]]


def distribution(number, **more):
    return {"coordinates": area(1, 5, 3, 2.5), "parameters": {"number": number, "v0": 1.1, **more}}


def config(**distributions):
    both = {"west": {"coordinates": area(0.1, 2, 0.3, 1)}, **CONFIG["exits"]}
    return {
        "exits": both,
        "distributions": distributions,
        "checkpoints": {"desk": {"coordinates": area(6, 6, 1, 1), "waiting_time": 4}},
        "zones": {"mud": {"coordinates": area(7, 1, 1, 1), "speed_factor": 0.5}},
        "journeys_v2": [
            {"id": "long", "sequence": ["desk", "jps-exits_0"]},
            {"id": "short", "sequence": ["west"]},
        ],
    }


def read(path):
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        plan, people = read_scenario(path)
    return plan, people, "\n".join(str(each.message) for each in found)


def test_people_of_jupedsim(tmp_path):
    weights = [{"journey_id": "long", "weight": 70}, {"journey_id": "short", "weight": 30}]
    flow = {"use_flow_spawning": True, "flow_start_time": 10, "flow_end_time": 20}
    given = config(
        hall={**distribution(5), "journey_weights": weights},
        later=distribution(4, v0_distribution="gaussian", v0_std=0.2, **flow),
    )
    plan, people, said = read(zipped(tmp_path / "hall.zip", given))
    first, second, third = people
    # 70 and 30 % of five are 3.5 and 1.5 people: four and one, or three and two, that add up.
    assert first.number + second.number == 5
    assert abs(first.number - 3.5) <= 0.5
    assert [first.exits, second.exits, third.exits] == [("jps-exits_0",), ("west",), None]
    (desk,) = first.stops
    assert (desk.area.bounds, desk.stay) == ((6, 6, 7, 7), 4)
    assert third.times == (10, 12.5, 15, 17.5)
    rng = np.random.default_rng(1)
    assert first.speed.draw(3, rng).tolist() == [1.1] * 3
    assert third.speed.draw(50, rng).std() == pytest.approx(0.2, abs=0.07)
    (mud,) = plan.zones
    assert (mud.factor, mud.area.area) == (0.5, 1)
    assert "left out people" not in said
    with pytest.warns(UserWarning, match="left out people of 3 sources"):
        FloorPlan.from_file(tmp_path / "hall.zip")


def spawner(**given):
    return {
        "constraintsTimeStart": 0.0,
        "constraintsTimeEnd": 4.0,
        "constraintsElementsMax": -1,
        "eventElementCount": 2,
        "distribution": {"updateFrequency": 2.0},
        **given,
    }


def test_people_of_vadere(tmp_path):
    data = deepcopy(VADERE)
    data["scenario"]["topography"] |= {
        "sources": [element(6, rectangle(2, 8, 2, 2), targetIds=[4, 3], spawner=spawner())],
        "dynamicElements": [
            {"position": {"x": 15, "y": 12}, "freeFlowSpeed": 1.25, "targetIds": [3]},
            {"type": "CAR"},
        ],
        "attributesPedestrian": {"speedDistributionStandardDeviation": 0.0},
    }
    (tmp_path / "hall.scenario").write_text(json.dumps(data))
    _, people, said = read(tmp_path / "hall.scenario")
    at_start, later, alone = people
    # Two people at 0, 2 and 4 s.
    assert (at_start.number, at_start.times, later.times) == (2, (), (2, 2, 4, 4))
    assert at_start.exits == later.exits == alone.exits == ("target 3",)
    assert [each.area.bounds for each in at_start.stops] == [(2, 2, 3, 3)]
    assert (alone.spots, alone.area) == (((15, 12),), Point(15, 12))
    rng = np.random.default_rng(1)
    assert alone.speed.draw(1, rng) == [1.25]
    assert at_start.speed.draw(1, rng) == [1.34]
    assert "left out 1 dynamicElements that are no pedestrians" in said


def test_people_are_put_where_the_scenario_has_them(tmp_path):
    zipped(tmp_path / "hall.zip", config(hall=distribution(6)))
    model = Scenario(tmp_path / "hall.zip", rng=1)
    places = np.array([each.position for each in model.agents])
    assert len(places) == 6
    assert box(1, 5, 4, 7.5).covers(Point(places.min(axis=0)))
    assert box(1, 5, 4, 7.5).covers(Point(places.max(axis=0)))


@pytest.mark.thorough
def test_a_scenario_runs_to_its_end(tmp_path):
    weights = [{"journey_id": "long", "weight": 1}]
    flow = {"use_flow_spawning": True, "flow_start_time": 1, "flow_end_time": 2}
    given = config(
        hall={**distribution(3), "journey_weights": weights}, later=distribution(2, **flow)
    )
    model = Scenario(zipped(tmp_path / "hall.zip", given), rng=1)
    model.run(max_seconds=60)
    assert (model.inside, model.summary()["pedestrians"]) == (0, 5)
    # Those of the journey stay 4 s at the desk.
    assert model.elapsed > 8


@pytest.mark.parametrize(
    ("hall", "message"),
    [
        ({"parameters": {"number": -1}, "coordinates": area(1, 5, 1, 1)}, "expected 0 to 20,000"),
        ({"parameters": {"number": 2}}, "0 corners, expected 3 to"),
        (distribution(2, v0="fast"), "v0: got 'fast', expected a number"),
        (distribution(2, use_flow_spawning=True, flow_end_time=-1), "people come from 0 to -1 s"),
        ([], "hall: expected an object, found list"),
    ],
)
def test_faulty_people(tmp_path, hall, message):
    with pytest.raises(FloorPlanError, match=message):
        read(zipped(tmp_path / "hall.zip", config(hall=hall)))


def test_scenarios_without_room_or_people(tmp_path):
    with pytest.raises(FloorPlanError, match="has no people, expected a scenario with some"):
        read(zipped(tmp_path / "none.zip", config()))
    crowded = config(hall=distribution(500))
    with pytest.raises(ModelError, match=r"hall.zip: hall: the floor plan leaves room for"):
        Scenario(zipped(tmp_path / "hall.zip", crowded), rng=1)
    outside = {**distribution(2), "coordinates": area(50, 50, 1, 1)}
    with pytest.raises(ModelError, match=r"the area around \(50.50, 50.50\) has no floor in it"):
        Scenario(zipped(tmp_path / "off.zip", config(hall=outside)), rng=1)
    with pytest.raises(ModelError, match="plan: got none, expected a scenario"):
        Scenario()
