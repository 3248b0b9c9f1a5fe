"""Wrong usage, bad surroundings and files in the way: one line, status 2, nothing touched."""

import hashlib
import importlib.metadata
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import mesa_mobility
from mesa_mobility.mobility.mapfile import shipped_map_path

REPOSITORY = Path(__file__).parents[2]


def cli(*arguments, **environment):
    return subprocess.run(
        [sys.executable, "-m", "mesa_mobility", *map(str, arguments)],
        capture_output=True,
        text=True,
        env=os.environ | environment,
    )


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["rn"], "No such command 'rn'"),
        (["run"], "Missing argument"),
        (["run", "doorway", "--bogus"], "No such option"),
        (["run", "doorway", "--seed", "x"], "Invalid value for '--seed'"),
        (["run", "doorway", "--seed", "-1"], "Invalid value for '--seed'"),
        (["run", "doorway", "--out", ""], "Invalid value for '--out': got nothing"),
        (["run", "doorway", "--map", " "], "Invalid value for '--map': got nothing"),
        (["map", "build", "x", "-o", ""], "got nothing, expected a path"),
        (["map", "build", "x"], "Missing option"),
        (["map", "nothing"], "No such command 'nothing'"),
        (["dashboard", "--port", "0"], "Invalid value for '--port'"),
        (["run", "doorway", "--set", "pedestrians=1000000000"], "m from walls, at most"),
    ],
)
def test_wrong_usage_is_one_line(command, arguments, message):
    outcome = command(*arguments)
    assert outcome.status == 2
    assert outcome.out == ""
    assert outcome.err.startswith("error: ")
    assert message in outcome.err
    assert len(outcome.err.splitlines()) == 1


def test_a_group_without_a_command_tells_its_commands(command):
    for arguments, word in (([], "verify"), (["map"], "coverage")):
        outcome = command(*arguments)
        assert outcome.status == 2
        assert word in outcome.out


@pytest.mark.parametrize(
    ("name", "value"),
    [("NUMBA_DISABLE_JIT", "1"), ("NUMBA_NUM_THREADS", "0"), ("NUMBA_NUM_THREADS", "two")],
)
def test_surroundings_that_will_not_do(name, value):
    done = cli("run", "straight_walk", "--seconds", 0.1, **{name: value})
    assert done.returncode == 2
    assert done.stderr.startswith(f"error: {name} is ")
    assert len(done.stderr.splitlines()) == 1


@pytest.mark.thorough
def test_pictures_need_no_backend_and_the_summary_tells_where_all_comes_from(tmp_path):
    done = cli(
        "run",
        "straight_walk",
        "--seconds",
        0.2,
        "--set",
        "pedestrians=3",
        "--seed",
        4,
        "--out",
        tmp_path,
        MPLBACKEND="nonsense",
    )
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "occupancy.png").stat().st_size > 1000
    summary = json.loads((tmp_path / "summary.json").read_text())
    digest = hashlib.sha256(shipped_map_path("able_bodied").read_bytes()).hexdigest()
    expected = {
        "parameters": {
            "pedestrians": 3,
            "slowest": 0.9,
            "fastest": 1.5,
            "length": 40.0,
            "frames_per_step": 3,
            "population": None,
        },
        "maps": {"able_bodied": {"file": "able_bodied.npz", "sha256": digest}},
        "mesa_mobility": importlib.metadata.version("mesa-mobility"),
    }
    assert {key: summary[key] for key in expected} == expected
    assert summary["versions"]["numpy"] == importlib.metadata.version("numpy")
    assert [(each["type"], each["people"]) for each in summary["by_type"]] == [("able_bodied", 3)]


@pytest.mark.usefixtures("plugins")
@pytest.mark.parametrize("name", ["summary.json", "floorplan.geojson", "trajectories.png"])
def test_a_folder_in_the_way_of_a_file_is_said_before_the_run(command, tmp_path, name):
    out = tmp_path / "out"
    (out / name).mkdir(parents=True)
    (out / "trajectories.parquet").write_text("of before")
    outcome = command("run", "corridor", "--out", out)
    assert outcome.status == 2
    assert outcome.err == f"error: {out / name}: is a folder, expected a file or nothing there\n"
    assert (out / "trajectories.parquet").read_text() == "of before"
    assert {path.name for path in out.iterdir()} == {name, "trajectories.parquet"}


def test_before_the_first_step_there_are_no_trajectories():
    from mesa_mobility.models import StraightWalk

    from mesa_mobility.errors import ResultsError
    from mesa_mobility.results import Trajectories

    with pytest.raises(ResultsError, match=r"has recorded nothing: expected a step before$"):
        Trajectories.of(StraightWalk(pedestrians=2, record=True, rng=1))


@pytest.mark.thorough
def test_a_checkout_that_is_not_the_one_installed_has_its_models(tmp_path):
    """In the current folder Python finds its package first, without what an install brings."""
    for folder in ("mesa_mobility", "behaviors", "models"):
        shutil.copytree(
            REPOSITORY / folder,
            tmp_path / folder,
            ignore=shutil.ignore_patterns("__pycache__", "*.npz", "*.png"),
        )
    source = (
        "import sys, mesa_mobility\n"
        "sys.meta_path = [each for each in sys.meta_path if 'editable' not in repr(each)]\n"
        "from mesa_mobility.models import Doorway\n"
        "from mesa_mobility.behaviors import Headway\n"
        "behavior = sys.modules[Headway.__module__]\n"
        "print(mesa_mobility.__file__, Doorway.__module__, behavior.__file__)"
    )
    done = subprocess.run(
        [sys.executable, "-c", source], capture_output=True, text=True, cwd=tmp_path
    )
    assert done.stdout.split() == [
        str(tmp_path / "mesa_mobility" / "__init__.py"),
        "mesa_mobility.models.doorway",
        str(tmp_path / "behaviors" / "headway.py"),
    ], done.stderr


def test_the_version():
    assert mesa_mobility.__version__ == importlib.metadata.version("mesa-mobility")


@pytest.mark.thorough
def test_no_worker_more_than_threads_are_allowed(recordings, tmp_path):
    source = (
        "import sys, threading\n"
        "from concurrent import futures\n"
        "made = []\n"
        "class Pool(futures.ThreadPoolExecutor):\n"
        "    def __init__(self, workers=None, **keywords):\n"
        "        made.append(workers)\n"
        "        super().__init__(workers, **keywords)\n"
        "futures.ThreadPoolExecutor = Pool\n"
        "from mesa_mobility.cli import main\n"
        "try: main()\n"
        "except SystemExit as ended: print(ended.code, set(made))"
    )
    arguments = ["map", "build", str(recordings), "-o", str(tmp_path / "m.npz"), "--clusters", "12"]
    done = subprocess.run(
        [sys.executable, "-c", source, *arguments],
        capture_output=True,
        text=True,
        env=os.environ | {"NUMBA_NUM_THREADS": "1"},
    )
    assert done.stdout.splitlines()[-1] == "0 {1}", done.stderr
