"""Runs that raise, never end or kill their worker are rows like any other."""

import pytest

from mesa_mobility.experiments import Grid, run_experiment
from tests.fixtures.experiments.quick import quick

# Many processes, which take minutes and count on a machine that is not loaded.
pytestmark = pytest.mark.slow


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
