"""Movements under way when walls, doors or newcomers appear in their way."""

import numpy as np
import pytest
from shapely import box

from mesa_mobility import Exit, FloorPlan
from mesa_mobility.errors import ModelError
from mesa_mobility.results import Trajectories, check_safety
from tests.fixtures.maps import shipped_map, strider
from tests.fixtures.scenes import advance, corridor, model_of, put


@pytest.mark.parametrize("ahead", [0.3, 0.45, 0.6, 1.0])
def test_nobody_walks_into_an_obstacle_put_down_ahead(ahead):
    model = model_of(corridor(), strider())
    walker = put(model, 2.0, 2.0, preferred_speeds=[1.25])
    advance(model, 17)  # in the middle of a movement
    x = walker.position[0]
    model.floor_plan.add_obstacle(box(x + ahead, 0.5, x + ahead + 0.4, 3.5))
    advance(model, 300)
    safety = check_safety(Trajectories.of(model), model.floor_plan.walls)
    assert safety.wall_crossings == 0


def test_nobody_leaves_by_a_door_that_has_just_closed():
    model = model_of(corridor(length=10.0), strider())
    walker = put(model, 9.0, 2.0, preferred_speeds=[1.25])
    advance(model, 3)
    model.floor_plan.close_gate(model.floor_plan.exits[0].name)
    advance(model, 90)
    assert model.inside == 1
    assert walker.position[0] < 10.0


def test_people_behind_one_who_had_to_stop_do_not_run_into_it():
    model = model_of(corridor(), shipped_map(), rng=1)
    lanes = [(x, y) for x in np.arange(1.0, 6.0, 0.5) for y in (1.0, 2.0, 3.0)]
    model.add_pedestrians(lanes)
    advance(model, 50)
    model.floor_plan.add_obstacle(box(8.0, 0.0, 8.3, 3.0))
    advance(model, 200)
    safety = check_safety(Trajectories.of(model), model.floor_plan.walls)
    assert (safety.overlaps, safety.wall_crossings) == (0, 0)


def test_newcomers_find_room_or_are_refused():
    model = model_of(corridor(), strider())
    walker = put(model, 2.0, 2.0, preferred_speeds=[1.25])
    with pytest.raises(ModelError, match=r"pedestrian 1 .* too close to another newcomer"):
        model.add_pedestrians([(5.0, 2.0), (5.1, 2.0)])
    advance(model, 5)
    x = walker.position[0]
    with pytest.raises(ModelError, match="too close to where pedestrian 0 is or will be"):
        put(model, x + 0.5, 2.0)  # free now, but the walker is on its way there
    put(model, x, 3.0)
    assert model.inside == 2


@pytest.mark.parametrize(
    ("points", "refused"),
    [
        ([(8.0, 2.0), (5.0, 1.0), (5.2, 1.0), (8.2, 2.0)], "pedestrian 2 .* another newcomer"),
        ([(8.0, 2.0), (2.2, 2.0), (8.2, 2.0)], "pedestrian 1 .* where pedestrian 0 is"),
        ([(8.0, 2.0), (8.2, 2.0), (2.2, 2.0)], "pedestrian 1 .* another newcomer"),
    ],
)
def test_of_newcomers_without_room_the_first_is_named(points, refused):
    model = model_of(corridor(), strider())  # bodies keep 0.28 m from one another
    put(model, 2.0, 2.0)
    with pytest.raises(ModelError, match=refused):
        model.add_pedestrians(points)
    assert model.inside == 1


def test_without_a_way_out_people_stay_about_where_they_are():
    plan = FloorPlan(box(0, 0, 30, 30), exits=[Exit("door", (30, 14), (30, 16))])
    plan.close_gate("door")
    model = model_of(plan, shipped_map(), rng=2)
    people = model.add_pedestrians([(10.0, 10.0), (20.0, 12.0)])
    advance(model, 900)
    for person, start in zip(people, [(10.0, 10.0), (20.0, 12.0)], strict=True):
        assert np.hypot(*(person.position - start)) < 1.0


def test_another_way_round_is_not_a_stall():
    plan = FloorPlan(
        box(0, 0, 120, 4),
        exits=[Exit("west", (0, 0), (0, 4)), Exit("east", (120, 0), (120, 4))],
    )
    model = model_of(plan, strider(), frames_per_step=3)
    put(model, 8.0, 2.0, preferred_speeds=[1.25])
    advance(model, 30)
    plan.close_gate("west")
    model.run(max_seconds=300)
    assert not model.stalled
    assert model.inside == 0


def test_a_model_runs_on_when_people_come_again():
    model = model_of(corridor(length=6.0), strider(), frames_per_step=3)
    model.step()
    assert not model.running
    assert model.summary()["egress_s"] is None
    put(model, 1.0, 2.0, preferred_speeds=[1.25])
    model.run(max_seconds=60)
    assert model.inside == 0
    assert model.summary()["egress_s"] > 3.0


def test_a_kernel_that_gives_no_number_is_refused():
    from mesa_mobility import CompiledTerm, option_kernel

    @option_kernel
    def slowness(option):
        return 1.0 / option.speed

    class Slowness(CompiledTerm):
        name = "slowness"
        kernel = slowness

    model = model_of(corridor(), strider())
    put(model, 2.0, 2.0)
    model.terms.append(Slowness())
    with pytest.raises(ModelError, match=r"not a number.*slowness"):
        advance(model, 3)
