"""One person alone passes jambs and corners of narrow ways without loops."""

import numpy as np
import pytest
from shapely import box, union_all

from mesa_mobility import Exit, FloorPlan, PedestrianModel
from tests.fixtures.plans.narrow_plans import narrow_plan


def overdue(plan, start, seed, way):
    """Whether somebody takes more than twice the way, metres, at their speed and 3 s."""
    model = PedestrianModel(plan, rng=seed)
    model.add_pedestrians([start])
    speed = model.crowd.agenda["speed"][0]
    model.run(max_seconds=2 * way / speed + 3)
    return model.inside > 0


def low_way(width):
    """A hall 1.2 m wide and a low way out of its lower left corner, 6 m long."""
    floor = union_all([box(0, 0, 1.2, 8), box(-6, 0, 0, width)])
    return FloorPlan(floor, exits=[Exit("out", (-6, 0), (-6, width))])


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize(
    ("width", "start", "way"),
    # 0.05 m down and 6.2 m along; 1.2 m down beside the jamb, or across from it, and as far along.
    [(0.55, (0.198, 0.482), 6.25), (0.45, (0.16, 2.43), 8.1), (0.45, (0.91, 1.13), 7.1)],
)
def test_nobody_stays_at_the_jamb_of_a_low_way(width, start, way, seed):
    assert not overdue(low_way(width), start, seed, way)


@pytest.mark.thorough
@pytest.mark.parametrize("seed", [3, 5, 13])
def test_hardly_anybody_is_late_in_random_plans_with_narrow_ways(seed):
    late = []
    for number in range(40):
        plan, rng = narrow_plan(seed, number)
        places = plan.random_points(13 if number < 20 else 12, rng, spacing=0.001, clearance=0.145)
        for k, place in enumerate(places):
            own = seed * 1_000_000 + number * 1_000 + k
            model = PedestrianModel(plan, rng=own)
            model.add_pedestrians([place])
            if overdue(plan, place, own, float(model.crowd.route[0])):
                late.append((number, np.round(place, 2).tolist()))
                assert not overdue(plan, place, own, 2 * float(model.crowd.route[0])), late
    # Fast walkers miss a gap at right angles to their way, now and then, and turn back.
    assert len(late) <= 5  # of 500
