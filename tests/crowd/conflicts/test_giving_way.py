"""People who block each other get past, or lead each other out."""

import numpy as np
import pytest
from shapely import box, union_all

from mesa_mobility import Exit, FloorPlan, PedestrianModel
from tests.fixtures.oracles.counting import overlaps, track, wall_crossings
from tests.fixtures.scenes import core_of, two_rooms


def meeting(niche: bool, giving_way: bool = True, seed: int = 1) -> PedestrianModel:
    """Two from the west and one from the east in a corridor 0.5 m wide, 12 m long."""
    parts = [box(0, 0, 6, 4), box(6, 1.75, 18, 2.25), box(18, 0, 24, 4)]
    if niche:
        parts.append(box(11, 2.25, 13, 3.25))
    exits = [Exit("west", (0, 1), (0, 3)), Exit("east", (24, 1), (24, 3))]
    model = PedestrianModel(FloorPlan(union_all(parts), exits=exits), record=True, rng=seed)
    if not giving_way:
        model.tactics[:] = [each for each in model.tactics if each.name != "giving_way"]
    model.add_pedestrians([(8.0, 2.0), (7.0, 2.0)], headings=0.0, exits=["east"])
    model.add_pedestrians([(13.5, 2.0)], headings=np.pi, exits=["west"])
    return model


def check_safe(model: PedestrianModel) -> None:
    rows = model.recorder.arrays()
    assert overlaps(rows, core_of(model)) == 0
    assert wall_crossings(rows, model.floor_plan.walls) == 0


@pytest.mark.parametrize("niche", [True, False])
def test_three_in_a_corridor_for_one_all_get_out(niche):
    model = meeting(niche)
    model.run(max_seconds=120)
    assert model.inside == 0
    check_safe(model)
    # Without a niche one party goes back to the room that it came from.
    rows = model.recorder.arrays()
    west = [track(rows, person)[:, 1].min() < 6.0 for person in (0, 1)]
    assert niche or all(west) or track(rows, 2)[:, 1].max() > 18.0


def test_without_it_they_stand_for_ever():
    model = meeting(niche=False, giving_way=False)
    model.run(max_seconds=120)
    assert model.inside == 3


def test_alone_nobody_makes_way():
    def places(giving_way: bool) -> bytes:
        model = PedestrianModel(two_rooms(1.0, 0.2), rng=3)
        if not giving_way:
            model.tactics[:] = [each for each in model.tactics if each.name != "giving_way"]
        model.add_pedestrians([(6.0, 4.0)], exits=["east"])
        model.run(max_seconds=8)
        return model.crowd.records[:1].tobytes()

    assert places(True) == places(False)


def test_a_saved_model_goes_on_alike(tmp_path):
    class Meeting(PedestrianModel):
        def __init__(self, rng=None):
            super().__init__(meeting(False).floor_plan, rng=rng)
            self.add_pedestrians([(8.0, 2.0), (7.0, 2.0)], headings=0.0, exits=["east"])
            self.add_pedestrians([(13.5, 2.0)], headings=np.pi, exits=["west"])

    model = Meeting(rng=1)
    [tactic] = [each for each in model.tactics if each.name == "giving_way"]
    while not tactic.making_way:
        model.step()
        assert model.elapsed < 30.0
    model.save(tmp_path / "now.ckpt")
    again = Meeting.load(tmp_path / "now.ckpt")
    until = model.elapsed + 5.0
    for each in (model, again):
        each.run(max_seconds=until)
    assert again.crowd.records[:3].tobytes() == model.crowd.records[:3].tobytes()


@pytest.mark.slow
@pytest.mark.parametrize("width", [0.9, 1.0, 1.2])
def test_twenty_wheelchairs_get_through_a_door(width):
    plan = two_rooms(width, 0.2)
    model = PedestrianModel(plan, population="wheelchair_powered", rng=1, record=True)
    rng = np.random.default_rng(1)
    places = plan.random_points(20, rng, within=box(3, 0.5, 9, 7.5), spacing=0.8, clearance=0.45)
    model.add_pedestrians(places, exits=["east"])
    model.run(max_seconds=300)
    assert model.inside == 0
    check_safe(model)
