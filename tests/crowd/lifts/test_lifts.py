"""People who do not climb wait for a lift, ride down in it, and leave; others take the stairs."""

from dataclasses import replace

import numpy as np
import pytest

from mesa_mobility import PedestrianModel, Trajectories
from mesa_mobility.buildings import Building, Level, Lift, Stairs
from mesa_mobility.crowd.conflicts import give_way
from mesa_mobility.errors import ContentError, FloorPlanError
from mesa_mobility.floorplan import Exit, Router
from mesa_mobility.results import check_safety
from tests.fixtures.checkpoints import check_going_on

HALL = "POLYGON ((0 0, 24 0, 24 8, 0 8, 0 0))"
RISE = 3.0
DOOR = ((20.0, 6.5), (20.9, 6.5))


def office(storeys=2, stairs=True, **lift):
    """Storeys 3 m apart with a lift between all of them, and an exit on the lowest."""
    levels = [
        Level(k, HALL, RISE * k, exits=[Exit("west", (0, 3), (0, 5))] if k == 0 else [])
        for k in range(storeys)
    ]
    flights = [
        Stairs.dog_leg(f"stairs {k}", k + 1, k, head=((8, 1.4), (8, 0.2)), risers=18, turn="left")
        for k in range(storeys - 1)
    ]
    given = {"speed": 1.5, "door_s": 2.0, **lift}
    return Building(levels, flights if stairs else [], lifts=[Lift("car", levels, DOOR, **given)])


def crowd(building, count, population, *, rng=1, level=1, **keywords):
    model = PedestrianModel(building, population=population, record=True, rng=rng, **keywords)
    places = building.random_points(count, model.rng, level=level, spacing=0.9, clearance=0.45)
    model.add_pedestrians(places)
    return model


def riders(model):
    """Rows of the people in the car, by its stops."""
    shaft, rows = model.lifts.shafts[0], model.rows
    places = np.column_stack([model.crowd.x[rows], model.crowd.y[rows]])
    return [rows[shaft.in_car(stop, places)] for stop in range(len(shaft.stops))]


def test_a_ride_takes_as_long_as_its_doors_and_its_way():
    shaft = office(storeys=4).floor_plan.shafts[0]
    # 2 s to close and 2 s to open; 3 m and 9 m at 1.5 m/s.
    assert shaft.ride_s(0, 1) == pytest.approx(4.0 + 2.0)
    assert shaft.ride_s(3, 0) == pytest.approx(4.0 + 6.0)


@pytest.mark.parametrize("rng", [1, 2, 3, 4])
def test_everybody_gets_out_by_stairs_or_lift(rng):
    building = office()
    model = crowd(building, 12, "able_bodied: 0.6, wheelchair_manual: 0.4", rng=rng)
    own = [person.pedestrian_type.climbs for person in model.agents]
    model.run(max_seconds=600)
    assert model.inside == 0
    assert model.without_stairs == []
    # Nobody else uses the lift.
    assert model.lifts.carried.tolist() == [own.count(False)]
    [lift] = model.summary()["lifts"]
    assert (lift["lift"], lift["carried"]) == ("car", own.count(False))
    # It goes up for each, and comes down: a wheelchair fills it.
    assert lift["trips"] == 2 * own.count(False)
    tracks = Trajectories.of(model)
    plan = building.floor_plan
    assert check_safety(tracks, plan.walls, plan.free, building=building).passed


def test_a_rider_who_makes_way_stays_in_a_car_that_is_under_way(monkeypatch):
    building = office(stairs=False)
    model = PedestrianModel(building, population="wheelchair_manual: 1.0", rng=1, frames_per_step=1)
    model.add_pedestrians(building.places([(20.45, 4.0), (12.0, 4.0)], level=1))
    while not model.lifts.carried[0]:
        model.step()
    before = building.places([(20.45, 5.4)], level=1)
    monkeypatch.setattr(give_way, "places_aside", lambda *_: before)
    [tactic] = [each for each in model.tactics if each.name == "giving_way"]
    # The other, to whom nobody is in the way, is to pass from the outside.
    steps = 0
    while model.lifts._from[0] >= 0:
        notes = tactic._notes
        notes["first"][0], notes["asked_by"][0], notes["until"][0] = 1, 1, 1e6
        model.step()
        steps += 1
        assert 0 in np.concatenate(riders(model))
    assert steps >= 150


