"""Crowds of maps that were built from a minute of recording."""

import numpy as np
import pytest
from mesa_mobility.models import Doorway, StraightWalk

from mesa_mobility import PedestrianModel
from mesa_mobility.capture import find_clips
from mesa_mobility.crowd.types.pedestrian_type import PedestrianType
from mesa_mobility.mobility import build_map, prepare_recordings
from tests.fixtures.oracles.counting import overlaps, track, wall_crossings

pytestmark = [pytest.mark.captures, pytest.mark.slow]


@pytest.fixture(scope="module", params=["limping", "slow", "control_105"])
def small_map(request, captures_dir):
    clips = prepare_recordings(find_clips(captures_dir), request.param)
    return build_map(clips.recordings, type_name=request.param)


def test_people_walk_at_the_speed_of_their_recordings(small_map):
    recorded = small_map.metadata["walking_speed_m_s"]["p75"]
    model = StraightWalk(
        slowest=recorded, fastest=recorded, length=15.0, mobility_map=small_map, record=True, rng=1
    )
    model.run(max_seconds=150)
    assert model.inside == 0
    rows = model.recorder.arrays()
    for person in range(50):
        frames, x = track(rows, person)[:, :2].T
        steady = x >= 2.0
        speed = 30 * np.ptp(x[steady]) / np.ptp(frames[steady])
        assert speed == pytest.approx(recorded, rel=0.05)


@pytest.mark.parametrize("seed", [1, 2])
def test_sixty_get_through_a_narrow_door(small_map, seed):
    recorded = small_map.metadata["walking_speed_m_s"]["p75"]
    # The same plan and places, with preferred speeds of the type's own.
    room = Doorway(pedestrians=60, door_width=0.9, mobility_map=small_map, rng=seed)
    kind = PedestrianType(mobility_map=small_map, preferred_speed=recorded)
    model = PedestrianModel(room.floor_plan, pedestrian_types=[kind], record=True, rng=seed)
    model.add_pedestrians([person.position for person in room.agents])
    model.run(max_seconds=400)
    assert model.inside == 0
    rows = model.recorder.arrays()
    assert overlaps(rows, kind.core_radius) == 0
    assert wall_crossings(rows, room.floor_plan.walls) == 0
