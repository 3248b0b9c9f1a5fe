"""Obstacles, walls and doors that come where somebody is."""

from contextlib import suppress

import numpy as np
import pytest
import shapely
from shapely import LineString, Point, affinity, box

from mesa_mobility import Exit, FloorPlan, Gate, PedestrianModel, PedestrianType
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.results import Trajectories, check_safety
from tests.fixtures.maps import shipped_map, strider
from tests.fixtures.oracles.counting import during, off_floor, overlaps, wall_crossings
from tests.fixtures.scenes import advance, core_of, corridor, model_of, put


def floor_with_doors() -> FloorPlan:
    """Two rooms with two doors between them and an exit at either end."""
    return FloorPlan(
        shapely.union_all(
            [box(0, 0, 8, 8), box(8.2, 0, 16.2, 8), *(box(8, y, 8.2, y + 1.4) for y in (1.3, 5.3))]
        ),
        exits=[Exit("west", (0, 3), (0, 5)), Exit("east", (16.2, 3), (16.2, 5))],
        gates=[Gate("low", (8.1, 1.3), (8.1, 2.7)), Gate("high", (8.1, 5.3), (8.1, 6.7))],
    )


@pytest.mark.parametrize("place", [(5.0, 2.0), (5.0, 0.2), (0.2, 0.2), (19.8, 2.0)])
@pytest.mark.parametrize("frames", [0, 20])
def test_an_obstacle_is_not_put_on_anybody(place, frames):
    model = model_of(corridor(), strider())
    person = put(model, *place, preferred_speeds=[1.25], pre_movement=[1.0 if frames else 0.0])
    advance(model, frames)
    plan = model.floor_plan
    before = plan.version, plan.obstacles, plan.area, plan.walls.tolist()
    with pytest.raises(
        FloorPlanError, match=r"^obstacle 0: pedestrian 0 stands there, expected free floor$"
    ):
        plan.add_obstacle(Point(person.position).buffer(0.4))
    assert (plan.version, plan.obstacles, plan.area, plan.walls.tolist()) == before
    model.run(max_seconds=60)
    assert model.inside == 0
    assert check_safety(Trajectories.of(model), plan.walls, plan.free).passed


@pytest.mark.parametrize(("away", "refused"), [(0.14, True), (0.16, False)])
def test_what_counts_is_the_body_not_its_middle(away, refused):
    model = model_of(corridor(), strider())  # cores of 0.15 m
    put(model, 5.0, 2.0)
    block = box(5.0 + away, 1.0, 6.0, 3.0)
    if refused:
        with pytest.raises(FloorPlanError, match="pedestrian 0 stands there"):
            model.floor_plan.add_obstacle(block)
    else:
        assert model.floor_plan.add_obstacle(block) == 0


def test_a_narrow_rest_of_floor_in_which_somebody_stands_is_not_closed():
    # The pocket left between obstacle and wall is 0.19 m wide: too narrow to be kept as floor.
    small = PedestrianType(mobility_map=strider(core_radius=0.05))
    model = PedestrianModel(corridor(), pedestrian_types=[small], rng=1)
    model.add_pedestrians([(8.0, 0.1)])
    with pytest.raises(FloorPlanError, match="pedestrian 0 stands there"):
        model.floor_plan.add_obstacle(
            box(4.0, 0.0, 12.0, 1.0).difference(box(4.5, -1.0, 11.5, 0.19))
        )


def test_the_first_of_those_in_the_way_is_named():
    model = model_of(corridor(), strider())
    model.add_pedestrians([(2.0, 2.0), (8.0, 2.0), (8.0, 3.0)])
    with pytest.raises(FloorPlanError, match="pedestrian 1 stands there"):
        model.floor_plan.add_obstacle(box(7.0, 1.0, 9.0, 3.9))


def test_people_of_every_model_of_a_plan_count_as_long_as_there_is_one():
    plan = corridor()
    first, second = (model_of(plan, strider()) for _ in range(2))
    put(first, 5.0, 2.0)
    put(second, 9.0, 2.0)
    for x in (5.0, 9.0):
        with pytest.raises(FloorPlanError, match="stands there"):
            plan.add_obstacle(box(x - 0.5, 1.0, x + 0.5, 3.0))
    del first
    number = plan.add_obstacle(box(4.5, 1.0, 5.5, 3.0))
    plan.remove_obstacle(number)
    second.remove_pedestrians(list(second.agents))
    assert plan.add_obstacle(box(8.5, 1.0, 9.5, 3.0)) == number + 1


