"""Two parties meet in a corridor in which they cannot pass each other."""

import numpy as np
import pytest
from mesa_mobility.behaviors import Yielding
from mesa_mobility.behaviors.corridors import find_corridors
from shapely import box, union_all

from mesa_mobility import Exit, FloorPlan, PedestrianModel
from mesa_mobility.errors import ModelError
from tests.fixtures.oracles.counting import overlaps, track, wall_crossings
from tests.fixtures.scenes import core_of

# The corridor lies between two rooms 8 m square.
ROOM, LENGTH = 8.0, 24.0


def corridor_plan(niche: bool, width: float = 0.8) -> FloorPlan:
    """A corridor 24 m long; a niche 4 m by 1 m is in its middle."""
    low, high, end = 4.0 - width / 2.0, 4.0 + width / 2.0, ROOM + LENGTH
    parts = [box(0, 0, ROOM, 8), box(ROOM, low, end, high), box(end, 0, end + ROOM, 8)]
    if niche:
        parts.append(box(18, high, 22, high + 1.0))
    exits = [Exit("west", (0, 1), (0, 7)), Exit("east", (end + ROOM, 1), (end + ROOM, 7))]
    return FloorPlan(union_all(parts), exits=exits)


def meeting(niche: bool, west: int, east: int, seed: int, middle: float = 20.0) -> PedestrianModel:
    """So many from either side, in file, 4 m from the middle of their meeting and farther."""
    model = PedestrianModel(corridor_plan(niche), record=True, rng=seed)
    model.tactics.append(Yielding())
    for count, sense, exit_ in ((west, -1, "east"), (east, 1, "west")):
        places = [(middle + sense * (4.0 + 0.6 * k), 4.0) for k in range(count)]
        headings = 0.0 if sense < 0 else np.pi
        model.add_pedestrians(places, headings=headings, exits=[exit_])
    return model


def backed_out(model: PedestrianModel, west: int) -> tuple[int, int]:
    """How many from the west, and from the east, were back in the room that they came from."""
    rows = model.recorder.arrays()
    tracks = [track(rows, person)[:, 1] for person in np.unique(rows["person"])]
    return (
        sum(float(x.min()) < ROOM for x in tracks[:west]),
        sum(float(x.max()) > ROOM + LENGTH for x in tracks[west:]),
    )


def check_safe(model: PedestrianModel) -> None:
    rows = model.recorder.arrays()
    assert overlaps(rows, core_of(model)) == 0
    assert wall_crossings(rows, model.floor_plan.walls) == 0


@pytest.mark.parametrize("niche", [False, True])
def test_a_corridor_and_the_places_beside_its_way(niche):
    [corridor] = find_corridors(corridor_plan(niche), 0.14, 0.14, 0.6)
    # A disc of 1.2 m fills 0.15 m of either mouth: 0.6 - sqrt(0.6^2 - 0.4^2).
    assert corridor.length == pytest.approx(LENGTH - 2 * 0.153, abs=0.2)
    along, aside, within = corridor.locate(
        np.array([[20.0, 4.0], [20.0, 4.3], [4.5, 4.0], [1.0, 4.0], [-5.0, 4.0]])
    )
    assert along[:2] == pytest.approx(corridor.length / 2, abs=0.2)
    assert aside[:2] == pytest.approx([0.0, 0.3], abs=0.1)
    assert along[2] == pytest.approx(4.5 - 8.153, abs=0.2)
    assert np.isnan(along[3:]).all()
    assert within.tolist() == [True, True, False, False, False]
    in_niche = (corridor.places[:, 0] > ROOM) & (corridor.places[:, 0] < ROOM + LENGTH)
    assert in_niche.any() == niche
    assert (corridor.places[in_niche, 1] >= 4.0 + 0.6 - 0.1).all()
    between = np.hypot(*(corridor.places[:, None] - corridor.places[None]).transpose(2, 0, 1))
    assert between[np.triu_indices(len(between), 1)].min() >= 0.6


