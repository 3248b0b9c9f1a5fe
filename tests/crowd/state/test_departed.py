"""Gates to cross, exits to leave by, and exits that are not one's own."""

import numpy as np
import pytest
from mesa_mobility.behaviors import Displacement
from shapely import LineString, box

from mesa_mobility import Exit, FloorPlan, Gate
from mesa_mobility.crowd.state.departed import Departed
from mesa_mobility.crowd.state.records import Crowd
from tests.fixtures.maps import shipped_map, strider
from tests.fixtures.oracles.counting import crossings, overlaps, track, wall_crossings
from tests.fixtures.scenes import advance, core_of, corridor, model_of, put, same_rows, two_doors


def test_leaves_in_the_first_frame_beyond_the_line():
    # 0.48 m at 1.25 m/s: 11.52 frames.
    model = model_of(corridor(length=20.0), strider())
    put(model, 19.52, 2.0, preferred_speeds=[1.25])
    advance(model, 11)
    assert model.inside == 1
    assert model.running
    advance(model, 1)
    assert model.inside == 0
    assert not model.running
    assert model.statistics.last_left == pytest.approx(0.4)
    assert model.summary()["egress_s"] == pytest.approx(0.4)
    last = track(model.recorder.arrays(), 0)[-1]
    assert last[0] == 12
    assert last[1] == pytest.approx(20.02, abs=1e-6)


def test_somebody_on_the_line_itself_leaves():
    model = model_of(corridor(length=20.0), strider())
    put(model, 20.0, 2.0, preferred_speeds=[1.25])
    advance(model, 45)
    assert model.inside == 0


def test_others_stay_when_one_leaves():
    model = model_of(corridor(length=20.0), strider())
    gone, near, far = (put(model, x, 2.0) for x in (19.8, 15.0, 3.0))
    advance(model, 30)
    assert gone not in model.agents
    assert [person.row for person in model.space.active_agents] == [near.row, far.row]
    assert same_rows(model)
    assert near.position[0] == pytest.approx(16.25, abs=1e-6)
    assert gone.row == 0


@pytest.mark.parametrize(("exits", "leaves"), [(["east"], True), (["west"], False), (None, True)])
def test_an_exit_that_is_not_ones_own_is_a_wall(exits, leaves):
    model = model_of(corridor(both_ends=True), strider(), behaviors=[Displacement()])
    person = put(model, 18.8, 2.0, exits=exits)
    advance(model, 45)
    if leaves:
        assert model.inside == 0
    else:
        # A metre ends 0.2 m short of the line, clear of the core; half a metre more does not.
        assert person.position[0] == pytest.approx(19.8, abs=1e-6)


def test_everybody_leaves_by_the_exit_that_is_its_own():
    model = model_of(two_doors(), shipped_map(), rng=4, frames_per_step=3)
    places = model.floor_plan.random_points(20, model.rng, spacing=0.6, clearance=0.3)
    own = {}
    for name, part in (("right", places[:10]), ("left", places[10:])):
        own |= {p.row: name for p in model.add_pedestrians(part, exits=[name])}
    model.run(max_seconds=120)
    assert model.inside == 0
    rows = model.recorder.arrays()
    for name in ("right", "left"):
        door = model.floor_plan.gate(name)
        passed = crossings(rows, door.a, door.b)
        assert passed == {row: int(own[row] == name) for row in own}
    assert wall_crossings(rows, model.floor_plan.walls) == 0


def test_by_default_the_nearest_exit_is_taken():
    model = model_of(two_doors(), shipped_map(), rng=4, frames_per_step=3)
    left = model.add_pedestrians([(1.5, 1.5), (2.0, 4.0)])
    right = model.add_pedestrians([(6.5, 6.5), (6.0, 4.0)])
    model.run(max_seconds=60)
    assert model.inside == 0
    rows = model.recorder.arrays()
    for name, people in (("left", left), ("right", right)):
        door = model.floor_plan.gate(name)
        passed = crossings(rows, door.a, door.b)
        assert {row for row, times in passed.items() if times} == {p.row for p in people}


def test_gates_are_crossed_on_the_way_out():
    floor = "POLYGON((0 0,5 0,5 2.4,5.2 2.4,5.2 0,10 0,10 6,5.2 6,5.2 3.6,5 3.6,5 6,0 6,0 0))"
    gate = Gate("door", (5.1, 2.4), (5.1, 3.6))
    plan = FloorPlan(floor, exits=[Exit("out", (10, 0.5), (10, 2.0))], gates=[gate])
    model = model_of(plan, shipped_map(), rng=2, frames_per_step=3)
    places = plan.random_points(25, model.rng, within=box(0, 0, 5, 6), spacing=0.5, clearance=0.3)
    model.add_pedestrians(places)
    model.run(max_seconds=120)
    assert model.inside == 0
    rows = model.recorder.arrays()
    passed = crossings(rows, gate.a, gate.b)
    # People who sway back over the line in a jam cross it once more in the end.
    assert all(times % 2 == 1 for times in passed.values())
    assert len(passed) == 25
    assert overlaps(rows, core_of(model)) == 0
    assert wall_crossings(rows, plan.walls) == 0


