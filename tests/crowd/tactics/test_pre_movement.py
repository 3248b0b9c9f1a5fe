"""People who set off later stand until then, and others walk round them."""

import numpy as np
import pytest
from mesa_mobility.models import Doorway

from mesa_mobility.distributions import Constant, Uniform
from mesa_mobility.errors import ModelError
from tests.fixtures.maps import shipped_map, strider
from tests.fixtures.oracles.counting import overlaps, track, wall_crossings
from tests.fixtures.scenes import advance, core_of, corridor, model_of, put, two_doors


def first_move(model, person):
    """Seconds at which a track first differs from where it began."""
    rows = track(model.recorder.arrays(), person.row)
    moved = np.hypot(*(rows[:, 1:3] - rows[0, 1:3]).T) > 0.0
    return (rows[np.argmax(moved), 0] - 1) / 30 if moved.any() else None


@pytest.mark.parametrize(("seconds", "frame"), [(0.0, 0), (0.01, 1), (0.5, 15), (3.0, 90)])
def test_sets_off_in_the_first_frame_after_its_time(seconds, frame):
    model = model_of(corridor(), strider())
    person = put(model, 2.0, 2.0, preferred_speeds=[1.25], pre_movement=seconds)
    assert person.start_time == pytest.approx(frame / 30)
    assert person.next_decision == pytest.approx(frame / 30)
    advance(model, frame + 45)
    assert first_move(model, person) == pytest.approx(frame / 30)
    assert person.position[0] == pytest.approx(3.875, abs=1e-6)
    assert int(model.crowd.decisions[person.row]) == 1


def test_counted_from_when_somebody_comes():
    model = model_of(corridor(), strider())
    put(model, 2.0, 1.0)
    advance(model, 30)
    late = put(model, 2.0, 3.0, pre_movement=2.0)
    assert late.start_time == pytest.approx(3.0)
    advance(model, 61)
    assert first_move(model, late) == pytest.approx(3.0)


def test_faces_its_first_target_all_the_while():
    model = model_of(two_doors(), strider())
    (person,) = model.add_pedestrians([(4.0, 5.5)], pre_movement=3.0)
    aim = person.target - person.position
    assert person.heading == pytest.approx(np.arctan2(aim[1], aim[0]))
    advance(model, 60)
    assert person.heading == pytest.approx(np.arctan2(aim[1], aim[0]))


def test_each_its_own_or_all_the_same_or_drawn():
    model = model_of(corridor(), strider(), rng=4)
    places = [(2.0, 0.5), (2.0, 1.5), (2.0, 2.5)]
    own = model.add_pedestrians(places, pre_movement=[0.0, 1.0, 40.0])
    assert [p.start_time for p in own] == pytest.approx([0.0, 1.0, 40.0])
    same = model.add_pedestrians(np.add(places, (2, 0)), pre_movement=Constant(7.0))
    assert [p.start_time for p in same] == pytest.approx([7.0] * 3)
    drawn = model.add_pedestrians(np.add(places, (4, 0)), pre_movement=Uniform(10.0, 100.0))
    times = [p.start_time for p in drawn]
    assert len(set(times)) == 3
    assert all(10.0 <= t <= 100.04 for t in times)


def test_preferred_speeds_drawn_from_a_distribution():
    model = model_of(corridor(), strider(), rng=4)
    people = model.add_pedestrians([(2.0, 1.0), (2.0, 3.0)], preferred_speeds=Uniform(0.97, 1.62))
    assert all(0.97 <= p.preferred_speed <= 1.62 for p in people)
    assert people[0].preferred_speed != people[1].preferred_speed


def test_somebody_who_stands_for_long_is_walked_round_and_unhurt():
    model = model_of(corridor(width=2.5), shipped_map(), rng=3, frames_per_step=3)
    model.add_pedestrians([(6.0, 0.6), (6.0, 1.25), (6.3, 1.9)], pre_movement=[20.0, 25.0, 1e5])
    places = model.floor_plan.random_points(
        12, model.rng, spacing=0.7, clearance=0.3, within=corridor(4.0, 2.5).walkable
    )
    model.add_pedestrians(places)
    model.run(max_seconds=60)
    assert model.inside == 1
    rows = model.recorder.arrays()
    assert overlaps(rows, core_of(model)) == 0
    assert wall_crossings(rows, model.floor_plan.walls) == 0
    still = track(rows, 2)
    assert (still[:, 1:3] == still[0, 1:3]).all()


def test_nobody_can_be_put_on_somebody_who_stands_for_long():
    model = model_of(corridor(), strider())
    put(model, 2.0, 2.0, pre_movement=100.0)
    advance(model, 60)
    with pytest.raises(ModelError, match="pedestrian 0"):
        put(model, 2.1, 2.0)


def test_a_wall_put_beside_somebody_who_stands_changes_nothing():
    model = model_of(corridor(), strider())
    person = put(model, 2.0, 2.0, pre_movement=2.0)
    advance(model, 10)
    model.floor_plan.add_obstacle("POLYGON((2.16 1, 2.4 1, 2.4 3, 2.16 3, 2.16 1))")
    advance(model, 45)
    assert person.position.tolist() == [2.0, 2.0]
    assert person.start_time == pytest.approx(2.0)


def test_a_run_has_not_stalled_while_somebody_is_yet_to_set_off():
    model = model_of(corridor(length=6.0), strider(), frames_per_step=3)
    put(model, 2.0, 2.0, preferred_speeds=[1.25], pre_movement=100.0)
    model.run()
    assert not model.stalled
    assert model.statistics.last_left == pytest.approx(100.0 + 4.0 / 1.25, abs=0.5)


@pytest.mark.parametrize("times", [-1.0, [1.0, 2.0], np.nan, 1e7, "lognormal(3, 1)"])
def test_times_that_cannot_be(times):
    model = model_of(corridor(), strider())
    with pytest.raises(ModelError, match="pre_movement") as refused:
        put(model, 2.0, 2.0, pre_movement=times)
    assert "\n" not in str(refused.value)
    assert model.inside == 0


def test_models_take_it():
    model = Doorway(pedestrians=8, pre_movement=Uniform(1.0, 5.0), rng=2, record=True)
    starts = {p.row: p.start_time for p in model.agents}
    assert min(starts.values()) >= 1.0
    model.run(max_seconds=60)
    rows = model.recorder.arrays()
    for row, start in starts.items():
        path = track(rows, row)
        before = path[path[:, 0] <= round(start * 30)]
        assert (before[:, 1:3] == before[0, 1:3]).all()


def test_somebody_behind_a_closed_exit_can_come_and_wait_for_it_to_open():
    model = model_of(two_doors(), strider())
    model.floor_plan.close_gate("left")
    put(model, 4.0, 4.0, exits=["left"])
    assert model.inside == 1
