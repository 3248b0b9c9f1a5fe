"""Doors with a rate, closing times or a capacity."""

import copy

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely import LineString, Point, box, union_all

from mesa_mobility import Door, Exit, FloorPlan, Gate, PedestrianModel
from mesa_mobility.crowd.doors.doors import _crossed
from mesa_mobility.errors import FloorPlanError, ModelError
from mesa_mobility.results import Trajectories, check_safety, crossings_of_doors
from tests.fixtures.maps import shipped_map, strider
from tests.fixtures.scenes import advance, corridor, model_of, put


def lobby() -> FloorPlan:
    """A room of 8 m x 6 m, a gate 1.2 m wide through a wall of 0.2 m, and a hall with an exit."""
    floor = union_all([box(0, 0, 8, 6), box(8, 2.4, 8.2, 3.6), box(8.2, 0, 14, 6)])
    return FloorPlan(
        floor,
        exits=[Exit("street", (14, 1), (14, 5)), Exit("back", (0, 2), (0, 4))],
        gates=[Gate("turnstile", (8.1, 2.4), (8.1, 3.6))],
    )


STARTS = [(x, y) for x in (2.0, 3.0, 4.0, 5.0) for y in (1.0, 2.0, 3.0, 4.0, 5.0)]


def lobby_model(door: Door | None, *, people: int = 20, **more) -> PedestrianModel:
    model = model_of(lobby(), shipped_map(), **{"rng": 2, "frames_per_step": 3, **more})
    if door is not None:
        model.add_door(door)
    model.add_pedestrians(STARTS[:people], exits=["street"])
    return model


def passages(model, name: str) -> np.ndarray:
    """Seconds of first passages, in order, as the results find them."""
    found = crossings_of_doors(Trajectories.of(model), model.floor_plan)[name]
    return np.sort(found.time[np.unique(found.person, return_index=True)[1]])


def test_a_rate_bounds_the_people_who_pass():
    model = lobby_model(Door(name="turnstile", rate=0.5))
    control = model.doors[0]
    model.run(max_seconds=120)
    assert model.inside == 0
    assert control.people == 20
    times = passages(model, "turnstile")
    for k in range(20):
        for later in range(k + 1, 20):
            # Two at once, then one every two seconds; one more may be in the door as it shuts.
            assert later - k + 1 <= 0.5 * (times[later] - times[k]) + 3 + 1e-6
    # Half a person a second: 19 intervals of 2 s, some of which pass before somebody sets off.
    assert times[-1] - times[0] == pytest.approx(38.0, abs=5.0)
    report = check_safety(Trajectories.of(model), model.floor_plan.walls)
    assert (report.overlaps, report.wall_crossings) == (0, 0)
    assert model.blocked == []


def test_people_wait_before_a_shut_door_and_are_not_called_blocked():
    model = lobby_model(Door(name="turnstile", rate=0.02), people=4)
    model.run(max_seconds=100)
    assert not model.stalled
    assert model.summary()["blocked"] == []
    # One at the beginning, the next after 50 s, at a hundredth of a second each frame.
    assert model.doors[0].people == pytest.approx(2, abs=1)
    assert any(each.waiting for each in model.agents)


def test_a_rate_at_an_exit():
    plan = FloorPlan(box(0, 0, 10, 4), exits=[Exit("east", (10, 1.5), (10, 2.4))])
    model = model_of(plan, shipped_map(), rng=3, frames_per_step=3)
    model.add_door(Door(name="east", rate=0.8))
    model.add_pedestrians([(x, y) for x in (2.0, 3.0, 4.0, 5.0) for y in (0.8, 1.6, 2.4, 3.2)])
    model.run(max_seconds=60)
    assert model.inside == 0
    times = passages(model, "east")
    assert len(times) == model.doors[0].people == 16
    for k in range(16):
        for later in range(k + 1, 16):
            assert later - k + 1 <= 0.8 * (times[later] - times[k]) + 4 + 1e-6
    assert times[-1] - times[0] == pytest.approx(15 / 0.8, abs=5.0)


def test_a_door_follows_its_times():
    model = lobby_model(Door(name="turnstile", closed=[(0, 5), (30, None)]), people=6)
    plan = model.floor_plan
    open_ = {}
    while model.elapsed < 40:
        model.step()
        open_[round(model.elapsed, 1)] = plan.is_open("turnstile")
        if model.inside == 0 and model.elapsed > 35:
            break
    assert not open_[4.9]
    assert open_[5.1]
    times = passages(model, "turnstile")
    assert len(times) == 6
    assert times.min() > 5.0


def test_closing_times_take_hold_in_their_first_frame():
    model = model_of(corridor(both_ends=True), strider())
    model.add_door(Door(name="west", closed=[(0.51, 1.0)]))
    put(model, 10.0, 2.0, exits=["east"])
    states = []
    for _ in range(40):
        states.append(model.floor_plan.is_open("west"))
        advance(model, 1)
    # 0.51 s are 15.3 frames, so frame 16 is the first; it opens in frame 30. What a frame does
    # shows after it.
    assert states == [True] * 17 + [False] * 14 + [True] * 9


def test_a_door_closes_for_good_after_its_capacity():
    model = lobby_model(Door(name="turnstile", capacity=5))
    control = model.doors[0]
    model.run(max_seconds=30)
    assert control.is_full
    assert not model.floor_plan.is_open("turnstile")
    # Nobody else, but those who stood in it as it closed.
    assert 5 <= control.people <= 7
    assert len(passages(model, "turnstile")) == control.people
    assert model.inside == 20 - control.people


