"""Agents of one's own: a class, fields, plans changed at run time, Mesa's sets and other agents."""

import copy

import numpy as np
import pytest
from mesa import Agent, DataCollector

from mesa_mobility import FloorPlan, Gate, Pedestrian, PedestrianModel, Source
from mesa_mobility.errors import FloorPlanError, ModelError
from mesa_mobility.floorplan import Exit
from tests.fixtures.maps import strider, wanderer
from tests.fixtures.scenes import advance, corridor, model_of, put, same_rows, two_doors


class Guest(Pedestrian):
    def __init__(self, model, row):
        super().__init__(model, row)
        self.stepped = []

    def step(self):
        self.stepped.append((self.model.frame, self.position[0]))


def guests(n=3, **keywords):
    model = model_of(
        corridor(),
        strider(),
        pedestrian_class=Guest,
        fields={"infected": bool, "visits": int, "mood": float},
        frames_per_step=3,
        **keywords,
    )
    model.add_pedestrians([(1.0 + k, 1.0) for k in range(n)], fields={"mood": np.arange(n) / 2})
    return model


def test_step_is_called_once_a_step_before_anybody_moves():
    model = guests()
    for _ in range(3):
        model.step()
    for k, person in enumerate(model.agents):
        assert isinstance(person, Guest)
        frames, places = zip(*person.stepped, strict=True)
        assert frames == (0, 3, 6)
        assert places[0] == 1.0 + k < places[2]


def test_without_a_step_of_ones_own_mesas_is_not_called(monkeypatch):
    model = model_of(corridor(), strider())
    put(model, 1.0, 1.0)
    monkeypatch.setattr("mesa.Agent.step", lambda self: pytest.fail("called"))
    model.step()


class Leaver(Guest):
    def step(self):
        if self.row == 0:
            for other in list(self.model.agents)[1:]:
                other.remove()
        super().step()


def test_who_is_removed_meanwhile_does_not_step():
    model = model_of(corridor(), strider(), pedestrian_class=Leaver)
    people = model.add_pedestrians([(1.0 + k, 1.0) for k in range(3)])
    model.step()
    assert [len(person.stepped) for person in people] == [1, 0, 0]
    assert same_rows(model)


class Host(Guest):
    def step(self):
        if self.model.steps == 2 and self.row == 0:
            self.model.add_pedestrians([(10.0, 2.0)])


def test_people_may_be_added_by_a_step():
    model = model_of(corridor(), strider(), pedestrian_class=Host)
    put(model, 1.0, 1.0)
    advance(model, 4)
    assert model.inside == 2
    assert same_rows(model)


def test_fields_are_attributes_and_columns():
    model = guests()
    first, second, third = model.agents
    assert [person.mood for person in model.agents] == [0.0, 0.5, 1.0]
    assert (first.infected, first.visits) == (False, 0)
    first.infected, second.visits, third.mood = True, 7, -1.5
    assert model.crowd.fields["infected"][:3].tolist() == [True, False, False]
    assert model.crowd.fields["visits"][:3].tolist() == [0, 7, 0]
    model.crowd.fields["mood"][1] = 4.0
    assert type(second.mood) is float
    assert second.mood == 4.0
    assert type(first.infected) is bool


def test_mesas_sets_read_and_write_them():
    model = guests()
    model.agents.select(lambda person: person.mood >= 0.5).set("infected", True)
    assert model.agents.get("infected") == [False, True, True]
    assert model.agents.agg("mood", sum) == 1.5
    model.agents.do("wait", seconds=2.0)
    assert all(person.waiting for person in model.agents)


def test_mesas_collector_reports_them():
    model = guests()
    model.datacollector = DataCollector(agent_reporters={"mood": "mood", "x": "position"})
    model.step()
    frame = model.datacollector.get_agent_vars_dataframe()
    assert frame["mood"].tolist() == [0.0, 0.5, 1.0]


def test_more_people_than_there_was_room_for():
    model = guests()
    model.crowd.fields["visits"][:3] = [1, 2, 3]
    plan = model.floor_plan
    places = plan.random_points(80, model.rng, spacing=0.5, clearance=0.3, avoid=[(2.0, 1.0)])
    far = places[places[:, 0] > 5.0]
    model.add_pedestrians(far, fields={"visits": 9})
    visits = model.crowd.fields["visits"][: model.population.count]
    assert visits.tolist() == [1, 2, 3] + [9] * len(far)


def test_a_source_gives_fields_too():
    model = guests(0)
    model.add_source(
        Source(area="POLYGON ((1 1, 3 1, 3 3, 1 3, 1 1))", times=[0.0], fields={"mood": 2.5})
    )
    model.step()
    (person,) = model.agents
    assert person.mood == 2.5


def test_a_copy_has_fields_of_its_own():
    model = guests()
    copied = copy.deepcopy(model)
    next(iter(copied.agents)).visits = 3
    assert model.crowd.fields["visits"].max() == 0
    assert copied.crowd.fields["visits"].max() == 3


@pytest.mark.parametrize(
    ("fields", "text"),
    [
        ({"mood": str}, "field 'mood': got <class 'str'>, expected bool, int or float"),
        ({"speed": float}, "people have 'speed' already"),
        ({"stepped": float, "step": bool}, "people have 'step' already"),
        ({"a b": int}, "got 'a b', expected a name"),
        ({"group": int}, "people have 'group' already"),
        ({"type": int}, "people have 'type' already"),
        (["mood"], "expected a type for each name"),
    ],
)
def test_declarations_that_are_refused(fields, text):
    with pytest.raises(ModelError, match=text):
        model_of(corridor(), strider(), fields=fields)


