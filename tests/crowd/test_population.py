"""People come, stay who they are, and go: rows, agents and space tell the same."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mesa_mobility import Pedestrian, PedestrianModel
from tests.fixtures.maps import shipped_map, strider
from tests.fixtures.scenes import advance, corridor, model_of, put, same_rows, two_doors


def places(n: int, x: float = 1.0) -> np.ndarray:
    k = np.arange(n)
    return np.column_stack([x + 0.5 * (k % 30), 0.5 + 0.5 * (k // 30)])


def test_added_where_they_were_put():
    model = model_of(corridor(), strider())
    people = model.add_pedestrians(
        [(1.0, 2.0), (3.5, 0.5)], headings=[0.25, -2.0], preferred_speeds=[0.9, 1.5]
    )
    assert all(isinstance(person, Pedestrian) for person in people)
    assert [p.position.tolist() for p in people] == [[1.0, 2.0], [3.5, 0.5]]
    assert [p.heading for p in people] == [0.25, -2.0]
    assert [p.preferred_speed for p in people] == [0.9, 1.5]
    assert [p.speed for p in people] == [0.0, 0.0]
    assert model.inside == 2
    assert same_rows(model)


def test_by_default_they_face_their_first_target():
    model = model_of(two_doors(), strider())
    for person in model.add_pedestrians([(4.0, 5.5), (4.0, 2.5), (7.0, 7.0)]):
        aim = person.target - person.position
        assert math.remainder(person.heading - math.atan2(aim[1], aim[0]), math.tau) == (
            pytest.approx(0.0, abs=1e-12)
        )


def test_by_default_preferred_speeds_are_drawn_from_the_type():
    model = model_of(corridor(), strider(), rng=3)
    speeds = [p.preferred_speed for p in model.add_pedestrians(places(200))]
    assert len(set(speeds)) > 190
    assert np.mean(speeds) == pytest.approx(1.34, abs=0.06)
    assert min(speeds) >= 0.6
    assert max(speeds) <= 2.0


def test_one_number_stands_for_everybody():
    model = model_of(corridor(), strider())
    people = model.add_pedestrians(places(3), headings=0.5, preferred_speeds=1.1)
    assert {(p.heading, p.preferred_speed) for p in people} == {(0.5, 1.1)}


def test_more_people_than_the_arrays_began_with():
    model = model_of(corridor(), strider(), preset="paper")  # bodies may overlap there
    first = model.add_pedestrians(places(40))
    before = [p.position.tolist() for p in first]
    model.add_pedestrians(places(170, x=1.25))
    assert model.inside == 210
    assert same_rows(model)
    assert [p.position.tolist() for p in first] == before
    assert len(model.core_radii) == 210
    advance(model, 3)
    assert same_rows(model)


def test_nobody_to_add():
    model = model_of(corridor(), strider())
    assert model.add_pedestrians(np.empty((0, 2))) == []
    assert model.inside == 0


def test_a_batch_removed():
    model = model_of(corridor(), strider(), rng=1)
    people = model.add_pedestrians(places(100))
    leaving = people[::3]
    model.remove_pedestrians(leaving)
    assert model.inside == 66
    assert same_rows(model)
    assert {p.row for p in model.agents} == {k for k in range(100) if k % 3}
    assert not set(leaving) & set(model.agents)
    advance(model, 6)
    assert same_rows(model)


def test_one_removed_by_itself_and_by_mesas_way():
    model = model_of(corridor(), strider())
    a, b, c = model.add_pedestrians(places(3))
    b.remove()
    assert list(model.rows) == [a.row, c.row]
    assert same_rows(model)
    model.agents.select(lambda agent: agent is a).do("remove")
    assert list(model.agents) == [c]
    assert same_rows(model)


def test_everybody_removed():
    model = model_of(corridor(), strider())
    model.remove_pedestrians(model.add_pedestrians(places(5)))
    assert model.inside == 0
    assert same_rows(model)
    model.step()
    assert not model.running


def test_those_who_come_later_have_rows_of_their_own():
    model = model_of(corridor(), strider())
    people = model.add_pedestrians(places(4))
    model.remove_pedestrians(people[1:3])
    advance(model, 30)
    (late,) = model.add_pedestrians([(10.0, 3.0)])
    assert late.row == 4
    assert same_rows(model)
    assert late.position.tolist() == [10.0, 3.0]
    assert late.next_decision == 0.0
    advance(model, 30)
    assert late.position[0] > 10.0


def test_those_removed_are_in_nobodys_way():
    model = model_of(corridor(), strider())
    blocker, walker = put(model, 3.0, 2.0), put(model, 2.0, 2.0, preferred_speeds=[1.25])
    model.remove_pedestrians([blocker])
    assert len(walker.movement_options().neighbours) == 0
    advance(model, 45)
    assert walker.position[0] == pytest.approx(3.875, abs=1e-6)


def test_positions_handed_out_are_copies():
    model = model_of(corridor(), strider())
    person = put(model, 2.0, 2.0)
    place = person.position
    place[:] = 99.0
    assert person.position.tolist() == [2.0, 2.0]
    radii = model.core_radii
    radii[:] = 9.0
    assert model.core_radii.tolist() == [0.15]


@pytest.mark.thorough
@given(st.lists(st.sampled_from(["add", "remove", "step"]), max_size=12), st.integers(0, 2**31))
@settings(max_examples=25, deadline=None)
def test_rows_agents_and_space_agree_whatever_happens(actions, seed):
    rng = np.random.default_rng(seed)
    model = model_of(
        corridor(length=8.0), strider(), rng=0, frames_per_step=9, record=False, preset="paper"
    )
    known: dict[int, object] = {}
    for action in actions:
        if action == "add":
            n = int(rng.integers(0, 40))
            for person in model.add_pedestrians(rng.uniform((0.3, 0.3), (7.5, 3.7), (n, 2))):
                assert person.row not in known
                known[person.row] = person
        elif action == "remove" and model.inside:
            people = list(model.agents)
            chosen = rng.choice(len(people), int(rng.integers(1, len(people) + 1)), replace=False)
            model.remove_pedestrians([people[k] for k in chosen])
        else:
            model.step()
        assert same_rows(model)
        assert all(known[person.row] is person for person in model.agents)


@pytest.mark.thorough
def test_evacuation_keeps_rows_agents_and_space_together():
    model = model_of(two_doors(), shipped_map(), rng=5, frames_per_step=3)
    places_ = model.floor_plan.random_points(60, model.rng, spacing=0.5, clearance=0.3)
    model.add_pedestrians(places_)
    while model.running and model.elapsed < 90:
        model.step()
        assert same_rows(model)
    assert model.inside == 0


def test_the_model_wants_the_names_it_says():
    with pytest.raises(TypeError):
        PedestrianModel(corridor(), mobility_map=strider(), colour="red")
