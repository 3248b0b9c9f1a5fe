"""People who cannot leave go to a refuge and wait there; the run ends when all others are out."""

import numpy as np
import pytest
import shapely

from mesa_mobility import (
    Building,
    Escalator,
    Exit,
    Level,
    Lift,
    PedestrianModel,
    Refuge,
    Stairs,
    Trajectories,
)
from mesa_mobility.buildings import read_floor
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.results import check_safety
from tests.fixtures.checkpoints import check_going_on

HALL = "POLYGON ((0 0, 24 0, 24 8, 0 8, 0 0))"
SAFE = "POLYGON ((19 1, 23 1, 23 4, 19 4, 19 1))"
CORNER = "POLYGON ((0 0, 2 0, 2 3, 0 3, 0 0))"
GROUND = Level(0, HALL, exits=[Exit("street", (0, 3), (0, 5))])
STAIRS = Stairs.dog_leg("stairs", 1, 0, ((8, 1.4), (8, 0.2)), risers=18)


LOBBY = Refuge("lobby", SAFE)


def office(refuges=(LOBBY,), lifts=()):
    return Building([GROUND, Level(1, HALL, 3.0, refuges=refuges)], [STAIRS], lifts=lifts)


def crowd(building, population="able_bodied: 0.6, wheelchair_powered: 0.4", rng=1):
    model = PedestrianModel(building, population=population, record=True, rng=rng)
    places = building.random_points(12, model.rng, level=1, spacing=1.3, clearance=0.65)
    model.add_pedestrians(places)
    return model


def test_those_who_cannot_leave_wait_in_the_refuge():
    building = office()
    model = crowd(building)
    own = [person.row for person in model.agents if not person.pedestrian_type.climbs]
    assert len(own) > 2
    model.run(max_seconds=200)
    assert not model.stalled
    assert sorted(model.rows.tolist()) == own
    assert model.without_stairs == own
    assert model.in_refuges == {"lobby": own}
    tracks, plan = Trajectories.of(model), building.floor_plan
    assert check_safety(tracks, plan.walls, plan.free, building=building).passed
    last = np.array([tracks.rows_of(row)[-1] for row in own])
    assert (tracks.z[last] == 3.0).all()
    # Somebody whom others keep out may wait right before it: a wheelchair is 0.7 m wide.
    area = shapely.from_wkt(SAFE)
    away = shapely.distance(area, shapely.points(tracks.x[last], tracks.y[last]))
    assert away.max() < 1.0
    assert (away == 0.0).sum() > len(own) / 2
    summary = model.summary()
    counted = {"wheelchair_powered": len(own)}
    assert summary["refuges"] == [{"refuge": "lobby", "waiting": len(own), "by_type": counted}]
    assert summary["cannot_leave"] == {"people": len(own), "by_type": counted}
    assert summary["left_inside"] == len(own)
    # The others are out.
    assert summary["egress_s"] == pytest.approx(np.nanmax(_times_out(tracks, own)), abs=0.05)


def _times_out(tracks, stay):
    return [
        tracks.frame[tracks.rows_of(person)[-1]] / 30.0
        for person in range(tracks.people)
        if person not in stay
    ]


def test_with_a_lift_nobody_needs_it_unless_the_lift_is_closed():
    lift = Lift("car", [0, 1], ((20.0, 6.5), (20.9, 6.5)), speed=2.0)
    model = crowd(office(lifts=[lift]))
    assert model.without_stairs == []
    assert model.in_refuges == {"lobby": []}
    building = office(lifts=[lift])
    for gate in ("car at level 0", "car at level 1"):
        building.floor_plan.close_gate(gate)
    model = crowd(building)
    model.run(max_seconds=200)
    assert model.in_refuges["lobby"] == model.without_stairs == model.rows.tolist() != []


def test_nobody_is_in_a_refuge_who_stands_elsewhere():
    lift = Lift("car", [1, 2], ((20.0, 6.5), (20.9, 6.5)))
    levels = [GROUND, Level(1, HALL, 3.0, refuges=[LOBBY]), Level(2, HALL, 6.0)]
    above = Stairs.dog_leg("above", 2, 1, ((8, 1.4), (8, 0.2)), risers=18)
    building = Building(levels, [STAIRS, above], lifts=[lift])
    model = PedestrianModel(building, population="wheelchair_powered", rng=1)
    waits, rides = model.add_pedestrians(
        [*building.places([(12.0, 5.0)], level=1), *building.places([(20.4, 4.0)], level=2)]
    )
    waits.wait(20.0)
    model.run(max_seconds=15)
    # One stands where they are told to, the other before the lift or in it.
    assert model.in_refuges == {"lobby": []}
    assert not model.all_in_refuges
    model.run(max_seconds=150)
    assert model.in_refuges == {"lobby": [waits.row, rides.row]}
    assert model.lifts.carried[0] == 1
    assert model.elapsed < 120


