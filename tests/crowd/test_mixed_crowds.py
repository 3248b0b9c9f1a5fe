"""Crowds of several types, drawn from a population."""

from copy import deepcopy
from dataclasses import replace

import numpy as np
import pytest
from shapely import box, union_all

from mesa_mobility import Exit, FloorPlan, PedestrianModel, PedestrianType, Source
from mesa_mobility.errors import FloorPlanError, MapError, MobilityError, ModelError
from mesa_mobility.populations import Population
from tests.fixtures.maps import shipped_map, strider
from tests.fixtures.scenes import corridor

NARROW, WIDE = 0.14, 0.35


def kinds(*cores: float) -> list[PedestrianType]:
    return [
        PedestrianType(mobility_map=strider(), core_radius=core, name=f"{core:g}") for core in cores
    ]


def population(*shares: float, cores=(NARROW, WIDE)) -> Population:
    return Population(dict(zip(kinds(*cores), shares, strict=True)))


def places(n: int, apart: float = 0.6, y: float = 1.0) -> np.ndarray:
    return np.column_stack([0.5 + apart * np.arange(n), np.full(n, y)])


@pytest.fixture
def maps(tmp_path, monkeypatch):
    """Maps that ship, small ones: able_bodied, child, wheelchair_manual."""
    speeds = {"able_bodied": None, "child": 1.1, "wheelchair_manual": 0.69}
    for name, speed in speeds.items():
        map_ = strider(pedestrian_type=name, core_radius=WIDE if "chair" in name else NARROW)
        more = {} if speed is None else {"preferred_speed_m_s": {"mean": speed}}
        replace(map_, metadata={**map_.metadata, **more}).save(tmp_path / f"{name}.npz")
    monkeypatch.setattr("mesa_mobility.mobility.mapfile.shipped_maps", lambda: tmp_path)
    return tmp_path


def test_each_type_gets_its_share_with_its_body_and_speed(maps):
    shares = {"able_bodied": 0.5, "child": 0.3, "wheelchair_manual": 0.2}
    model = PedestrianModel(corridor(), population=shares, rng=3)
    people = model.add_pedestrians(places(20, apart=0.8))
    names = [person.pedestrian_type.name for person in people]
    assert [names.count(name) for name in shares] == [10, 6, 4]
    assert names != sorted(names)
    assert {p.preferred_speed for p in people if p.pedestrian_type.name == "child"} == {1.1}
    assert sorted(model.core_radii.tolist()) == [NARROW] * 16 + [WIDE] * 4


def test_a_population_of_one_type_draws_as_that_type_alone_does():
    plan, spots = corridor(), places(12)
    runs = []
    for keywords in ({"mobility_map": shipped_map()}, {"population": "able_bodied"}):
        model = PedestrianModel(plan, rng=5, record=True, **keywords)
        model.add_pedestrians(spots)
        model.run(max_seconds=3)
        runs.append(model.recorder.arrays())
    assert all(np.array_equal(runs[0][name], runs[1][name]) for name in runs[0])


def test_the_same_seed_gives_the_same_people():
    def types(seed):
        model = PedestrianModel(corridor(), population=population(0.7, 0.3), rng=seed)
        model.add_pedestrians(places(20, apart=0.8))
        return model.crowd.type_index[:20].tolist()

    assert types(1) == types(1)
    assert types(1) != types(2)


def test_wide_people_stand_where_they_have_room():
    # Every second place is 0.2 m from a wall: too near for a wide body.
    spots = places(20, apart=0.9)
    spots[::2, 1] = 0.2
    for seed in range(5):
        model = PedestrianModel(corridor(), population=population(0.5, 0.5), rng=seed)
        people = model.add_pedestrians(spots)
        assert [person.row for person in people] == list(range(20))
        assert model.crowd.type_index[:20].tolist() == [0, 1] * 10


def test_wide_people_leave_room_to_those_beside_them():
    # Pairs 0.4 m apart: a wide body, 0.35 + 0.14 m, fits only beside nobody.
    pairs = [[1.5 * k + shift, 1.0] for k in range(6) for shift in (0.0, 0.4)]
    alone = [[1.5 * k, 3.0] for k in range(6)]
    spots = np.add(pairs + alone, [0.6, 0.0])
    model = PedestrianModel(corridor(), population=population(2 / 3, 1 / 3), rng=1)
    model.add_pedestrians(spots)
    assert model.crowd.type_index[:18].tolist() == [0] * 12 + [1] * 6


def test_wide_people_start_where_their_way_out_is_wide_enough():
    cabin = union_all([box(0, 0, 4, 4), box(4, 1.7, 4.2, 2.3), box(4.2, 0, 12, 4)])
    plan = FloorPlan(cabin, exits=[Exit("out", (12, 1), (12, 3))])
    spots = np.array([(x, y) for x in (1.0, 3.0, 6.0, 9.0) for y in (1.0, 3.0)])
    model = PedestrianModel(plan, population=population(0.5, 0.5), rng=1)
    model.add_pedestrians(spots)
    assert model.crowd.type_index[:8].tolist() == [0] * 4 + [1] * 4
    with pytest.raises(ModelError, match=r"4 people are of type '0.35', but only 0 .* 8 places"):
        PedestrianModel(plan, population=population(0.5, 0.5), rng=1).add_pedestrians(
            np.array([(x, y) for x in (0.5, 1.5, 2.5, 3.5) for y in (1.0, 3.0)])
        )


