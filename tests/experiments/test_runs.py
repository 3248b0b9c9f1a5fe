"""Runs of an experiment: the same rows whatever runs them."""

from concurrent.futures import ThreadPoolExecutor

import pyarrow.dataset as dataset
import pytest

from mesa_mobility.errors import ModelError
from mesa_mobility.experiments import Experiment, open_store, run_experiment
from mesa_mobility.experiments.design.points import point_key, seed_of_run
from tests.fixtures.experiments.models import Quick
from tests.fixtures.experiments.quick import quick


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


def test_a_run_that_ends_with_people_who_block_each_other_says_so(tmp_path):
    model, values = "tests.fixtures.face_to_face:FaceToFace", [90.0, 0.0]
    asked = Experiment(model, {"waiting": values}, replications=1, seed=1, max_seconds=62.0)
    store = run_experiment(asked, tmp_path / "s", executor="serial")
    frame = store.frame().set_index("waiting")
    # Where nobody waits, the third leaves, and those who are left can all not move.
    assert frame.status.to_dict() == {90.0: "blocked", 0.0: "stalled"}
    assert frame.blocked.to_dict() == {90.0: 2.0, 0.0: 2.0}
    counts = store.status()
    assert (counts["blocked"], counts["stalled"], counts["failed"]) == (1, 1, 0)


def test_arrow_reads_the_folder_as_it_is(serial):
    table = dataset.dataset(serial.folder.path("runs"), format="parquet").to_table()
    assert table.num_rows == 12
    assert str(table.schema.field("y").type) == "double"


@pytest.mark.parametrize(
    "executor",
    [
        "threads",
        *(
            pytest.param(each, marks=pytest.mark.slow)
            for each in ("processes", "dask", "client", "address")
        ),
    ],
)
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
    run_experiment(
        more, tmp_path / "s", executor="serial", progress=lambda now: ended.append(now.total)
    )
    assert ended[-1] == 4
    assert store.status()["done"] == 16
    assert store.status()["missing"] == 0


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


def test_models_of_a_function_are_refused_with_processes(tmp_path):
    class Local(Quick):
        pass

    with pytest.raises(ModelError, match=r"cannot import .*Local: it is defined within a function"):
        run_experiment(quick(model=Local), tmp_path / "s", executor="processes")
    assert run_experiment(quick(model=Local), tmp_path / "t", executor="serial").status()["done"]


@pytest.mark.parametrize(
    ("keywords", "message"),
    [
        ({"replications": 0}, "replications is 0, expected a whole number, 1 or more"),
        ({"replications": True}, "replications is True"),
        ({"seed": -1}, "seed is -1, expected a whole number, 0 or more"),
        ({"time_limit": 0}, "time_limit is 0, expected seconds above 0"),
        ({"max_seconds": float("nan")}, "max_seconds is nan"),
        ({"keep": ["all"]}, "keep has 'all', expected occupancy, trajectories or doors"),
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
