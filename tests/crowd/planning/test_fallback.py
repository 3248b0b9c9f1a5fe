"""No option is free: four frames straight towards the target, then again from standing."""

import math

import numpy as np
import pytest
from mesa_mobility.behaviors import (
    Displacement,
    FacingDeviation,
    Interference,
    PreferredSpeed,
    TargetDistance,
)
from shapely import box

from mesa_mobility import Exit, FloorPlan
from tests.fixtures.maps import STANDING, WALKING, make_map, shipped_map, straight
from tests.fixtures.oracles.counting import overlaps, wall_crossings
from tests.fixtures.scenes import (
    advance,
    core_of,
    corridor,
    dead_end,
    follow,
    model_of,
    put,
    statues,
)


@pytest.fixture
def onward():
    """Nothing but ahead: 0.5 m from standing, 1.875 m when walking."""
    return make_map([[straight(0.5, 12)], [straight(1.875, 45)]])


@pytest.fixture
def cornered(onward, whole):
    """Somebody 0.4 m from a wall, facing it; the way out is behind and somewhat to the left."""
    model = model_of(dead_end(x=5.0), onward, preset=whole)
    return put(model, 4.6, 2.0, 0.75, preferred_speeds=[1.2])


def test_lasts_four_frames(cornered):
    advance(cornered.model, 1)
    assert cornered.in_fallback
    assert cornered.next_decision == pytest.approx(3 / 30)
    assert cornered.model.summary()["decisions"] == 1
    advance(cornered.model, 3)
    assert cornered.next_decision == 0.0
    advance(cornered.model, 1)
    assert cornered.model.summary()["decisions"] == 2


def test_goes_straight_and_evenly_towards_the_target(cornered):
    track = follow(cornered, 4)
    steps = np.diff(track, axis=0)
    np.testing.assert_allclose(steps - steps.mean(axis=0), 0.0, atol=1e-12)
    moved = track[4, :2] - track[0, :2]
    aim = cornered.target - track[0, :2]
    assert moved @ aim == pytest.approx(np.linalg.norm(moved) * np.linalg.norm(aim))
    # No faster than the person likes to walk: 4 frames at 1.2 m/s.
    assert 0.05 < np.linalg.norm(moved) <= 0.16 + 1e-9


def test_turns_towards_the_target_the_shorter_way(cornered):
    track = follow(cornered, 4)
    aim = cornered.target - track[0, :2]
    before, after = (
        math.remainder(math.atan2(aim[1], aim[0]) - heading, math.tau)
        for heading in track[[0, 4], 2]
    )
    assert before > 1.5
    assert 0.0 <= after < before - 0.1


def test_decides_again_from_standing(onward, whole):
    model = model_of(dead_end(x=5.0), onward, preset=whole)
    # Half a metre of 1.1 m ahead leaves too little for the 1.875 m that walking has.
    person = put(model, 3.9, 2.0)
    advance(model, 12)
    assert not person.in_fallback
    assert person.cluster == WALKING
    advance(model, 1)
    assert person.in_fallback
    assert person.cluster == STANDING
    advance(model, 4)
    # From standing the half metre would do, but not ahead.
    assert model.summary()["decisions"] == 3


def test_turning_away_from_the_wall_lets_the_person_walk_off(cornered):
    model = cornered.model
    model.run(max_seconds=30)
    assert model.inside == 0
    rows = model.recorder.arrays()
    assert wall_crossings(rows, model.floor_plan.walls) == 0
    assert 0.0 < model.statistics.fallback_decision_share < 1.0


def test_shares_of_decisions_and_of_time(onward, whole):
    # One falls back thrice in a row (12 frames), another strides on (12 frames, one decision).
    model = model_of(
        corridor(length=40.0),
        [onward, make_map([[straight(0.5, 12, to=0)]])],
        behaviors=[Displacement()],
        preset=whole,
    )
    model.floor_plan.add_obstacle(box(6.3, 0.5, 6.4, 3.5))
    stuck, walker = put(model, 6.0, 2.0), put(model, 20.0, 2.0, type_index=1)
    advance(model, 12)
    assert stuck.in_fallback
    assert not walker.in_fallback
    summary = model.summary()
    assert summary["decisions"] == 4
    assert summary["fallback_decision_share"] == pytest.approx(3 / 4)
    assert summary["fallback_time_share"] == pytest.approx(12 / 24)


def test_the_step_is_checked_against_bodies_and_walls_too(onward, whole):
    # Hemmed in by three statues on the way out, 0.32 m off: no step of 0.16 m is free.
    model = model_of(dead_end(x=5.0), [onward, statues()], preset=whole)
    for angle in (math.pi - 1.0, math.pi, math.pi + 1.0):
        put(model, 4.8 + 0.32 * math.cos(angle), 2.0 + 0.32 * math.sin(angle), type_index=1)
    person = put(model, 4.8, 2.0, preferred_speeds=[1.2])
    advance(model, 120)
    assert person.in_fallback
    rows = model.recorder.arrays()
    assert overlaps(rows, 0.15, tolerance=0.0) == 0
    assert np.linalg.norm(person.position - (4.8, 2.0)) <= 0.02 + 1e-9


def test_a_step_of_the_fallback_is_checked_against_paths_still_under_way(whole):
    # A walker passes close by; who falls back must not step into its way.
    blocked = make_map([[straight(3.0, 45, to=0)]])
    walker_map = make_map([[straight(1.875, 45, to=0)]])
    plan = FloorPlan(
        box(0, 0, 6, 4), exits=[Exit("east", (6, 0), (6, 4)), Exit("north", (0, 4), (6, 4))]
    )
    model = model_of(plan, [walker_map, blocked], preset=whole)
    put(model, 2.0, 2.0, exits=["east"])
    # 0.31 m beside the walker's line at x = 3, wishing to cross it; facing the lower wall.
    put(model, 3.0, 1.69, -math.pi / 2, type_index=1, exits=["north"], preferred_speeds=[1.5])
    advance(model, 45)
    assert model.summary()["fallback_decision_share"] > 0.5
    assert overlaps(model.recorder.arrays(), 0.15, tolerance=0.0) == 0


def test_without_an_option_free_nobody_freezes_for_ever_nor_passes_through_others(whole):
    # Back to the exit, 3 persons/m2.
    plan, people, shares = corridor(length=4.0, width=2.0), 24, []
    for seed in range(3):
        # Without a headway, which keeps them from walking to where no option is free.
        terms = [TargetDistance(), FacingDeviation(0.5), PreferredSpeed(2.0), Interference()]
        model = model_of(
            plan, shipped_map(), preset=whole, behaviors=terms, rng=seed, frames_per_step=3
        )
        places = plan.random_points(people, model.rng, spacing=0.36, clearance=0.16)
        model.add_pedestrians(places, headings=np.full(people, math.pi))
        model.run(max_seconds=120)
        assert model.inside == 0
        assert overlaps(model.recorder.arrays(), core_of(model)) == 0
        shares.append(model.statistics.fallback_decision_share)
    assert max(shares) > 0.0
