"""Gates crossed in order, then an exit; or round for ever."""

import math

import numpy as np
import pytest
from mesa_mobility.behaviors import Displacement
from shapely import LineString, box

from mesa_mobility import Exit, FloorPlan, Gate
from mesa_mobility.errors import FloorPlanError, ModelError
from mesa_mobility.results import Trajectories, crossings
from tests.fixtures.maps import shipped_map, strider
from tests.fixtures.oracles.counting import overlaps, track, wall_crossings
from tests.fixtures.scenes import advance, core_of, model_of, put, statues

CORNERS = ["south", "east", "north", "west"]


def hall(*, both_ends: bool = False) -> FloorPlan:
    """20 m x 4 m, gates across at 6, 12 and 16 m, an exit at the right end."""
    exits = [Exit("right", (20, 0), (20, 4))]
    exits += [Exit("left", (0, 0), (0, 4))] * both_ends
    gates = [Gate(name, (x, 0), (x, 4)) for name, x in (("a", 6), ("b", 12), ("c", 16))]
    return FloorPlan(box(0, 0, 20, 4), exits=exits, gates=gates)


def ring(width: float = 1.2) -> FloorPlan:
    """A closed track, 4 m straight and 3 m in radius along its middle, and a gate on each side."""
    middle, half = LineString([(-2, 0), (2, 0)]), width / 2
    floor = middle.buffer(3 + half).difference(middle.buffer(3 - half))
    ends = {"south": (0, -1), "north": (0, 1), "east": (1, 0), "west": (-1, 0)}
    gates = []
    for name in CORNERS:
        x, y = ends[name]
        near, far = ((2 * x + x * r, y * r) for r in (3 - half, 3 + half))
        gates.append(Gate(name, near, far))
    return FloorPlan(floor, gates=gates)


def order(model, person, names):
    """Gates in the order in which a person's track crosses them, each time."""
    tracks = Trajectories.of(model)
    passed = []
    for name in names:
        gate = model.floor_plan.gate(name)
        found = crossings(tracks, gate.a, gate.b)
        passed += [(t, name) for t in found.time[found.person == person.row].tolist()]
    return [name for _, name in sorted(passed)]


def test_gates_are_crossed_in_the_order_given_then_the_exit():
    model = model_of(hall(), shipped_map(), rng=1, frames_per_step=3)
    # b lies ahead of a: through b and back to a; then through a, b and c to the exit.
    person = put(model, 8.0, 2.0, route=["b", "a"])
    assert person.route == ("b", "a")
    assert person.gates_crossed == 0
    model.run(max_seconds=60)
    assert model.inside == 0
    assert order(model, person, "abc") == ["b", "b", "a", "a", "b", "c"]
    assert person.gates_crossed == 2


def test_the_way_left_is_that_to_the_next_gate():
    model = model_of(hall(), strider())
    person = put(model, 2.0, 2.0, preferred_speeds=[1.25], route=["a", "c"])
    assert model.crowd.route[person.row] == pytest.approx(4.0)
    assert person.target.tolist() == pytest.approx([8.0, 2.0])
    # 1.875 m each 45 frames: after three times 1.625 m past a, and 8.375 m off c.
    advance(model, 136)
    assert person.gates_crossed == 1
    assert model.crowd.route[person.row] == pytest.approx(16.0 - 7.625, abs=1e-6)


def test_a_gate_that_is_crossed_before_its_turn_does_not_count():
    model = model_of(hall(), strider())
    person = put(model, 10.0, 2.0, preferred_speeds=[1.25], route=["c", "a"])
    advance(model, 80)
    assert person.position[0] > 12.0
    assert person.gates_crossed == 0


def test_two_gates_crossed_in_one_movement_both_count():
    plan = FloorPlan(
        box(0, 0, 20, 4),
        exits=[Exit("right", (20, 0), (20, 4))],
        gates=[Gate("a", (6, 0), (6, 4)), Gate("b", (6.5, 0), (6.5, 4))],
    )
    model = model_of(plan, strider())
    person = put(model, 5.0, 2.0, preferred_speeds=[1.25], route=["a", "b"])
    back = put(model, 5.0, 3.0, preferred_speeds=[1.25], route=["b", "a"])
    advance(model, 46)
    assert person.gates_crossed == 2
    assert back.gates_crossed == 1


@pytest.mark.parametrize("exits", [None, ["left"]])
def test_nobody_leaves_before_the_last_gate(exits):
    # Displacement alone: straight on through anything that is free.
    model = model_of(hall(both_ends=True), strider(), behaviors=[Displacement()])
    person = put(model, 18.8, 2.0, route=["a"], exits=exits)
    advance(model, 45)
    # A metre ends 0.2 m short of the exit, as before a wall.
    assert person.position[0] == pytest.approx(19.8, abs=1e-6)


def test_after_the_last_gate_the_exits_given_count():
    model = model_of(hall(both_ends=True), shipped_map(), rng=3, frames_per_step=3)
    people = [
        put(model, 10.0, 1.0 + k, route=["b"], exits=[name])
        for k, name in enumerate(("left", "right"))
    ]
    model.run(max_seconds=60)
    assert model.inside == 0
    rows = model.recorder.arrays()
    assert track(rows, people[0].row)[-1, 1] < 0.0
    assert track(rows, people[1].row)[-1, 1] > 20.0


