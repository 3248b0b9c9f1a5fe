"""Both ways through a passage too narrow for two."""

import numpy as np
import pytest
from shapely import box

from mesa_mobility import PedestrianModel
from mesa_mobility.crowd.tactics.turns import Turns
from tests.fixtures.scenes import two_rooms


def crowds(width: float, depth: float, people: int, seed: int = 1, **keywords) -> PedestrianModel:
    """So many people on either side; all want to get to the other side."""
    plan = two_rooms(width, depth)
    model = PedestrianModel(plan, rng=seed, **keywords)
    rng = np.random.default_rng(seed)
    left, right = box(1.5, 0.0, 9.5, 8.0), box(10.5 + depth, 0.0, 18.5 + depth, 8.0)
    for room, exit_ in ((left, "east"), (right, "west")):
        places = plan.random_points(people, rng, within=room, spacing=0.5, clearance=0.3)
        model.add_pedestrians(places, exits=[exit_])
    return model


@pytest.mark.slow
def test_seventy_against_seventy_at_a_door():
    model = crowds(1.0, 0.2, 70)
    model.run(max_seconds=300)
    assert model.inside == 0


@pytest.mark.slow
def test_a_corridor_for_one_does_not_fall_silent():
    model = crowds(0.7, 10.0, 70)
    model.run(max_seconds=600)
    inside = np.array(model.statistics.occupancy)
    news = inside[1:, 0][np.diff(inside[:, 1]) != 0]
    assert model.inside == 0 or model.stalled
    assert np.diff(news).max() <= 60.0


def test_all_one_way_nothing_changes(monkeypatch):
    def places(turns: bool):
        plan = two_rooms(1.0, 0.2)
        model = PedestrianModel(plan, rng=3)
        model.add_pedestrians([(6.0 + k % 3, 3.0 + k // 3) for k in range(9)], exits=["east"])
        if not turns:
            monkeypatch.setattr(Turns, "take", lambda *given: given[-2:])
        model.run(max_seconds=8)
        return model.crowd.records[:9].tobytes()

    assert places(True) == places(False)


def test_people_waiting_for_their_turn_leave_the_way_out_free():
    model = PedestrianModel(two_rooms(0.7, 10.0), rng=1)
    model.add_pedestrians([(15.0, 4.0)], headings=[0.0], exits=["east"], preferred_speeds=[0.8])
    waiting = model.add_pedestrians([(21.5, 4.0)], exits=["west"])[0]
    model.run(max_seconds=3)
    assert waiting.position[0] > 20.0
    assert abs(waiting.position[1] - 4.0) > 0.3
    model.run(max_seconds=60)
    assert model.inside == 0
