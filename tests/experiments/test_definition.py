"""Experiments in files."""

import json
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mesa_mobility.errors import ModelError
from mesa_mobility.experiments import Experiment, Grid, OccupancyConvergence, Precision
from mesa_mobility.experiments.definition import (
    from_definition,
    read_experiment,
    to_definition,
)
from mesa_mobility.results.files import json_text

EXAMPLE = Path(__file__).parents[2] / "examples" / "experiments" / "doorway.toml"
NUMBERS = st.floats(0.001, 1e6)
NAMES = st.text("abcdefgh_", min_size=1, max_size=6)
PRECISIONS = st.builds(
    Precision,
    st.lists(st.sampled_from(["mean egress_s", "p95 y", "p5 y"]), min_size=1, max_size=3),
    st.floats(0.001, 0.5),
    st.floats(0.5, 0.999),
    st.integers(2, 30),
    st.integers(200, 999),
    st.none() | st.builds(OccupancyConvergence, st.floats(0.001, 0.5), st.integers(1, 20)),
)
EXPERIMENTS = st.builds(
    Experiment,
    NAMES,
    st.builds(
        Grid,
        st.dictionaries(NAMES, st.lists(NUMBERS, min_size=1, max_size=3, unique=True), max_size=3),
    ),
    st.integers(1, 99) | st.just("auto"),
    st.integers(0, 2**64),
    st.just({}),
    st.none() | NUMBERS,
    st.none() | NUMBERS,
    st.sampled_from([(), ("occupancy",)]),
    PRECISIONS,
    st.text(),
    st.sampled_from(["independent", "common"]),
)


@given(EXPERIMENTS)
def test_what_is_written_is_read_again(experiment):
    text = json.dumps(to_definition(experiment))
    assert from_definition(json.loads(text)) == experiment


def test_the_example_is_200_runs_of_the_doorway():
    experiment = read_experiment(EXAMPLE)
    assert experiment.model == "doorway"
    assert len(experiment.design) * experiment.replications == 200
    assert set(experiment.column_types()) == {"pedestrians", "door_width"}


def test_a_model_file_is_looked_for_beside_the_experiment(tmp_path):
    (tmp_path / "e.toml").write_text(
        'model = "room.py:Room"\n[latin_hypercube]\npoints = 3\n'
        "[latin_hypercube.between]\nwidth = [0.8, 1.2]\n"
    )
    experiment = read_experiment(tmp_path / "e.toml")
    assert experiment.model == str(tmp_path / "room.py:Room")
    assert len(experiment.design) == 3


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("model = ", "is not TOML"),
        ("seed = 1", "model is None, expected the name of a model"),
        ('model = "m"\nreplicatons = 3', "unknown key 'replicatons', did you mean 'replications'"),
        ('model = "m"\n[grid]\n[sobol]', "has the designs grid and sobol, expected one"),
        ('model = "m"\ngrid = 3', "grid: expected a table"),
        ('model = "m"\ntable = 3', "table: expected tables"),
        ('model = "m"\n[sobol]\npoints = 3', "sobol: missing 1 required positional argument"),
        ('model = "m"\n[sobol]\nponts = 3', "sobol: got an unexpected keyword argument 'ponts'"),
        ('model = "m"\n[precision]\noccupancy = 3', "occupancy is 3, expected a table or false"),
        ('model = "m"\nreplications = "many"', "replications is 'many', expected a whole number"),
        ('model = "m"\nseed = 1' + "0" * 5000, "is not TOML"),
        ('model = "m"\n[grid]\nx = ' + "[" * 5000 + "]" * 5000, "is not TOML"),
        ('model = "m"\n[grid]\nx = {a = 1, b = 2}', "parameter x: got dict, expected a number"),
        ('model = "m"\n[grid]\nx = [99999999999999999999]', "expected a number of at most 64"),
        ('model = "m"\n[grid]\nx = [1979-05-27]', "parameter x: got date, expected a number"),
        ('model = "m"\ntable = [1, 2]', "table: point 1 is 1, expected values by parameter"),
        ('model = "m"\n[sobol]\nbetween = 3\npoints = 4', "sobol: has no parameters"),
        ('model = "m"\n[sobol]\nbetween.x = [0, 1]\npoints = 4\nseed = -1', "sobol: seed is -1"),
        ('model = "m"\n[morris]\nbetween.x = [0, 1]\nlevels = true', "levels is True"),
        (
            'model = "m"\n[sobol_indices]\nbetween.x = [0, 1]\nsamples = 1099511627776',
            "expected 1 to 10,000,000",
        ),
        ('model = "m"\nreplications = 100000000', "expected at most 10,000,000 runs"),
        ('model = "m"\nkeep = "occupancy"', "keep is 'occupancy', expected a list"),
        ('model = "m"\nname = 3', "name is 3, expected text"),
        ('model = "m"\ntime_limit = 1e10', "time_limit is 10000000000.0, expected seconds"),
        ('model = "m"\n[precision]\nfigures = "mean y"', "figures is 'mean y', expected a list"),
        ('model = "m"\n[precision]\nfigures = ["p0 y"]', "figure 'p0 y': expected one such as"),
        ('model = "m"\n[precision]\nfigures = []\noccupancy = false', "figures: got none"),
        ('model = "m"\n[precision]\nmost = 71', "interval of p95 at 0.95 takes 72 runs"),
        ('model = "m"\n[precision]\nmost = 5', "most is 5, expected a whole number, 20 (least)"),
    ],
)
def test_files_that_are_no_experiment(text, message, tmp_path):
    path = tmp_path / "e.toml"
    path.write_text(text)
    with pytest.raises(ModelError) as caught:
        read_experiment(path)
    assert str(caught.value).startswith(f"{path}: ")
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


def test_what_a_report_prints_is_read_from_a_json_file(tmp_path):
    experiment = Experiment("doorway", Grid({"pedestrians": [2, 3]}), replications=2, seed=5)
    path = tmp_path / "again.json"
    path.write_text(json_text(to_definition(experiment), indent=1))
    assert read_experiment(path) == experiment


def test_a_model_in_a_file_is_found_again_from_any_folder(tmp_path, monkeypatch):
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "model.py").write_text("")
    (tmp_path / "sub" / "e.toml").write_text('model = "model.py"\nreplications = 1\n')
    monkeypatch.chdir(tmp_path)
    experiment = read_experiment("sub/e.toml")
    assert experiment.model == str(tmp_path / "sub" / "model.py")
    path = tmp_path / "sub" / "again.json"
    path.write_text(json_text(to_definition(experiment), indent=1))
    assert read_experiment("sub/again.json") == experiment


@pytest.mark.parametrize(
    ("text", "message"),
    [("{", "is not JSON: "), ("[" * 100_000, "is not JSON: "), ("[1]", "expected an object")],
)
def test_json_that_is_no_experiment(text, message, tmp_path):
    path = tmp_path / "e.json"
    path.write_text(text)
    with pytest.raises(ModelError, match=message):
        read_experiment(path)


def test_no_such_file(tmp_path):
    with pytest.raises(ModelError, match="no such file, expected an experiment in TOML"):
        read_experiment(tmp_path / "e.toml")
