"""`mesa-mobility map build`: what it writes and says."""

import json
import shutil

import numpy as np
import pytest

from mesa_mobility.mobility import MobilityMap
from tests.commands.maps.conftest import last_line, rows_of


def test_build_writes_a_map_and_says_what_is_in_it(command, recordings, map_file, tmp_path):
    path = tmp_path / "again.npz"
    outcome = command(
        "map", "build", recordings, "-o", path, "--clusters", 12, "--type", "able_bodied", "--json"
    )
    assert outcome.status == 0, outcome.err
    assert len(outcome.out.splitlines()) == 1
    answer = last_line(outcome)
    # Two clips of 270 frames, each with its mirror image.
    expected = {"recordings": 4, "clusters": 12, "pedestrian_type": "able_bodied"}
    assert {key: answer[key] for key in expected} == expected
    assert answer["build"]["poses"] == 4 * 270
    assert answer["skipped"] == [["short", "40 frames at 30 Hz, 45 needed"]]
    # Hips 0.9 m above the origin; the toes end 0.96 m below them.
    assert answer["recorded"]["clips"] == 2
    assert answer["recorded"]["units"] == {"1 m (metre), guessed": 2}
    assert answer["recorded"]["frames_a_second"] == {"30": 2}
    assert answer["recorded"]["heights_m"] == {"person 1": pytest.approx(0.96, abs=0.03)}
    assert "2 clips of 1 person, 0.9" in outcome.err
    assert "unit of length: 1 m (metre), guessed" in outcome.err.splitlines()
    assert "skipped short: 40 frames" in outcome.err
    assert MobilityMap.load(path).n_clusters == 12
    # Built by another process, under another name: the same but for the examination.
    with np.load(path) as one, np.load(map_file) as other:
        arrays = {name: one[name].tobytes() for name in one.files if name != "metadata"}
        assert arrays == {name: other[name].tobytes() for name in arrays}
        metadata = [json.loads(bytes(each["metadata"])) for each in (one, other)]
    for each in metadata:
        each.pop("examination")
    assert metadata[0] == metadata[1]


def test_mirror_images_can_be_left_out(command, recordings, tmp_path):
    path = tmp_path / "plain.npz"
    outcome = command(
        "map", "build", recordings, "-o", path, "--clusters", 12, "--no-mirror", "--json"
    )
    assert last_line(outcome)["build"]["poses"] == 2 * 270


def test_the_other_side_alone_turns_the_other_way(command, recordings, map_file, tmp_path):
    path = tmp_path / "other.npz"
    outcome = command("map", "build", recordings, "-o", path, "--other-side", "--json")
    answer = last_line(outcome)
    assert answer["recordings"] == 2
    assert answer["preparation"]["mirrored"] == "mirror images alone"
    left_out = answer["clips_left_out_one_at_a_time"]
    assert [clip["clip"] for clip in left_out["clips"]] == ["brisk", "slow"]
    assert answer["command"].endswith("--other-side")
    both = command("map", "build", recordings, "-o", path, "--other-side", "--mirror")
    assert both.status == 2


def test_a_map_that_cannot_be_judged_is_written(command, recordings, tmp_path):
    """Without the walk, somebody who only stands is left: no map, but with it there is one."""
    folder = tmp_path / "recordings"
    folder.mkdir()
    shutil.copy(recordings / "slow.bvh", folder)
    head, time, motion = rows_of(recordings)
    (folder / "still.bvh").write_text("\n".join([*head, "Frames: 60", time, *motion[:60]]))
    outcome = command("map", "build", folder, "-o", tmp_path / "a.npz", "--json")
    assert outcome.status == 0, outcome.err
    assert "clips are not left out one at a time: without slow: 2.0 s of" in outcome.err
    assert "clips_left_out_one_at_a_time" not in last_line(outcome)
    assert MobilityMap.load(tmp_path / "a.npz").n_options > 0


