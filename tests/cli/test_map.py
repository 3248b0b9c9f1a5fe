import json
import os
import shutil
import signal

import pytest

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


def test_the_map_says_how_it_was_made(command, recordings, map_file):
    answer = last_line(command("map", "info", map_file, "--json"))
    assert answer["command"] == (
        f"mesa-mobility map build {recordings.name} -o able_bodied.npz --type able_bodied "
        "--clusters 12"
    )
    assert {clip["clip"] for clip in answer["provenance"]} == {"slow", "brisk"}


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
        (lambda rows: rows[:1] * 90, "nobody moves in the 180 poses of 2 clips"),
        # 3 s of walking.  The figure stands in the first 2 s of 9 and in the last 2.
        (
            lambda rows: rows[90:180],
            "that lead to each other and back: expected recordings that show people both standing",
        ),
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
