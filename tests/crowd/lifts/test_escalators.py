"""People step onto an escalator, stand on it, and walk on at its end.

This one has a rise of 4 m at 30 degrees: 8 m along the slope, and 0.75 m/s are 0.0125 m of height a
frame.
"""

import numpy as np
import pytest

from mesa_mobility import PedestrianModel, Trajectories
from mesa_mobility.compiled import threads
from mesa_mobility.crowd.lifts.belt_places import BeltPlaces
from mesa_mobility.crowd.lifts.clear_way import way_is_clear
from mesa_mobility.crowd.lifts.escalators import carry
from mesa_mobility.errors import ContentError, ModelError
from mesa_mobility.results import check_safety, climbs
from mesa_mobility.schema import Members, check
from tests.fixtures.checkpoints import check_going_on
from tests.fixtures.escalators import HEAD, RISE, hall
from tests.fixtures.seams import overlaps

A_FRAME = 0.75 * 0.5 / 30.0
"""Metres of height in a frame."""


def crowd(count, *, rng=1, spacing=0.6, population="able_bodied", record=True, steps=3, **given):
    """A hall, and people on the storey from which its escalator leads."""
    building = hall(**given)
    level = 0 if given.get("direction") == "up" else 1
    model = PedestrianModel(
        building, population=population, record=record, frames_per_step=steps, rng=rng
    )
    places = building.random_points(count, model.rng, level=level, spacing=spacing, clearance=0.3)
    model.add_pedestrians(places, exits=["east" if level == 0 else "west"])
    return model


def true_tracks(model):
    """Tracks of a run, which is checked for overlaps, jumps and steps through walls."""
    tracks, plan = Trajectories.of(model), model.floor_plan
    assert check_safety(tracks, plan.walls, plan.free, building=model.building).passed
    xyz = np.column_stack([tracks.x, tracks.y, tracks.z])
    assert overlaps(tracks.frame, xyz, tracks.radii[tracks.person]) == 0
    first, later = tracks.steps()
    assert np.abs(xyz[later] - xyz[first]).max() < 0.1
    return tracks


@pytest.mark.parametrize("direction", ["up", "down"])
def test_people_stand_on_it_and_ride_at_its_speed(direction):
    model = crowd(1, direction=direction)
    model.run(max_seconds=60)
    assert model.inside == 0
    tracks = true_tracks(model)
    rows = tracks.rows_of(0)
    z, x, y = tracks.z[rows], tracks.x[rows], tracks.y[rows]
    on = np.flatnonzero((z > 0.15 * RISE) & (z < 0.85 * RISE))
    sign = 1.0 if direction == "up" else -1.0
    assert np.diff(z[on]) == pytest.approx(sign * A_FRAME, abs=1e-9)
    # In plan 0.75 m/s are 0.75 cos 30, and nobody moves aside.
    assert np.diff(x[on]) == pytest.approx(sign * 0.75 * np.sqrt(0.75) / 30.0, abs=1e-9)
    assert np.ptp(y[on]) == pytest.approx(0.0, abs=1e-9)
    assert model.summary()["escalators"] == [{"escalator": "esc", "carried": 1, "stood_s": 0.0}]


@pytest.mark.parametrize(
    ("given", "a_second"), [({"capacity": 4500.0}, 1.25), ({"speed": 0.5, "direction": "up"}, 1.25)]
)
def test_a_queue_fills_it_as_far_as_its_capacity(given, a_second):
    model = crowd(70, **given)
    model.run(max_seconds=100)
    assert model.inside == 0
    assert model.escalators.carried.tolist() == [70]
    ways = climbs(true_tracks(model), model.building)["esc"]
    start = np.sort(ways.start)[10:60]
    assert 49.0 / (start[-1] - start[0]) == pytest.approx(a_second, rel=0.1)
    ride = 8.0 / given.get("speed", 0.75)
    assert (ways.end - ways.start).mean() == pytest.approx(ride, rel=0.1)


def test_all_on_it_keep_their_distances():
    model = crowd(30)
    model.run(max_seconds=60)
    assert model.inside == 0
    tracks = true_tracks(model)
    first, later = tracks.steps()
    on = (tracks.z[first] < 0.8 * RISE) & (tracks.z[first] > 0.2 * RISE)
    step, frame = tracks.z[later[on]] - tracks.z[first[on]], tracks.frame[first[on]]
    moves = step < -0.5 * A_FRAME
    assert step == pytest.approx(np.where(moves, -A_FRAME, 0.0), abs=1e-9)
    # It moves or stands with all of them, and moves nearly always.
    assert not set(frame[moves].tolist()) & set(frame[~moves].tolist())
    assert moves.sum() > 30 * 5.0 * 30.0 > 20.0 * (~moves).sum()


