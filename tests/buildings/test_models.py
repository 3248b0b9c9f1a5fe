"""Models of buildings: people walk down stairs, and results say where they were."""

import copy

import numpy as np
import pytest
import shapely
from shapely import box

from mesa_mobility import Building, Exit, FloorPlan, Level, PedestrianModel, Trajectories
from mesa_mobility.buildings import ON_STAIRS
from mesa_mobility.commands.models.making import ModelOptions, create_model
from mesa_mobility.errors import ModelError
from mesa_mobility.results import Site, check_safety, read_parquet
from tests.fixtures.buildings import HALL, RISE, two_storeys, with_refuge_and_lift
from tests.fixtures.engine import ENGINE
from tests.fixtures.seams import overlaps

PEOPLE = 60


@pytest.fixture(scope="module")
def run():
    """A building, and the tracks of people who leave its upper level."""
    office = two_storeys()
    model = PedestrianModel(office, preset=ENGINE, record=True, rng=1)
    model.add_pedestrians(
        office.random_points(PEOPLE, model.rng, level=1, spacing=0.6, clearance=0.25)
    )
    model.run(max_seconds=200)
    assert model.inside == 0
    return office, Trajectories.of(model)


def test_nobody_is_lost_doubled_or_jumps(run):
    _, tracks = run
    assert tracks.people == PEOPLE
    first, later = tracks.steps()
    assert len(first) == len(tracks) - PEOPLE
    xyz = np.column_stack([tracks.x, tracks.y, tracks.z])
    step = np.abs(xyz[later] - xyz[first])
    assert np.hypot(step[:, 0], step[:, 1]).max() < 0.1
    # A riser of 0.17 m to a tread of 0.29 m.
    assert step[:, 2].max() < 0.1 * 0.17 / 0.29 * 18 / 17 + 1e-9
    last = np.array([tracks.rows_of(person)[-1] for person in range(PEOPLE)])
    assert (tracks.level[last] == 0).all()
    assert (np.abs(tracks.x[last] - 12.0) >= 12.0).all()


def test_nobody_walks_through_others_on_any_floor_or_flight(run):
    _, tracks = run
    xyz = np.column_stack([tracks.x, tracks.y, tracks.z])
    assert overlaps(tracks.frame, xyz, tracks.radii[tracks.person]) == 0


def test_the_safety_check_of_a_building_finds_nothing_in_a_run(run):
    office, tracks = run
    plan = office.floor_plan
    assert check_safety(tracks, plan.walls, plan.free, building=office).passed


def standing(office, *people):
    """Tracks of people who are at (x, y, z) in each of three frames."""
    xyz = np.array(people, dtype=float)  # (people, frames, 3)
    frame = np.repeat(np.arange(3), len(xyz))
    x, y, z = xyz.transpose(1, 0, 2).reshape(-1, 3).T
    person = np.tile(np.arange(len(xyz)), 3)
    return Trajectories(frame, person, x, y, 0.0 * x, core_radius=0.15, fields={"z": z})


@pytest.mark.parametrize(
    ("people", "overlaps", "crossings"),
    [
        # Above each other, on two levels.
        ([[(4, 4, 0)] * 3, [(4, 4, RISE)] * 3], 0, 0),
        # In the same place on one level, and with 0.1 m between them on a flight.
        ([[(4, 4, 0)] * 3, [(4, 4, 0)] * 3], 3, 0),
        ([[(10.0, 0.6, RISE * (12.93 - 10.0) / 4.93)] * 3,
          [(10.1, 0.6, RISE * (12.93 - 10.1) / 4.93)] * 3], 3, 0),
        # Down the flight over the seam at x = 10.465.
        ([[(x, 0.6, RISE * (12.93 - x) / 4.93) for x in (10.44, 10.46, 10.48)]], 0, 0),
        # Beside the flight on the upper level, then through its side wall near its head.
        ([[(8.2, y, RISE) for y in (1.5, 1.4, 1.3)]], 0, 0),
        ([[(8.05, 1.3, RISE), (8.05, 1.3, RISE), (8.05, 1.1, RISE * 4.88 / 4.93)]], 0, 1),
    ],
)  # fmt: skip
def test_the_safety_check_knows_storeys_and_flights(people, overlaps, crossings):
    office = two_storeys()
    plan = office.floor_plan
    report = check_safety(standing(office, *people), plan.walls, plan.free, building=office)
    assert (report.overlaps, report.wall_crossings) == (overlaps, crossings)
    assert report.off_floor == 0