def test_people_astride_a_door_that_closes_step_off_to_their_side():
    plan = floor_with_doors()
    model = model_of(plan, shipped_map(), frames_per_step=3, rng=5)
    y = np.array([1.5, 1.9, 2.3, 5.5, 5.9, 6.3])
    x = 8.1 + np.array([-0.1, 0.03, 0.12, 0.06, -0.002, -0.13])
    model.add_pedestrians(np.column_stack([x, y]), headings=np.arange(6.0))
    plan.close_gate("low")
    plan.close_gate("high")
    model.run(max_seconds=60)
    assert model.inside == 0
    rows = model.recorder.arrays()
    assert wall_crossings(rows, plan.walls) == 0
    assert off_floor(rows, plan.free) == 0
    last = {p: rows["x"][rows["person"] == p][-1] for p in range(6)}
    assert [last[p] > 8.1 for p in range(6)] == (x > 8.1).tolist()


def changing(changes: int, seed: int, *, over_people: bool) -> None:
    """So many random changes of a plan while people walk on it, and nobody is harmed by any.

    Args:
        changes: obstacles and walls put down or taken away, doors and exits closed and opened.
        seed: of the plan, the people and the changes.
        over_people: whether obstacles and walls are aimed at people.
    """
    rng = np.random.default_rng(seed)
    plan = floor_with_doors()
    model = model_of(plan, shipped_map(), rng=seed, frames_per_step=3)
    core = core_of(model)
    model.add_pedestrians(plan.random_points(25, rng, spacing=0.6, clearance=0.3))
    standing, refused, put_down, intervals = list[int](), 0, 0, []
    done = come = 0
    while done < changes:
        start = model.frame
        advance(model, int(rng.integers(1, 12)))
        intervals.append((start, model.frame, plan.walls, plan.free))
        if model.inside < 20:
            with suppress(FloorPlanError):
                taken = [person.position for person in model.agents]
                more = plan.random_points(8, rng, spacing=0.6, clearance=0.3, avoid=taken)
                come += _let_in(model, more)
        if standing and (len(standing) > 4 or rng.random() < 0.3):
            plan.remove_obstacle(standing.pop(int(rng.integers(len(standing)))))
        elif rng.random() < 0.3:
            door = rng.choice(["low", "high", "west", "east"])
            (plan.close_gate if plan.is_open(door) else plan.open_gate)(str(door))
        else:
            people = np.array([person.position for person in model.agents]).reshape(-1, 2)
            at = rng.uniform((0, 0), (16, 8))
            if over_people and len(people):
                at = people[int(rng.integers(len(people)))] + rng.uniform(-0.2, 0.2, 2)
            block = _something(rng, at)
            under = shapely.distance(shapely.points(people), block) < core - 1e-9
            version = plan.version
            said = ""
            try:
                standing.append(plan.add_obstacle(block))
            except FloorPlanError as error:
                said = str(error)
            if said:
                assert plan.version == version
                refused += "stands there" in said
                assert under.any() or "stands there" not in said
                done += over_people
                continue
            assert not under.any()
            put_down += 1
        done += 1
    for number in standing:
        plan.remove_obstacle(number)
    for name in ("low", "high", "west", "east"):
        plan.open_gate(name)
    start = model.frame
    model.run(max_seconds=120)
    intervals.append((start, model.frame, plan.walls, plan.free))
    assert model.inside == 0
    assert refused > changes // 5 if over_people else put_down > changes // 5
    rows = model.recorder.arrays()
    assert overlaps(rows, core, tolerance=1e-5) == 0
    for first, last, walls, free in intervals:
        part = during(rows, first, last, plan, core)
        assert wall_crossings(part, walls) == 0, (first, last)
        assert off_floor(part, free) == 0, (first, last)


def _let_in(model: PedestrianModel, places: np.ndarray) -> int:
    there = np.array([person.position for person in model.agents]).reshape(-1, 2)
    if len(there):
        # Nobody who walks can be there within a movement.
        apart = np.hypot(*(places[:, None] - there[None]).transpose(2, 0, 1)).min(axis=1)
        places = places[apart > 3.5]
    return len(model.add_pedestrians(places)) if len(places) else 0


def _something(rng: np.random.Generator, at: np.ndarray) -> shapely.Polygon:
    """A pillar, a table or a piece of thin wall around a place."""
    x, y = at
    shape = int(rng.integers(3))
    if shape == 0:
        return Point(x, y).buffer(float(rng.uniform(0.1, 0.6)), quad_segs=4)
    if shape == 1:
        return box(x, y, *(at + rng.uniform(0.2, 1.2, 2)))
    line = LineString([(x - rng.uniform(0.2, 2.0), y), (x + rng.uniform(0.2, 2.0), y)])
    return affinity.rotate(line, float(rng.uniform(0, 180))).buffer(0.05, cap_style="flat")


def test_changes_of_plan_with_people_under_them():
    changing(20, 1, over_people=True)


def test_changes_of_plan_at_random():
    changing(20, 2, over_people=False)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(5))
def test_500_changes_of_plan_with_people_under_them(seed):
    changing(100, 100 + seed, over_people=True)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(10))
def test_2000_changes_of_plan_at_random(seed):
    changing(200, 200 + seed, over_people=False)