def test_who_waits_in_a_refuge_is_in_checkpoints(tmp_path):
    class Office(PedestrianModel):
        def __init__(self, rng=None):
            super().__init__(office(), population="wheelchair_powered", record=True, rng=rng)
            self.add_pedestrians(self.building.places([(19.0, 2.5), (5.0, 4.0)], level=1))

    check_going_on(Office(rng=1), tmp_path, saved_at=8, until=40)
    model = Office(rng=1)
    model.run(max_seconds=8)
    assert len(model.in_refuges["lobby"]) == 1


def test_a_level_with_a_refuge_is_written_and_read(tmp_path):
    hall = Building([Level(0, HALL, exits=[Exit("street", (0, 3), (0, 5))], refuges=[LOBBY])])
    hall.write_geojson(tmp_path / "hall.geojson")
    assert [each.name for each in read_floor(tmp_path / "hall.geojson").refuges] == ["lobby"]


def test_without_a_refuge_they_stay_where_they_are():
    model = crowd(office(refuges=()), population="wheelchair_powered")
    before = model.crowd.x[model.rows].copy()
    model.run(max_seconds=20)
    assert np.allclose(model.crowd.x[model.rows], before, atol=0.05)
    assert model.in_refuges == {}
    assert "refuges" not in model.summary()


def test_refuges_are_written_and_read():
    building = office(refuges=[Refuge("lobby", SAFE), Refuge("corner", CORNER)])
    read = Building.from_geojson(building.to_geojson())
    assert read.levels[1].refuges == building.levels[1].refuges
    assert read.to_geojson() == building.to_geojson()
    [lobby, _] = read.refuges
    shift = read.sheets[1].shift[0]
    assert lobby.shape.bounds == pytest.approx((19.0 + shift, 1.0, 23.0 + shift, 4.0))


@pytest.mark.parametrize(
    ("refuges", "said"),
    [
        ([Refuge("a", SAFE)] * 2, "refuge 'a' is there twice"),
        (["lobby"], "level 1: refuges must be Refuge objects, found str"),
        (
            [Refuge("a", "POLYGON ((22 1, 26 1, 26 4, 22 4, 22 1))")],
            r"level 1: refuge 'a' leaves the walkable area at \(25.00, 2.50\)",
        ),
    ],
)
def test_bad_refuges_get_one_line(refuges, said):
    with pytest.raises(FloorPlanError, match=said) as caught:
        office(refuges=refuges)
    assert "\n" not in str(caught.value)


LIFT = Lift("car", [0, 1], ((20.0, 6.5), (20.9, 6.5)))


@pytest.mark.parametrize(
    ("area", "said"),
    [
        (
            "POLYGON ((7 0, 9 0, 9 1, 7 1, 7 0))",
            r"stairs 'stairs 2' on level 1: refuge 'a' is in their way at \(8.5",
        ),
        (
            "POLYGON ((11 3, 12 3, 12 5, 11 5, 11 3))",
            r"escalator 'belt' on level 1: refuge 'a' is in their way at \(11.5",
        ),
        (
            "POLYGON ((20 6.8, 21 6.8, 21 8, 20 8, 20 6.8))",
            "lift 'car' on level 1: refuge 'a' is in their way at",
        ),
        (
            "POLYGON ((22 3, 24 3, 24 6, 22 6, 22 3))",
            r"level 1: refuges 'lobby' and 'a' overlap at \(22.50, 3.50\)",
        ),
    ],
)
def test_refuges_lie_on_free_floor(area, said):
    belt = Escalator.straight("belt", 1, 0, ((14, 3), (14, 4)), length=5.2)
    level = Level(1, HALL, 3.0, refuges=[LOBBY, Refuge("a", area)])
    with pytest.raises(FloorPlanError, match=said) as caught:
        Building([GROUND, level], [STAIRS, belt], lifts=[LIFT])
    assert "\n" not in str(caught.value)


def test_refuges_may_touch_each_other_and_the_edges_of_stairs():
    beside = Refuge("beside", "POLYGON ((19 4, 23 4, 23 6, 19 6, 19 4))")
    stairs = Refuge("stairs", "POLYGON ((6 0, 8 0, 8 3, 6 3, 6 0))")
    assert office(refuges=[LOBBY, beside, stairs]).refuges


def test_what_is_no_list_of_refuges_gets_one_line():
    with pytest.raises(FloorPlanError, match="level 1: refuges must be a list, found int"):
        Level(1, HALL, refuges=5)


