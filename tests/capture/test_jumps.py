"""Where recordings jump: found, named with its frame, and cut out."""

import numpy as np
import pytest

from mesa_mobility.capture import find_jumps, load_clips, read_bvh, read_folder, sound_parts
from mesa_mobility.errors import CaptureError
from mesa_mobility.mobility import pose_table


def standing(frames):
    """(F, 8, 3) joints of two straight legs 0.2 m apart, 0.9 m long."""
    leg = np.array([[0, 0.1, 0.9], [0, 0.1, 0.5], [0, 0.1, 0.1], [0.15, 0.1, 0.0]])
    return np.tile(np.concatenate([leg, leg * [1, -1, 1]]), (frames, 1, 1))


def walking(frames, speed=1.3):
    joints = standing(frames)
    joints[..., 0] += np.arange(frames)[:, None] * speed / 30
    return joints


def spoilt(joints):
    return np.flatnonzero(find_jumps(joints).spoilt).tolist()


def test_walking_and_the_fastest_sprint_are_no_jumps():
    assert spoilt(walking(60)) == []
    assert spoilt(walking(60, speed=12.3)) == []
    assert find_jumps(walking(60)).reason == ""


def test_faster_than_any_sprint_is_a_jump_everywhere():
    found = find_jumps(walking(60, speed=12.4))
    assert found.spoilt.all()
    assert found.reason == "the hips move at 12.4 m/s, expected at most 12.34"


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_one_frame_beside_the_others_is_found_with_its_neighbours(axis):
    joints = walking(60)
    joints[20, :, axis] += 1.0
    found = find_jumps(joints)
    # Out and back take one frame each: 30 m/s.
    assert np.flatnonzero(found.spoilt).tolist() == [19, 20, 21]
    assert found.frames.tolist() == [20]


def test_a_small_spike_is_found_by_its_acceleration_alone():
    joints = standing(60)
    # 0.06 m and back: 2 * 0.06 * 900 = 108 m/s2, at 1.8 m/s.
    joints[20, :, 0] += 0.06
    found = find_jumps(joints)
    assert np.flatnonzero(found.spoilt).tolist() == [20]
    assert found.reason == "the hips move with 108 m/s2, expected at most 100"
    joints[20, :, 0] -= 0.01
    assert spoilt(joints) == []


def test_a_step_aside_spoils_the_frames_on_both_sides():
    joints = standing(60)
    joints[30:, :, 1] += 0.3
    assert spoilt(joints) == [29, 30]


def test_a_foot_that_jumps_is_named():
    joints = standing(60)
    # 2 * 0.2 * 900 = 360 m/s2.
    joints[10, 7, 2] += 0.2
    assert find_jumps(joints).reason == ("the right toe moves with 360 m/s2, expected at most 250")


def test_a_body_turned_round_within_a_frame_is_a_jump():
    joints = standing(60)
    # The toes are drawn in, so that nothing but the hip line tells.
    joints[:, :, 0] = 0.0
    joints[30:, :, 1] *= -1.0
    found = find_jumps(joints)
    assert np.flatnonzero(found.spoilt).tolist() == [29, 30]
    # Half a turn in 1/30 s: 30 * 3.1416.
    assert found.reason == "the hips turn at 94 rad/s, expected at most 36"


def test_clips_too_short_to_jump():
    assert spoilt(standing(1)) == []
    assert spoilt(standing(2)) == []
    assert spoilt(walking(2, speed=60.0)) == [0, 1]


def rows_of(text):
    lines = text.splitlines()
    return lines, lines.index("MOTION") + 3


def shifted(text, frames, metres):
    """The recording in centimetres with its root aside in some frames."""
    lines, first = rows_of(text)
    for frame in frames:
        x, rest = lines[first + frame].split(" ", 1)
        lines[first + frame] = f"{float(x) + 100 * metres} {rest}"
    return "\n".join(lines) + "\n"


def test_a_clip_is_split_at_its_jumps_and_says_so(write, walker_bvh):
    path = write("walk.bvh", shifted(walker_bvh(200), [60, 130], 1.0))
    loaded = load_clips(read_folder(path.parent))
    assert [r.name for r in loaded.recordings] == [
        "walk[0:59]",
        "walk[0:59]~mirror",
        "walk[62:129]",
        "walk[62:129]~mirror",
        "walk[132:200]",
        "walk[132:200]~mirror",
    ]
    assert [r.frames for r in loaded.recordings] == [59, 59, 67, 67, 68, 68]
    assert loaded.skipped == []
    assert loaded.split == [
        (
            "walk",
            "jumps at frame 60 and 1 more of walk.bvh, where the hips move at 30.0 m/s, "
            "expected at most 12.34",
        )
    ]
    # The walker moves 1 cm a frame: the parts are of the ground that they were on.
    np.testing.assert_allclose(loaded.recordings[2].root_position[:2, 0], [0.62, 0.63])


def test_parts_that_are_too_short_are_left_out(write, walker_bvh):
    path = write("walk.bvh", shifted(walker_bvh(120), [46, 80], 1.0))
    loaded = load_clips(read_folder(path.parent), mirrored=False)
    assert [r.name for r in loaded.recordings] == ["walk[0:45]"]


def test_where_nothing_is_left_the_first_clip_says_why(write, walker_bvh):
    path = write("walk.bvh", shifted(walker_bvh(80), [40], 3.0))
    with pytest.raises(CaptureError) as error:
        load_clips(read_folder(path.parent))
    assert str(error.value) == (
        f"{path.parent}: walk cannot be used: jumps at frame 40 of walk.bvh, where the hips move "
        "at 90.0 m/s, expected at most 12.34"
    )


@pytest.mark.parametrize(("frame_time", "rate"), [("0.0083333", 120), ("0.01", 100), ("0.05", 20)])
def test_jumps_are_counted_in_frames_of_the_file(write, walker_bvh, frame_time, rate):
    at = 4 * rate
    text = shifted(walker_bvh(8 * rate, frame_time), [at], 2.0)
    recording = read_bvh(write("walk.bvh", text), unit_to_m=0.01)
    parts = sound_parts(recording, 45)
    assert len(parts.jumps) == 1
    assert abs(parts.jumps[0] - at) <= max(1, rate / 30)
    (first, second) = parts.ranges
    assert (first[0], second[1]) == (0, 8 * rate)
    for start, stop in parts.ranges:
        assert not start <= at < stop


def test_a_pose_table_takes_no_clip_that_jumps(write, walker_bvh):
    text = shifted(walker_bvh(80), [40], 1.0)
    recording = read_bvh(write("walk.bvh", text), unit_to_m=0.01)
    with pytest.raises(CaptureError, match="walk: jumps at frame 40, the hips move at 30"):
        pose_table([recording])


@pytest.mark.thorough
@pytest.mark.captures
def test_no_real_recording_jumps(captures_dir):
    from mesa_mobility.capture import read_manifest

    loaded = load_clips(read_manifest(captures_dir / "manifest.tsv"), mirrored=False)
    assert loaded.split == []
    assert len(loaded.recordings) > 100
