"""The environment of a crowd in checkpoints."""

import numpy as np
from shapely import box

from mesa_mobility import Exit, FloorPlan
from mesa_mobility.crowd.state.environment import Environment


def hall():
    """A room round a block, so that routes bend at corners."""
    return FloorPlan(
        box(0, 0, 20, 8) - box(6, 2, 14, 8),
        exits=[Exit("east", (20, 5), (20, 7)), Exit("west", (0, 5), (0, 7))],
    )


def test_corners_have_the_same_numbers_after_a_restore():
    # The slim body has routes, though nobody who has come goes by them.
    saved = Environment(hall(), reach=2.0, core_radii=[0.15, 0.3])
    saved.destination(None, 0)
    to = saved.destination(("east",), 1)
    restored = Environment(hall(), reach=2.0, core_radii=[0.15, 0.3])
    restored.restore(saved.state())
    points, destinations = np.array([[2.0, 6.0]]), np.array([to])
    numbers = []
    for each in (saved, restored):
        corners = each.targets(points, destinations).corners
        assert (corners >= 0).any()
        numbers.append(each.corners.shared(np.atleast_2d(corners)))
    assert np.array_equal(*numbers)
