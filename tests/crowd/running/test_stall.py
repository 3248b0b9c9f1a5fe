"""An evacuation has stalled when for a minute nobody left and nobody came nearer to an exit."""

import pytest
from shapely import box

from mesa_mobility import Exit, FloorPlan, Source
from tests.fixtures.maps import shipped_map, strider
from tests.fixtures.scenes import advance, corridor, dead_end, model_of, put, statues


def test_a_minute_of_nothing():
    model = model_of(corridor(), statues(), frames_per_step=3)
    put(model, 5.0, 2.0)
    model.run(max_seconds=600)
    assert model.stalled
    assert model.elapsed == pytest.approx(60.0, abs=0.5)
    assert model.inside == 1
    summary = model.summary()
    assert summary["stalled"] is True
    assert summary["egress_s"] is None
    assert summary["left_inside"] == 1


def test_not_before():
    model = model_of(corridor(), statues(), frames_per_step=3)
    put(model, 5.0, 2.0)
    model.run(max_seconds=55)
    assert not model.stalled


def test_a_minute_of_nothing_for_those_who_are_left():
    """Somebody far ahead leaves after 4 s; whoever is left has stood all the time."""
    model = model_of(corridor(), [strider(), statues()], frames_per_step=3)
    put(model, 15.0, 1.0)
    put(model, 10.0, 3.0, type_index=1)
    model.run(max_seconds=600)
    assert model.stalled
    assert model.statistics.last_left == pytest.approx(4.0, abs=0.2)
    assert model.elapsed == pytest.approx(60.1, abs=0.1)


def test_somebody_on_a_long_way_does_not_stall():
    model = model_of(corridor(length=120.0), strider(), frames_per_step=3)
    put(model, 1.0, 2.0, preferred_speeds=[1.25])
    model.run(max_seconds=200)
    assert not model.stalled
    assert model.inside == 0


def test_nor_where_somebody_else_has_no_way_out():
    plan = FloorPlan(
        box(0, 0, 120, 4), exits=[Exit("east", (120, 0), (120, 4)), Exit("west", (0, 0), (0, 4))]
    )
    plan.close_gate("west")
    model = model_of(plan, [strider(), statues()], frames_per_step=3)
    walker = put(model, 1.0, 1.0, preferred_speeds=[1.25], exits=["east"])
    put(model, 3.0, 3.0, exits=["west"], type_index=1)
    model.run(max_seconds=90)
    assert walker.position[0] == pytest.approx(113.5, abs=2.0)
    assert not model.stalled


def test_a_way_out_that_opens_ends_it():
    model = model_of(dead_end(x=8.0, depth=8.0), shipped_map(), rng=6, frames_per_step=3)
    model.floor_plan.close_gate("west")
    model.add_pedestrians([(4.0, 1.0), (5.0, 2.0)])
    model.run(max_seconds=120)
    assert model.stalled
    model.floor_plan.open_gate("west")
    advance(model, 30)
    assert not model.stalled
    model.run(max_seconds=240)
    assert model.inside == 0


def stalled():
    """Somebody who cannot move, a minute and a bit later."""
    model = model_of(corridor(), [statues(), strider()], frames_per_step=3)
    put(model, 5.0, 2.0)
    model.run()
    assert model.stalled
    return model


def let_in_later(model):
    model.add_source(Source(area=box(8, 1, 12, 3), rate=1.0, start=model.elapsed + 20, number=3))


def put_behind_a_closed_door(model):
    model.floor_plan.close_gate("east")
    advance(model, 1)
    model.go_on()
    model.run()
    assert model.stall_reason == "every exit is closed"
    put(model, 12.0, 2.0, type_index=1)


@pytest.mark.parametrize(
    "change", [let_in_later, put_behind_a_closed_door, lambda model: model.go_on()]
)
def test_a_run_that_has_stalled_has_another_minute_when_people_come_or_somebody_asks(change):
    model = stalled()
    change(model)
    before = model.elapsed
    assert model.running
    assert not model.stalled
    while model.running and model.elapsed < before + 59.0:
        model.step()
    assert model.elapsed == pytest.approx(before + 59.0, abs=0.1)
