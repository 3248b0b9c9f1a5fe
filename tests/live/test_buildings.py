"""Live models of buildings: true places and levels, and ways to places on other levels."""

import json
import math

import numpy as np
import pytest

from mesa_mobility import Exit, PedestrianModel, Trajectories
from mesa_mobility.buildings import ON_STAIRS, Building, Level
from mesa_mobility.crowd import Tactic
from mesa_mobility.errors import LiveError
from mesa_mobility.live.commands import read_command
from mesa_mobility.live.levels import where
from mesa_mobility.live.order_tactics import follow_orders
from mesa_mobility.live.orders import STANDS
from mesa_mobility.live.point_routes import PointRoutes
from mesa_mobility.live.run import Run
from mesa_mobility.live.snapshot import Camera
from tests.fixtures.buildings import HALL, RISE, two_storeys, with_refuge_and_lift
from tests.fixtures.escalators import hall

WHEELCHAIR = "wheelchair_manual: 1.0"


def do(run, verb, **fields):
    _, command = read_command(json.dumps({"do": verb, **fields}))
    return command(run)


def run_of(building, population=None, **keywords):
    return Run(PedestrianModel(building, population=population, rng=1, **keywords), rate=10)


def added(run, place, level):
    [person] = do(run, "add", positions=[place], level=level)["people"]
    return person


def here(run, person):
    """x, y and z in metres, and the level."""
    found = where(run.model, np.array([person]))
    return (*(float(each[0]) for each in found[:3]), int(found.level[0]))


def on_the_way(run, person, seconds):
    """Where somebody is after each step, until they stand at the place to which they were sent."""
    places = []
    for _ in range(10 * seconds):
        run.step()
        places.append(here(run, person))
        if run.orders.does[person] == STANDS:
            return places
    raise AssertionError(f"after {seconds} s at {places[-1]}, expected them to have arrived")


@pytest.mark.parametrize("form", ["binary", "json"])
def test_clients_get_the_building_and_true_places(serve_model, form):
    building = two_storeys()
    served = serve_model(PedestrianModel(building, rng=1))
    with served.client(form=form) as client:
        client.frame()
        [scene] = client.others
        assert scene["plan"] == json.loads(json.dumps(building.to_geojson()))
        kinds = [each["properties"]["kind"] for each in scene["plan"]["features"]]
        assert kinds.count("stairs") == 2
        client.tell("pause")
        assert client.tell("add", positions=[[5.0, 4.0]], level=1)["people"] == [0]
        assert client.tell("add", positions=[[5.0, 4.0], [6.5, 2.0]], level=0)["people"] == [1, 2]
        frame = client.until(lambda frame: len(frame) == 3)
        assert frame.x.tolist() == [5.0, 5.0, 6.5]
        assert frame.y.tolist() == [4.0, 4.0, 2.0]
        assert frame.z.tolist() == [3.06, 0.0, 0.0]
        assert frame.level.tolist() == [1, 0, 0]
        assert frame.level.dtype == np.int16
        answer = client.tell("walk", person=0, to=[3.0, 3.0])
        assert answer["error"] == "level: missing, expected one of 0, 1"


def test_people_on_stairs_have_the_height_of_the_slope():
    building = two_storeys()
    model = PedestrianModel(building, rng=1)
    # The stair goes down from x = 8 over 17 treads of 0.29 m: here is a quarter of the way.
    quarter = 8.0 + 17 * 0.29 / 4
    model.add_pedestrians(building.plane_places([(quarter, 0.6, 0.75 * RISE), (20.0, 3.0, RISE)]))
    found = where(model, model.rows)
    assert found.x == pytest.approx([quarter, 20.0])
    assert found.y == pytest.approx([0.6, 3.0])
    assert found.z == pytest.approx([2.295, 3.06])
    assert found.level.tolist() == [ON_STAIRS, 1]


def test_a_model_of_one_level_has_frames_as_ever():
    run = run_of(Building([Level(0, HALL, exits=[Exit("west", (0, 3), (0, 5))])]))
    do(run, "add", positions=[[5.0, 4.0]])
    frame = Camera(run.model, 10).take(paused=True).frame
    assert (frame.z, frame.level) == (None, None)
    assert list(json.loads(frame.to_json())) == [
        *("type", "number", "frame", "sent", "paused", "person", "x", "y", "heading", "vx", "vy")
    ]
    assert len(frame.to_bytes()) == 32 + 44
    assert frame.to_bytes()[6:8] == b"\1\0"
    with pytest.raises(LiveError, match="level: got 0, expected none: the model has one level"):
        do(run, "walk", person=0, to=[3.0, 3.0], level=0)


