"""People who block each other across a seam make way as on one floor."""

import numpy as np
import pytest

from mesa_mobility import Exit, FloorPlan, PedestrianModel, Trajectories
from tests.fixtures.engine import ENGINE
from tests.fixtures.seams import APART, MIDDLE, cut_corridor, overlaps, room_with_corridor, true_x

WEST = Exit("west", (-8.0, -3.0), (-8.0, 3.0))


def meeting(cut, apart):
    """A model in which two people meet at the seam of a corridor 0.5 m wide, whole or cut."""
    plan = (cut_corridor if cut else room_with_corridor)(0.5)
    both = FloorPlan(plan.walkable, exits=[*plan.exits, WEST], seams=plan.seams)
    model = PedestrianModel(both, preset=ENGINE, record=True, rng=1)
    beyond = APART if cut else 0.0
    model.add_pedestrians([(MIDDLE - apart / 2, 0.0)], exits=["east"], headings=0.0)
    model.add_pedestrians([(MIDDLE + apart / 2 + beyond, 0.0)], exits=["west"], headings=np.pi)
    return model


@pytest.mark.parametrize("cut", [False, True])
def test_whoever_is_beyond_the_seam_is_known_to_be_in_the_way(cut):
    model = meeting(cut, 0.4)
    assert model.wishes(np.array([0, 1])).blockers.tolist() == [1, 0]
    assert model.explain(0).blocked_by == 1


@pytest.mark.parametrize("cut", [False, True])
def test_one_of_two_who_cannot_pass_each_other_backs_out(cut):
    """Nobody passes another there: one walks back 6 m to the room."""
    model = meeting(cut, 1.0)
    model.run(max_seconds=120)
    assert model.inside == 0
    tracks = Trajectories.of(model)
    x = true_x(tracks.x)
    back = x[tracks.person == 0]
    assert back.min() < 0.5
    assert back[-1] > 11.5
    places = np.column_stack([x, tracks.y, np.zeros(len(x))])
    assert overlaps(tracks.frame, places, tracks.radii[tracks.person]) == 0
