"""Who steps aside for somebody who is steered, and where to; all numbers by hand."""

import numpy as np
import pytest

from mesa_mobility.crowd.state.records import Crowd
from mesa_mobility.live.making_way import step_aside

NOBODY = []


def crowd_of(*people):
    """People of 0.15 m radius, each x, y and velocity; the first is the one who is steered."""
    crowd = Crowd(len(people))
    for row, (x, y, vx, vy) in enumerate(people):
        crowd.x[row], crowd.y[row], crowd.vx[row], crowd.vy[row] = x, y, vx, vy
        crowd.core[row], crowd.active[row] = 0.15, True
    return crowd


def aside(crowd, velocity, rows=None):
    rows = np.arange(1, len(crowd.x)) if rows is None else np.array(rows, dtype=np.int64)
    who, points = step_aside(rows, np.array([0]), np.array([velocity], dtype=float), crowd)
    return rows[who].tolist(), points.round(9).tolist()


@pytest.mark.parametrize(
    ("x", "y", "expected"),
    [
        # Two bodies of 0.15 m pass each other 0.6 m apart, and 0.5 m more is aimed at.
        (1.0, 0.0, [[1.0, 1.1]]),
        (1.0, 0.2, [[1.0, 1.1]]),
        (1.0, -0.2, [[1.0, -1.1]]),
        (2.5, 0.0, [[2.5, 1.1]]),
        (2.7, 0.0, NOBODY),
        (1.0, 0.7, NOBODY),
        (-0.5, 0.0, NOBODY),
    ],
)
def test_people_in_the_way_step_to_the_side_on_which_they_are(x, y, expected):
    who, points = aside(crowd_of((0, 0, 1, 0), (x, y, 0, 0)), (1.0, 0.0))
    assert points == expected
    assert who == ([1] if expected else [])


def test_the_way_is_that_of_the_velocity():
    # Straight up: left is towards -x.
    _, points = aside(crowd_of((0, 0, 0, 1), (-0.1, 1.5, 0, 0)), (0.0, 1.5))
    assert points == [[-1.1, 1.5]]


@pytest.mark.parametrize(("away", "steps"), [(0.8, True), (1.2, False), (-1.0, True)])
def test_people_who_walk_away_as_fast_need_not(away, steps):
    who, _ = aside(crowd_of((0, 0, 1, 0), (1.0, 0.0, away, 0)), (1.0, 0.0))
    assert who == ([1] if steps else [])


def test_for_somebody_who_stands_nobody_steps_aside():
    assert aside(crowd_of((0, 0, 0, 0), (0.5, 0, 0, 0)), (0.0, 0.0)) == ([], [])


def test_nobody_decides():
    assert aside(crowd_of((0, 0, 1, 0), (0.5, 0, 0, 0)), (1.0, 0.0), rows=[]) == ([], [])


def test_of_two_who_are_steered_the_nearer_one_counts():
    crowd = crowd_of((0, 0, 1, 0), (1, -1.0, 0, 1), (1, 0.1, 0, 0))
    velocities = np.array([(1.0, 0.0), (0.0, 1.0)])
    who, points = step_aside(np.array([2]), np.array([0, 1]), velocities, crowd)
    assert who.tolist() == [0]
    # 1 m before the first, 1.1 m before the second.
    np.testing.assert_allclose(points, [[1.0, 1.1]])