def test_somebody_is_sent_upstairs_and_down_again():
    run = run_of(two_storeys())
    person = added(run, [4.0, 4.0], 0)
    do(run, "walk", person=person, to=[4.0, 4.0], level=1)
    up = on_the_way(run, person, 40)
    # By the south stair: 7 m to its foot at (12.93, 0.6) and round it, 5 m up, and 5 m back. Nobody
    # walks 17 m in less than 9 s.
    assert len(up) > 90
    assert math.dist(up[-1][:3], (4.0, 4.0, RISE)) < 0.5
    assert [up[0][3], up[-1][3]] == [0, 1]
    heights = [z for _, _, z, level in up if level == ON_STAIRS]
    assert heights == sorted(heights)
    assert len(heights) > 20
    do(run, "walk", person=person, to=[4.0, 4.0], level=0)
    assert math.dist(on_the_way(run, person, 40)[-1][:3], (4.0, 4.0, 0.0)) < 0.5


def test_nobody_in_a_wheelchair_is_led_to_stairs():
    run = run_of(two_storeys(), WHEELCHAIR)
    person = added(run, [6.0, 4.0], 0)
    do(run, "walk", person=person, to=[4.0, 4.0], level=1)
    for _ in range(50):
        run.step()
    # There is no way: they wait for one.
    assert math.dist(here(run, person)[:3], (6.0, 4.0, 0.0)) < 0.2
    do(run, "walk", person=person, to=[12.0, 4.0], level=0)
    assert math.dist(on_the_way(run, person, 20)[-1][:3], (12.0, 4.0, 0.0)) < 0.5


def test_a_wheelchair_rides_to_a_place_and_stays_there():
    run = run_of(with_refuge_and_lift(), WHEELCHAIR, record=True)
    person = added(run, [20.0, 3.0], 0)
    do(run, "walk", person=person, to=[20.0, 4.5], level=1)
    places = on_the_way(run, person, 60)
    assert math.dist(places[-1][:3], (20.0, 4.5, RISE)) < 0.5
    # Riders count as on the level from which they ride until the doors have opened.
    assert max(z for _, _, z, level in places if level == 0) == pytest.approx(RISE)
    assert ON_STAIRS not in {level for *_, level in places}
    assert run.model.lifts.carried.tolist() == [1]
    # The results have the same places.
    tracks = Trajectories.of(run.model)
    every = tracks.frame % 3 == 0
    np.testing.assert_allclose(tracks.z[every][1:], [z for _, _, z, _ in places], atol=1e-12)
    # The way out leads through the lift, 2 m away, which lets nobody in who is to stand there.
    for _ in range(60):
        run.step()
        assert run.model.lifts.rides(np.array([person])).tolist() == [-1]
    assert math.dist(here(run, person)[:3], places[-1][:3]) < 0.1


def test_who_is_sent_to_a_place_goes_to_no_refuge():
    run = run_of(with_refuge_and_lift(), WHEELCHAIR)
    for level in (0, 1):
        do(run, "close", opening=f"lift at level {level}")
    person = added(run, [12.0, 4.0], 1)
    for _ in range(300):
        run.step()
    assert run.model.in_refuges["north lobby"] == [person]
    do(run, "walk", person=person, to=[8.0, 4.0], level=1)
    assert math.dist(on_the_way(run, person, 20)[-1][:3], (8.0, 4.0, RISE)) < 0.5
    assert run.model.in_refuges["north lobby"] == []
    do(run, "release", person=person)
    for _ in range(150):
        run.step()
    # The refuge begins at x = 15.
    assert here(run, person)[0] > 14.0


def test_who_has_no_way_waits_for_one_even_in_a_refuge():
    run = run_of(with_refuge_and_lift(), WHEELCHAIR)
    do(run, "close", opening="lift")
    person = added(run, [17.0, 2.5], 1)
    do(run, "walk", person=person, to=[20.0, 3.0], level=0)
    for _ in range(300):
        run.step()
    assert math.dist(here(run, person)[:3], (17.0, 2.5, RISE)) < 0.2
    do(run, "open", opening="lift")
    assert math.dist(on_the_way(run, person, 60)[-1][:3], (20.0, 3.0, 0.0)) < 0.5
    # Then they go on to the exit, as before.
    do(run, "release", person=person)
    for _ in range(600):
        run.step()
    assert run.model.inside == 0


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"to": [3, 3]}, "level: missing, expected one of 0, 1"),
        ({"to": [3, 3], "level": 7}, "level: got 7, expected one of 0, 1"),
        ({"to": [3, 3], "level": "first"}, 'level: got "first", expected the number of a level'),
        ({"to": [3, 3], "level": True}, "level: got true, expected the number of a level"),
        # On the sheet beside it this would be a place on the floor: 44 m off.
        ({"to": [47, 4], "level": 0}, "to: (47, 4) is not on level 0, expected a place on"),
        ({"to": [-41, 4], "level": 1}, "to: (-41, 4) is not on level 1"),
        ({"to": [10, 0.6], "level": 1}, "to: (10, 0.6) is not on level 1"),
        ({"to": [3, 0.1], "level": 1}, "expected a place with room for the body"),
    ],
)
def test_a_place_without_its_level_is_refused(fields, message):
    run = run_of(two_storeys())
    person = added(run, [4.0, 4.0], 0)
    with pytest.raises(LiveError) as refused:
        do(run, "walk", person=person, **fields)
    assert message in str(refused.value)


