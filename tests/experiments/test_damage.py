"""Stores that something has happened to, and figures that nobody has."""

import json

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from mesa_mobility.errors import MobilityError, ModelError, ResultsError
from mesa_mobility.experiments import Experiment, Precision, open_store, run_experiment
from mesa_mobility.experiments.storing.shards import Folder
from mesa_mobility.experiments.workers.batches import Journal
from tests.fixtures.damage.mutating import mutate

MODELS = "tests.fixtures.experiments.models:"


def run(path, **keywords):
    experiment = Experiment(MODELS + "Quick", {"x": [0.0, 1.0]}, **keywords)
    return run_experiment(experiment, path, executor="serial")


@pytest.fixture
def store(tmp_path):
    return run(tmp_path / "s", replications=2)


def test_a_changed_byte_of_a_shard_is_one_line_that_says_what_to_do(store, tmp_path):
    path = tmp_path / "s" / "runs"
    [file] = path.glob("*.parquet")
    content = bytearray(file.read_bytes())
    content[len(content) // 4] ^= 1
    file.write_bytes(content)
    with pytest.raises(ResultsError) as caught:
        store.frame()
    message = str(caught.value)
    assert message.startswith(f"{store}/runs/{file.name}: damaged: ")
    assert message.endswith("without this file its runs are done anew")
    assert "\n" not in message
    file.unlink()
    assert run(tmp_path / "s", replications=2).status()["done"] == 4


def test_a_table_of_something_else_is_refused(store):
    pq.write_table(pa.table({"y": [1.0]}), store.folder.path("runs/other.parquet"))
    for read in (store.frame, store.status, store.compact, store.run_names):
        with pytest.raises(ResultsError, match=r"other\.parquet: no sha256 in mesa_mobility"):
            read()


def test_no_byte_of_a_shard_changes_unseen(store):
    [name] = store.shards()
    whole = store.folder.read_bytes(name)
    unseen = []
    for at in range(0, len(whole), 11):
        content = bytearray(whole)
        content[at] ^= 1
        store.folder.write_bytes(name, bytes(content))
        try:
            store.table()
            unseen.append(at)
        except ResultsError:
            continue
    assert unseen == []


@pytest.mark.parametrize("seed", range(60))
def test_damaged_stores_are_one_line(seed, store):
    """Whatever is changed, the store is read as it was, or refused with the project's error."""
    rng = np.random.default_rng(seed)
    name = "experiment.json" if seed % 2 else next(iter(store.shards()))
    whole = store.folder.read_bytes(name)
    store.folder.write_bytes(name, mutate(whole, rng))
    said = ""
    try:
        opened = open_store(store.folder.url)
        opened.status()
        opened.frame()
    except MobilityError as error:
        said = str(error)
    assert "\n" not in said


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda values: values.pop("sessions"), "damaged: no 'sessions'"),
        (lambda values: values.update(sessions=[]), "expected an experiment and its sessions"),
        (lambda values: values["sessions"][0].pop("inputs"), "damaged: no 'inputs'"),
        (lambda values: values["sessions"][0].update(versions=3), "damaged: versions is 3"),
        (lambda values: values.update(format_version=9), "format version 9, expected 1"),
    ],
)
def test_a_definition_that_lacks_something(change, message, store):
    path = store.folder.path("experiment.json")
    with open(path) as file:
        values = json.load(file)
    change(values)
    with open(path, "w") as file:
        json.dump(values, file)
    with pytest.raises(ResultsError, match=message):
        open_store(store.folder.url)


def test_an_experiment_that_is_none_is_damage(store):
    path = store.folder.path("experiment.json")
    with open(path) as file:
        values = json.load(file)
    values["experiment"]["replications"] = "many"
    with open(path, "w") as file:
        json.dump(values, file)
    with pytest.raises(ResultsError, match=r"experiment\.json: damaged: .*replications is 'many'"):
        open_store(store.folder.url).status()


def test_a_line_that_is_not_whole_takes_no_other_along(tmp_path):
    path = tmp_path / "batch.jsonl"
    path.write_text('{"row": {"run": "a-0", "y": 1}}\n{"row": {"run": "a-1", "y"')
    journal = Journal(path)
    assert list(journal.rows) == ["a-0"]
    journal.begin("a-1")
    journal.end({"run": "a-1", "y": 2})
    again = Journal(path)
    assert {run: row["y"] for run, row in again.rows.items()} == {"a-0": 1, "a-1": 2}
    assert again.begun == {"a-1": 1}


def test_a_folder_that_cannot_be_read_is_one_line(store, monkeypatch):
    def refused(*_, **__):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(type(store.folder.fs), "ls", refused)
    with pytest.raises(ResultsError, match="runs: cannot be read: Permission denied"):
        store.status()


@pytest.mark.parametrize(
    ("figure", "message"),
    [
        ("mean egres_s", r"runs have no column 'egres_s', did you mean 'egress_s'\?"),
        ("mean worker", "column worker is string, expected numbers"),
    ],
)
def test_figures_that_nobody_has_do_not_cost_a_thousand_runs(figure, message, tmp_path):
    experiment = Experiment(
        MODELS + "Emptying",
        replications="auto",
        precision=Precision((figure,), least=3, occupancy=None),
    )
    with pytest.raises(ModelError, match=message):
        run_experiment(experiment, tmp_path / "s", executor="serial")
    assert open_store(tmp_path / "s").status()["done"] == 3


def test_a_store_on_an_unknown_file_system():
    with pytest.raises(ResultsError, match="nothing://x: "):
        Folder("nothing://x")


def test_models_may_call_their_own_things_population_types_and_occupancy(tmp_path):
    experiment = Experiment(MODELS + "Named", replications=2)
    store = run_experiment(experiment, tmp_path / "s", executor="serial")
    frame = store.frame()
    assert list(frame.status) == ["done", "done"]
    assert list(frame.summary_types) == list(frame.summary_occupancy) == [3.0, 3.0]
