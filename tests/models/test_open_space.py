"""Two groups cross a plaza at right angles."""

import numpy as np
import pytest
from mesa_mobility.models import OpenSpace

from tests.fixtures.maps import shipped_map
from tests.fixtures.oracles.counting import overlaps, track, wall_crossings
from tests.fixtures.scenes import core_of


@pytest.fixture(scope="module", params=[1, 2])
def crossing(request):
    model = OpenSpace(mobility_map=shipped_map(), record=True, rng=request.param)
    model.run(max_seconds=120)
    return model


def test_everybody_crosses_and_leaves(crossing):
    assert crossing.population.count == 100
    assert crossing.inside == 0
    # 30 m at the slowest speed there is, 0.6 m/s.
    assert crossing.elapsed < 60


def test_each_group_leaves_by_its_own_side(crossing):
    rows = crossing.recorder.arrays()
    tracks = [track(rows, person) for person in range(100)]
    east, north = tracks[:50], tracks[50:]
    assert all(t[0, 1] < 10.0 and 30.0 <= t[-1, 1] < 32.0 for t in east)
    assert all(0.0 < t[-1, 2] < 30.0 for t in east)
    assert all(t[0, 2] < 10.0 and 30.0 <= t[-1, 2] < 32.0 for t in north)
    assert all(0.0 < t[-1, 1] < 30.0 for t in north)


def test_nobody_overlaps_or_crosses_a_wall(crossing):
    rows = crossing.recorder.arrays()
    assert overlaps(rows, core_of(crossing)) == 0
    assert wall_crossings(rows, crossing.floor_plan.walls) == 0


def test_where_there_is_room_people_hardly_need_the_fallback(crossing):
    assert crossing.statistics.fallback_time_share < 0.02
    assert crossing.summary()["mean_speed_mps"] > 1.0


def test_an_odd_number_of_people():
    model = OpenSpace(pedestrians=7, mobility_map=shipped_map(), rng=1)
    x = np.array([person.position[0] for person in model.agents])
    assert (x < 10.0).sum() == 4


def test_the_paper_preset_runs_to_its_end():
    model = OpenSpace(mobility_map=shipped_map(), preset="paper", record=True, rng=1)
    model.run(max_seconds=120)
    assert model.inside == 0
    assert wall_crossings(model.recorder.arrays(), model.floor_plan.walls) == 0
