"""People slow down before places at which they are to stand."""

import numpy as np
import pytest
from shapely import box

from mesa_mobility import Exit, FloorPlan, Visit
from mesa_mobility.crowd.tactics.visits import slow_down
from tests.fixtures.maps import shipped_map
from tests.fixtures.scenes import model_of

LANES = 2.0 + 3.0 * np.arange(10)


def hall():
    return FloorPlan(box(0, 0, 20, 32), exits=[Exit("west", (0, 3), (0, 5))])


def test_speeds_fall_with_the_root_of_the_way_that_remains():
    # From 1.2 m/s to standing in 3 s takes 1.8 m; with a quarter of it left, 0.45 m, half the
    # speed remains, and with a hundredth a tenth.
    remaining = np.array([np.inf, 5.0, 1.8, 0.45, 0.018, 0.0])
    np.testing.assert_allclose(
        slow_down(np.full(6, 1.2), remaining), [1.2, 1.2, 1.2, 0.6, 0.12, 0.0], rtol=1e-12
    )


def test_whoever_stands_keeps_standing_where_a_place_has_no_way():
    assert slow_down(np.array([0.0]), np.array([np.inf])).tolist() == [0.0]


@pytest.mark.parametrize("seed", [1, 2])
def test_nobody_walks_past_the_point_at_which_it_is_to_stand(seed):
    model = model_of(hall(), shipped_map(), rng=seed, frames_per_step=1)
    people = [model.add_pedestrians([(2.0, y)], route=[Visit((12.0, y), 60.0)])[0] for y in LANES]
    track = []
    while model.elapsed < 20.0:
        track.append([person.position for person in people])
        model.step()
    assert all(person.waiting for person in people)
    track = np.array(track)
    walked = np.hypot(*np.moveaxis(np.diff(track, axis=0), -1, 0)).sum(axis=0)
    detours = walked - np.hypot(*(track[-1] - track[0]).T)
    assert (track[..., 0].max(axis=0) - 12.0).max() < 0.3
    # A sway of some centimetres in ten metres.
    assert detours.max() < 0.2


def test_those_who_only_pass_a_place_keep_their_speed():
    slowest = {}
    for stay in (0.0, 1.0):
        model = model_of(hall(), shipped_map(), rng=1, frames_per_step=1)
        model.tactics[:] = [each for each in model.tactics if each.name == "visits"]
        for x, y in zip(np.linspace(2.0, 3.0, 10), LANES, strict=True):
            route = [Visit((12.0, y), stay), Visit((18.0, y), stay)]
            model.add_pedestrians([(x, y)], route=route, preferred_speeds=1.2)
        rows, shares = model.rows, []
        while (short := model.crowd.x[rows] < 12.0 - 0.6).any():
            model.step()
            shares.append(np.where(short, model.crowd.preferred[rows] / 1.2, np.inf))
        slowest[stay] = np.min(shares[5:])
    assert slowest[0.0] == 1.0
    # The square root of 0.6 m over 1.8 m is 0.58; somebody decides up to 0.25 m before that.
    assert 0.57 < slowest[1.0] < 0.7
