"""How far away people heed each other does not depend on who else might walk there."""

import numpy as np
from shapely import box

from mesa_mobility import Exit, FloorPlan, PedestrianModel, PedestrianType
from mesa_mobility.results import Trajectories


def walked_by_children(*others):
    """Places of children who walk towards each other, where other types might walk as well."""
    plan = FloorPlan(
        box(0, 0, 16, 4), exits=[Exit("west", (0, 0), (0, 4)), Exit("east", (16, 0), (16, 4))]
    )
    kinds = [PedestrianType.named(name) for name in ("child", *others)]
    model = PedestrianModel(plan, pedestrian_types=kinds, record=True, rng=1)
    for x, to, heading in ((3.0, "east", 0.0), (12.0, "west", np.pi)):
        places = [(x + dx, y) for dx in (0.0, 1.0) for y in (0.9, 2.0, 3.1)]
        model.add_pedestrians(
            places, headings=np.full(6, heading), type_index=0, exits=[to], preferred_speeds=1.2
        )
    model.run(max_seconds=30)
    tracks = Trajectories.of(model)
    return np.column_stack([tracks.frame, tracks.person, tracks.x, tracks.y, tracks.heading])


def test_a_type_that_gets_farther_in_a_movement_changes_nothing_for_others():
    alone = walked_by_children()
    assert len(np.unique(alone[:, 1])) == 12
    assert np.array_equal(alone, walked_by_children("able_bodied"))