def test_overlaps_and_steps_through_walls_say_on_which_storey_they_are():
    office = with_refuge_and_lift()
    people = [
        *[[(x, 4, 0)] * 3 for x in (4.0, 4.2)],
        *[[(x, 4, RISE)] * 3 for x in (6.0, 6.2)],
        *[[(x, 0.6, RISE * (12.93 - x) / 4.93)] * 3 for x in (10.0, 10.1)],
        *[[(x, 7.4, z) for z in (RISE, 2.0, 1.0)] for x in (20.3, 20.5)],
        [(1.0, 0.3, 0.0), (1.0, -0.3, 0.0), (1.0, -0.3, 0.0)],
    ]
    plan = office.floor_plan
    report = check_safety(standing(office, *people), plan.walls, building=office)
    height = RISE * (12.93 - 10.0) / 4.93
    [*pairs] = report.overlapping_pairs[:4]
    assert [(each.frame, each.first, each.second) for each in pairs] == [
        (0, 2 * k, 2 * k + 1) for k in range(4)
    ]
    assert [each.at for each in pairs] == [
        Site(4.0, 4.0, 0.0, "level 0"),
        Site(6.0, 4.0, RISE, "level 1"),
        Site(10.0, 0.6, height, "stairs south"),
        Site(20.3, 7.4, RISE, "lift lift"),
    ]
    assert report.overlapping_pairs[7].at == Site(20.3, 7.4, 2.0, "lift lift")
    assert str(pairs[1].at) == "on level 1 at (6.00, 4.00, 3.06)"
    assert [(each.frame, each.person, each.at) for each in report.crossings] == [
        (0, 8, Site(1.0, 0.3, 0.0, "level 0"))
    ]
    flat = Trajectories([0, 0], [0, 1], [1, 1], [2, 2], [0, 0], core_radius=0.2)
    [pair] = check_safety(flat, np.empty((0, 4))).overlapping_pairs
    assert (pair.at, str(pair.at)) == (Site(1.0, 2.0, 0.0), "at (1.00, 2.00)")


def test_the_least_distance_is_of_people_on_one_storey():
    office = two_storeys()
    people = [[(4, 4, 0)] * 3, [(4.1, 4, RISE)] * 3, [(6, 4, 0)] * 3]
    tracks = standing(office, *people)
    assert check_safety(tracks, office.floor_plan.walls, building=office).min_distance_m == 2.0
    alone = standing(office, *people[:2])
    assert check_safety(alone, office.floor_plan.walls, building=office).min_distance_m is None


def test_nobody_walks_through_walls_or_beside_stairs(run):
    office, tracks = run
    for level in (0, 1):
        plan, there = office.floor_plan_of(level), tracks.on(level=level)
        report = check_safety(there, plan.walls, plan.free.buffer(1e-3))
        assert report.wall_crossings == 0
        gone = there.exit_frames[there.person] == there.frame
        inside = shapely.intersects_xy(plan.free.buffer(1e-3), there.x, there.y)
        assert (inside | gone).all()
    on = tracks.level == ON_STAIRS
    # By hand: south, both flights of north, and its landing.
    parts = [
        box(8, 0, 12.93, 1.2),
        box(14, 6.8, 16.32, 8),
        box(14, 5.4, 16.32, 6.6),
        box(16.32, 5.4, 17.52, 8),
    ]
    stairs = shapely.union_all(parts).buffer(1e-6)
    assert shapely.intersects_xy(stairs, tracks.x[on], tracks.y[on]).all()
    assert on.any()


def test_both_stairs_are_used_and_people_slow_down_on_them(run):
    office, tracks = run
    on = tracks.level == ON_STAIRS
    south = np.unique(tracks.person[on & (tracks.y < 2.0)])
    north = np.unique(tracks.person[on & (tracks.y > 2.0)])
    assert len(south) + len(north) == PEOPLE
    assert min(len(south), len(north)) > PEOPLE / 4
    first, later = tracks.steps(30)
    speed = np.hypot(tracks.x[later] - tracks.x[first], tracks.y[later] - tracks.y[first])
    flights = on[first] & on[later] & (tracks.y[first] < 2.0)
    factor = office.flights[0].factor
    assert factor == pytest.approx(0.693, abs=0.001)
    assert np.quantile(speed[flights], 0.95) < 1.6 * factor


def test_a_lone_walker_takes_the_time_that_the_reference_gives():
    """On the straight flight, at 1.34 m/s on a level floor: 1.34 times the factor, to 12 %."""
    office = two_storeys()
    model = PedestrianModel(office, preset=ENGINE, record=True, rng=3)
    model.add_pedestrians(office.places([(4.0, 0.6)], level=1), preferred_speeds=1.34)
    model.run(max_seconds=60)
    tracks = Trajectories.of(model)
    on = np.flatnonzero((tracks.level == ON_STAIRS) & (tracks.x > 9.0) & (tracks.x < 12.0))
    speed = (tracks.x[on[-1]] - tracks.x[on[0]]) / ((len(on) - 1) / 30.0)
    assert speed == pytest.approx(1.34 * office.flights[0].factor, rel=0.12)


