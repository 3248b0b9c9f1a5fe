"""Which runs an experiment does next: by rounds, after interruptions, and after workers died."""

import gc
import weakref
from types import SimpleNamespace

import pytest

from mesa_mobility.errors import ModelError
from mesa_mobility.experiments import (
    Experiment,
    Precision,
    Store,
    open_store,
    run_experiment,
    write_report,
)
from mesa_mobility.experiments.design.points import point_key, run_name
from mesa_mobility.experiments.driver import _Driver
from mesa_mobility.experiments.workers import batches, figures, one_run
from mesa_mobility.experiments.workers.batches import Batch, Finished, Journal
from tests.fixtures.experiments.quick import quick

MODELS = "tests.fixtures.experiments.models:"


class Enough(Exception):
    pass


def auto(model="Emptying", **keywords):
    fixed = keywords.pop("fixed", {})
    precision = Precision(("mean egress_s",), occupancy=None, **keywords)
    return Experiment(MODELS + model, replications="auto", seed=1, precision=precision, fixed=fixed)


def run_in_pieces(experiment, path, ended):
    """Interrupt an experiment after each so many runs."""

    def stop(progress):
        if progress.ended >= ended:
            raise Enough

    for _ in range(1000):
        try:
            return run_experiment(experiment, path, executor="serial", progress=stop)
        except Enough:
            continue
    raise AssertionError("does not come to an end")


@pytest.mark.thorough
@pytest.mark.parametrize("ended", [1, 7])
def test_interruptions_do_not_change_how_many_runs_are_enough(ended, rows, tmp_path):
    whole = run_experiment(auto(), tmp_path / "whole", executor="serial")
    pieces = run_in_pieces(auto(), tmp_path / "pieces", ended)
    assert rows(pieces) == rows(whole)


def test_only_whole_rounds_are_looked_at(tmp_path):
    precision = Precision(("mean egress_s",), least=20, most=40, occupancy=None)
    looks = {0: 0, 19: 19, 20: 20, 24: 20, 25: 25, 31: 25, 32: 32, 39: 32, 40: 40, 90: 40}
    assert {count: precision.last_look(count) for count in looks} == looks
    # Of 25 runs the fourth is lost, and with it all later ones do not count.
    store = run_experiment(
        auto(tolerance=0.001, least=20, most=25), tmp_path / "s", executor="serial"
    )
    [known] = store.assessments().values()
    assert known.runs == 25
    table = store.table()
    table = table.filter([number != 3 for number in table["replication"].to_pylist()])
    store.table = lambda columns: table.select(list(dict.fromkeys(["run", "status", *columns])))
    [known] = store.assessments().values()
    assert known.runs == 3


def test_points_of_which_every_run_fails_end_after_the_least(tmp_path):
    experiment = Experiment(
        MODELS + "Quick",
        {"end": ["well", "raise"]},
        replications="auto",
        seed=1,
        precision=Precision(("mean y",), 0.5, least=4, most=30, occupancy=None),
    )
    store = run_experiment(experiment, tmp_path / "s", executor="serial")
    frame = store.frame()
    assert len(frame[frame.end == "raise"]) == 4
    assert len(frame[frame.end == "well"]) == 30
    text = write_report(store).read_text(encoding="utf-8")
    assert "no run has a figure" in text
    assert "4 of 34 runs have failed, and count nowhere" in text


@pytest.mark.parametrize("name", ["seed", "status", "worker", "types"])
def test_parameters_called_like_a_column_of_the_store_are_refused(name, tmp_path):
    kind = type("Named", (), {"__init__": lambda self, rng=None, **others: None})
    with pytest.raises(ModelError, match=f"parameter {name} is called like a column of the store"):
        run_experiment(Experiment(kind, {name: [1]}), tmp_path / "s", executor="serial")


def test_a_figure_does_not_take_the_place_of_a_parameter(monkeypatch):
    monkeypatch.setattr(figures, "has_pedestrians", lambda model: True)
    monkeypatch.setattr(figures, "_by_type", lambda model: {"types": [], "flow_per_s": 2.5})
    model = SimpleNamespace(summary=lambda: {"egress_s": 8.0})
    row = figures.figures_of(model, {"run", "flow_per_s"}, occupancy=False)
    assert row == {"egress_s": 8.0, "types": [], "summary_flow_per_s": 2.5}


