"""Runs of an experiment: the same rows whatever runs them, and whatever goes wrong."""

import json
import os
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pyarrow.dataset as dataset
import pytest

from mesa_mobility.errors import ModelError, ResultsError
from mesa_mobility.experiments import Experiment, Grid, open_store, run_experiment
from mesa_mobility.experiments.points import point_key, seed_of_run
from tests.fixtures.experiment_models import Quick

# Many processes, which take minutes and count on a machine that is not loaded.
pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]
QUICK = "tests.fixtures.experiment_models:Quick"


def quick(replications=4, **keywords):
    given = {"parameters": {"x": [0.0, 1.5, 3.0]}, "seed": 5, "replications": replications}
    return Experiment(keywords.pop("model", QUICK), **{**given, **keywords})


@pytest.fixture(scope="module")
def serial(tmp_path_factory):
    return run_experiment(quick(), tmp_path_factory.mktemp("serial") / "s", executor="serial")


def test_a_row_has_parameters_seed_times_and_figures(serial):
    frame = serial.frame()
    assert list(frame.x) == [0.0] * 4 + [1.5] * 4 + [3.0] * 4
    assert list(frame.replication) == [0, 1, 2, 3] * 3
    assert set(frame.status) == {"done"}
    first = frame.iloc[0]
    assert first.seed == seed_of_run(5, point_key({"x": 0.0}), 0)
    # The same model, made by hand.
    model = Quick(x=0.0, rng=int(first.seed))
    assert first.y == model.summary()["y"]
    assert first.wall_s >= 0.0
    # A figure that has the name of a parameter has another one here.
    assert list(frame.summary_x) == list(frame.x)


def test_arrow_reads_the_folder_as_it_is(serial):
    table = dataset.dataset(serial.folder.path("runs"), format="parquet").to_table()
    assert table.num_rows == 12
    assert str(table.schema.field("y").type) == "double"


@pytest.mark.parametrize("executor", ["processes", "threads", "dask", "client", "address"])
def test_the_same_rows_from_every_executor(executor, serial, rows, tmp_path, request):
    def run(given):
        return run_experiment(quick(), tmp_path / "s", executor=given, workers=2)

    if executor == "threads":
        with ThreadPoolExecutor(2) as pool:
            store = run(pool)
    elif executor == "processes":
        store = run(executor)
    else:
        cluster = request.getfixturevalue("dask_cluster")
        if executor == "client":
            from distributed import Client

            with Client(cluster) as client:
                store = run(client)
        else:
            store = run(cluster if executor == "dask" else cluster.scheduler_address)
    assert rows(store) == rows(serial)


def test_the_same_rows_in_another_order(serial, rows, tmp_path):
    backwards = quick(parameters={"x": [3.0, 0.0, 1.5]})
    assert rows(run_experiment(backwards, tmp_path / "s", executor="serial")) == rows(serial)


def test_interrupted_and_gone_on(serial, rows, tmp_path):
    class Enough(Exception):
        pass

    def stop(progress):
        if progress.ended >= 5:
            raise Enough

    with pytest.raises(Enough):
        run_experiment(quick(), tmp_path / "s", executor="serial", progress=stop)
    assert 5 <= open_store(tmp_path / "s").status()["done"] < 12
    totals = []
    store = run_experiment(
        quick(), tmp_path / "s", executor="serial", progress=lambda now: totals.append(now.total)
    )
    assert totals[0] < 12
    assert rows(store) == rows(serial)


def test_only_what_is_added_is_run(serial, rows, tmp_path):
    run_experiment(quick(2), tmp_path / "s", executor="serial")
    before = open_store(tmp_path / "s").frame().set_index("run").began
    ended = []
    store = run_experiment(
        quick(4), tmp_path / "s", executor="serial", progress=lambda now: ended.append(now.total)
    )
    assert ended[-1] == 6
    assert rows(store) == rows(serial)
    after = store.frame().set_index("run").began
    assert (after[before.index] == before).all()
    more = quick(4, parameters={"x": [0.0, 1.5, 2.0, 3.0]})
    run_experiment(more, tmp_path / "s", executor="serial",
                   progress=lambda now: ended.append(now.total))  # fmt: skip
    assert ended[-1] == 4
    assert store.status()["done"] == 16
    assert store.status()["missing"] == 0