@pytest.mark.thorough
def test_a_derived_type_says_what_it_is_derived_from(command, recordings, tmp_path):
    path = tmp_path / "child.npz"
    outcome = command("map", "build", recordings, "-o", path, "--derive", "child")
    assert outcome.status == 0, outcome.err
    made = MobilityMap.load(path)
    assert made.pedestrian_type == "child"
    assert made.metadata["derived"]["from"] == "able_bodied"
    assert made.metadata["derived"]["length_factor"] == pytest.approx(1.25 / 1.75, abs=1e-4)
    assert made.metadata["body"]["core_radius_m"] == pytest.approx(0.128)
    assert made.metadata["command"].endswith("-o child.npz --derive child")
    figures = last_line(command("map", "coverage", path, recordings, "--leave-one-out", "--json"))
    assert [clip["clip"] for clip in figures["clips"]] == ["brisk", "slow"]
    assert 0.0 <= figures["precision"] <= 1.0
    both = command("map", "build", recordings, "-o", path, "--derive", "child", "--type", "slow")
    assert both.status == 2
    unknown = command("map", "build", recordings, "-o", path, "--derive", "giant")
    assert unknown.err == (
        "error: no derived type 'giant', expected one of child, older_adult, "
        "frail_older_adult, cane, crutches, walking_frame, wheelchair_manual, wheelchair_powered, "
        "wheelchair_assisted\n"
    )


@pytest.mark.thorough
def test_a_distribution_of_options_is_the_same_map_from_a_smaller_file(
    command, recordings, map_file, tmp_path
):
    path, again = tmp_path / "small.npz", tmp_path / "again.npz"
    options = ("--clusters", 12, "--options", "distribution")
    for file in (path, again):
        outcome = command("map", "build", recordings, "-o", file, *options)
        assert outcome.status == 0, outcome.err
    assert path.read_bytes() == again.read_bytes()
    assert path.stat().st_size <= map_file.stat().st_size / 5
    whole, read = MobilityMap.load(map_file), MobilityMap.load(path)
    np.testing.assert_array_equal(read.paths, whole.paths)
    np.testing.assert_array_equal(read.offsets, whole.offsets)
    assert read.metadata["command"] == whole.metadata["command"] + " --options distribution"
    figures = [
        last_line(command("map", "coverage", file, recordings, "--json"))
        for file in (map_file, path)
    ]
    assert {**figures[0], "file": ""} == {**figures[1], "file": ""}


def test_a_type_can_be_given_a_name(command, recordings, tmp_path):
    path = tmp_path / "a.npz"
    outcome = command("map", "build", recordings, "-o", path, "--name", "limping_left")
    assert outcome.status == 0, outcome.err
    made = MobilityMap.load(path)
    assert made.pedestrian_type == "limping_left"
    assert made.metadata["command"].endswith(
        "-o limping_left.npz --type able_bodied --name limping_left"
    )


def test_wheelchairs_need_no_recordings(command, recordings, tmp_path):
    path = tmp_path / "wheelchair.npz"
    outcome = command("map", "build", "--derive", "wheelchair_manual", "-o", path, "--json")
    assert outcome.status == 0, outcome.err
    assert last_line(outcome)["preferred_speed_m_s"]["mean"] == 0.69
    assert MobilityMap.load(path).metadata["command"] == (
        "mesa-mobility map build --derive wheelchair_manual -o wheelchair_manual.npz"
    )
    superfluous = ("map", "build", recordings, "--derive", "wheelchair_manual", "-o", path)
    for arguments in (superfluous, ("map", "build", "-o", path)):
        outcome = command(*arguments)
        assert outcome.status == 2
        assert len(outcome.err.splitlines()) == 1


@pytest.mark.thorough
def test_a_recording_that_jumps_is_split_and_said(command, recordings, tmp_path):
    folder = tmp_path / "recordings"
    shutil.copytree(recordings, folder)
    lines = (folder / "slow.bvh").read_text().splitlines()
    row = lines.index("MOTION") + 3 + 200
    lines[row] = "1.0" + lines[row].removeprefix("0")
    (folder / "slow.bvh").write_text("\n".join(lines))
    outcome = command("map", "build", folder, "-o", tmp_path / "a.npz", "--clusters", 12, "--json")
    assert outcome.status == 0, outcome.err
    # The figure stands or walks at 1 m/s; 1 m aside and back at 30 Hz.
    said = "jumps at frame 200 of slow.bvh, where the hips move at 30.0 m/s, expected at most 12.34"
    assert f"split slow: {said}" in outcome.err.splitlines()
    answer = last_line(outcome)
    assert answer["split"] == [["slow", said]]
    names = [entry["clip"] for entry in answer["provenance"]]
    assert names == ["brisk", "slow[0:199]", "slow[202:270]"]
