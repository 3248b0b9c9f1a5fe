"""Processes that run an experiment: killed, two at a time, watched, out of disk space."""

import json
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from mesa_mobility.errors import ResultsError
from mesa_mobility.experiments import open_store, run_experiment
from tests.fixtures.experiments.quick import quick

ROOT = Path(__file__).parents[2]

# Many processes, which take minutes and count on a machine that is not loaded.
pytestmark = pytest.mark.slow


DRIVER = """
import json
import sys
from mesa_mobility.experiments import Experiment, run_experiment
if __name__ == "__main__":
    experiment = Experiment(
        "tests.fixtures.experiments.models:Quick", json.loads(sys.argv[3]), seed=5,
        replications=10, fixed=json.loads(sys.argv[4]),
    )
    run_experiment(experiment, sys.argv[1], executor=sys.argv[2], workers=2)
"""


SLOW = {"end": "slow"}


X = {"x": [0.0, 1.5, 3.0]}


def driver(tmp_path, store, executor, fixed=SLOW, parameters=X, **keywords):
    script = tmp_path / "driver.py"
    script.write_text(DRIVER)
    return subprocess.Popen(
        [
            sys.executable,
            str(script),
            str(store),
            executor,
            json.dumps(parameters),
            json.dumps(fixed),
        ],
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        stderr=subprocess.PIPE,
        text=True,
        **keywords,
    )


def wait_until(condition):
    for _ in range(1200):
        if condition():
            return
        time.sleep(0.05)
    raise AssertionError("not in time")


def wait_for_rows(store, count):
    wait_until(
        lambda: list(store.glob("runs/*.parquet")) and open_store(store).status()["done"] >= count
    )


@pytest.fixture(scope="module")
def slow_rows(tmp_path_factory):
    store = tmp_path_factory.mktemp("slow") / "s"
    experiment = quick(10, fixed={"end": "slow"})
    return run_experiment(experiment, store, executor="processes", workers=2)


def test_a_driver_that_is_killed(rows, tmp_path):
    path, mark = tmp_path / "s", tmp_path / "mark"
    # Half of the runs do not end before the driver is killed, however slow the machine is.
    fixed, parameters = {"mark": str(mark)}, {"end": ["well", "wait"], "x": [0.0, 1.5, 3.0]}
    experiment = quick(10, parameters=parameters, fixed=fixed)
    first = driver(tmp_path, path, "processes", fixed, parameters)
    wait_for_rows(path, 5)
    first.send_signal(signal.SIGKILL)
    first.wait()
    had = open_store(path).frame().set_index("run").began
    assert 5 <= len(had) <= 30
    assert not open_store(path).status()["running"]
    mark.touch()
    store = run_experiment(experiment, path, workers=2)
    assert store.status()["done"] == len(store.frame()) == 60
    alone = run_experiment(experiment, tmp_path / "alone", executor="serial")
    assert rows(store) == rows(alone)
    # What had finished was not run again.
    assert (store.frame().set_index("run").began[had.index] == had).all()
    assert list(Path(store.folder.path("work")).glob("*")) == []


def test_a_second_driver_is_refused(rows, tmp_path):
    path, mark = tmp_path / "s", tmp_path / "mark"
    # The first one goes on until it is let go, however slow the machine is.
    fixed = {"end": "wait", "mark": str(mark)}
    experiment = quick(10, fixed=fixed)
    first = driver(tmp_path, path, "processes", fixed)
    try:
        wait_until((path / "experiment.json").exists)
        assert open_store(path).status()["running"]
        with pytest.raises(ResultsError, match="another process is running this experiment"):
            run_experiment(experiment, path, executor="serial")
    finally:
        mark.touch()
    assert first.wait(timeout=120) == 0, first.stderr.read()
    assert not open_store(path).status()["running"]
    alone = run_experiment(experiment, tmp_path / "t", executor="serial")
    assert rows(open_store(path)) == rows(alone)


def test_those_who_only_look_are_in_nobodys_way(tmp_path):
    path, stop, seen = tmp_path / "s", threading.Event(), []
    run_experiment(quick(1), path, executor="serial")
    store = open_store(path)

    def look():
        while not stop.wait(0.001):
            seen.append(store.is_locked())

    lookers = [threading.Thread(target=look) for _ in range(2)]
    for each in lookers:
        each.start()
    time.sleep(0.5)
    assert not any(seen)
    for replications in range(2, 6):
        run_experiment(quick(replications), path, executor="serial")
    stop.set()
    for each in lookers:
        each.join()
    assert store.status()["done"] == 15


def test_two_drivers_at_once_where_there_are_no_locks(slow_rows, rows, tmp_path, monkeypatch):
    from contextlib import contextmanager

    from mesa_mobility.experiments import Store

    @contextmanager
    def unlocked(self):
        yield

    monkeypatch.setattr(Store, "locked", unlocked)
    path = tmp_path / "s"
    path.mkdir()
    experiment = quick(10, fixed={"end": "slow"})
    threads = [
        threading.Thread(target=run_experiment, args=(experiment, path), kwargs={"workers": 1})
        for _ in range(2)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert rows(open_store(path)) == rows(slow_rows)


def test_a_disk_without_room_is_one_line_and_nothing_finished_is_lost(slow_rows, rows, tmp_path):
    def little_room():
        import resource

        # No file may grow beyond this: the definition fits, a journal of ten runs does not.
        resource.setrlimit(resource.RLIMIT_FSIZE, (2300, 2300))

    path = tmp_path / "s"
    first = driver(tmp_path, path, "serial", preexec_fn=little_room)
    _, error = first.communicate(timeout=120)
    assert first.returncode == 1
    last = error.splitlines()[-1]
    assert "ResultsError" in last
    assert "cannot be written: File too large" in last
    store = run_experiment(quick(10, fixed={"end": "slow"}), path, workers=2)
    assert rows(store) == rows(slow_rows)


UNGUARDED = "\n".join(
    line.removeprefix("    ") for line in DRIVER.splitlines() if "__main__" not in line
)


def test_a_script_without_a_guard_is_told_so(tmp_path):
    script = tmp_path / "script.py"
    script.write_text(UNGUARDED)
    done = subprocess.run(
        [
            sys.executable,
            str(script),
            str(tmp_path / "s"),
            "processes",
            json.dumps(X),
            json.dumps(SLOW),
        ],
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert done.returncode == 1
    assert "its script calls run_experiment when it is imported" in done.stderr.splitlines()[-1]
