"""Ctrl-C at any time ends a command with status 130, or lets it finish.

`MESA_MOBILITY_INTERRUPTS` says how often the slow ones press it (20).
"""

import json
import os
import random
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import pytest

from tests.fixtures.interrupting import check_run, interrupted

OFTEN = int(os.environ.get("MESA_MOBILITY_INTERRUPTS", "20"))

pytestmark = pytest.mark.skipif(os.name != "posix", reason="terminals send Ctrl-C otherwise")


def some_times(seed, n, low, high):
    draw = random.Random(seed)
    return [draw.uniform(low, high) for _ in range(n)]


def two_at_a_time(press, times):
    """Call ``press`` with the number of each time and the time; most of it is waiting."""
    with ThreadPoolExecutor(2) as pool:
        for _ in pool.map(press, range(len(times)), times):
            pass


@pytest.mark.thorough
@pytest.mark.parametrize("after", some_times(1, 3, 0.0, 2.5))
def test_at_some_time(after, tmp_path):
    arguments = ["run", "straight_walk", "--seconds", 2, "--out", tmp_path / "out"]
    check_run(interrupted(arguments, after), tmp_path / "out")


@pytest.mark.slow
@pytest.mark.parametrize("threads", [1, 2])
def test_in_the_first_seconds(threads, tmp_path):
    def press(k, after):
        folder = tmp_path / str(k)
        arguments = ["run", "auditorium", "--seconds", 3, "--out", folder]
        check_run(interrupted(arguments, after, threads=threads), folder)

    two_at_a_time(press, some_times(threads, OFTEN, 0.0, 2.0))


@pytest.mark.slow
def test_while_a_model_is_made_and_run(tmp_path):
    def press(k, after):
        folder = tmp_path / str(k)
        arguments = ["run", "auditorium", "--seconds", 3, "--out", folder]
        check_run(interrupted(arguments, after, times=1 + k % 3), folder)

    two_at_a_time(press, some_times(3, OFTEN, 0.3, 3.0))


@pytest.mark.slow
def test_while_everything_is_compiled(tmp_path):
    """The compiler keeps the main thread for seconds."""
    for k, after in enumerate(some_times(4, max(3, OFTEN // 5), 1.0, 12.0)):
        cache = {"NUMBA_CACHE_DIR": str(tmp_path / f"cache {k}")}
        folder = tmp_path / str(k)
        arguments = ["run", "straight_walk", "--seconds", 2, "--out", folder]
        check_run(interrupted(arguments, after, environment=cache), folder)


@pytest.mark.slow
@pytest.mark.parametrize(
    "arguments",
    [
        ["verify", "rimea-01", "rimea-04", "--jobs", "2"],
        ["validate", "walking", "--jobs", "2"],
        ["dashboard", "straight_walk", "--port", "18765"],
    ],
)
def test_other_commands(arguments, tmp_path):
    for after in some_times(5, max(4, OFTEN // 4), 0.0, 8.0):
        ended = interrupted(arguments, after)
        assert ended.status in (0, 1, 130), ended
        assert "Traceback" not in ended.err
        assert (ended.status == 130) == ended.err.endswith("interrupted: nothing written\n"), ended


@pytest.mark.slow
def test_building_a_map(recordings, tmp_path):
    for k, after in enumerate(some_times(6, max(4, OFTEN // 4), 0.0, 6.0)):
        folder = tmp_path / str(k)
        ended = interrupted(
            ["map", "build", recordings, "-o", folder / "new.npz", "--clusters", 12], after
        )
        assert ended.status in (0, 130), ended
        assert "Traceback" not in ended.err
        found = [path.name for path in folder.iterdir()] if folder.exists() else []
        assert found in ([], ["new.npz"])
        if ended.status == 0 or ended.err.endswith("interrupted: nothing written\n"):
            assert (ended.status == 0) == (found == ["new.npz"])


PRESS = "import signal; press = lambda *_: os.kill(os.getpid(), signal.SIGINT)\n"


@pytest.mark.thorough
def test_a_second_one_stops_at_once_and_writes_nothing(tmp_path):
    prepare = PRESS + (
        "from mesa_mobility import results\n"
        "results.check_safety = lambda *_, **__: (press(), press())"
    )
    arguments = ["run", "straight_walk", "--seconds", 0.2, "--out", tmp_path / "out"]
    ended = interrupted(arguments, 0.0, times=0, prepare=prepare)
    assert ended.status == 130
    assert ended.err.endswith("interrupted: nothing written\n")
    assert list((tmp_path / "out").iterdir()) == []


@pytest.mark.parametrize("loaded", ["cli", "interrupts", "commands"])
def test_while_the_command_is_loaded(loaded):
    source = (
        "import os, runpy, signal, sys\n"
        "class Press:\n"
        "    def find_spec(name, path, target=None):\n"
        f"        if name == 'mesa_mobility.{loaded}': os.kill(os.getpid(), signal.SIGINT)\n"
        "sys.meta_path.insert(0, Press)\n"
        "runpy.run_module('mesa_mobility', run_name='__main__')"
    )
    ended = subprocess.run([sys.executable, "-c", source, "models"], capture_output=True, text=True)
    assert (ended.returncode, ended.stderr) == (130, "interrupted: nothing written\n")


def test_while_a_model_is_looked_for(tmp_path):
    prepare = PRESS + "from mesa_mobility.plugins import registry\nregistry.load_model = press"
    ended = interrupted(["run", "straight_walk"], 0.0, times=0, prepare=prepare)
    assert (ended.status, ended.err) == (130, "interrupted: nothing written\n")


@pytest.mark.thorough
def test_while_files_are_put_in_place_all_of_them_are(tmp_path):
    prepare = PRESS + (
        "from mesa_mobility.results import files\n"
        "class Os:\n"
        "    def __getattr__(self, name): return getattr(os, name)\n"
        "    def replace(self, old, new):\n"
        "        if '.writing-' not in str(new): press(); press()\n"
        "        os.replace(old, new)\n"
        "files.os = Os()"
    )
    arguments = ["run", "straight_walk", "--seconds", 0.2, "--out", tmp_path, "--json"]
    ended = interrupted(arguments, 0.0, times=0, prepare=prepare)
    assert ended.err.endswith("interrupted\n")
    check_run(ended, tmp_path)
    assert json.loads((tmp_path / "summary.json").read_text())["pedestrians"] == 50


def test_the_compiler_does_not_put_it_off():
    """A lock that is taken twice holds the main thread for ever, as the compiler does for long."""
    prepare = (
        "import ctypes\n"
        "from mesa_mobility.plugins import registry\n"
        "lock, take = ctypes.create_string_buffer(128), ctypes.CDLL(None).pthread_mutex_lock\n"
        "registry.load_model = lambda name: (take(lock), take(lock))"
    )
    ended = interrupted(["run", "straight_walk"], 1.0, prepare=prepare)
    assert (ended.status, ended.err) == (130, "interrupted: nothing written\n")
