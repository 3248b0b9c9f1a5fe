import json
import os
import shutil
import signal

import numpy as np
import pytest

from mesa_mobility.bodies import PoseBank
from mesa_mobility.mobility import MobilityMap


def last_line(outcome):
    return json.loads(outcome.out.splitlines()[-1])


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
    assert "skipped short: 40 frames" in outcome.err
    assert MobilityMap.load(path).n_clusters == 12
    # Built by another process, under another name: the same bytes.
    assert path.read_bytes() == map_file.read_bytes()


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


def test_the_map_says_how_it_was_made(command, recordings, map_file):
    answer = last_line(command("map", "info", map_file, "--json"))
    assert answer["command"] == (
        f"mesa-mobility map build {recordings.name} -o able_bodied.npz --type able_bodied "
        "--clusters 12"
    )
    assert {clip["clip"] for clip in answer["provenance"]} == {"slow", "brisk"}


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


def test_what_people_of_a_map_can_do_is_said(command, recordings, map_file):
    outcome = command("map", "info", map_file, "--json")
    answer = last_line(outcome)
    # The figure only walks straight on.
    assert answer["standing"] == (
        "turning on the spot and steps aside and back borrowed from the map 'able_bodied'"
    )
    assert answer["standing"] in outcome.err
    assert min(answer["abilities"]["turn_on_the_spot_deg"]) >= 30
    assert answer["abilities"]["warnings"] == []
    # It walks at 1 and 1.3 m/s, and starts and stops.
    assert 0.9 < answer["walking_speed_m_s"]["p75"] < 1.35


def test_info_for_people_to_read(command, map_file):
    outcome = command("map", "info", map_file)
    assert outcome.status == 0
    lines = [" ".join(line.split()) for line in outcome.out.splitlines()]
    assert "clusters 12" in lines
    assert "build: durations frames 12, 24, 45" in lines
    assert "provenance 2 entries, see --json" in lines


def test_coverage_of_recordings_the_map_was_built_from(command, recordings, map_file):
    outcome = command("map", "coverage", map_file, recordings, "--json")
    answer = last_line(outcome)
    # 270 - 45 poses of two clips have 45 frames to come.
    assert answer["poses"] == 2 * (270 - 45)
    assert set(answer["endpoint_error_m"]) == {"median", "p90", "p95"}
    # Their own movements are among the options.
    assert answer["endpoint_error_m"]["median"] < 0.05
    assert 0.9 < answer["share_within_15cm_20deg"] <= 1.0


def test_coverage_takes_several_recordings(command, recordings, map_file):
    one = last_line(command("map", "coverage", map_file, recordings / "slow.bvh", "--json"))
    both = last_line(
        command(
            "map", "coverage", map_file, recordings / "slow.bvh", recordings / "brisk.bvh", "--json"
        )
    )
    assert (one["poses"], both["poses"]) == (225, 450)


def test_bad_input_is_one_line_and_status_two(command, recordings, map_file, tmp_path):
    (tmp_path / "text.npz").write_text("no map")
    (tmp_path / "none.bvh").write_text("")
    (tmp_path / "taken").write_text("mine")
    output = ("-o", tmp_path / "new.npz")
    for arguments, where in (
        (("info", tmp_path / "text.npz"), "text.npz: "),
        (("info", tmp_path / "absent.npz"), "absent.npz: "),
        (("coverage", tmp_path / "text.npz", recordings), "text.npz: "),
        (("coverage", map_file, tmp_path / "none.bvh"), "none.bvh: "),
        (("coverage", map_file, tmp_path / "absent"), "absent: "),
        (("build", tmp_path / "absent", *output), "absent: "),
        (("build", tmp_path / "none.bvh", *output), "none.bvh: "),
        (("build", recordings, "-o", tmp_path), "is a folder, expected a file"),
        (("build", recordings, "-o", tmp_path / "taken" / "new.npz"), "taken: is not a folder"),
    ):
        outcome = command("map", *arguments)
        assert outcome.status == 2, arguments
        assert outcome.err.startswith("error: "), arguments
        assert where in outcome.err, arguments
        assert len(outcome.err.splitlines()) == 1, arguments
        assert outcome.out == "", arguments
    assert sorted(path.name for path in tmp_path.iterdir()) == ["none.bvh", "taken", "text.npz"]


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