def test_people_can_step_into_a_car_and_into_no_shaft_without_one():
    building = office()
    model = PedestrianModel(building, rng=1)
    places = [building.places([(20.45, 6.2)], level=level)[0] for level in (0, 1)]
    model.add_pedestrians(places, headings=np.pi / 2.0)
    goals = [building.places([(20.45, 7.4)], level=level)[0] for level in (0, 1)]
    wishes = model.wishes(model.rows, np.array(goals), np.full(2, 1.3))
    ends = [wishes.paths[k, 1, : wishes.pieces[k] + 1].max() for k in (0, 1)]
    # The line of the door is y = 6.5. The car is on level 0.
    assert ends[0] > 6.5
    assert ends[1] <= 6.5 - model.crowd.core[1] + 1e-6


def test_doors_are_shut_where_no_car_is():
    building = office(storeys=3, stairs=False)
    model = PedestrianModel(building, population="wheelchair_manual: 1.0", rng=1, frames_per_step=1)
    model.add_pedestrians(building.places([(20.45, 4.0)], level=2))
    shut, car, seen = model._scene.environment, model.lifts, set()
    while model.inside and model.elapsed < 300:
        model.step()
        stops = {int(car.at[0])} if car._from[0] < 0 else set()
        assert shut.shut == {f"car at level {k}" for k in range(3) if k not in stops}
        seen.add(tuple(stops))
    assert seen == {(0,), (2,), ()}


@pytest.mark.parametrize("y", [6.3, 7.3])
def test_who_stands_in_the_door_of_a_car_that_is_elsewhere_waits_for_it(y):
    # 0.2 m before the line of the door, y = 6.5, and where the car will be.
    building = office(stairs=False)
    model = PedestrianModel(building, population="wheelchair_manual: 1.0", rng=1, frames_per_step=1)
    model.add_pedestrians(building.places([(20.45, y)], level=1))
    while model.lifts._rides[:1].max(initial=-1) < 0 and model.time < 60.0:
        model.step()
        assert len(riders(model)[1]) == (y > 6.5)
    model.run(max_seconds=300)
    assert (model.inside, model.lifts.carried.tolist(), model.lifts.trips.tolist()) == (0, [1], [2])


def test_the_car_holds_no_more_than_its_capacity_and_they_ride_together():
    building = office(stairs=False, everybody=True, capacity=4)
    model = crowd(building, 10, "able_bodied: 1.0")
    most, times = 0, []
    while model.inside and model.elapsed < 300:
        before = riders(model)
        model.step()
        after = riders(model)
        most = max(most, *map(len, after))
        gone = set(before[1].tolist()) & set(after[0].tolist())
        if gone:
            # All in the car come down at once, and keep their places in it.
            assert gone == set(before[1].tolist())
            times.append(model.elapsed)
    assert model.inside == 0
    assert most == 4
    assert len(times) == 3  # 4, 4 and 2
    assert model.lifts.carried.tolist() == [10]
    # Down 6 s, up 6 s, and time to get out and in.
    assert min(np.diff(times)) > 12.0


def test_a_car_stops_where_somebody_wants_to_get_out():
    levels = [
        Level(0, HALL, 0.0),
        Level(1, HALL, 3.0, exits=[Exit("bridge", (0, 3), (0, 5))]),
        Level(2, HALL, 6.0),
    ]
    building = Building(levels, lifts=[Lift("car", levels, DOOR, everybody=True)])
    model = PedestrianModel(building, record=True, rng=1)
    for level in (0, 2):
        model.add_pedestrians(building.places([(18.0, 4.0)], level=level))
    model.run(max_seconds=200)
    assert model.inside == 0
    tracks = Trajectories.of(model)
    for person, start in enumerate((0.0, 6.0)):
        rows = tracks.rows_of(person)
        assert set(tracks.level[rows].tolist()) == {2 * person, 1}
        assert tracks.z[rows[[0, -1]]].tolist() == [start, 3.0]


def test_riders_rise_with_the_car_and_are_on_their_level_until_the_doors_open():
    levels = [Level(0, HALL), Level(1, HALL, 3.0, exits=[Exit("out", (0, 3), (0, 5))])]
    lift = Lift("car", levels, DOOR, everybody=True, speed=1.5, door_s=2.0)
    building = Building(levels, lifts=[lift])
    model = PedestrianModel(building, record="decisions", rng=1)
    model.add_pedestrians(building.places([(20.45, 4.5)], level=0))
    model.run(max_seconds=60)
    tracks = Trajectories.of(model)
    rows = tracks.rows_of(0)
    z, level = tracks.z[rows], tracks.level[rows]
    moving = np.flatnonzero((z > 0.0) & (z < 3.0))
    # 3 m at 1.5 m/s take 60 frames, after the first of which the car has risen by 5 cm.
    assert np.diff(moving).tolist() == [1] * 58
    assert z[moving] == pytest.approx(0.05 * np.arange(1, 60))
    # The doors open in 2 s: 60 frames and one look at the cars, every third frame.
    opened = int(np.argmax(level == 1))
    assert 60 <= opened - (moving[-1] + 1) <= 63
    assert (level[:opened] == 0).all()
    assert (level[opened:] == 1).all()
    assert (z[moving[-1] + 1 :] == 3.0).all()
    # Bodies are those on a level floor, as high as the car.
    level_floor = replace(tracks, fields={**tracks.fields, "z": np.zeros(len(tracks))})
    risen = tracks.poses(0, building=building).positions - level_floor.poses(0).positions
    assert risen == pytest.approx(np.broadcast_to([0.0, 0.0, 1.0], risen.shape) * z[:, None, None])
    # They are in the car meanwhile: 1.1 m wide about x = 20.45, from y = 6.6 to 8.0.
    riding = rows[moving[0] : opened]
    assert np.abs(tracks.x[riding] - 20.45).max() < 0.55
    assert (tracks.y[riding].min() > 6.6) & (tracks.y[riding].max() < 8.0)
    plan = building.floor_plan
    assert check_safety(tracks, plan.walls, plan.free, building=building).passed