def test_a_full_exit_sends_people_to_another():
    model = model_of(corridor(both_ends=True), shipped_map(), rng=1, frames_per_step=3)
    model.add_door(Door(name="east", capacity=3))
    model.add_pedestrians([(x, y) for x in (16.0, 17.0, 18.0) for y in (1.0, 2.0, 3.0)])
    model.run()
    assert model.inside == 0
    assert len(passages(model, "east")) == model.doors[0].people >= 3
    assert len(passages(model, "west")) == 9 - model.doors[0].people


def test_a_full_door_stays_closed_after_its_times():
    model = lobby_model(Door(name="turnstile", closed=[(20, 22)], capacity=4))
    model.run(max_seconds=26)
    assert model.doors[0].is_full
    assert not model.floor_plan.is_open("turnstile")


@pytest.mark.parametrize(
    "door",
    [
        Door(name="turnstile", rate=0.7),
        Door(name="turnstile", closed=[(2, 4.03), (9, 11)]),
        Door(name="turnstile", capacity=6),
    ],
)
def test_trajectories_do_not_depend_on_the_length_of_a_step(door):
    found = []
    for frames_per_step in (1, 3, 8):
        model = lobby_model(door, frames_per_step=frames_per_step)
        while model.frame < 24 * 17:
            model.step()
        rows = model.recorder.arrays()
        keep = rows["frame"] <= 24 * 16
        found.append({name: column[keep] for name, column in rows.items()})
    for other in found[1:]:
        for name, column in found[0].items():
            np.testing.assert_array_equal(column, other[name])


@pytest.mark.parametrize("record", [True, False])
def test_recording_changes_nothing(record):
    model = lobby_model(Door(name="turnstile", rate=0.7), record=record)
    for _ in range(120):
        model.step()
    crowd = model.crowd
    assert float(crowd.x[:20].sum()) == pytest.approx(_SUMS.setdefault("x", crowd.x[:20].sum()))


_SUMS: dict[str, float] = {}


@pytest.mark.parametrize("seconds", [3.1, 6.0, 9.7])
def test_checkpoints_restore_doors(tmp_path, seconds):
    doors = [
        Door(name="turnstile", rate=0.6, closed=[(4, 6)], capacity=9),
        Door(name="back", closed=[(0, None)]),
    ]
    model, other = lobby_model(doors[0]), lobby_model(doors[0])
    for each in (model, other):
        each.add_door(doors[1])
    while other.elapsed < seconds - 1e-9:
        other.step()
    other.save(tmp_path / "checkpoint.zip")
    loaded = PedestrianModel.load(
        tmp_path / "checkpoint.zip", pedestrian_types=other.pedestrian_types
    )
    copied = copy.deepcopy(other)
    assert [each.door for each in loaded.doors] == doors
    for each in (model, loaded, copied):
        while each.elapsed < 20 - 1e-9:
            each.step()
    for again in (loaded, copied):
        assert [each.people for each in again.doors] == [each.people for each in model.doors]
        for name, column in model.recorder.arrays().items():
            np.testing.assert_array_equal(column, again.recorder.arrays()[name])


@given(
    st.tuples(*[st.floats(-3, 3)] * 4),
    st.lists(st.tuples(*[st.floats(-3, 3)] * 4), min_size=1, max_size=20),
)
def test_crossings_as_shapely_finds_them(line, ways):
    a, b = Point(line[:2]), Point(line[2:])
    if a.distance(b) < 0.1:
        return
    gate = LineString([a, b])
    found = _crossed(np.array(line), np.array(ways)[:, :2], np.array(ways)[:, 2:])
    for each, (x0, y0, x1, y1) in zip(found, ways, strict=True):
        way = LineString([(x0, y0), (x1, y1)])
        if gate.distance(way) > 1e-6:
            assert not each
        ends = [gate.distance(Point(x0, y0)), gate.distance(Point(x1, y1))]
        if way.crosses(gate) and min(*ends, way.distance(a), way.distance(b)) > 1e-6:
            assert each


def test_doors_are_refused_where_there_is_no_such_gate_or_one_already():
    model = lobby_model(None)
    with pytest.raises(FloorPlanError, match="no gate or exit 'moon'"):
        model.add_door(Door(name="moon", rate=1.0))
    model.add_door(Door(name="back", rate=1.0))
    with pytest.raises(ModelError, match="is there already"):
        model.add_door(Door(name="back", capacity=1))
    with pytest.raises(ModelError, match="expected a Door"):
        model.add_door("back")


@pytest.mark.parametrize(
    "keywords",
    [
        {},
        {"rate": 0.0},
        {"rate": -1.0},
        {"rate": np.nan},
        {"rate": 1e9},
        {"rate": "often"},
        {"capacity": 0},
        {"capacity": 1.5},
        {"capacity": True},
        {"closed": "60-120"},
        {"closed": [60]},
        {"closed": [(60, 60)]},
        {"closed": [(-1, 60)]},
        {"closed": [(60, 120), (100, 140)]},
        {"closed": [(60, None), (100, 140)]},
        {"closed": [(60, 1e9)]},
        {"closed": [(np.nan, 1)]},
        {"closed": [("a", "b")]},
    ],
)
def test_doors_that_cannot_be(keywords):
    with pytest.raises(ModelError, match="door 'east'") as refused:
        Door(name="east", **keywords)
    assert "\n" not in str(refused.value)
