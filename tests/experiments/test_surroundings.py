"""Stores and workers where the clock, the disk, the file system or a model is not as one thinks."""

import hashlib
import os
import time

import fsspec
import pytest
from fsspec.implementations.memory import MemoryFileSystem

from mesa_mobility.errors import MapError, ModelError, ResultsError
from mesa_mobility.experiments import Experiment, Precision, Store, open_store, run_experiment
from mesa_mobility.experiments.session import session_of
from mesa_mobility.experiments.storing.shards import Folder, joined, table_of
from mesa_mobility.experiments.workers import batches, compiling
from mesa_mobility.files.atomic import replacing

MODELS = "tests.fixtures.experiments.models:"
SESSION = {"began": "", "executor": "serial", "machine": "", "versions": {}, "inputs": {}}


def run(path, replications=2, **keywords):
    experiment = Experiment(MODELS + "Quick", {"x": [0.0, 1.0]}, replications, **keywords)
    return run_experiment(experiment, path, executor="serial")


def test_a_clock_that_stands_still_loses_no_rows(tmp_path, monkeypatch):
    monkeypatch.setattr(time, "time_ns", lambda: 7)
    store = run(tmp_path / "s")
    store.compact()
    run(tmp_path / "s", 4)
    store.compact()
    assert len(store.frame()) == 8
    # The same for what dead workers have left in their journals.
    for number in range(2):
        journal = batches.Journal.of(store.folder, f"b{number}")
        row = {"run": f"r-{number}", "point": "r", "replication": number, "status": "done"}
        journal.end({**row, "wall_s": 0.0})
        run(tmp_path / "s", 4)
    assert len(store.frame()) == 10


def test_files_are_on_the_disk_before_they_are_in_place(tmp_path, monkeypatch):
    """What was merged is deleted next: the merged file must not be lost with the power."""
    done = []
    sync, replace = os.fsync, os.replace
    monkeypatch.setattr(os, "fsync", lambda file: (done.append("fsync"), sync(file))[1])
    monkeypatch.setattr(os, "replace", lambda *a: (done.append("replace"), replace(*a))[1])
    Folder(tmp_path).write_bytes("x", b"rows")
    assert done == ["fsync", "replace"]


def test_two_writers_of_one_file_are_not_in_each_others_way(tmp_path):
    """Processes of two machines may have the same number."""
    path = tmp_path / "x"
    with replacing(path, MapError) as one, replacing(path, MapError) as other:
        one.write_text("one")
        other.write_text("other")
    assert path.read_text() == "one"
    assert list(tmp_path.iterdir()) == [path]


def test_what_killed_drivers_have_half_written_goes(tmp_path):
    run(tmp_path / "s", 1)
    old = [tmp_path / "s" / ".experiment.1.tmp.json", tmp_path / "s" / "runs" / ".a.1.tmp.parquet"]
    for path in old:
        path.touch()
        os.utime(path, (1e9, 1e9))
    run(tmp_path / "s")
    assert not any(path.exists() for path in old)


def test_a_file_that_somebody_reads_may_stay(tmp_path, monkeypatch):
    """Windows deletes no file that is open; its rows are there twice and count once."""

    def refused(*_):
        raise PermissionError(13, "in use")

    store = run(tmp_path / "s")
    [first] = store.shards()
    monkeypatch.setattr(type(store.folder.fs), "rm_file", refused)
    run(tmp_path / "s", 3)
    assert first in store.shards()
    assert len(store.frame()) == 6


def test_a_name_without_a_file_does_not_keep_readers_waiting(tmp_path):
    store = run(tmp_path / "s")
    (tmp_path / "s" / "runs" / "lost.parquet").symlink_to(tmp_path / "nowhere")
    with pytest.raises(ResultsError, match=r"runs/lost\.parquet: is listed, but is no file"):
        store.frame()


def test_locks_that_a_file_system_does_not_have(tmp_path, monkeypatch):
    def refused(*_, **__):
        raise NotImplementedError("FileSystem does not appear to support flock")

    monkeypatch.setattr("filelock.FileLock.acquire", refused)
    store = run(tmp_path / "s")
    assert store.status()["done"] == 4
    assert not store.is_locked()


@pytest.mark.parametrize("replications", [2, "auto"])
def test_workers_that_write_elsewhere_are_found_out(replications, tmp_path, monkeypatch):
    """As where a folder has the same name on two machines, but is not shared."""
    monkeypatch.setattr(batches, "write_table", lambda *_: None)
    with pytest.raises(ResultsError, match=r"has no rows of runs that have ended, .* all workers"):
        run(tmp_path / "s", replications, precision=Precision(("mean y",), occupancy=None))