@pytest.mark.thorough
def test_seven_of_eight_lone_walkers_leave_without_delay():
    # From a grid of starts all over the room: the straight way to the middle of the door at the
    # speed of one's own, and two seconds for setting off and turning. The others come along the
    # wall, step past the door and turn back.
    late, plan = [], two_doors()
    for x in np.arange(0.5, 8.0, 1.0):
        for y in np.arange(0.5, 8.0, 1.0):
            model = model_of(plan, shipped_map(), rng=1, frames_per_step=3, record=False)
            person = model.add_pedestrians([(x, y)], exits=["right"])[0]
            speed = float(model.crowd.preferred[person.row])
            model.run(max_seconds=30)
            assert model.inside == 0
            late.append(model.statistics.last_left > np.hypot(8.0 - x, 5.6 - y) / speed + 2.0)
    assert np.mean(late) <= 1 / 8


def test_nobody_stops_in_a_doorway_that_is_free_beyond():
    model = model_of(two_doors(), shipped_map(), rng=1, frames_per_step=3)
    model.add_pedestrians([(6.0, 2.0)], exits=["right"])
    model.run(max_seconds=30)
    assert model.inside == 0
    t = track(model.recorder.arrays(), 0)
    near = np.hypot(t[:, 1] - 8.0, t[:, 2] - 5.6) < 1.0
    speed = np.hypot(*np.diff(t[near][::6, 1:3], axis=0).T) / 0.2
    assert speed.min() > 0.4


def test_the_target_lies_beyond_the_exit():
    model = model_of(corridor(), strider())
    person = put(model, 15.0, 1.0)
    way = LineString([person.position, person.target])
    assert way.crosses(model.floor_plan.gate("east").line)
    assert person.target[0] > 20.5


def test_occupancy_counts_people_inside_each_second():
    model = model_of(corridor(length=20.0), strider(), frames_per_step=3)
    for k in range(4):
        put(model, 19.0 - 1.25 * k, 0.5 + k, preferred_speeds=[1.25])
    model.run()
    # They reach the line after 0.8, 1.8, 2.8 and 3.8 s.
    seconds, inside = zip(*model.statistics.occupancy, strict=True)
    assert seconds[:4] == pytest.approx((0.0, 1.0, 2.0, 3.0))
    assert inside[:4] == (4, 3, 2, 1)
    assert model.statistics.last_left == pytest.approx(3.8, abs=0.04)


@pytest.mark.parametrize(
    ("line", "begun", "velocity", "then"),
    [
        # 0.5 m/s at a slant over x = 8, both ways round; half a second later it is 0.25 m on.
        ((8.0, 0.0, 8.0, 1.2), 7.5, (0.3, 0.4), (8.25, 1.0)),
        ((8.0, 1.2, 8.0, 0.0), 7.5, (0.3, -0.4), (8.25, 1.0)),
        ((8.0, 0.0, 8.0, 1.2), 8.5, (-0.3, 0.4), (7.75, 1.0)),
        # It sways back over the line just then.
        ((8.0, 0.0, 8.0, 1.2), 7.5, (-0.3, 0.4), (8.25, 1.0)),
        # The exit has been closed in that very frame: it walks on as it went.
        (None, 7.5, (0.3, 0.4), (8.15, 1.2)),
    ],
)
def test_people_who_have_left_walk_straight_away_from_the_exit(line, begun, velocity, then):
    crowd, beyond = Crowd(2), Departed()
    crowd.x[1], crowd.y[1] = 8.0, 1.0
    crowd.from_x[1], crowd.from_y[1] = begun, 0.6
    crowd.vx[1], crowd.vy[1] = velocity
    far = (50.0, 0.0, 50.0, 9.0)
    exits = np.empty((0, 4)) if line is None else np.array([far, line])
    beyond.add(np.array([1]))
    beyond.set_off(30, crowd, exits)
    beyond.move(45, crowd)
    assert (crowd.x[1], crowd.y[1]) == pytest.approx(then)
    beyond.move(80, crowd)
    assert len(beyond.rows) == 0
    # After 1.5 s it stays in place, however many frames pass.
    after = np.array([8.0, 1.0]) + 3.0 * (np.array(then) - [8.0, 1.0])
    assert (crowd.x[1], crowd.y[1]) == pytest.approx(tuple(after))


@pytest.mark.parametrize(
    ("preferred", "metres"),
    # 0.5 m/s in the exit. Of the difference to 1.3 m/s, which decays with 0.54 s, 1.5 s leave
    # 0.36 (1 - exp(-1.5 / 0.54)) = 0.3376 on average: 1.030 m/s.
    [(1.3, 0.515), (0.5, 0.25), (0.3, 0.25)],
)
def test_people_who_were_held_up_in_the_exit_speed_up_beyond_it(preferred, metres):
    crowd, beyond = Crowd(1), Departed()
    crowd.x[0], crowd.y[0], crowd.from_x[0], crowd.from_y[0] = 8.0, 1.0, 7.5, 1.0
    crowd.vx[0], crowd.preferred[0] = 0.5, preferred
    beyond.add(np.array([0]))
    beyond.set_off(30, crowd, np.array([[8.0, 0.0, 8.0, 1.2]]))
    beyond.move(45, crowd)
    assert (crowd.x[0], crowd.y[0]) == pytest.approx((8.0 + metres, 1.0), abs=1e-3)