def test_doors_and_wide_corridors_are_none():
    assert find_corridors(corridor_plan(False, width=1.2), 0.14, 0.14, 0.6) == []
    door = box(0, 0, 8, 8).union(box(8, 3.6, 8.2, 4.4)).union(box(8.2, 0, 16, 8))
    plan = FloorPlan(door, exits=[Exit("west", (0, 1), (0, 7))])
    assert find_corridors(plan, 0.14, 0.14, 0.6) == []


def test_one_gives_way_to_one_in_the_niche():
    model = meeting(True, 1, 1, seed=1)
    model.run(max_seconds=60)
    assert model.inside == 0
    rows = model.recorder.arrays()
    off = [np.abs(track(rows, person)[:, 2] - 4.0)[:, None] for person in (0, 1)]
    inside = [track(rows, person)[:, 1] for person in (0, 1)]
    aside = [
        float(y[(x > ROOM) & (x < ROOM + LENGTH)].max()) for x, y in zip(inside, off, strict=True)
    ]
    # A place for one is 0.6 m aside; the other keeps within the 0.8 m of the corridor.
    assert sorted(each > 0.5 for each in aside) == [False, True]
    assert backed_out(model, 1) == (0, 0)
    check_safe(model)


def test_the_few_give_way_to_the_many():
    model = meeting(False, 2, 6, seed=2)
    model.run(max_seconds=6)
    assert model.tactics[-1].giving_way == [0, 1]
    model.run(max_seconds=120)
    assert model.inside == 0
    assert backed_out(model, 2) == (2, 0)
    check_safe(model)


def test_those_who_are_near_their_end_give_way():
    model = meeting(False, 3, 3, seed=3, middle=15.0)
    model.run(max_seconds=6)
    # 3 m to the west from there, 13 m to the east.
    assert model.tactics[-1].giving_way == [0, 1, 2]


def test_all_one_way_nothing_changes():
    def places(tactics):
        model = PedestrianModel(corridor_plan(True), rng=4)
        model.tactics += tactics
        model.add_pedestrians([(10.0 + 0.6 * k, 4.0) for k in range(5)], exits=["east"])
        model.run(max_seconds=10)
        return model.crowd.records[:5].tobytes()

    assert places([Yielding()]) == places([])


@pytest.mark.slow
def test_a_checkpoint_goes_on_to_the_same_bytes(tmp_path):
    model = PedestrianModel(corridor_plan(False), rng=5)
    model.tactics.append(Yielding())
    model.add_pedestrians([(17.0, 4.0), (16.4, 4.0)], headings=0.0, exits=["east"])
    model.add_pedestrians([(23.0, 4.0)], headings=np.pi, exits=["west"])
    model.run(max_seconds=5)
    assert model.tactics[-1].giving_way == [2]
    model.save(tmp_path / "run.checkpoint")
    again = PedestrianModel.load(tmp_path / "run.checkpoint", plugins=[Yielding()],
                                 floor_plan=corridor_plan(False))  # fmt: skip
    assert again.tactics[-1].giving_way == [2]
    for each in (model, again):
        each.run(max_seconds=15)
    assert model.crowd.records[:3].tobytes() == again.crowd.records[:3].tobytes()


def test_parameters_are_checked():
    with pytest.raises(ModelError, match="yielding: sight 0, expected more than 0 m"):
        Yielding(sight=0)
    with pytest.raises(ModelError, match="yielding: room inf"):
        Yielding(room=float("inf"))


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(1, 11))
@pytest.mark.parametrize(("west", "east"), [(10, 10), (5, 5), (2, 10), (1, 1)])
def test_without_a_niche_one_group_backs_out(west, east, seed):
    model = meeting(False, west, east, seed)
    model.run(max_seconds=200)
    assert model.inside == 0
    # All of one group, and nobody of the other.
    assert backed_out(model, west) in ((west, 0), (0, east))
    check_safe(model)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(1, 11))
@pytest.mark.parametrize(("west", "east"), [(10, 10), (5, 5), (2, 10), (1, 1)])
def test_with_a_niche_they_pass(west, east, seed):
    model = meeting(True, west, east, seed)
    model.run(max_seconds=200)
    assert model.inside == 0
    # The niche has room for six at a time.
    assert min(backed_out(model, west)) == 0
    assert max(backed_out(model, west)) <= 5
    check_safe(model)
