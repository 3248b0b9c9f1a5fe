"""People who have stood for a minute without a reason, and the rings that they belong to."""

from types import SimpleNamespace

import numpy as np
import pytest
from mesa_mobility.behaviors import Counter, Queueing
from shapely import box

from mesa_mobility import Exit, FloorPlan, PedestrianModel
from mesa_mobility.crowd import Watch
from mesa_mobility.crowd.running.blocking import in_words, ring_of
from mesa_mobility.crowd.running.last_minute import LastMinute
from mesa_mobility.crowd.running.standing import StandingWatch
from mesa_mobility.crowd.state.records import Crowd
from mesa_mobility.errors import ContentError, ModelError
from mesa_mobility.plugins.registry import load_behavior
from tests.fixtures.maps import shipped_map, strider
from tests.fixtures.scenes import advance, corridor, model_of, put, statues


def narrow(places, *, frames_per_step=3):
    """People (x, name of the exit) in a corridor 0.5 m wide, without any tactic."""
    model = model_of(
        corridor(12.0, 0.5, both_ends=True), shipped_map(), frames_per_step=frames_per_step
    )
    model.tactics.clear()
    for x, goal in places:
        put(model, x, 0.25, np.pi * (goal == "west"), exits=[goal])
    return model


FACE_TO_FACE = ((5.8, "east"), (6.2, "west"))


@pytest.mark.parametrize("frames_per_step", [3, 7, 45])
def test_two_who_face_each_other_are_reported_after_a_minute(frames_per_step):
    model = narrow(FACE_TO_FACE, frames_per_step=frames_per_step)
    while model.frame + frames_per_step < 1800:
        model.step()
        assert model.blocked == []
    model.step()
    model.step()
    assert [(each.person, each.since, each.ring) for each in model.blocked] == [
        (0, 0.0, (1, 0)),
        (1, 0.0, (0, 1)),
    ]
    assert model.summary()["blocked"] == [
        {"person": 0, "since_s": 0.0, "ring": [1, 0], "stands": True},
        {"person": 1, "since_s": 0.0, "ring": [0, 1], "stands": True},
    ]


def test_the_reason_of_a_stall_names_the_ring():
    model = narrow(FACE_TO_FACE)
    model.run()
    assert model.elapsed == pytest.approx(60.1, abs=0.01)
    assert model.stall_reason == (
        "nobody has come nearer to an exit for 60 s: people 0 and 1 are in each other's way"
    )


def test_whoever_stands_behind_a_ring_has_it_in_the_way():
    model = narrow([*FACE_TO_FACE, (5.3, "east")])
    assert [model.blocked_by(row) for row in range(3)] == [[], [], []]
    model.run(max_seconds=10)
    assert [model.blocked_by(row) for row in range(3)] == [[1, 0], [0, 1], [0, 1, 0]]
    assert [model.explain(row).blocked_by for row in range(3)] == [1, 0, 0]
    model.watch = Watch(2)
    advance(model, 45)
    assert model.watch.decision.blocked_by == 0
    with pytest.raises(ModelError, match="pedestrian 3: expected the row of somebody inside"):
        model.blocked_by(3)


def test_a_chain_ends_with_somebody_who_gets_on_waits_or_has_nobody_in_the_way():
    model = narrow([(8.0, "east"), (8.4, "east")])
    list(model.agents)[1].wait(1000.0)
    model.tactics.append(load_behavior("waiting")())
    model.run(max_seconds=10)
    assert model.blocked_by(0) == [1]
    assert model.blocked_by(1) == []
    model = narrow([(1.0, "east"), (1.5, "east")])
    model.run(max_seconds=6)
    assert [model.blocked_by(0), model.blocked_by(1)] == [[], []]


def test_somebody_alone_before_a_wall_stands_in_nobodys_way():
    model = model_of(corridor(), strider(), frames_per_step=3)
    model.floor_plan.add_obstacle(box(10.0, 0.0, 10.4, 3.5))
    put(model, 9.7, 1.0)
    model.run(max_seconds=200)
    assert [(each.person, each.since, each.ring) for each in model.blocked] == [(0, 0.0, ())]
    assert model.stalled
    assert model.stall_reason == "nobody has come nearer to an exit for 60 s"
    # Loose later, it still counts, and once.
    model.floor_plan.remove_obstacle(0)
    model.run(max_seconds=200)
    assert model.inside == 0
    assert model.blocked == []
    assert model.summary()["blocked"] == [
        {"person": 0, "since_s": 0.0, "ring": [], "stands": False}
    ]


def reported_at(model, seconds=200):
    """Second at which somebody is reported first."""
    while model.elapsed < seconds:
        model.step()
        if model.blocked:
            return model.elapsed
    return None


def test_whoever_is_told_to_wait_has_a_reason_until_then():
    model = model_of(corridor(), statues(), frames_per_step=3)
    put(model, 5.0, 2.0).wait(30.0)
    assert reported_at(model) == pytest.approx(90.0)
    assert model.blocked[0].since == 30.0


def test_a_jam_that_moves_is_a_reason():
    """Somebody passes after 29 s and leaves.  At 30 s they are 1.25 m away, with 0.75 m less to go;
    that second is within the last minute until 90 s."""
    model = model_of(corridor(), [statues(), strider()], frames_per_step=3)
    put(model, 10.0, 2.0)
    advance(model, 29 * 30)
    put(model, 9.5, 1.0, type_index=1, preferred_speeds=[1.25])
    assert reported_at(model) == pytest.approx(91.0)
    assert model.inside == 1
    assert model.blocked[0].since == 31.0


