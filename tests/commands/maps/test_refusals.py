"""What `mesa-mobility map` refuses, in one line, and Ctrl-C while it builds."""

import os
import signal

import pytest

from tests.commands.maps.conftest import rows_of


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


def test_nothing_but_recordings_that_jump_is_one_line(command, recordings, tmp_path):
    lines = (recordings / "short.bvh").read_text().splitlines()
    lines[-20] = "1.0" + lines[-20].removeprefix("0")
    (tmp_path / "short.bvh").write_text("\n".join(lines))
    outcome = command("map", "build", tmp_path / "short.bvh", "-o", tmp_path / "a.npz")
    assert outcome.status == 2
    assert len(outcome.err.splitlines()) == 1
    assert "short cannot be used: jumps at frame 20 of short.bvh" in outcome.err


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
    # Unit and height come first: with a wrong unit, nobody walks.
    [line] = [each for each in outcome.err.splitlines() if each.startswith("error: ")]
    assert says in line
    assert outcome.err.splitlines()[-1] == line
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
