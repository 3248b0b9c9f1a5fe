"""Tactics see people beyond a seam as on one floor."""

from contextlib import nullcontext

import numpy as np
import pytest
from mesa_mobility.behaviors.steering.anticipation import turn_aside
from mesa_mobility.behaviors.steering.course_choice import CourseSettings, choose_courses
from mesa_mobility.behaviors.steering.speed_adaptation import adapt_speeds

from mesa_mobility.crowd.state.records import Crowd
from mesa_mobility.crowd.state.twins import laid_twins, strips_of
from mesa_mobility.crowd.state.view import CrowdView
from mesa_mobility.steering import sight_on
from tests.fixtures.seams import APART, MIDDLE, cut_corridor, room_with_corridor

WIDTH = 1.6
REACH = 1.8
PEOPLE = 8


def turned(inside, plan, targets, speeds):
    """Points and speeds by ``anticipation``."""
    return turn_aside(inside.pedestrians, inside.grid, 10, inside.crowd, plan, targets, speeds)


def slowed(inside, _plan, targets, speeds):
    """Points and speeds by ``speed_adaptation``."""
    own = adapt_speeds(inside.pedestrians, inside.grid, inside.crowd, targets, speeds)
    return targets, own


def led(inside, plan, targets, speeds):
    """Points and speeds by ``course_choice``."""
    sight, settings = sight_on(plan, 0.0), CourseSettings(8.0, 0.4)
    return choose_courses(inside.pedestrians, inside, 0, sight, targets, speeds, settings), speeds


def asked(tactic, seed, cut):
    """(n, 2) points on the whole floor and (n,) speeds of people about the seam, with and without
    it."""
    rng = np.random.default_rng(seed)
    x, y = rng.uniform(MIDDLE - 2.0, MIDDLE + 2.0, PEOPLE), rng.uniform(-0.6, 0.6, PEOPLE)
    crowd = Crowd(PEOPLE)
    shift = np.where(cut & (x > MIDDLE), APART, 0.0)
    crowd.x[:], crowd.y[:] = x + shift, y
    crowd.core[:] = 0.14
    crowd.active[:] = True
    crowd.vx[:], crowd.vy[:] = rng.uniform(-1.2, 1.2, PEOPLE), rng.uniform(-0.2, 0.2, PEOPLE)
    # Nobody looks farther than the strip is drawn.
    ahead = np.column_stack([np.where(crowd.vx > 0.0, 1.3, -1.3), -0.5 * y])
    targets = np.column_stack([crowd.x, crowd.y]) + ahead
    crowd.target_x[:], crowd.target_y[:] = targets.T
    plan, rows = (cut_corridor if cut else room_with_corridor)(WIDTH), np.arange(PEOPLE)
    twins = laid_twins(strips_of(plan.seams), rows, PEOPLE, REACH, crowd) if cut else nullcontext()
    with twins:
        points, speeds = tactic(CrowdView(rows, crowd), plan, targets, np.full(PEOPLE, 1.3))
    changed = not np.array_equal(points, targets) or (speeds != 1.3).any()
    return np.column_stack([points[:, 0] - shift, points[:, 1]]), speeds, changed


@pytest.mark.parametrize("tactic", [turned, slowed, led])
def test_people_beyond_a_seam_count_as_on_one_floor(tactic):
    some = 0
    for seed in range(20):
        points, speeds, changed = asked(tactic, seed, cut=True)
        expected = asked(tactic, seed, cut=False)
        assert np.allclose(points, expected[0], atol=1e-9)
        assert np.allclose(speeds, expected[1], atol=1e-9)
        some += changed
    assert some >= 10


def test_each_sees_another_where_they_are_nearer():
    crowd = Crowd(3)
    crowd.x[:], crowd.core[:], crowd.active[:] = (5.5, 6.5 + APART, -7.0), 0.14, True
    plan, rows = cut_corridor(WIDTH), np.arange(3)
    looks, others = np.array([0, 1, 2, 0, 2]), np.array([1, 0, 1, 2, 0])
    inside = CrowdView(rows, crowd)
    assert inside.seen_by(looks, others)[:, 0].tolist() == [66.5, 5.5, 66.5, -7.0, 5.5]
    with laid_twins(strips_of(plan.seams), rows, 3, REACH, crowd):
        seen = inside.seen_by(looks, others)
        there = inside.with_copies(rows[:2])
        assert inside.person_of(there).tolist() == [0, 1, 0, 1]
        assert sorted(crowd.x[there].tolist()) == [5.5, 6.5, 65.5, 66.5]
    assert seen[:, 0].tolist() == [6.5, 65.5, 6.5, -7.0, 5.5]
    assert inside.with_copies(rows).tolist() == [0, 1, 2]
