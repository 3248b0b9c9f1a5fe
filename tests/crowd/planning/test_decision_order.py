"""Who decides in a frame, and in which order."""

import numpy as np

from mesa_mobility.crowd.planning.decision_order import decision_order, due
from mesa_mobility.crowd.state.records import Crowd
from mesa_mobility.floorplan import Targets


def test_those_whose_movement_has_ended_are_due():
    crowd = Crowd(5)
    crowd.end[:] = [12, 10, 45, 24, 9]
    crowd.gone[:] = [0, 0, 20, 0, 0]
    rows, soonest = due(np.array([4, 3, 2, 1]), 10, crowd.records)
    # Row 2 leaves in frame 20, before the movement of row 3 ends in frame 24.
    assert (rows.tolist(), soonest) == ([4, 1], 20)


def test_the_nearest_decides_first_and_equal_ones_keep_their_order():
    deciding = np.array([7, 2, 5, 9, 4])
    lengths = np.array([3.0, np.inf, 1.5, 3.0, 0.5])
    targets = Targets(np.zeros((5, 2)), np.zeros(5, np.int64), lengths)
    assert decision_order(deciding, targets).tolist() == [4, 5, 7, 9, 2]
