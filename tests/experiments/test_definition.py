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

EXAMPLE = Path(__file__).parents[2] / "examples" / "experiments" / "doorway.toml"
NUMBERS = st.floats(0.001, 1e6)
NAMES = st.text("abcdefgh_", min_size=1, max_size=6)
PRECISIONS = st.builds(
    Precision, st.lists(st.sampled_from(["mean egress_s", "p95 y", "p5 y"]), max_size=3),
    st.floats(0.001, 0.5), st.floats(0.5, 0.999), st.integers(2, 30), st.integers(30, 99),
    st.none() | st.builds(OccupancyConvergence, st.floats(0.001, 0.5), st.integers(1, 20)),
)  # fmt: skip
EXPERIMENTS = st.builds(
    Experiment, NAMES,
    st.builds(Grid, st.dictionaries(NAMES, st.lists(NUMBERS, min_size=1, max_size=3, unique=True),
                                    max_size=3)),
    st.integers(1, 99) | st.just("auto"), st.integers(0, 2**64), st.just({}),
    st.none() | NUMBERS, st.none() | NUMBERS, st.sampled_from([(), ("occupancy",)]), PRECISIONS,
    st.text(),
)  # fmt: skip


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
    (tmp_path / "e.toml").write_text('model = "room.py:Room"\n[latin_hypercube]\npoints = 3\n'
                                     "[latin_hypercube.between]\nwidth = [0.8, 1.2]\n")  # fmt: skip
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


def test_no_such_file(tmp_path):
    with pytest.raises(ModelError, match="no such file, expected an experiment in TOML"):
        read_experiment(tmp_path / "e.toml")
