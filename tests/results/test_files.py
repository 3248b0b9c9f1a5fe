import json
import math
import signal
import subprocess
import sys

import numpy as np
import pytest

from mesa_mobility.errors import FloorPlanError, ResultsError
from mesa_mobility.floorplan import FloorPlan
from mesa_mobility.results import check_writable, files, plots, read_parquet, run, write_run
from mesa_mobility.results.files import json_text

RUN_FILES = [
    "floorplan.geojson",
    "occupancy.png",
    "summary.json",
    "trajectories.parquet",
    "trajectories.png",
]
SUMMARY = {
    "model": "doorway",
    "preset": "default",
    "seed": 3,
    "egress_s": None,
    "left_inside": 1,
    "min_distance_m": np.float64(0.31),
}


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def test_folders_are_made_as_needed(tmp_path):
    assert check_writable(tmp_path / "a" / "b").is_dir()
    assert names(tmp_path / "a" / "b") == []


def test_a_file_is_no_folder(tmp_path):
    (tmp_path / "taken").write_text("")
    with pytest.raises(ResultsError, match="taken: is not a folder"):
        check_writable(tmp_path / "taken")
    with pytest.raises(ResultsError, match="inside: cannot be written"):
        check_writable(tmp_path / "taken" / "inside")


def test_json_has_plain_numbers_and_null():
    values = {
        "share": np.float32(0.5),
        "count": np.int64(3),
        "flag": np.bool_(True),
        "nothing": math.nan,
        "rows": np.array([[0.0, 2.0]]),
        "pairs": ((1, math.inf),),
    }
    assert json.loads(json_text(values)) == {
        "share": 0.5,
        "count": 3,
        "flag": True,
        "nothing": None,
        "rows": [[0.0, 2.0]],
        "pairs": [[1, None]],
    }
    assert "\n" not in json_text(values)


def test_json_refuses_what_it_cannot_say():
    with pytest.raises(TypeError, match="object"):
        json_text({"thing": object()})


def test_a_run_leaves_five_files(two_leave_one_stays, room, tmp_path):
    folder = tmp_path / "out"
    write_run(folder, summary=SUMMARY, trajectories=two_leave_one_stays, plan=room)
    assert names(folder) == RUN_FILES
    summary = json.loads((folder / "summary.json").read_text())
    assert summary == SUMMARY | {"min_distance_m": 0.31}
    assert read_parquet(folder / "trajectories.parquet").people == 3
    plan = FloorPlan.from_geojson(folder / "floorplan.geojson")
    assert plan.free.equals(room.free)


def test_the_curve_ends_when_the_last_one_leaves(walk, room, tmp_path, monkeypatch):
    drawn = []
    monkeypatch.setattr(plots, "plot_occupancy", lambda curve, path, **_: drawn.extend(curve))
    monkeypatch.setattr(run, "RUN_FILES", ("summary.json",))
    leaving = walk({0: (0, [(1, 1)] * 4)}, frame_rate=2.0, inside_at_end=[])
    write_run(tmp_path, summary={}, trajectories=leaving, plan=room)
    assert drawn == [[0.0, 1], [1.0, 1], [1.5, 0]]


def test_a_second_run_replaces_the_first(two_leave_one_stays, room, tmp_path):
    for seed in (3, 4):
        write_run(
            tmp_path, summary=SUMMARY | {"seed": seed}, trajectories=two_leave_one_stays, plan=room
        )
    assert json.loads((tmp_path / "summary.json").read_text())["seed"] == 4
    assert names(tmp_path) == RUN_FILES


def test_a_run_that_cannot_be_written_leaves_what_was_there(
    two_leave_one_stays, room, tmp_path, monkeypatch
):
    (tmp_path / "summary.json").write_text("before")

    def fail(self, path):
        raise FloorPlanError("no room")

    monkeypatch.setattr(FloorPlan, "write_geojson", fail)
    with pytest.raises(FloorPlanError):
        write_run(tmp_path, summary=SUMMARY, trajectories=two_leave_one_stays, plan=room)
    assert names(tmp_path) == ["summary.json"]
    assert (tmp_path / "summary.json").read_text() == "before"


KILLED = """
import os, signal, sys
from pathlib import Path
from mesa_mobility.results import files

def counted(do):
    def step(*arguments, **keywords):
        global steps
        if steps == 0:
            os.kill(os.getpid(), signal.SIGKILL)
        steps -= 1
        return do(*arguments, **keywords)
    return step

for steps in range(len(sys.argv) - 1):
    if os.fork() == 0:
        break
    _, status = os.wait()
    print(status, flush=True)
else:
    sys.exit()
with files.all_or_none(Path(sys.argv[1 + steps]), ["a", "b", "sealing"]) as temporary:
    for name in ("a", "b", "sealing"):
        (temporary / name).write_text("new")
    os.replace = counted(os.replace)
    Path.unlink = counted(Path.unlink)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="no SIGKILL")
@pytest.mark.parametrize("before", [False, True])
def test_a_folder_that_has_the_last_file_is_whole_whenever_the_writer_is_killed(tmp_path, before):
    folders = [tmp_path / str(steps) for steps in range(5)]
    for folder in folders:
        folder.mkdir()
        if before:
            for name in ("a", "b", "sealing"):
                (folder / name).write_text("old")
    done = subprocess.run([sys.executable, "-c", KILLED, *folders], capture_output=True, text=True)
    # Killed before each of four steps, and not at all.
    assert done.stdout.split() == [*[str(int(signal.SIGKILL))] * 4, "0"], done.stderr
    whole = []
    for folder in folders:
        found = {path.name: path.read_text() for path in folder.iterdir() if path.is_file()}
        whole.append("sealing" in found)
        if whole[-1]:
            assert found in (
                dict.fromkeys(("a", "b", "sealing"), "old"),
                dict.fromkeys(("a", "b", "sealing"), "new"),
            )
    assert whole == [before, False, False, False, True]


def test_the_last_file_of_a_run_is_its_summary(two_leave_one_stays, room, tmp_path, monkeypatch):
    placed = []
    replace = files.os.replace

    def noted(old, new):
        if new.parent == tmp_path:
            placed.append(new.name)
        replace(old, new)

    monkeypatch.setattr(files.os, "replace", noted)
    write_run(tmp_path, summary=SUMMARY, trajectories=two_leave_one_stays, plan=room)
    assert sorted(placed) == RUN_FILES
    assert placed[-1] == "summary.json"