def test_to_and_fro_between_two_gates_for_ever():
    model = model_of(hall(), shipped_map(), rng=2, frames_per_step=3)
    person = put(model, 8.0, 2.0, preferred_speeds=[1.3], route=["b", "a"], loop=True)
    model.run(max_seconds=120)
    assert model.inside == 1
    assert not model.stalled
    assert model.summary()["egress_s"] is None
    # Six metres from line to line, and no more than six seconds to turn round.
    assert 120 / (6.0 / 1.3 + 6.0) <= person.gates_crossed <= 120 / (6.0 / 1.3)


def test_round_a_closed_track_nobody_leaves_turns_or_hits_anybody():
    model = model_of(ring(), shipped_map(), rng=2, frames_per_step=3)
    people = []
    for k in range(16):
        # South goes before east, and so on: each starts behind the gate that is next.
        side, share = divmod(k, 4)
        angle = math.pi / 2 * (side - 1) + 0.3 + share * 0.28
        x = 2 * math.copysign(1, math.cos(angle))
        people += model.add_pedestrians(
            [(x + 3 * math.cos(angle), 3 * math.sin(angle))],
            headings=[angle + math.pi / 2],
            preferred_speeds=[1.2],
            route=CORNERS[(side + 1) % 4 :] + CORNERS[: (side + 1) % 4],
            loop=True,
        )
    model.run(max_seconds=60)
    assert model.inside == 16
    assert not model.stalled
    rows = model.recorder.arrays()
    assert overlaps(rows, core_of(model)) == 0
    assert wall_crossings(rows, model.floor_plan.walls) == 0
    lap = 8 + 2 * math.pi * 3
    for person in people:
        path = track(rows, person.row)
        turned = np.unwrap(np.arctan2(path[:, 2], path[:, 1]))[-1] - np.arctan2(*path[0, 2:0:-1])
        # Four gates a lap.
        assert person.gates_crossed / 4 == pytest.approx(turned / math.tau, abs=0.5)
        assert 60 * 0.75 / lap < turned / math.tau < 60 * 1.3 / lap


def test_people_who_stand_still_on_a_closed_track_have_stalled():
    model = model_of(ring(), statues(), frames_per_step=3)
    put(model, 0.0, -3.0, route=CORNERS, loop=True)
    model.run(max_seconds=200)
    assert model.stalled
    assert model.elapsed == pytest.approx(60.0, abs=0.5)


def test_somebody_stopped_has_crossed_what_it_had_crossed():
    model = model_of(hall(), strider())
    person = put(model, 5.5, 2.0, preferred_speeds=[1.25], route=["a", "b"])
    advance(model, 20)
    assert 6.0 < person.position[0] < 6.5
    model.floor_plan.add_obstacle(box(6.8, 0.0, 7.2, 3.0))
    advance(model, 1)
    assert person.gates_crossed == 1


def test_a_closed_gate_is_waited_for():
    plan = hall()
    plan.close_gate("b")
    model = model_of(plan, shipped_map(), rng=1, frames_per_step=3)
    person = put(model, 8.0, 2.0, route=["b"])
    advance(model, 300)
    assert person.position[0] < 12.0
    plan.open_gate("b")
    model.run(max_seconds=60)
    assert model.inside == 0
    assert person.gates_crossed == 1


@pytest.mark.parametrize(
    ("keywords", "error", "match"),
    [
        ({"route": "ab"}, ModelError, "route.*'ab'"),
        ({"route": ["a", "a"]}, ModelError, "'a' follows itself"),
        ({"route": ["a", "b", "a"], "loop": True}, ModelError, "'a' follows itself"),
        ({"route": ["a"], "loop": True}, ModelError, "'a' follows itself"),
        ({"loop": True}, ModelError, "loop"),
        ({"route": ["a", "b"], "loop": True, "exits": ["right"]}, ModelError, "exits"),
        ({"route": ["a", "z"]}, FloorPlanError, "'z'"),
        ({"route": ["a", "right"]}, FloorPlanError, "'right' is an exit"),
        ({"route": ["a"], "exits": ["b"]}, FloorPlanError, "'b' is a gate"),
    ],
)
def test_routes_that_cannot_be(keywords, error, match):
    model = model_of(hall(), strider())
    with pytest.raises(error, match=match) as refused:
        put(model, 2.0, 2.0, **keywords)
    assert "\n" not in str(refused.value)
    assert model.inside == 0


def test_a_run_without_end_needs_a_time_limit():
    model = model_of(hall(), strider())
    put(model, 2.0, 2.0, route=["a", "b"], loop=True)
    with pytest.raises(ModelError, match="max_seconds"):
        model.run()


def test_without_an_exit_everybody_needs_a_route():
    model = model_of(ring(), strider())
    with pytest.raises(FloorPlanError, match="1 of 1 people have no way to any exit"):
        put(model, 0.0, -3.0)
    with pytest.raises(FloorPlanError, match="no way from 'south' to any exit"):
        put(model, 0.0, -3.0, route=["south"])