def test_nobody_is_sent_into_a_lift():
    run = run_of(with_refuge_and_lift(), WHEELCHAIR)
    person = added(run, [20.0, 3.0], 0)
    with pytest.raises(LiveError, match=r"\(20.4, 7.3\) is not on level 0"):
        do(run, "walk", person=person, to=[20.4, 7.3], level=0)


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"positions": [[3, 3]]}, "level: missing, expected one of 0, 1"),
        ({"positions": [[3, 3], [30, 3]], "level": 1}, "positions: (30, 3) is not on level 1"),
        ({"positions": [[3, 0.1]], "level": 1}, "pedestrian 0 at [3.0, 0.1]: 0.100 m from a wall"),
        ({"positions": [[8, 4]], "level": 1}, "pedestrian 0 at [8.0, 4.0]: too close to where"),
    ],
)
def test_errors_about_newcomers_name_true_places(fields, message):
    run = run_of(two_storeys())
    added(run, [8.0, 4.0], 1)
    with pytest.raises(LiveError) as refused:
        do(run, "add", **fields)
    assert message in str(refused.value)


def test_routes_over_stairs_count_as_routes_of_the_model_do():
    building = two_storeys()
    plan = building.floor_plan
    start, place = building.plane_places([(4.0, 0.6, RISE), (16.0, 0.6, 0.0)])
    aims = PointRoutes(plan, 0.3).targets(start[None], tuple(place.tolist()))
    [south] = [each for each in plan.seams if each.name == "south"]
    # Straight on, and what the stair counts more.
    assert aims.lengths[0] == pytest.approx(12.0 + south.extra, abs=0.01)
    assert plan.openings()[aims.gates[0]].name.startswith("south")
    wheeled = PointRoutes(plan, 0.3, climbs=False).targets(start[None], tuple(place.tolist()))
    assert wheeled.lengths.tolist() == [math.inf]


def test_routes_take_an_escalator_its_own_way():
    building = hall(direction="down")
    above, below = building.plane_places([(20.0, 3.0, 4.0), (4.0, 3.0, 0.0)])
    routes = PointRoutes(building.floor_plan, 0.3)
    assert math.isfinite(routes.targets(above[None], tuple(below.tolist())).lengths[0])
    assert routes.targets(below[None], tuple(above.tolist())).lengths[0] == math.inf


class Spy(Tactic):
    """Keeps what people were to want when it was asked."""

    name = "spy"
    targets = points = None

    def apply(self, deciding, desired):
        self.targets, self.points = desired.targets, desired.points


def test_behaviours_see_the_way_to_the_place_instead_of_that_to_the_exit():
    run = run_of(two_storeys())
    person, other = added(run, [4.0, 4.0], 1), added(run, [6.0, 4.0], 1)
    spy = Spy()
    names = [each.name for each in run.model.tactics]
    run.model.tactics.insert(names.index("walking_orders") + 1, spy)
    do(run, "walk", person=person, to=[4.0, 7.0], level=1)
    run.step()
    rows = [person, other]
    # The sheet of level 1 lies 44 m to the right.
    assert spy.targets.points[rows[0]].tolist() == pytest.approx([48.0, 7.0])
    assert spy.targets.distances[rows[0]] == pytest.approx(3.0, abs=1e-6)
    assert (spy.targets.points == spy.points).all()
    assert spy.targets.points[rows[1]].tolist() != pytest.approx([48.0, 7.0])


class Office(PedestrianModel):
    """One person in a wheelchair who goes up by the lift, and one who takes the stairs."""

    def __init__(self, rng=None):
        building = with_refuge_and_lift()
        both = "able_bodied: 0.5, wheelchair_manual: 0.5"
        super().__init__(building, population=both, record=True, rng=rng)
        orders = follow_orders(self)
        people = self.add_pedestrians(building.places([(20.0, 3.0), (12.0, 4.0)], level=0))
        [[x, y]] = building.places([(20.0, 4.5)], level=1).tolist()
        orders.walk(np.array([each.row for each in people]), (x, y), None)


def test_orders_to_another_level_are_in_checkpoints(tmp_path):
    model = Office(rng=1)
    while model.lifts.rides(model.rows).max() < 0:
        model.step()
    model.save(tmp_path / "run.zip")
    again = Office.load(tmp_path / "run.zip")
    until = model.elapsed + 30.0
    for each in (model, again):
        each.run(max_seconds=until)
    tracks, others = Trajectories.of(model), Trajectories.of(again)
    assert all(np.array_equal(getattr(tracks, name), getattr(others, name)) for name in "xyz")
    assert set(tracks.level[tracks.frame == tracks.frame.max()].tolist()) == {1}