def test_a_refuge_needs_a_name_and_an_area():
    with pytest.raises(FloorPlanError, match="refuge: expected a name"):
        Refuge("", SAFE)
    with pytest.raises(FloorPlanError, match="refuge 'a'"):
        Refuge("a", "POINT (1 2)")


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"geometry": {"type": "Point", "coordinates": [0, 0]}}, "refuge must be a Polygon"),
        ({"geometry": None}, "the geometry cannot be read"),
        ({"name": ""}, "refuge: expected a name"),
        ({"level": "roof"}, "level must be a whole number"),
        ({"level": 7}, "level 7: expected one walkable area, found 0"),
    ],
)
def test_bad_files_name_the_feature(change, said):
    collection = office().to_geojson()
    [feature] = [each for each in collection["features"] if each["properties"]["kind"] == "refuge"]
    for name, value in change.items():
        (feature if name == "geometry" else feature["properties"])[name] = value
    with pytest.raises(FloorPlanError, match=said) as caught:
        Building.from_geojson(collection)
    assert "\n" not in str(caught.value)


def test_those_for_whom_there_is_no_room_wait_before_the_refuge():
    small = Refuge("small", "POLYGON ((22.8 6.8, 24 6.8, 24 8, 22.8 8, 22.8 6.8))")
    model = crowd(office(refuges=[small]), population="wheelchair_powered")
    model.run(max_seconds=300)
    assert model.elapsed < 200
    assert not model.stalled
    assert model.in_refuges == {"small": list(range(12))}


def test_the_area_is_filled_first():
    model = PedestrianModel(office(), population="wheelchair_powered", rng=1)
    model.add_pedestrians(
        model.building.places([(13, 5), (11, 3), (10, 6), (12, 7), (15, 3)], level=1)
    )
    model.run(max_seconds=120)
    assert model.in_refuges == {"lobby": [0, 1, 2, 3, 4]}
    [lobby] = model.building.refuges
    assert shapely.intersects_xy(lobby.shape, model.crowd.x[:5], model.crowd.y[:5]).all()


def sent_then(change, seconds=90, lifts=(LIFT,), start=(9.0, 5.0)):
    """A model of one person in a wheelchair, who is sent to the lobby, and to whom ``change``
    happens 3 s later."""
    building = office(lifts=lifts)
    for gate in ("car at level 0", "car at level 1") if lifts else ():
        building.floor_plan.close_gate(gate)
    model = PedestrianModel(building, population="wheelchair_powered", rng=1)
    model.add_pedestrians(building.places([start], level=1))
    model.run(max_seconds=3)
    change(building.floor_plan)
    model.run(max_seconds=seconds)
    return model


def reopen(plan):
    for gate in ("car at level 0", "car at level 1"):
        plan.open_gate(gate)


def test_who_has_not_come_to_a_refuge_takes_a_lift_that_is_in_use_again():
    model = sent_then(reopen)
    assert model.inside == 0
    assert model.lifts.carried.tolist() == [1]


def test_an_obstacle_on_the_middle_moves_the_target():
    shift = office().sheets[1].shift[0]
    block = shapely.box(20.5 + shift, 2.0, 21.5 + shift, 3.0)
    model = sent_then(lambda plan: plan.add_obstacle(block), lifts=())
    assert model.in_refuges == {"lobby": [0]}
    assert not model.stalled


def test_nobody_goes_to_a_refuge_because_an_exit_is_closed_for_everybody():
    ground = Level(0, HALL, exits=GROUND.exits, refuges=[LOBBY])
    building = Building([ground, Level(1, HALL, 3.0)], [STAIRS])
    model = PedestrianModel(building, population="wheelchair_powered", rng=1)
    model.add_pedestrians(building.places([(9.0, 5.0)], level=0))
    building.floor_plan.close_gate("street")
    model.run(max_seconds=4)
    assert model.without_stairs == []
    building.floor_plan.open_gate("street")
    model.run(max_seconds=60)
    assert model.inside == 0


def test_whom_a_closed_lift_holds_is_not_said_to_need_stairs():
    building = office(lifts=[LIFT])
    model = PedestrianModel(building, population="wheelchair_powered", rng=1)
    model.add_pedestrians(building.places([(20.4, 5.0)], level=1))
    while model.lifts.car_of(np.column_stack([model.crowd.x[:1], model.crowd.y[:1]]))[0] < 0:
        model.step()
        assert model.elapsed < 40
    for gate in ("car at level 0", "car at level 1"):
        building.floor_plan.close_gate(gate)
    model.run(max_seconds=model.elapsed + 90)
    assert model.stall_reason == (
        "nobody inside has a way to go: people 0 are in lifts whose doors are closed"
    )
    assert model.without_stairs == []
