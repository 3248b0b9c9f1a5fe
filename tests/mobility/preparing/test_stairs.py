"""Long stairs from a few recorded steps."""

from dataclasses import replace

import numpy as np
import pytest

from mesa_mobility.capture import leg_joints
from mesa_mobility.errors import MapError
from mesa_mobility.mobility import pose_table
from mesa_mobility.mobility.preparing.stairs import CADENCES, on_long_stairs, stair_cycles
from tests.fixtures.climber import climber

RISER, TREAD, FRAMES = 0.18, 0.3, 20


@pytest.fixture(scope="module")
def five_steps():
    return climber(steps=5, riser=RISER, tread=TREAD, frames=FRAMES, heading=0.7)


def backwards(recording):
    """The same steps taken downwards, as of somebody who steps back."""
    return replace(
        recording,
        root_position=recording.root_position[::-1],
        rotations=recording.rotations[::-1],
    )


def test_the_climber_puts_the_feet_on_the_treads(five_steps):
    toes = five_steps.positions()[:, leg_joints(five_steps.skeleton).left[-1]]
    # The left foot takes steps 1, 3 and 5; it stands at the end of each.
    at = [0, *(30 + k * FRAMES for k in (1, 3, 5))]
    assert toes[at, 2] == pytest.approx([0.0, RISER, 3 * RISER, 5 * RISER], abs=1e-6)


def test_cycles_are_two_treads_long(five_steps):
    cycles = stair_cycles(five_steps)
    # One begins with each step from the first on that has two more after it.
    assert len(cycles) == 3
    for each in cycles:
        assert each.way == pytest.approx(2 * TREAD, abs=0.01)
        assert each.rise == pytest.approx(2 * RISER, abs=0.01)
        assert each.cadence == pytest.approx(30.0 / FRAMES, rel=0.06)


def test_cycles_are_closed_and_level(five_steps):
    for each in stair_cycles(five_steps):
        places = each.recording.positions()
        assert places[-1] == pytest.approx(places[0] + [each.way, 0.0, 0.0], abs=1e-9)
        # The body keeps its height over the treads: 0.65 m, and what the line through the toes
        # falls over the 0.4 treads and 0.15 m that the body is behind them.
        height = 0.65 + 0.4 * RISER + 0.15 * RISER / TREAD
        assert places[:, 0, 2] == pytest.approx(height, abs=0.03)


@pytest.mark.parametrize("tread", [0.25, 0.35])
def test_strides_are_treads_at_every_cadence(five_steps, tread):
    recordings, metadata = on_long_stairs([five_steps], up=True, tread=tread)
    assert len(recordings) == 3 * len(CADENCES)
    for each, cadence in zip(recordings, CADENCES * 3, strict=True):
        way = np.diff(each.root_position[:, 0])
        assert way.mean() * 30.0 == pytest.approx(tread * cadence, rel=0.03)
        assert each.duration > 5.0
        assert np.ptp(each.root_position[:, 2]) < 0.06
    facing = pose_table(recordings).facing
    assert np.abs(facing).max() < 0.05
    derived = metadata["derived"]
    assert derived["tread_m"] == tread
    assert derived["recorded"]["risers_m"] == pytest.approx([RISER] * 3, abs=0.005)


def test_down_is_told_from_up(five_steps):
    with pytest.raises(MapError, match="nobody walks down stairs in these recordings, expected th"):
        on_long_stairs([five_steps], up=False, tread=TREAD)
    recordings, _ = on_long_stairs([backwards(five_steps)], up=False, tread=TREAD)
    assert recordings


def test_a_level_walk_has_no_cycles():
    assert stair_cycles(climber(steps=6, riser=0.0, tread=0.5, frames=18)) == []


@pytest.mark.captures
def test_recorded_steps_are_found(captures_dir):
    from mesa_mobility.capture import find_clips, load_clips

    clips = load_clips(
        find_clips(captures_dir), pedestrian_type="stairs_up_down", mirrored=False
    ).recordings
    for recording in clips:
        # Each clip goes up and down three steps, of 0.21 m.
        rises = [each.rise for each in stair_cycles(recording)]
        assert rises == pytest.approx([0.42, -0.42], abs=0.02)