def test_people_walk_up_too():
    ground = Level(0, HALL)
    first = Level(1, HALL, RISE, exits=[Exit("roof", (0, 3), (0, 5))])
    office = Building([ground, first], two_storeys().stairs)
    model = PedestrianModel(office, preset=ENGINE, record=True, rng=2)
    model.add_pedestrians(office.random_points(10, model.rng, level=0, spacing=1.0, clearance=0.3))
    model.run(max_seconds=120)
    assert model.inside == 0
    tracks = Trajectories.of(model)
    last = np.array([tracks.rows_of(person)[-1] for person in range(10)])
    assert (tracks.level[last] == 1).all()


def test_people_who_cross_on_the_stairs_pass_each_other():
    hall = [Exit("west", (0, 3), (0, 5))], [Exit("roof", (0, 3), (0, 5))]
    office = Building(
        [Level(0, HALL, exits=hall[0]), Level(1, HALL, RISE, exits=hall[1])],
        two_storeys().stairs[:1],
    )
    model = PedestrianModel(office, preset=ENGINE, record=True, rng=2)
    for level, exit_ in ((0, "roof"), (1, "west")):
        places = office.random_points(12, model.rng, level=level, spacing=1.0, clearance=0.3)
        model.add_pedestrians(places, exits=[exit_])
    model.run(max_seconds=240)
    tracks = Trajectories.of(model)
    xyz = np.column_stack([tracks.x, tracks.y, tracks.z])
    assert overlaps(tracks.frame, xyz, tracks.radii[tracks.person]) == 0
    assert model.inside == 0


def test_results_are_written_with_elevation_and_level(run, tmp_path):
    _, tracks = run
    tracks.to_parquet(tmp_path / "tracks.parquet")
    read = read_parquet(tmp_path / "tracks.parquet")
    for name in ("frame", "person", "x", "y", "z", "level"):
        assert (getattr(read, name) == getattr(tracks, name)).all()
    assert read.level.dtype == np.int16
    assert {"z", "level"} <= set(tracks.to_pandas().columns)


def test_the_rows_of_one_level_are_those_at_its_height(run):
    _, tracks = run
    above, below = tracks.on(level=1), tracks.on(level=0)
    assert (above.z == RISE).all()
    assert (below.z == 0.0).all()
    on = tracks.level == ON_STAIRS
    assert len(above) + len(below) + on.sum() == len(tracks)
    assert ((tracks.z[on] > 0.0) & (tracks.z[on] < RISE)).all()
    assert above.frames == below.frames == tracks.frames
    assert len(tracks.on(level=7)) == 0


def test_one_level_gives_the_bytes_of_its_floor_plan(tmp_path):
    exits = [Exit("out", (0, 3), (0, 5))]
    floors = FloorPlan(HALL, exits=exits), Building([Level(0, HALL, exits=exits)])
    for name, floor in zip(("plan", "building"), floors, strict=True):
        model = PedestrianModel(floor, preset=ENGINE, record=True, rng=5)
        assert model.building is None
        points = floor.random_points(30, model.rng, spacing=0.6, clearance=0.3)
        model.add_pedestrians(points)
        model.run(max_seconds=60)
        Trajectories.of(model).to_parquet(tmp_path / name)
    assert (tmp_path / "plan").read_bytes() == (tmp_path / "building").read_bytes()


def test_fields_may_not_be_named_as_columns_of_buildings():
    with pytest.raises(ModelError, match="fields: 'level' is a column of all results of buildings"):
        PedestrianModel(two_storeys(), fields={"level": int})


def test_a_saved_run_goes_on_as_it_would_have(tmp_path):
    office = two_storeys()
    model = PedestrianModel(office, record=True, rng=1)
    model.add_pedestrians(office.random_points(20, model.rng, level=1, spacing=0.8, clearance=0.3))
    model.run(max_seconds=12)
    assert (Trajectories.of(model).level == ON_STAIRS).any()
    model.save(tmp_path / "saved.npz")
    again = PedestrianModel.load(tmp_path / "saved.npz", floor_plan=two_storeys())
    found = []
    for each in (model, copy.deepcopy(model), again):
        each.run(max_seconds=20)
        tracks = Trajectories.of(each)
        found.append([values.tobytes() for values in (tracks.x, tracks.y, tracks.z)])
    assert found[0] == found[1] == found[2]


class Office(PedestrianModel):
    """A building without people."""

    def __init__(self, rng=None):
        super().__init__(two_storeys(), rng=rng)


def test_commands_that_show_one_plan_refuse_models_of_buildings():
    with pytest.raises(ModelError, match="model office: has a building of 2 levels, expected one"):
        create_model(Office, "office", ModelOptions(seed=1))
