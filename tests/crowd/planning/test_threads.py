"""Large crowds are decided by several threads; nothing else about them changes."""

import math
import os
import threading
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from shapely import box

from mesa_mobility import Exit, FloorPlan, PedestrianModel
from mesa_mobility.compiled import threads
from mesa_mobility.crowd import CompiledTerm, option_kernel
from mesa_mobility.errors import ModelError


@option_kernel
def _lost(me):
    return math.nan if me.preferred_speed > 1.6 else 0.0


class LostIfFast(CompiledTerm):
    """Not a number for those who like to walk faster than 1.6 m/s."""

    name = "lost_if_fast"
    kernel = _lost


def crowd(people, behaviors=None):
    """Half of them walk to the left and half to the right, 0.8 persons/m2, all through others."""
    rng = np.random.default_rng(3)
    width = (people / 0.8 / 2.0) ** 0.5
    plan = FloorPlan(
        box(0.0, 0.0, 2.0 * width, width),
        exits=[
            Exit("left", (0.0, 0.0), (0.0, width)),
            Exit("right", (2.0 * width, 0.0), (2.0 * width, width)),
        ],
    )
    model = PedestrianModel(plan, rng=5, record=True, behaviors=behaviors)
    across = int(np.ceil((2.0 * people) ** 0.5))
    row, column = np.divmod(rng.permutation(across * (people // across))[:people], across)
    places = np.column_stack([column + 0.5, row + 0.5]) * 2.0 * width / across
    places = places[(places[:, 1] > 0.4) & (places[:, 1] < width - 0.4)]
    for name, half in zip(("left", "right"), np.array_split(places, 2), strict=True):
        model.add_pedestrians(half, exits=[name])
    return model


def frames(count, monkeypatch):
    """Every frame of two seconds of 900 people with so many threads."""
    monkeypatch.setattr(threads, "THREADS", count)
    threads._pool.cache_clear()
    model = crowd(900)
    model.run(2.0)
    threads._pool.cache_clear()
    return model


@pytest.fixture(scope="module")
def alone():
    with pytest.MonkeyPatch.context() as patch:
        return frames(1, patch)


@pytest.mark.parametrize("count", [2, 3, 7])
def test_the_same_bytes_whatever_the_number_of_threads(count, alone, monkeypatch):
    model = frames(count, monkeypatch)
    theirs, ours = alone.recorder.arrays(), model.recorder.arrays()
    assert theirs.keys() == ours.keys()
    for name, values in theirs.items():
        assert values.tobytes() == ours[name].tobytes(), name
    assert model.crowd.records.tobytes() == alone.crowd.records.tobytes()
    assert model.statistics.mean_speed_so_far == alone.statistics.mean_speed_so_far


def test_more_people_than_threads_can_ask_decide_in_one_frame(alone):
    # All start at once, so the first frame has them all, one within reach of the other.
    assert len(alone.rows) > 3 * threads.MANY
    assert alone.crowd.decisions[: alone.population.count].min() >= 1


def test_small_crowds_start_no_thread(monkeypatch):
    def none(*args, **kwargs):
        raise AssertionError("a thread was started")

    monkeypatch.setattr(threads, "THREADS", 4)
    monkeypatch.setattr(ThreadPoolExecutor, "submit", none)
    model = crowd(200)
    model.run(1.0)
    assert model.elapsed == pytest.approx(1.0)


def test_models_share_their_threads(monkeypatch):
    frames(2, monkeypatch)
    before = threading.active_count()
    monkeypatch.setattr(threads, "THREADS", 2)
    for _ in range(3):
        crowd(900).run(0.2)
    assert threading.active_count() <= before + 2
    threads._pool.cache_clear()


@pytest.mark.parametrize("count", [1, 3])
def test_the_first_for_whom_a_cost_is_not_a_number_is_named(count, monkeypatch):
    monkeypatch.setattr(threads, "THREADS", count)
    threads._pool.cache_clear()
    model = crowd(900, behaviors=[LostIfFast()])
    with pytest.raises(ModelError, match="not a number") as error:
        model.step()
    threads._pool.cache_clear()
    order = model.rows[np.argsort(model.crowd.route[model.rows], kind="stable")]
    first = order[model.crowd.preferred[order] > 1.6][0]
    assert f"pedestrian {first}:" in str(error.value)


@pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")
@pytest.mark.skipif(not hasattr(os, "fork"), reason="there are no forks here")
def test_a_forked_process_has_threads_of_its_own(monkeypatch):
    frames(2, monkeypatch)
    monkeypatch.setattr(threads, "THREADS", 2)
    crowd(900).run(0.2)  # the threads run
    child = os.fork()
    if child == 0:
        crowd(900).run(0.2)
        os._exit(0)
    deadline = threading.Timer(60.0, os.kill, (child, 9))
    deadline.start()
    _, status = os.waitpid(child, 0)
    deadline.cancel()
    threads._pool.cache_clear()
    assert status == 0