def test_it_stands_while_somebody_is_in_the_way_at_its_end():
    model = crowd(25)
    # The foot is at x = 7.07. Three people stand across it, 0.4 m apart, for 40 s.
    places = model.building.places([(6.7, 2.6), (6.7, 3.0), (6.7, 3.4)], level=0)
    for person in model.add_pedestrians(places, exits=["west"]):
        person.wait(40.0)
    model.run(max_seconds=39)
    carried = model.escalators.riders(model.rows)
    assert len(carried) > 5
    assert model.escalators.carried[0] <= 4  # those for whom there is room before the three
    assert model.escalators.stood_s[0] > 10.0
    before = model.crowd.x[carried].copy()
    model.run(max_seconds=40)
    assert (model.crowd.x[carried] == before).all()
    model.run(max_seconds=120)
    assert model.inside == 0
    assert model.escalators.carried.tolist() == [25]
    true_tracks(model)


def test_people_in_wheelchairs_do_not_take_it():
    model = crowd(2, population="wheelchair_powered", spacing=1.2)
    model.run(max_seconds=5)
    assert model.without_stairs == [0, 1]


def test_people_walk_on_one_that_stands():
    model = crowd(8, speed=0.0)
    assert len(model.escalators) == 0
    model.run(max_seconds=60)
    assert model.inside == 0
    true_tracks(model)


def test_threads_steps_and_checkpoints_change_nothing(monkeypatch, tmp_path):
    class Hall(PedestrianModel):
        def __init__(self, frames_per_step=3, rng=None):
            super().__init__(hall(), record=True, frames_per_step=frames_per_step, rng=rng)
            places = self.building.random_points(20, self.rng, level=1, spacing=0.6, clearance=0.3)
            self.add_pedestrians(places, exits=["west"])

    monkeypatch.setattr(threads, "MANY", 1)
    tracks = []
    for frames, count in ((1, 1), (3, 2), (30, 1)):
        monkeypatch.setattr(threads, "THREADS", count)
        threads._pool.cache_clear()
        model = Hall(frames_per_step=frames, rng=1)
        model.run(max_seconds=20)
        tracks.append([model.recorder.arrays()[name].tobytes() for name in ("x", "y")])
    threads._pool.cache_clear()
    assert tracks[0] == tracks[1] == tracks[2]
    model = Hall(rng=1)
    model.run(max_seconds=12)
    assert len(model.escalators.riders(model.rows)) > 2
    check_going_on(Hall(rng=1), tmp_path, saved_at=12, until=25)


@pytest.mark.parametrize("capacity", [1700, None])
def test_recording_and_steps_change_nothing(capacity):
    """A recorded run looks at each frame, another one passes over those without decisions."""
    places = []
    for record, frames in ((True, 3), (False, 1), (False, 3), (False, 30)):
        model = crowd(30, record=record, steps=frames, capacity=capacity)
        model.run(max_seconds=18)
        assert model.escalators.carried[0] > 3
        places.append(model.crowd.x[model.rows].tobytes())
    assert len(set(places)) == 1


def test_a_checkpoint_with_an_escalator_that_is_not_there_is_refused():
    model = crowd(2)
    state = {**model.escalators.state(), "_rides": np.array([0, 1])}
    with pytest.raises(ContentError, match="_rides"):
        check(state, Members(model.escalators.members()), "escalators", {})


@pytest.mark.parametrize(("frames", "clear"), [(17, True), (18, True), (19, False)])
def test_a_rider_must_not_come_to_touch_others(frames, clear):
    """Two bodies of 0.2 m radius 1 m apart: at 1 m/s they touch after 0.6 s, 18 frames."""
    model = PedestrianModel(hall(), rng=1)
    model.add_pedestrians(model.building.places([(3.0, 3.0), (4.0, 3.0)], level=1))
    state = model.crowd
    state.core[:2] = 0.2
    for row in (0, 1):
        carry(np.array([row]), np.zeros(2), np.array([1.0, 0.0]), 0, 3, state)
    found = way_is_clear(
        np.array([0]),
        np.array([1]),
        np.zeros((2, 2)),
        np.array([1.0, 0.0]),
        frames,
        (0, 0),
        model._scene.repertoire.table,
        state.records,
    )
    assert found is clear


def test_who_is_carried_has_no_decision_to_explain():
    model = PedestrianModel(hall(), rng=1)
    model.add_pedestrians(model.building.places([(15.0, 3.0)], level=1), exits=["west"])
    while not len(model.escalators.riders(model.rows)):
        model.step()
        assert model.elapsed < 10
    with pytest.raises(ModelError, match="pedestrian 0: decides nothing while an escalator"):
        model.explain(0)


@pytest.mark.parametrize(("reach", "seen"), [(1.0, False), (3.0, True)])
def test_people_count_as_near_who_may_come_into_the_way(reach, seen):
    """Somebody 2.5 m before the belt, which moves on by 0.39 m in 18 frames."""
    plan = hall().floor_plan
    belt = BeltPlaces(plan.seams[0], plan.seams[0].belt, reach, 18)
    place = hall().places([(HEAD[0][0] + 2.5, 3.0)], level=1)
    assert bool(len(belt.near(place).who)) is seen