def test_values_that_are_refused():
    model = guests()
    person = next(iter(model.agents))
    for name, value in (("infected", 2), ("visits", 1.5), ("mood", "good"), ("visits", [1, 2])):
        with pytest.raises(ModelError, match=f"field '{name}'"):
            setattr(person, name, value)
    with pytest.raises(ModelError, match="field 'mod': is not declared; the model has infected"):
        model.add_pedestrians([(9.0, 1.0)], fields={"mod": 1.0})
    with pytest.raises(ModelError, match=r"field 'mood': got shape \(2,\)"):
        model.add_pedestrians([(9.0, 1.0)], fields={"mood": [1.0, 2.0]})
    assert model.inside == 3
    with pytest.raises(AttributeError, match="no attribute 'modd'"):
        _ = person.modd


def test_agents_are_not_made_by_hand():
    model = guests()
    for arguments in ((0,), (3,), (-1,)):
        with pytest.raises(ModelError, match=r"Guest\(\.\.\.\): nobody stands on the floor"):
            Guest(model, *arguments)
    with pytest.raises(ModelError, match=r"Pedestrian\(\.\.\.\): nobody stands on the floor"):
        Pedestrian(model)
    assert same_rows(model)
    with pytest.raises(ModelError, match="expected a class derived from Pedestrian"):
        model_of(corridor(), strider(), pedestrian_class=int)


def test_people_are_not_put_elsewhere():
    model = guests()
    person = next(iter(model.agents))
    for name in ("pos", "position"):
        with pytest.raises(ModelError, match="people walk by themselves"):
            setattr(person, name, (3.0, 3.0))
    assert person.pos == pytest.approx(person.position)


def test_a_new_preferred_speed():
    model = model_of(corridor(), strider(), frames_per_step=3)
    person = put(model, 1.0, 2.0, preferred_speeds=0.5)
    person.preferred_speed = 1.5
    assert person.preferred_speed == 1.5
    advance(model, 90)
    assert person.position[0] > 4.0
    with pytest.raises(ModelError, match="preferred_speeds: got -1"):
        person.preferred_speed = -1.0


def test_other_exits():
    model = model_of(two_doors(), wanderer(5, options=60), frames_per_step=3)
    person = put(model, 4.0, 4.0, exits=["right"])
    assert person.exits == ("right",)
    advance(model, 3)
    person.exits = ["left"]
    assert person.exits == ("left",)
    advance(model, 60)
    assert person.target[0] < 0.0  # behind the left door, at x = 0
    person.exits = None
    assert person.exits == ("right", "left")
    with pytest.raises(FloorPlanError, match="no gate or exit 'middle'"):
        person.exits = ["middle"]
    with pytest.raises(ModelError, match=r"expected a list of names such as \['left'\]"):
        person.exits = "left"
    assert person.exits == ("right", "left")


def test_a_new_route_ends_at_the_exits_that_the_person_had():
    plan = FloorPlan(
        "POLYGON ((0 0, 20 0, 20 4, 0 4, 0 0))",
        exits=[Exit("east", (20, 0), (20, 4)), Exit("west", (0, 0), (0, 4))],
        gates=[Gate("middle", (10, 0), (10, 4))],
    )
    model = model_of(plan, strider(), frames_per_step=3)
    person = put(model, 5.0, 2.0, exits=["east"])
    person.route = ["middle"]
    assert (person.route, person.exits) == (("middle",), ("east",))
    model.run(max_seconds=60)
    assert model.inside == 0
    assert person.gates_crossed == 1
    with pytest.raises(ModelError, match="has left"):
        person.route = ["middle"]


def test_joining_a_group_brings_its_speed_rule():
    model = guests()
    first, second, _ = model.agents
    assert model.speed_rules == []
    first.group = second.group = "friends"
    model.step()
    assert [rule.name for rule in model.speed_rules] == ["walk_together"]
    assert model.crowd.agenda["group"][:3].tolist() == [1, 1, 0]
    first.group = None
    assert first.group is None
    with pytest.raises(ModelError, match=r"group: got 1\.5"):
        first.group = 1.5


class Alarm(Agent):
    """Sounds after a second."""

    def step(self):
        self.model.alarm = self.model.time > 1.0 - 1e-9


def test_a_fire_alarm_after_a_second():
    model = guests()
    model.agents.do("wait", until=lambda: model.alarm)
    model.alarm = False
    Alarm(model)
    people = model.agents_by_type[Guest]
    for _ in range(10):
        model.step()
    before = [person.position[0] for person in people]
    assert before == [1.0, 2.0, 3.0]
    for _ in range(20):
        model.step()
    assert all(person.position[0] > x + 0.5 for person, x in zip(people, before, strict=True))


def test_rows_of_a_base_model_stay_as_they_are():
    assert isinstance(put(model_of(corridor(), strider()), 1.0, 1.0), Pedestrian)
    assert PedestrianModel(corridor(), mobility_map=strider(), rng=1).crowd.fields == {}


def test_a_row_stays_and_who_has_left_does_not_wait():
    model = model_of(corridor(), strider())
    first, second = model.add_pedestrians([(2.0, 1.0), (2.0, 3.0)])
    with pytest.raises(ModelError, match=r"^pedestrian 0: their row is the same for ever, got 1"):
        first.row = second.row
    first.remove()
    with pytest.raises(ModelError, match=r"^pedestrian 0: has left, expected somebody inside"):
        first.wait(3.0)
    assert not first.waiting
