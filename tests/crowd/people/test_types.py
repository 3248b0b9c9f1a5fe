"""Several types of pedestrians in one crowd, each with its own map."""

import math

import pytest
from mesa_mobility.behaviors import Displacement
from shapely import box

from mesa_mobility import Exit, FloorPlan, PedestrianModel, PedestrianType
from tests.fixtures.maps import make_map, stand, straight, strider, wanderer
from tests.fixtures.oracles.counting import overlaps, track
from tests.fixtures.scenes import advance, corridor, model_of, put


def test_each_walks_as_its_own_map_has_it():
    slow = make_map([[stand(), straight(0.25, 12)], [straight(0.5, 24), stand()]])
    model = model_of(corridor(), [strider(), slow], behaviors=[Displacement()])
    fast, slower = put(model, 1.0, 1.0), put(model, 1.0, 3.0, type_index=1)
    advance(model, 36)
    assert slower.position[0] == pytest.approx(1.75, abs=1e-6)
    assert slower.cluster == 1
    advance(model, 9)
    assert fast.position[0] == pytest.approx(2.875, abs=1e-6)
    assert fast.cluster == 1
    assert fast.pedestrian_type is model.pedestrian_types[0]
    assert slower.pedestrian_type is model.pedestrian_types[1]


def test_the_standing_cluster_is_that_of_the_type(whole):
    only_ahead = make_map([[straight(3.0, 45, to=1)], [straight(2.5, 45, to=1)]])
    model = model_of(corridor(length=10.0), [wanderer(1), only_ahead], preset=whole)
    model.floor_plan.add_obstacle(box(3.5, 0.5, 4.0, 3.5))
    person = put(model, 3.0, 2.0, type_index=1)
    advance(model, 1)
    assert person.in_fallback
    assert person.cluster == 0
    assert person.movement_options().displacements.tolist() == [3.0]


def test_people_of_different_sizes_keep_their_own_distances():
    plan = FloorPlan(box(0, 0, 6, 6), exits=[Exit("east", (6, 2.5), (6, 3.5))])
    kinds = [
        PedestrianType(mobility_map=wanderer(k), core_radius=r, name=str(k))
        for k, r in ((3, 0.125), (4, 0.25))
    ]
    model = PedestrianModel(plan, pedestrian_types=kinds, record=True, rng=1)
    places = plan.random_points(16, model.rng, spacing=0.6, clearance=0.35)
    small = model.add_pedestrians(places[:8])
    large = model.add_pedestrians(places[8:], type_index=1)
    assert model.core_radii.tolist() == [0.125] * 8 + [0.25] * 8
    model.run(max_seconds=12)
    rows = model.recorder.arrays()
    assert overlaps(rows, 0.125, tolerance=0.0) == 0
    both = {p.row: track(rows, p.row) for p in (*small, *large)}
    nearest = {0.25: math.inf, 0.375: math.inf, 0.5: math.inf}
    for a in both:
        for b in range(a):
            n = min(len(both[a]), len(both[b]))
            gap = both[a][:n, 1:3] - both[b][:n, 1:3]
            apart = float((gap**2).sum(axis=1).min()) ** 0.5
            cores = float(model.core_radii[a] + model.core_radii[b])
            nearest[cores] = min(nearest[cores], apart)
    assert all(apart >= cores for cores, apart in nearest.items())


def test_types_have_speeds_of_their_own():
    kinds = [PedestrianType(mobility_map=strider(), preferred_speed=m) for m in (0.8, 1.6)]
    model = PedestrianModel(corridor(), pedestrian_types=kinds)
    assert [put(model, 1.0, 1.0 + k, type_index=k).preferred_speed for k in (0, 1)] == [0.8, 1.6]