def test_nothing_but_recordings_that_jump_is_one_line(command, recordings, tmp_path):
    lines = (recordings / "short.bvh").read_text().splitlines()
    lines[-20] = "1.0" + lines[-20].removeprefix("0")
    (tmp_path / "short.bvh").write_text("\n".join(lines))
    outcome = command("map", "build", tmp_path / "short.bvh", "-o", tmp_path / "a.npz")
    assert outcome.status == 2
    assert len(outcome.err.splitlines()) == 1
    assert "short cannot be used: jumps at frame 20 of short.bvh" in outcome.err


def rows_of(recordings):
    lines = (recordings / "slow.bvh").read_text().splitlines()
    first = lines.index("MOTION") + 3
    return lines[: first - 2], lines[first - 1], lines[first:]


@pytest.mark.parametrize(
    ("rows", "says"),
    [
        # A T-pose held for 9 s: the arms are no part of the figure, the legs are straight.
        (lambda rows: rows[:1] * 270, "nobody walks: they get 0.00 m far within 1.5 s"),
        (
            lambda rows: rows[90:180],
            "3.0 s of recordings: expected at least 5 s of people",
        ),
        # The first 2 s, in which the figure stands, three times.
        (lambda rows: rows[:60] * 3, "nobody walks: they get"),
        (lambda rows: rows[:44], "slow cannot be used: 44 frames at 30 Hz, 45 needed"),
    ],
)
def test_too_little_movement_is_one_line(command, recordings, tmp_path, rows, says):
    head, time, motion = rows_of(recordings)
    motion = rows(motion)
    text = "\n".join([*head, f"Frames: {len(motion)}", time, *motion])
    (tmp_path / "slow.bvh").write_text(text)
    outcome = command("map", "build", tmp_path / "slow.bvh", "-o", tmp_path / "a.npz")
    assert outcome.status == 2
    assert len(outcome.err.splitlines()) == 1
    assert says in outcome.err
    assert not (tmp_path / "a.npz").exists()


def test_control_c_while_building_leaves_nothing(command, recordings, tmp_path, monkeypatch):
    def pose_table(recordings, progress=None):
        os.kill(os.getpid(), signal.SIGINT)
        progress(1, 2)
        raise AssertionError("went on after the next report of progress")

    monkeypatch.setattr("mesa_mobility.mobility.build.pose_table", pose_table)
    outcome = command("map", "build", recordings, "-o", tmp_path / "new.npz")
    assert outcome.status == 130
    assert outcome.err.endswith("interrupted: nothing written\n")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "arguments", [["build", "x"], ["build", "x", "-o", "y", "--clusters", "1"], ["nothing"]]
)
def test_wrong_usage_has_status_two(command, arguments):
    assert command("map", *arguments).status == 2


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("kept", "choices", "frames"),
    [
        ("stored", ("--no-mirror",), 270),
        ("distribution", ("--other-side", "--name", "other"), 270),
        # Times x 118 / 121: 269 intervals become 262.
        ("distribution", ("--derive", "older_adult"), 263),
    ],
)
def test_poses_of_a_built_map_are_those_of_its_file(
    command, recordings, tmp_path, kept, choices, frames
):
    path, later = tmp_path / "a.npz", tmp_path / "later.poses.npz"
    build = ("map", "build", recordings, "-o", path, "--clusters", 12, "--options", kept)
    outcome = command(*build, *choices, "--poses")
    assert outcome.status == 0, outcome.err
    bank = PoseBank.load(tmp_path / "a.poses.npz")
    bank.check_map(MobilityMap.load(path).digest)
    assert bank.n_options == MobilityMap.load(path).n_options
    assert len(bank.rotations) == 2 * frames
    outcome = command("map", "poses", path, recordings, "-o", later)
    assert outcome.status == 0, outcome.err
    assert later.read_bytes() == (tmp_path / "a.poses.npz").read_bytes()
