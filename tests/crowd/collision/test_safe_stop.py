"""A person whose movement ends first counts as standing there until the other's has ended."""

import math

import numpy as np
import pytest
from mesa_mobility.behaviors import Displacement
from shapely import box

from mesa_mobility import Exit, FloorPlan
from tests.fixtures.maps import make_map, stand, straight, strider, wanderer
from tests.fixtures.oracles.counting import overlaps
from tests.fixtures.scenes import advance, corridor, model_of, put, statues


@pytest.mark.parametrize(("gap", "metres"), [(1.0, 0.5), (2.0, 1.875)])
def test_a_neighbour_held_at_its_end_while_mine_goes_on(gap, metres, whole):
    # The one in front commits to half a metre; were it to stop there, 1.875 m of mine, 1 m
    # behind, would run into it - although at a steady walk it would be long gone.
    short = make_map([[straight(0.5, 12, to=0)]])
    either = make_map([[straight(0.5, 12, to=0), straight(1.875, 45, to=0)]])
    model = model_of(corridor(), [short, either], behaviors=[Displacement()], preset=whole)
    put(model, 5.0 + gap, 2.0)
    behind = put(model, 5.0, 2.0, type_index=1)
    advance(model, 1)
    advance(model, round(behind.next_decision * 30))
    assert behind.position[0] - 5.0 == pytest.approx(metres, abs=1e-6)


CROSSING = FloorPlan(
    box(-3, 0, 3, 6), exits=[Exit("east", (3, 0), (3, 6)), Exit("north", (-3, 6), (3, 6))]
)


@pytest.mark.parametrize(
    ("walker_y", "stays"), [(2.0, True), (1.72, True), (2.28, True), (2.31, False), (1.69, False)]
)
def test_mine_held_at_its_end_while_the_neighbours_goes_on(walker_y, stays, whole):
    # The walker passes x = 1 at frame 24.  I could be at (1, 2) by frame 12, when it is half
    # a metre off, but if I had to stand there it would come closer than 0.3 m.
    long_way = make_map([[straight(1.875, 45, to=0)]])
    dash = make_map([[stand(), straight(1.0, 12, to=0)]])
    model = model_of(CROSSING, [long_way, dash], behaviors=[Displacement()], preset=whole)
    walker = put(model, 0.0, walker_y, exits=["east"])
    me = put(model, 1.0, 1.0, math.pi / 2, type_index=1, exits=["north"])
    advance(model, 12)
    assert walker.position[0] == pytest.approx(0.5)
    assert (me.position[1] == pytest.approx(1.0)) == stays


@pytest.mark.parametrize(("length", "follows"), [(6.0, False), (5.7, True)])
def test_somebody_who_leaves_is_there_behind_the_exit_too(length, follows, whole):
    # The one in front leaves within 0.4 s, and its movement ends at 6.1 m: 0.125 m beyond where
    # the other's would, unless that one has left by then as well.
    short = make_map([[straight(0.5, 12, to=0)]])
    either = make_map([[stand(), straight(1.875, 45, to=0)]])
    maps, terms = [short, either], [Displacement()]
    model = model_of(corridor(length=length), maps, behaviors=terms, preset=whole)
    put(model, 5.6, 2.0)
    behind = put(model, 4.1, 2.0, type_index=1)
    advance(model, 1)
    assert behind.speed == pytest.approx(1.25 if follows else 0.0)


@pytest.mark.parametrize(("y", "leaves"), [(2.0, False), (1.85, True)])
def test_people_who_leave_run_over_nobody_who_stays(y, leaves, whole):
    # It crosses the line at (6, 2.42), 0.42 m from somebody who stands at (5.95, 2), and passes
    # it behind the line, 0.25 m off; 0.33 m from somebody at (5.95, 1.85).
    out = make_map([[stand(), straight(1.0, 12, towards=-math.pi / 3, to=0)]])
    model = model_of(
        corridor(length=6.0), [out, statues()], behaviors=[Displacement()], preset=whole
    )
    leaver = put(model, 5.75, 2.85, 0.0)
    put(model, 5.95, y, type_index=1)
    advance(model, 1)
    assert (leaver.speed > 0.0) == leaves


def test_people_who_have_left_walk_on_for_a_while():
    # It crosses the line at 6 m in frame 12 and walks on as it went, though it would like to be
    # slower: for 1.5 s it is a neighbour of those behind, and no longer.
    model = model_of(corridor(length=6.0), strider())
    put(model, 5.52, 2.0, preferred_speeds=[1.1])
    behind = put(model, 5.0, 1.0)
    behind.wait(60.0)
    seen = []
    for _ in range(75):
        advance(model, 1)
        seen.append(behind.movement_options().neighbour_positions[:, 0].tolist())
    assert seen[11] == pytest.approx([6.02])
    assert seen[41] == pytest.approx([6.02 + 1.25])
    assert seen[55] == pytest.approx([6.02 + 1.25 * 44 / 30])
    assert seen[57] == []


def test_closest_approach_between_samples_of_two_who_move(whole):
    # Both run 3 m in 12 frames, crossing at right angles; at the samples, each 0.75 m on,
    # they are 0.53 m apart at least, between two of them they meet.
    dash = make_map([[stand(), straight(3.0, 12, to=0)]])
    model = model_of(CROSSING, dash, behaviors=[Displacement()], preset=whole)
    first = put(model, -1.125, 3.0, exits=["east"])
    second = put(model, 0.0, 3.0 - 1.125, math.pi / 2, exits=["north"])
    advance(model, 1)
    assert sorted([first.speed, second.speed]) == pytest.approx([0.0, 7.5])


@pytest.mark.parametrize("seed", range(4))
def test_nobody_comes_closer_than_two_cores_in_a_crush(seed):
    rng = np.random.default_rng(seed)
    plan = FloorPlan(box(0, 0, 5, 5), exits=[Exit("east", (5, 2.2), (5, 2.8))])
    model = model_of(plan, wanderer(seed + 50, options=25), rng=seed, frames_per_step=3)
    model.add_pedestrians(plan.random_points(25, rng, spacing=0.5, clearance=0.3))
    advance(model, 600)
    rows = model.recorder.arrays()
    assert len(rows["frame"]) > 600
    assert overlaps(rows, 0.15, tolerance=0.0) == 0
