"""Progress towards the exits, measured on invented remaining distances."""

import numpy as np
import pytest
from shapely import box

from mesa_mobility import Exit, FloorPlan
from mesa_mobility.crowd.options.table import FRAMES_A_SECOND
from mesa_mobility.crowd.running.stall import StallWatch
from mesa_mobility.crowd.state.aggregates import Aggregates
from mesa_mobility.crowd.state.records import Crowd
from tests.fixtures.scenes import corridor, model_of, put, statues


def stalls_at(routes, *, gone=lambda t: 0) -> float | None:
    """Seconds at which people whose ways are ``routes(t)``, metres, count as stalled, if ever."""
    watch, crowd = StallWatch(), Crowd(len(routes(0.0)))
    rows = np.arange(len(crowd.route))
    for frame in range(0, 400 * FRAMES_A_SECOND, 3):
        seconds = frame / FRAMES_A_SECOND
        crowd.route[:] = routes(seconds)
        going = int(np.isfinite(crowd.route).sum())
        seen = Aggregates(people=len(rows), speeds=0.0, going=going, awaited=0)
        if watch.stalled(frame, rows, crowd, seen, gone(seconds), 0):
            return seconds
    return None


def test_stepping_back_and_forth_is_not_coming_nearer():
    rng = np.random.default_rng(1)
    places = rng.uniform(1.0, 8.0, 140)
    to_and_fro = rng.uniform(-0.8, 0.8, (4000, 140))
    assert stalls_at(lambda t: places + to_and_fro[int(10 * t)]) == pytest.approx(60.0, abs=60.0)


def test_changing_places_is_not_coming_nearer():
    near_and_far = np.repeat([[4.0], [6.0]], 30, axis=1)
    swapped = [near_and_far.ravel(), near_and_far[::-1].ravel()]
    assert stalls_at(lambda t: swapped[int(t) // 2 % 2]) == pytest.approx(60.0, abs=3.0)


def test_pressing_closer_is_not_coming_nearer():
    # 0.15 m a minute each: more than a metre all together.
    places = np.linspace(1.0, 8.0, 100)
    assert stalls_at(lambda t: places - 0.0025 * t) == pytest.approx(60.0, abs=1.0)


@pytest.mark.parametrize("speed", [0.02, 1.0])
def test_a_crowd_on_its_way_does_not_stall(speed):
    places = np.linspace(410.0, 420.0, 100)
    assert stalls_at(lambda t: places - speed * t) is None


def test_one_on_a_long_way_among_many_who_stand_does_not_stall():
    standing = np.full(2000, 5.0)
    assert stalls_at(lambda t: np.append(standing, 500.0 - 0.5 * t)) is None


def test_nor_do_people_who_leave_now_and_then():
    places = np.linspace(1.0, 8.0, 100)
    assert stalls_at(lambda t: places, gone=lambda t: int(t // 50)) is None


def test_another_way_is_no_step_back():
    # After 30 s the door closes: 200 m more to walk, which takes until long after a minute.
    assert stalls_at(lambda t: np.array([50.0 - t + 200.0 * (t >= 30.0) + 400.0] * 3)) is None


def test_to_change_ones_mind_again_and_again_is_not_coming_nearer():
    places = np.linspace(5.0, 8.0, 20)
    assert stalls_at(lambda t: places + 20.0 * (int(t) // 7 % 2)) == pytest.approx(60.0, abs=1.0)


def test_people_without_a_way_are_ignored():
    assert stalls_at(lambda t: np.array([np.inf, np.inf])) == pytest.approx(60.0, abs=1.0)


def test_the_reason_is_that_every_exit_is_closed():
    model = model_of(corridor(), statues(), frames_per_step=3)
    put(model, 5.0, 2.0)
    model.floor_plan.close_gate("east")
    assert model.stall_reason is None
    model.run(max_seconds=200)
    assert model.stalled
    assert model.stall_reason == model.summary()["stall_reason"] == "every exit is closed"


def test_the_reason_is_that_there_is_no_way():
    plan = FloorPlan(
        box(0, 0, 20, 4), exits=[Exit("east", (20, 0), (20, 4)), Exit("west", (0, 0), (0, 4))]
    )
    model = model_of(plan, statues(), frames_per_step=3)
    put(model, 5.0, 2.0, exits=["east"])
    plan.close_gate("east")
    model.run(max_seconds=200)
    assert model.stall_reason == "nobody inside has a way to go"


def test_the_reason_is_that_nobody_gets_on():
    model = model_of(corridor(), statues(), frames_per_step=3)
    put(model, 5.0, 2.0)
    model.run(max_seconds=200)
    assert model.stall_reason == "nobody has come nearer to an exit for 60 s"