@pytest.mark.parametrize("executor", ["serial", "processes"])
def test_a_run_that_raises_is_a_row(executor, tmp_path):
    ends = Grid({"end": ["well", "raise", "exit"]})
    store = run_experiment(quick(2, parameters=ends), tmp_path / "s", executor=executor, workers=1)
    frame = store.frame().set_index(["end", "replication"])
    assert list(frame.status) == ["done"] * 2 + ["failed"] * 4
    assert frame.error["raise", 0] == "ValueError: a step that fails"
    assert frame.error["exit", 1] == "SystemExit: 3"
    assert store.status()["missing"] == 0


def test_a_run_whose_steps_do_not_end(tmp_path):
    experiment = quick(1, parameters={"end": ["endless", "well"]}, time_limit=0.3)
    store = run_experiment(experiment, tmp_path / "s", executor="serial")
    frame = store.frame()
    assert list(frame.status) == ["timed_out", "done"]
    assert frame.error[0] == "took longer than 0.3 s"
    assert 0.3 < frame.wall_s[0] < 5.0


@pytest.mark.parametrize("executor", ["processes", "dask"])
def test_a_step_that_never_comes_back(executor, tmp_path, request):
    given = request.getfixturevalue("dask_cluster") if executor == "dask" else executor
    experiment = quick(1, parameters={"end": ["well", "stuck", "raise"]}, time_limit=0.5)
    store = run_experiment(experiment, tmp_path / "s", executor=given, workers=1)
    frame = store.frame()
    assert list(frame.status) == ["done", "timed_out", "failed"]
    assert "without an end to its step" in frame.error[1]


@pytest.mark.parametrize("executor", ["processes", "dask"])
def test_a_worker_that_is_killed(executor, rows, tmp_path, request):
    given = request.getfixturevalue("dask_cluster") if executor == "dask" else executor
    mark = tmp_path / "mark"
    point = {"end": "die once", "mark": str(mark)}
    experiment = quick(3, parameters={"x": [0.0, 1.0]}, fixed=point)
    store = run_experiment(experiment, tmp_path / "s", executor=given, workers=2)
    assert mark.exists()
    assert store.status()["done"] == 6
    again = run_experiment(experiment, tmp_path / "again", executor="serial")
    assert rows(store) == rows(again)


def test_a_run_that_kills_its_workers_is_a_row(tmp_path):
    experiment = quick(2, parameters={"end": ["die", "well"]})
    store = run_experiment(experiment, tmp_path / "s", executor="processes", workers=2)
    frame = store.frame()
    assert list(frame.status) == ["failed", "failed", "done", "done"]
    assert all("workers died during this run" in error for error in frame.error[:2])


DRIVER = """
import json
import sys
from mesa_mobility.experiments import Experiment, run_experiment
if __name__ == "__main__":
    experiment = Experiment(
        "tests.fixtures.experiment_models:Quick", {"x": [0.0, 1.5, 3.0]}, seed=5,
        replications=10, fixed=json.loads(sys.argv[3]),
    )
    run_experiment(experiment, sys.argv[1], executor=sys.argv[2], workers=2)
"""


SLOW = {"end": "slow"}


def driver(tmp_path, store, executor, fixed=SLOW, **keywords):
    script = tmp_path / "driver.py"
    script.write_text(DRIVER)
    return subprocess.Popen(
        [sys.executable, str(script), str(store), executor, json.dumps(fixed)],
        env=os.environ | {"PYTHONPATH": str(ROOT)}, stderr=subprocess.PIPE, text=True, **keywords,
    )  # fmt: skip


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


def test_a_driver_that_is_killed(slow_rows, rows, tmp_path):
    path = tmp_path / "s"
    first = driver(tmp_path, path, "processes")
    wait_for_rows(path, 5)
    first.send_signal(signal.SIGKILL)
    first.wait()
    had = open_store(path).frame().set_index("run").began
    assert 5 <= len(had) < 30
    assert not open_store(path).status()["running"]
    store = run_experiment(quick(10, fixed={"end": "slow"}), path, workers=2)
    assert rows(store) == rows(slow_rows)
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


def test_a_store_of_another_experiment_is_refused(serial):
    with pytest.raises(ModelError, match="holds runs with seed 5, got 6; expected another store"):
        run_experiment(quick(seed=6), serial.folder.url, executor="serial")


def test_memory_as_an_fsspec_url(serial, rows):
    import fsspec

    try:
        store = run_experiment(quick(), "memory://experiment", executor="serial")
        assert rows(store) == rows(serial)
    finally:
        fsspec.filesystem("memory").rm("/experiment", recursive=True)


