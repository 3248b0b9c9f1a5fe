"""Small groups walk side by side, as Moussaid et al. (2010) observed them."""

from dataclasses import replace

import numpy as np
import pytest
from mesa_mobility.behaviors import WalkingAbreast
from shapely import box

from mesa_mobility import Exit, FloorPlan, PedestrianModel
from mesa_mobility.crowd import PRESETS
from mesa_mobility.errors import ModelError
from tests.fixtures.checkpoints import check_going_on
from tests.fixtures.maps import shipped_map, strider
from tests.fixtures.oracles.counting import overlaps, wall_crossings
from tests.fixtures.scenes import advance, core_of, corridor, model_of, put


def walk(size, places, *, width=6.0, speed=1.22, abreast=True):
    """(size, 2, n) places of a group on its way from x = 12 to 32 m, from right to left."""
    model = model_of(corridor(36.0, width), shipped_map(), frames_per_step=3)
    if abreast:
        model.add_tactic(WalkingAbreast())
    model.add_pedestrians(places, preferred_speeds=speed, group="friends")
    model.run(max_seconds=60)
    rows = model.recorder.arrays()
    last = min(int(rows["frame"][rows["person"] == k].max()) for k in range(size))
    tracks = np.array(
        [
            [rows[axis][(rows["person"] == k) & (rows["frame"] <= last)] for axis in "xy"]
            for k in range(size)
        ]
    )
    middle = tracks[:, 0].mean(axis=0)
    tracks = tracks[:, :, (middle > 12.0) & (middle < 32.0)]
    return tracks[np.argsort(tracks[:, 1].mean(axis=1))]


def speed_of(tracks):
    x = tracks[:, 0].mean(axis=0)
    return 30.0 * (x[-1] - x[0]) / (len(x) - 1)


@pytest.mark.parametrize(
    ("size", "places"),
    [
        (2, [(1.0, 3.0), (2.2, 3.2)]),
        (3, [(1.0, 2.0), (1.5, 3.0), (1.0, 4.0)]),
        (4, [(1.0, 1.5), (2.0, 1.7), (1.5, 3.0), (1.0, 4.0)]),
    ],
)
def test_small_groups_walk_side_by_side_and_slower(size, places):
    tracks = walk(size, places)
    # Their fit for low density: 1.26 - 0.04 N m/s, so that one alone walks at 1.22 m/s.
    assert speed_of(tracks) == pytest.approx(1.26 - 0.04 * size, abs=0.025)
    dx, dy = np.diff(tracks[:, 0], axis=0), np.diff(tracks[:, 1], axis=0)
    assert dy.mean() == pytest.approx(0.75, abs=0.03)
    # Those in the middle walk behind, and all sway: 0.1 to 0.25 m along the way add up to 0.04 m.
    assert 0.73 < np.hypot(dx, dy).mean() < 0.79
    # Angle of the line between the outermost members to the way of the group.
    first, last = tracks[0].mean(axis=1), tracks[-1].mean(axis=1)
    angle = np.degrees(np.arctan2(last[1] - first[1], last[0] - first[0]))
    assert angle == pytest.approx(90.0, abs=5.0)


def test_the_one_in_the_middle_of_three_walks_behind():
    right, middle, left = walk(3, [(1.0, 2.0), (1.5, 3.0), (1.0, 4.0)])
    assert 0.05 < ((right + left) / 2.0 - middle)[0].mean() < 0.25


def test_a_pair_fits_a_narrow_corridor():
    tracks = walk(2, [(1.0, 0.75), (1.8, 0.75)], width=1.5)
    assert np.diff(tracks[:, 1], axis=0).mean() == pytest.approx(0.75, abs=0.1)


def test_without_it_they_go_as_they_are():
    tracks = walk(2, [(1.0, 3.0), (2.2, 3.2)], abreast=False)
    assert speed_of(tracks) == pytest.approx(1.22, abs=0.02)
    assert abs(np.diff(tracks[:, 0], axis=0).mean()) > 0.4


@pytest.mark.parametrize("group", [None, "a large one"])
def test_those_alone_and_in_large_groups_walk_as_before(group):
    tracks = []
    for abreast in (False, True):
        model = model_of(corridor(), shipped_map(), frames_per_step=3)
        if abreast:
            model.add_tactic(WalkingAbreast())
        model.add_pedestrians([(1.0 + 0.5 * k, 0.5 + 0.7 * k) for k in range(5)], group=group)
        model.run(max_seconds=5)
        tracks.append(model.recorder.arrays()["x"])
    assert np.array_equal(*tracks)


def test_only_members_near_by_with_the_same_way_count():
    plan = FloorPlan(
        box(0, 0, 20, 4), exits=[Exit("east", (20, 0), (20, 4)), Exit("west", (0, 0), (0, 4))]
    )
    alone = replace(PRESETS["default"], name="no pace of groups", group_pace=None)
    # One who goes elsewhere, one who is 7 m ahead, and one beside.
    for exits, x, together in (
        (["west"], 4.0, False),
        (["east"], 9.0, False),
        (["east"], 2.0, True),
    ):
        model = model_of(plan, strider(), preset=alone)
        model.add_tactic(WalkingAbreast())
        person = put(model, 2.0, 2.0, preferred_speeds=1.25, exits=["east"], group=1)
        put(model, x, 1.25, preferred_speeds=0.9, exits=exits, group=1)
        advance(model, 46)  # no movement takes longer, so that it has decided walking
        assert (model.crowd.preferred[person.row] < 1.0) == together


def test_groups_pass_a_door():
    floor = box(0, 0, 8, 6).union(box(8, 2.6, 8.2, 3.4)).union(box(8.2, 0, 11, 6))
    plan = FloorPlan(floor, exits=[Exit("out", (11, 0), (11, 6))])
    model = model_of(plan, shipped_map(), rng=2, frames_per_step=3)
    model.add_tactic(WalkingAbreast())
    for number in range(6):
        model.add_pedestrians(
            [(6.0 - 0.7 * k, 0.5 + number) for k in range(2 + number % 2)], group=number
        )
    model.run(max_seconds=60)
    assert model.inside == 0
    rows = model.recorder.arrays()
    assert overlaps(rows, core_of(model)) == 0
    assert wall_crossings(rows, plan.walls) == 0


def test_it_goes_on_from_a_checkpoint(tmp_path):
    class Street(PedestrianModel):
        def __init__(self, rng=None):
            super().__init__(corridor(), mobility_map=shipped_map(), record=True, rng=rng)
            self.add_tactic(WalkingAbreast())
            self.add_pedestrians([(1.0, 2.0), (1.5, 3.0)], group=1)

    check_going_on(Street(rng=1), tmp_path, saved_at=3, until=6)


@pytest.mark.parametrize(
    ("wrong", "text"),
    [
        ({"distance": 0.0}, "distance 0.0, expected more than 0 m"),
        ({"behind": -0.1}, "behind -0.1, expected 0 m or more"),
        ({"slower": float("nan")}, "slower nan, expected 0 m/s or more"),
    ],
)
def test_numbers_out_of_range_are_refused(wrong, text):
    with pytest.raises(ModelError, match=f"walking_abreast: {text}"):
        WalkingAbreast(**wrong)