def test_workers_in_another_folder_find_the_model_file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    crew = SimpleNamespace(count=1, address="")
    driver = _Driver(Experiment("sub/room.py:Room"), Store("s"), crew, lambda now: None)
    setup = driver._setup(own_processes=True)
    assert setup.model == f"{tmp_path}/sub/room.py:Room"
    assert setup.store == f"{tmp_path}/s"


def test_a_run_is_not_to_blame_for_workers_that_died_before_it_began(tmp_path):
    experiment = Experiment(MODELS + "Quick", {"x": [0.0]})
    store = Store(tmp_path / "s")
    for name in ("runs", "work"):
        store.folder.make(name)
    crew = SimpleNamespace(count=1, address="")
    driver = _Driver(experiment, store, crew, lambda now: None)
    setup = driver._setup(own_processes=True)
    batch = Batch("b", ((experiment.point(0), 0),))
    for _ in range(10):
        assert driver._again(setup, batch) == [batch]
    journal = Journal.of(store.folder, "b")
    for _ in range(2):
        journal.begin(run_name(point_key(experiment.point(0)), 0))
    assert driver._again(setup, batch) == []
    assert driver.progress.failed == 1


@pytest.mark.parametrize("own_process", [True, False])
def test_models_of_long_batches_leave_the_memory_of_a_worker(own_process, tmp_path, monkeypatch):
    """A caller's own process is not held up: it may have many objects of its own."""
    made, run_once = [], one_run.run_once

    def remembered(*arguments):
        row, model = run_once(*arguments)
        model.itself = model
        made.append(weakref.ref(model))
        return {**row, "wall_s": 1.0}, model

    monkeypatch.setattr(batches, "run_once", remembered)
    experiment, store = Experiment(MODELS + "Quick"), Store(tmp_path / "s")
    store.folder.make("runs")
    crew = SimpleNamespace(count=1, address="")
    setup = _Driver(experiment, store, crew, lambda now: None)._setup(own_processes=own_process)
    gc.disable()
    try:
        for runs in (1, 2):
            batches.run_batch(setup, Batch(f"b{runs}", tuple(({}, k) for k in range(runs))))
            alive = sum(each() is not None for each in made)
            collected = own_process and runs == 2
            assert alive == (0 if collected else len(made))
            # A later collection does not go through what the worker has had all along.
            assert (len(gc.get_objects()) < 10_000) == collected
    finally:
        gc.unfreeze()
        gc.enable()


def test_what_outlives_a_batch_is_freed_once_it_is_garbage():
    class Kept:
        def __init__(self):
            self.itself = self

    kept = Kept()
    alive = weakref.ref(kept)
    try:
        batches._collect()
        del kept
        for _ in range(20):
            batches._collect()
    finally:
        gc.unfreeze()
    assert alive() is None


SOURCE = """
import mesa

class Changing(mesa.Model):
    def __init__(self, rng=None):
        super().__init__(rng=rng)

    def step(self):
        self.running = False

    def summary(self):
        return {"y": 1.0}
"""


def test_a_model_whose_source_has_changed_is_refused(tmp_path, monkeypatch):
    file = tmp_path / "changing_model.py"
    file.write_text(SOURCE)
    monkeypatch.syspath_prepend(tmp_path)
    experiment = Experiment("changing_model:Changing", replications=1)
    run_experiment(experiment, tmp_path / "s", executor="serial")
    file.write_text("# What is not the model may change.\n" + SOURCE)
    more = Experiment("changing_model:Changing", replications=2)
    run_experiment(more, tmp_path / "s", executor="serial")
    file.write_text(SOURCE.replace("1.0", "2.00"))
    with pytest.raises(ModelError, match="holds runs with another source of the model"):
        run_experiment(more, tmp_path / "s", executor="serial")
    assert list(open_store(tmp_path / "s").frame().y) == [1.0, 1.0]


@pytest.mark.slow
@pytest.mark.parametrize(("workers", "seconds"), [(2, 5.0), (200, 5.0), (1000, 25.0)])
def test_many_workers_get_longer_batches(workers, seconds, tmp_path):
    crew = SimpleNamespace(count=workers, address="")
    driver = _Driver(quick(1_000_000), Store(tmp_path / "s"), crew, lambda now: None)
    driver.progress.total = 3_000_000
    driver._note(Finished({"done": 10}, 1.0))
    batch = driver._batch(({"x": 0.0}, number) for number in range(1000))
    assert len(batch.runs) == pytest.approx(seconds / 0.1)