def test_workers_that_come_later_are_counted(monkeypatch):
    distributed = pytest.importorskip("distributed", reason="needs the extra cluster")
    from mesa_mobility.experiments.workers import dask_workers

    monkeypatch.setattr(dask_workers, "_COUNT_AGAIN", 0.0)
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None
    ) as cluster, distributed.Client(cluster) as client:  # fmt: skip
        workers = dask_workers.DaskWorkers(client)
        assert workers.count == 1
        cluster.scale(3)
        client.wait_for_workers(3)
        assert workers.ended(0.01) == []
        assert workers.count == 3


@pytest.mark.parametrize(("workers", "seconds"), [(2, 5.0), (200, 5.0), (1000, 25.0)])
def test_many_workers_get_longer_batches(workers, seconds, tmp_path):
    from types import SimpleNamespace

    from mesa_mobility.experiments import Store
    from mesa_mobility.experiments.driver import _Driver
    from mesa_mobility.experiments.workers.batches import Finished

    crew = SimpleNamespace(count=workers, address="")
    driver = _Driver(quick(1_000_000), Store(tmp_path / "s"), crew, lambda now: None)
    driver.progress.total = 3_000_000
    driver._note(Finished({"done": 10}, 1.0))
    batch = driver._batch(({"x": 0.0}, number) for number in range(1000))
    assert len(batch.runs) == pytest.approx(seconds / 0.1)


def test_models_of_a_function_are_refused_with_processes(tmp_path):
    class Local(Quick):
        pass

    with pytest.raises(ModelError, match=r"cannot import .*Local: it is defined within a function"):
        run_experiment(quick(model=Local), tmp_path / "s", executor="processes")
    assert run_experiment(quick(model=Local), tmp_path / "t", executor="serial").status()["done"]


UNGUARDED = "\n".join(line.removeprefix("    ") for line in DRIVER.splitlines()
                      if "__main__" not in line)  # fmt: skip


def test_a_script_without_a_guard_is_told_so(tmp_path):
    script = tmp_path / "script.py"
    script.write_text(UNGUARDED)
    done = subprocess.run(
        [sys.executable, str(script), str(tmp_path / "s"), "processes", json.dumps(SLOW)],
        env=os.environ | {"PYTHONPATH": str(ROOT)}, capture_output=True, text=True, timeout=120,
    )  # fmt: skip
    assert done.returncode == 1
    assert "its script calls run_experiment when it is imported" in done.stderr.splitlines()[-1]


@pytest.mark.parametrize(
    ("keywords", "message"),
    [
        ({"replications": 0}, "replications is 0, expected a whole number, 1 or more"),
        ({"replications": True}, "replications is True"),
        ({"seed": -1}, "seed is -1, expected a whole number, 0 or more"),
        ({"time_limit": 0}, "time_limit is 0, expected seconds above 0"),
        ({"max_seconds": float("nan")}, "max_seconds is nan"),
        ({"keep": ["all"]}, "keep has 'all', expected occupancy or trajectories"),
        ({"fixed": {"x": 1}}, "x is both fixed and varied"),
    ],
)
def test_experiments_that_are_none(keywords, message):
    with pytest.raises(ModelError, match=message):
        quick(**keywords)


@pytest.mark.parametrize(
    ("keywords", "message"),
    [
        ({"parameters": {"xx": 1}}, "unknown parameter 'xx', did you mean 'x'"),
        ({"model": "nothing"}, "unknown model 'nothing'"),
        ({"model": "tests.nothing:Quick"}, "cannot be loaded"),
        ({"keep": ["trajectories"]}, "its constructor does not take record"),
        ({"parameters": {"rng": 1}}, "rng is a parameter, but each run is given its own"),
    ],
)
def test_what_does_not_fit_the_model_is_refused_before_a_store_is_made(keywords, message, tmp_path):
    with pytest.raises(ModelError, match=message):
        run_experiment(quick(**keywords), tmp_path / "s", executor="serial")
    assert not (tmp_path / "s").exists()


@pytest.mark.parametrize("executor", ["proceses", 3, None])
def test_executors_that_are_none(executor, tmp_path):
    with pytest.raises(ModelError, match=r"^executor is "):
        run_experiment(quick(), tmp_path / "s", executor=executor)