def test_somebody_behind_or_farther_away_who_gets_on_is_none():
    model = model_of(corridor(), [statues(), strider()], frames_per_step=3)
    put(model, 10.0, 2.0)
    # They walk from 7.5 m behind for 4 s, and are halted by a wall 1.2 m behind the other.
    model.floor_plan.add_obstacle(box(8.8, 0.0, 9.0, 1.5))
    put(model, 3.0, 0.7, type_index=1, preferred_speeds=[1.25])
    put(model, 15.0, 1.0, type_index=1, preferred_speeds=[1.25])
    assert reported_at(model) == pytest.approx(60.0)
    assert [each.person for each in model.blocked] == [0]


def test_whoever_comes_by_again_on_a_round_has_not_stood():
    """A round takes 20 s, so they are where they were after three of them; the other stands."""
    watch, crowd = StandingWatch(), Crowd(2)
    crowd.active[:], crowd.route[:], crowd.agenda["speed"] = True, 50.0, 1.2
    model = SimpleNamespace(
        crowd=crowd,
        population=SimpleNamespace(present=np.arange(2), count=2),
        wishes=lambda rows: SimpleNamespace(blockers=np.full(len(rows), -1)),
    )
    for second in range(100):
        angle = 2 * np.pi * second / 20.0
        crowd.x[:], crowd.y[:] = (4.0 * np.cos(angle), 50.0), (4.0 * np.sin(angle), 0.0)
        crowd.from_x[:], crowd.from_y[:] = crowd.x, crowd.y
        model.frame, model.elapsed = 30 * second, float(second)
        watch.look(model)
        assert [each.person for each in watch.now] == [1] * (second >= 60)


def test_a_queue_waits_for_a_reason():
    counter = Counter([(10, 6), (3, 6)], service=80.0, spacing=0.6)
    plan = FloorPlan(box(0, 0, 16, 8), exits=[Exit("out", (16, 0), (16, 2))])
    model = model_of(plan, shipped_map(), frames_per_step=3)
    model.add_tactic(Queueing([counter]))
    model.add_pedestrians([(8.6, 5.0), (9.3, 5.0), (8.0, 5.0)], route=[counter.visit])
    model.run(max_seconds=100)
    assert model.inside == 2 or model.inside == 3
    assert model.summary()["blocked"] == []


def test_closed_exits_are_a_reason():
    model = model_of(corridor(), shipped_map(), frames_per_step=3)
    model.add_pedestrians([(4.0, 1.0), (5.0, 2.0)])
    model.floor_plan.close_gate("east")
    model.run(max_seconds=200)
    assert model.stall_reason == "every exit is closed"
    assert model.summary()["blocked"] == []


def test_a_crowd_of_which_one_waits_has_not_stalled_yet():
    model = model_of(corridor(), statues(), frames_per_step=3)
    put(model, 5.0, 2.0)
    put(model, 9.0, 2.0).wait(100.0)
    model.run(max_seconds=90)
    assert not model.stalled
    assert [each.person for each in model.blocked] == [0]


@pytest.mark.parametrize("at", [20, 65])
def test_a_loaded_model_reports_the_same(tmp_path, at):
    model = narrow([*FACE_TO_FACE, (2.0, "east")])
    advance(model, at * 30)
    model.save(tmp_path / "one.zip")
    again = PedestrianModel.load(
        tmp_path / "one.zip", pedestrian_types=list(model.pedestrian_types)
    )
    again.save(tmp_path / "two.zip")
    assert (tmp_path / "one.zip").read_bytes() == (tmp_path / "two.zip").read_bytes()
    for each in (model, again):
        advance(each, (80 - at) * 30)
    assert model.summary() == again.summary()
    assert model.blocked == again.blocked
    assert [each.person for each in model.blocked] == [0, 1, 2]
    assert model.stall_reason == again.stall_reason


def test_rings_of_chains():
    assert ring_of(0, [1, 0]) == [0, 1]
    assert ring_of(0, [4, 7, 9, 4]) == [4, 7, 9]
    assert ring_of(0, [4, 7]) == ring_of(0, []) == []
    assert [in_words([3]), in_words([3, 5, 9])] == ["3", "3, 5 and 9"]


def test_places_far_from_the_origin_are_kept_to_the_millimetre():
    crowd, minute = Crowd(3), LastMinute()
    crowd.x[:], crowd.y[:], crowd.route[:] = (4e6, 4e6 + 0.125, 4e6 + 700.001), 5e6, (3, 2, np.inf)
    crowd.from_x[:], crowd.from_y[:] = crowd.x, crowd.y
    minute.add(7, np.array([0, 2]), crowd)
    again = LastMinute()
    again.restore(minute.state())
    x, y, ways = again.at(7).of(np.array([0, 1, 2]))
    assert x == pytest.approx([4e6, np.inf, 4e6 + 700.001], abs=1e-3, rel=0)
    assert (y[0], ways.tolist()) == (5e6, [3.0, np.inf, np.inf])
    assert again.at(8) is None


def test_a_damaged_minute_is_refused():
    crowd, minute = Crowd(3), LastMinute()
    minute.add(7, np.array([0, 2]), crowd)
    with pytest.raises(ContentError, match="counts: got 3 people at 1 seconds, expected 2"):
        LastMinute().restore({**minute.state(), "counts": np.array([3])})
    with pytest.raises(ContentError, match="rows: not rising at 7 s"):
        LastMinute().restore({**minute.state(), "rows": np.array([2, 2])})