def test_places_in_a_car_are_on_the_drawing_of_the_nearest_level():
    building = office(storeys=3)
    inside = (20.45, 7.4)
    found = building.plane_places([(*inside, z) for z in (0.0, 1.4, 1.6, 4.4, 4.6, 6.0)])
    places, levels = building.true_places(found)
    assert levels.tolist() == [0, 0, 1, 1, 2, 2]
    assert places[:, :2] == pytest.approx(np.tile(inside, (6, 1)))
    with pytest.raises(FloorPlanError, match="or in a lift; the nearest level is 2, at 6 m"):
        building.plane_places([(*inside, 6.5)])
    with pytest.raises(FloorPlanError, match="or in a lift"):
        building.plane_places([(20.45, 5.0, 1.4)])


def test_people_of_a_level_without_a_lift_stay():
    levels = [
        Level(k, HALL, 3.0 * k, exits=[Exit("out", (0, 3), (0, 5))] if k == 0 else [])
        for k in range(3)
    ]
    flights = [
        Stairs.dog_leg(f"stairs {k}", k + 1, k, head=((8, 1.4), (8, 0.2)), risers=18)
        for k in range(2)
    ]
    building = Building(levels, flights, lifts=[Lift("car", levels[:2], DOOR)])
    model = crowd(building, 3, "wheelchair_powered: 1.0", level=2)
    model.run(max_seconds=20)
    assert model.without_stairs == [0, 1, 2]


def test_steps_and_checkpoints_change_nothing(tmp_path):
    class Office(PedestrianModel):
        def __init__(self, frames_per_step=3, rng=None):
            super().__init__(
                office(),
                population="able_bodied: 0.5, wheelchair_powered: 0.5",
                record=True,
                frames_per_step=frames_per_step,
                rng=rng,
            )
            building = self.building
            self.add_pedestrians(
                building.random_points(6, self.rng, level=1, spacing=0.9, clearance=0.45)
            )

    tracks = []
    for frames in (1, 3, 30):
        model = Office(frames_per_step=frames, rng=1)
        model.run(max_seconds=40)
        tracks.append(model.recorder.arrays()["x"])
    assert all(np.array_equal(each, tracks[0]) for each in tracks)
    # 18 s: somebody rides.
    check_going_on(Office(rng=1), tmp_path, saved_at=18, until=40)


def test_a_checkpoint_with_a_stop_that_is_not_there_is_refused():
    model = crowd(office(), 2, "wheelchair_powered: 1.0")
    model.run(max_seconds=10)
    state = {name: each.copy() for name, each in model.lifts.state().items()}
    assert (state["_calls"] >= 0).any()
    state["_stop"][state["_calls"] >= 0] = 2
    with pytest.raises(ContentError, match="rides, begun, row 0: there is no such lift or stop"):
        model.lifts.log.restore({"begun": np.array([[0, 1, 2, 300]])})
    with pytest.raises(ContentError, match="lifts, _stop: has a stop that the lift does not have"):
        model.lifts.restore(state)


def test_routes_count_a_ride_as_long_as_it_takes():
    building = office()
    router = Router(building.floor_plan, clearance=0.2, climbs=False)
    [place] = building.places([(20.45, 4.5)], level=1)
    # 2.05 m to the middle of the doorway; 6 s of ride and as much of waiting, at 1.34 m/s; and from
    # there past the jamb to the exit: about 20.45 m along and 1.75 m across.
    expected = 2.05 + 2.0 * 6.0 * 1.34 + np.hypot(20.45, 6.55 - 4.8)
    assert router.targets([place], [0]).distances[0] == pytest.approx(expected, abs=0.3)
