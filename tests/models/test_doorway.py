"""Figure 6: through a door, then on to a second one, counted by code that shares nothing."""

import numpy as np
import pytest
import shapely
from mesa_mobility.models import Doorway

from tests.fixtures.maps import shipped_map
from tests.fixtures.oracles.counting import crossings, overlaps, track, wall_crossings
from tests.fixtures.scenes import core_of


def run(seed, **keywords):
    model = Doorway(mobility_map=shipped_map(), record=True, rng=seed, **keywords)
    model.run(max_seconds=300)
    return model


@pytest.fixture(
    scope="module",
    params=[1, 2, *(pytest.param(seed, marks=pytest.mark.slow) for seed in range(3, 11))],
)
def doorway(request):
    return run(request.param)


def test_sixty_people_pass_both_doors_in_turn(doorway):
    assert doorway.population.count == 60
    assert doorway.inside == 0
    rows = doorway.recorder.arrays()
    plan = doorway.floor_plan
    first, second = plan.gate("first door"), plan.gate("second door")
    once_over = crossings(rows, second.a, second.b)
    assert once_over == dict.fromkeys(range(60), 1)
    passed = crossings(rows, first.a, first.b)
    # People who sway back over the line in a jam cross it once more in the end.
    assert set(passed) == set(range(60))
    assert all(times % 2 == 1 for times in passed.values())


def test_nobody_overlaps(doorway):
    assert overlaps(doorway.recorder.arrays(), core_of(doorway)) == 0


def test_nobody_crosses_a_wall(doorway):
    rows = doorway.recorder.arrays()
    assert wall_crossings(rows, doorway.floor_plan.walls) == 0


def test_bodies_keep_off_the_walls(doorway):
    rows = doorway.recorder.arrays()
    barrier = shapely.multilinestrings(
        shapely.linestrings(doorway.floor_plan.walls.reshape(-1, 2, 2))
    )
    shapely.prepare(barrier)
    points = shapely.points(rows["x"], rows["y"])
    inside = rows["x"] < doorway.floor_plan.bounds[2]
    assert not shapely.dwithin(points[inside], barrier, core_of(doorway) - 1e-5).any()


def test_nobody_needs_the_fallback(doorway):
    # To stay where one is is among everybody's options, and always free.
    assert doorway.statistics.fallback_decision_share == 0.0


def test_a_step_leads_no_further_than_people_can_go(doorway):
    rows = doorway.recorder.arrays()
    for person in range(60):
        t = track(rows, person)
        # 3 m/s and a turn of 12 rad/s are beyond anything walked.
        assert np.hypot(*np.diff(t[:, 1:3], axis=0).T).max() < 0.1
        assert np.abs(np.diff(t[:, 3])).max() < 0.4


def test_nobody_jitters(doorway):
    # Jitter is going back where one came from from moment to moment.  A moment: 0.2 s.
    rows = doorway.recorder.arrays()
    moments = back = 0
    for person in range(60):
        steps = np.diff(track(rows, person)[::6, 1:3], axis=0)
        length = np.hypot(*steps.T)
        cosine = (steps[1:] * steps[:-1]).sum(axis=1) / np.maximum(length[1:] * length[:-1], 1e-9)
        moments += len(cosine)
        back += ((length[1:] > 0.03) & (length[:-1] > 0.03) & (cosine < -0.5)).sum()
    assert moments > 5000
    assert back < 0.05 * moments


def test_a_wider_door_lets_people_out_sooner():
    narrow, wide = (run(1, door_width=width) for width in (0.8, 2.0))
    assert narrow.inside == wide.inside == 0
    assert wide.statistics.last_left < 0.75 * narrow.statistics.last_left


def test_doors_are_as_wide_as_asked_for():
    plan = Doorway(pedestrians=1, door_width=1.5, mobility_map=shipped_map()).floor_plan
    assert plan.gate("first door").length == pytest.approx(1.5)
    assert plan.gate("second door").length == pytest.approx(1.5)


def test_people_start_in_the_room_before_the_first_door():
    model = Doorway(mobility_map=shipped_map(), rng=4)
    x = np.array([person.position[0] for person in model.agents])
    assert x.max() < model.floor_plan.gate("first door").a[0]


@pytest.mark.parametrize(
    "seed", [1, *(pytest.param(seed, marks=pytest.mark.slow) for seed in (2, 3))]
)
def test_the_paper_preset_runs_to_its_end_within_the_walls(seed):
    model = run(seed, preset="paper")
    assert model.inside == 0
    rows = model.recorder.arrays()
    assert wall_crossings(rows, model.floor_plan.walls) == 0
