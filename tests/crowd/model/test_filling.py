"""Rooms filled with people, by number, density or use."""

import numpy as np
import pytest
from shapely import box, union_all

from mesa_mobility import Building, Exit, FloorPlan, Gate, Level, PedestrianModel, Room, Stairs
from mesa_mobility.distributions import Uniform
from mesa_mobility.errors import FloorPlanError, ModelError
from tests.fixtures.maps import strider
from tests.fixtures.scenes import model_of


def offices() -> FloorPlan:
    """Two offices of 5 m x 4 m beside a hall of 10.2 m x 6 m."""
    one, other, hall = box(0, 0, 5, 4), box(5.2, 0, 10.2, 4), box(0, 4.2, 10.2, 10.2)
    doors = [box(2, 4, 3, 4.2), box(7, 4, 8, 4.2)]
    return FloorPlan(
        union_all([one, other, hall, *doors]),
        exits=[Exit("street", (10.2, 6), (10.2, 8))],
        gates=[Gate(f"door {k}", (2 + 5 * k, 4.1), (3 + 5 * k, 4.1)) for k in range(2)],
        rooms=[
            Room("office 1", one, use="office"),
            Room("office 2", other, use="office"),
            Room("hall", hall, use="tables_and_chairs"),
        ],
    )


def office_model(**more) -> PedestrianModel:
    return model_of(offices(), strider(), **more)


def where(model, people) -> np.ndarray:
    rows = [each.row for each in people]
    return np.column_stack([model.crowd.x[rows], model.crowd.y[rows]])


def test_people_are_in_their_rooms_with_space_around_them():
    model = office_model()
    found = model.fill({"hall": 12, "office*": "0.25/m2"})
    assert {name: len(people) for name, people in found.items()} == {
        "office 1": 5,
        "office 2": 5,
        "hall": 12,
    }
    for name, people in found.items():
        x0, y0, x1, y1 = next(r for r in model.floor_plan.rooms if r.name == name).shape.bounds
        places = where(model, people)
        assert (places >= np.array([x0, y0]) + 0.3 - 1e-9).all()
        assert (places <= np.array([x1, y1]) - 0.3 + 1e-9).all()
    everybody = where(model, [each for people in found.values() for each in people])
    apart = np.hypot(*(everybody[:, None] - everybody[None]).transpose(2, 0, 1))
    assert apart[np.triu_indices(len(apart), 1)].min() >= 0.5


def test_by_default_rooms_have_the_load_of_their_use():
    model = office_model()
    found = model.fill()
    # 20 / 13.935 = 1.435 each; 61.2 / 1.3935 = 43.92; together 46.79.
    assert {name: len(people) for name, people in found.items()} == {
        "office 1": 2,
        "office 2": 1,
        "hall": 44,
    }


def test_a_second_filling_keeps_clear_of_the_first():
    model = office_model()
    model.fill("hall", 20)
    model.fill("hall", 20)
    places = where(model, model.agents)
    apart = np.hypot(*(places[:, None] - places[None]).transpose(2, 0, 1))
    assert len(places) == 40
    assert apart[np.triu_indices(40, 1)].min() >= 0.5


def test_pre_movement_by_room():
    model = office_model()
    found = model.fill(load=9, pre_movement={"hall": 2.0, "office*": Uniform(10, 20)})
    assert all(each.start_time == pytest.approx(2.0) for each in found["hall"])
    for name in ("office 1", "office 2"):
        assert all(10 <= each.start_time <= 20.1 for each in found[name])
    model = office_model()
    [*people] = model.fill("office 1", 3, pre_movement={"hall": 2.0})["office 1"]
    assert all(each.start_time == 0.0 for each in people)


def test_fill_as_a_text():
    model = office_model()
    model.fill_as("hall=7 after 3; office*=4 after uniform(10, 20)", 5.0)
    times = sorted(each.start_time for each in model.agents)
    assert len(times) == 11
    assert times[:7] == pytest.approx([3.0] * 7)
    assert all(10 <= each <= 20.1 for each in times[7:])
    model = office_model()
    model.fill_as("5", 6.0)
    assert [each.start_time for each in model.agents] == pytest.approx([6.0] * 5)


def test_same_seed_same_places():
    one, other = office_model(rng=3), office_model(rng=3)
    for model in (one, other):
        model.fill(load="0.3/m2")
    np.testing.assert_array_equal(where(one, one.agents), where(other, other.agents))


def test_further_arguments_hold_for_all():
    model = office_model()
    model.fill("hall", 3, preferred_speeds=1.1, group="tour")
    assert [each.preferred_speed for each in model.agents] == pytest.approx([1.1] * 3)
    assert {each.group for each in model.agents} == {"tour"}


def test_rooms_of_buildings_are_filled_on_their_level():
    hall = "POLYGON ((0 0, 20 0, 20 6, 0 6, 0 0))"
    ground = Level(0, hall, exits=[Exit("street", (0, 2), (0, 4))])
    first = Level(1, hall, elevation=3.06, rooms=[Room("studio", box(0, 0, 20, 6), use="office")])
    main = Stairs.straight("main", first, ground, head=((12, 5), (12, 3)), risers=18, tread=0.29)
    model = PedestrianModel(Building([ground, first], [main]), mobility_map=strider(), rng=1)
    found = model.fill({"studio": 20, "room 1": 6})
    assert {name: len(people) for name, people in found.items()} == {"room 1": 6, "studio": 20}
    places, levels = model.building.true_places(where(model, found["studio"]))
    assert (levels == 1).all()
    np.testing.assert_allclose(places[:, 2], 3.06)
    assert (model.building.true_places(where(model, found["room 1"]))[1] == 0).all()


def test_a_building_of_one_level_has_its_rooms():
    room = Room("studio", box(0, 0, 6, 4), use="office")
    level = Level(3, box(0, 0, 6, 4), exits=[Exit("street", (0, 1), (0, 3))], rooms=[room])
    model = PedestrianModel(Building([level]), mobility_map=strider(), rng=1)
    assert len(model.fill("studio", 4)["studio"]) == 4


@pytest.mark.parametrize(
    ("arguments", "error", "said"),
    [
        (("cellar", 3), FloorPlanError, "there is no room 'cellar'"),
        (("office 1", 500), FloorPlanError, "room 'office 1': room for"),
        ((["office 1", "hall"], 5), ModelError, "for several rooms"),
        (({"hall": 3}, 5), ModelError, "expected one of them"),
        (("hall", "bazaar"), FloorPlanError, "no use 'bazaar'"),
    ],
)
def test_fillings_that_cannot_be(arguments, error, said):
    model = office_model()
    with pytest.raises(error, match=said):
        model.fill(*arguments)
    assert model.inside == 0


@pytest.mark.parametrize(
    "text", ["", "hall=", "=5", "hall=1; hall=2", "hall=3 after soon", "hall=3 after uniform(1)"]
)
def test_texts_that_cannot_be_read(text):
    model = office_model()
    with pytest.raises(ModelError) as refused:
        model.fill_as(text)
    assert "\n" not in str(refused.value)
    assert model.inside == 0