def test_types_may_be_given_person_by_person():
    model = PedestrianModel(corridor(), pedestrian_types=kinds(NARROW, WIDE), rng=1)
    people = model.add_pedestrians(places(4, apart=1.0), type_index=[1, 0, 0, 1])
    assert [person.pedestrian_type.name for person in people] == ["0.35", "0.14", "0.14", "0.35"]
    assert model.draw_types(3).tolist() == [0, 0, 0]


def test_nobody_is_left_behind_by_an_error():
    model = PedestrianModel(corridor(), pedestrian_types=kinds(NARROW, WIDE), rng=1)
    # The fourth, who is wide, would stand in a wall.
    spots = [(1, 1), (2, 1), (3, 1), (4, 0.2)]
    with pytest.raises(ModelError, match=r"pedestrian 3 at \[4.0, 0.2\].* wall"):
        model.add_pedestrians(spots, type_index=[0, 0, 1, 1], group="some")
    assert model.inside == 0
    assert not model.crowd.active.any()
    with pytest.raises(ModelError, match=r"pedestrian 1 at .*another newcomer"):
        model.add_pedestrians([(1, 1), (1.4, 1)], type_index=[0, 1])
    model.add_pedestrians([(1, 1), (1.5, 1)], type_index=[0, 1])
    assert model.inside == 2


def test_people_of_a_source_have_the_shares_too():
    model = PedestrianModel(corridor(), population=population(0.8, 0.2), rng=1)
    area = "POLYGON ((0 0, 6 0, 6 4, 0 4, 0 0))"
    inflow = model.add_source(Source(area=area, rate=4.0, number=100))
    model.run(max_seconds=120)
    assert (inflow.entered, model.inside) == (100, 0)
    assert np.bincount(model.crowd.type_index[:100]).tolist() == [80, 20]


def test_a_source_of_its_own_population():
    model = PedestrianModel(corridor(), pedestrian_types=kinds(NARROW, WIDE), rng=1)
    own = Population({model.pedestrian_types[1]: 1.0})
    area = "POLYGON ((0 0, 6 0, 6 4, 0 4, 0 0))"
    model.add_source(Source(area=area, times=[0, 1], population=own))
    model.add_source(Source(area=area, times=[0, 1], population={"0.14": 1.0}))
    model.run(max_seconds=60)
    assert np.bincount(model.crowd.type_index[:4]).tolist() == [2, 2]


def test_a_source_where_only_some_have_room_or_a_way():
    plan = FloorPlan(box(0, 0, 10, 0.6), exits=[Exit("out", (10, 0), (10, 0.6))])
    model = PedestrianModel(plan, population=population(0.8, 0.2), rng=1)
    with pytest.raises(FloorPlanError, match="no place in it"):
        model.add_source(Source(area="POLYGON ((0 0, 2 0, 2 0.6, 0 0.6, 0 0))", rate=1, until=9))


def test_a_copy_goes_on_alike():
    model = PedestrianModel(corridor(), population=population(0.8, 0.2), rng=1)
    model.add_source(Source(area="POLYGON ((0 0, 6 0, 6 4, 0 4, 0 0))", rate=4.0, number=30))
    model.run(max_seconds=3)
    copied = deepcopy(model)
    for each in (model, copied):
        each.run(max_seconds=60)
    assert np.array_equal(model.crowd.type_index, copied.crowd.type_index)


@pytest.mark.parametrize(
    ("error", "match", "make"),
    [
        (
            ModelError,
            "mobility_map and population",
            lambda model: PedestrianModel(
                corridor(), mobility_map=strider(), population="able_bodied"
            ),
        ),
        (
            MapError,
            "no map named 'giraffe'",
            lambda model: PedestrianModel(
                corridor(), population={"able_bodied": 0.5, "giraffe": 0.5}
            ),
        ),
        (
            ModelError,
            "add up to 0.9",
            lambda model: PedestrianModel(corridor(), population={"able_bodied": 0.9}),
        ),
        (
            ModelError,
            "no type 'child', expected one of 0.14, 0.35",
            lambda model: model.add_pedestrians([(1, 1)], population="child"),
        ),
        (
            ModelError,
            "type_index and population",
            lambda model: model.add_pedestrians([(1, 1)], population={"0.14": 1.0}, type_index=0),
        ),
        (
            ModelError,
            "type_index and population",
            lambda model: model.add_source(
                Source(area=box(0, 0, 3, 3), rate=1, population={"0.14": 1.0}, type_index=0)
            ),
        ),
        (
            ModelError,
            "type_index.*one for each",
            lambda model: model.add_pedestrians([(1, 1)], type_index=[0, 1]),
        ),
        (
            ModelError,
            "type_index.*1.5",
            lambda model: model.add_pedestrians([(1, 1)], type_index=1.5),
        ),
        (
            ModelError,
            "type_index",
            lambda model: model.add_pedestrians([(1, 1)], type_index=[[0], [0, 1]]),
        ),
    ],
)
def test_what_cannot_be(error, match, make):
    model = PedestrianModel(corridor(), pedestrian_types=kinds(NARROW, WIDE), rng=1)
    with pytest.raises(error, match=match) as raised:
        make(model)
    assert isinstance(raised.value, MobilityError)
    assert "\n" not in str(raised.value)
    assert model.inside == 0