class Unreachable(MemoryFileSystem):
    """An object store without credentials, whose errors are of its own kind."""

    protocol = "unreachable"

    def refused(self, *_, **__):
        raise RuntimeError("no\ncredentials")

    makedirs = pipe_file = cat_file = ls = exists = refused


def test_a_remote_store_out_of_reach_is_one_line():
    fsspec.register_implementation("unreachable", Unreachable, clobber=True)
    for use in (run, open_store, lambda url: Store(url).shards()):
        with pytest.raises(ResultsError, match="cannot be reached: RuntimeError: no credentials"):
            use("unreachable://store")


@pytest.mark.parametrize("fault", [None, OSError])
def test_code_is_compiled_before_runs_whose_time_is_limited(fault, tmp_path, monkeypatch):
    """Also where no folder can keep it, or none can be locked."""

    class Locked:
        def __init__(self, path):
            raise fault("no locks")

    done = []
    monkeypatch.setattr("mesa_mobility.compiled.cache.folder", lambda: fault and tmp_path)
    monkeypatch.setattr(compiling, "FileLock", Locked)
    for name in ("compile_the_rest", "compile_decisions"):
        monkeypatch.setattr(
            f"mesa_mobility.crowd.precompile.{name}", lambda name=name: done.append(name)
        )
    compiling.compile_once.cache_clear()
    compiling.compile_once("doorway")
    compiling.compile_once.cache_clear()
    assert done == ["compile_the_rest", "compile_decisions"]


ROOM = "from mesa_mobility import PedestrianModel\nclass Room(PedestrianModel):\n    pass\n"


def test_the_sha256_of_a_model_file_in_a_folder_called_like_one(tmp_path):
    file = tmp_path / "my.python.models" / "room.py"
    file.parent.mkdir()
    file.write_text(ROOM)
    inputs = session_of(Experiment(f"{file}:Room"), "serial")["inputs"]
    assert inputs["model file"] == hashlib.sha256(ROOM.encode()).hexdigest()


def test_an_experiment_with_a_model_file_goes_on_from_another_folder(tmp_path):
    store = Store(tmp_path / "s")
    session = {**SESSION, "inputs": {"model file": "a" * 64}}
    store.prepare(Experiment("sub/room.py:Room"), session)
    store.prepare(Experiment("room.py:Room"), session)
    for other in ("room.py:Hall", "hall.py:Room", "room"):
        with pytest.raises(ModelError, match="holds runs with model "):
            store.prepare(Experiment(other), session)
    with pytest.raises(ModelError, match="holds runs with another model file"):
        store.prepare(Experiment("room.py:Room"), {**SESSION, "inputs": {"model file": "b" * 64}})


def test_a_map_of_earlier_runs_that_has_changed_is_refused(tmp_path):
    store, experiment = Store(tmp_path / "s"), Experiment(MODELS + "Quick")
    for inputs in ({"map a": "1" * 64}, {"map b": "2" * 64}):
        store.prepare(experiment, {**SESSION, "inputs": inputs})
    with pytest.raises(ModelError, match="holds runs with another map a"):
        store.prepare(experiment, {**SESSION, "inputs": {"map a": "3" * 64}})


def test_numbers_and_text_of_one_figure_do_not_depend_on_files():
    rows = [
        {"run": f"r-{k}", "status": "done", "y": y} for k, y in enumerate([1.0, 1e20, "none", True])
    ]
    together = table_of(rows, {})["y"].to_pylist()
    assert together == ["1.0", "1e+20", "none", "True"]
    for cut in (1, 2, 3):
        apart = joined([table_of(rows[:cut], {}), table_of(rows[cut:], {})])
        assert apart["y"].to_pylist() == together


def test_figures_that_files_cannot_hold_do_not_end_an_experiment(tmp_path):
    kinds = ["huge", "letters", "error", "number"]
    experiment = Experiment(MODELS + "Odd", {"kind": kinds})
    frame = run_experiment(experiment, tmp_path / "s", executor="serial").frame().set_index("kind")
    assert list(frame.status) == ["failed", "done", "failed", "done"]
    assert frame.error["huge"].startswith("OverflowError: ")
    assert frame.y["letters"] == r"caf\udce9"
    assert frame.error["error"] == r"ValueError: caf\udce9"
    assert frame["3"]["number"] == 4.0
    with pytest.raises(ModelError, match=r"parameter kind: got 'caf.*expected text"):
        Experiment(MODELS + "Odd", {"kind": ["caf\udce9"]})
