"""People in one another's way, with all that the default preset has, on the map that ships."""

import pytest
from shapely import box

from mesa_mobility import Exit, FloorPlan, PedestrianModel, Trajectories
from mesa_mobility.results import check_safety, crossings
from tests.fixtures.maps import shipped_map

ROOMS = [box(0.0, 0.0, 10.0, 10.0), box(10.0, 4.0, 20.0, 6.0), box(20.0, 0.0, 30.0, 10.0)]


def model_on(plan: FloorPlan, seed: int) -> PedestrianModel:
    return PedestrianModel(plan, mobility_map=shipped_map(), record=True, rng=seed)


def test_thirty_against_thirty_through_a_corridor_two_metres_wide():
    plan = FloorPlan(
        ROOMS[0].union(ROOMS[1]).union(ROOMS[2]),
        exits=[Exit("right", (30.0, 0.0), (30.0, 10.0)), Exit("left", (0.0, 0.0), (0.0, 10.0))],
    )
    model = model_on(plan, 11)
    for area, goal in ((box(0.0, 0.0, 6.0, 10.0), "right"), (box(24.0, 0.0, 30.0, 10.0), "left")):
        places = plan.random_points(30, model.rng, within=area, spacing=0.5, clearance=0.2)
        model.add_pedestrians(places, exits=[goal])
    model.run(180.0)
    assert not model.stalled
    assert model.inside == 0
    walked = Trajectories.of(model)
    through = crossings(walked, (15.0, 4.0), (15.0, 6.0))
    assert sorted(set(through.person.tolist())) == list(range(60))
    report = check_safety(walked, plan.walls)
    assert (report.overlaps, report.wall_crossings) == (0, 0)


@pytest.mark.parametrize("x", [3.0, 3.7])
@pytest.mark.parametrize("apart", [0.36, 0.5, 0.8])
def test_two_side_by_side_before_a_door_both_get_through(x, apart):
    plan = FloorPlan(
        box(0.0, 0.0, 8.0, 4.0),
        exits=[Exit("east", (8.0, 0.0), (8.0, 4.0))],
        obstacles=[box(4.0, 0.0, 4.2, 1.6), box(4.0, 2.4, 4.2, 4.0)],
    )
    model = model_on(plan, 1)
    places = [(x, 2.0 - apart / 2.0), (x, 2.0 + apart / 2.0)]
    model.add_pedestrians(places, headings=[0.0, 0.0], preferred_speeds=1.34)
    model.run(10.0)
    walked = Trajectories.of(model)
    through = crossings(walked, (4.2, 1.6), (4.2, 2.4))
    assert sorted(set(through.person.tolist())) == [0, 1]
    assert check_safety(walked, plan.walls).passed
