"""Keys and seeds: what they depend on, and what they do not."""

import hashlib
import time
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mesa_mobility.errors import ModelError
from mesa_mobility.experiments import Experiment
from mesa_mobility.experiments.design.points import plain_value, point_key, run_name, seed_of_run
from mesa_mobility.experiments.missing import missing_runs

NUMBERS = st.integers() | st.floats(allow_nan=False, allow_infinity=False)
VALUES = st.none() | st.booleans() | st.text() | NUMBERS
POINTS = st.dictionaries(st.text(min_size=1), VALUES, max_size=5)


def test_a_key_is_a_hash_of_names_and_values():
    # The text is written out by hand.
    expected = hashlib.sha256(b'{"people": 30, "preset": "paper", "width": 1.2}').hexdigest()[:16]
    assert point_key({"width": 1.2, "people": 30, "preset": "paper"}) == expected


@given(POINTS)
def test_the_order_of_names_does_not_matter(point):
    assert point_key(dict(reversed(list(point.items())))) == point_key(point)


@given(POINTS, POINTS)
def test_other_values_give_another_key(one, other):
    if one != other:
        assert point_key(one) != point_key(other) or _same_numbers(one, other)


def _same_numbers(one, other):
    # True == 1 == 1.0 in Python, but true is not 1 in a store.
    return repr(sorted(one)) == repr(sorted(other)) and all(one[k] == other[k] for k in one)


def test_whole_numbers_count_the_same_with_a_decimal_point():
    assert point_key({"people": 30}) == point_key({"people": 30.0})
    assert point_key({"people": 1}) != point_key({"people": True})
    assert point_key({"people": 1}) != point_key({"people": "1"})


def test_the_seed_is_numpys_from_experiment_point_and_replication():
    key = point_key({"people": 30})
    words = np.random.SeedSequence([7, int(key, 16), 4]).generate_state(1, np.uint64)
    assert seed_of_run(7, key, 4) == int(words[0]) // 2


def test_seeds_differ():
    keys = [point_key({"people": n}) for n in range(20)]
    seeds = {seed_of_run(s, key, n) for s in range(3) for key in keys for n in range(20)}
    assert len(seeds) == 3 * 20 * 20
    assert 0 <= min(seeds) <= max(seeds) < 2**63
    assert run_name(keys[0], 12) == f"{keys[0]}-12"


@pytest.mark.parametrize("value", [float("nan"), float("inf"), [1], {"a": 1}, object()])
def test_values_that_cannot_be_kept(value):
    with pytest.raises(ModelError, match=r"^parameter width: got "):
        plain_value("width", value)


def test_numpys_numbers_are_plain_ones():
    assert type(plain_value("n", np.int64(3))) is int
    assert type(plain_value("n", np.float32(0.5))) is float


class Names:
    """What stands for a store: the names of the runs that are there."""

    folder = SimpleNamespace(exists=lambda name: True)

    def __init__(self, names):
        self.names = np.unique(np.array(names, dtype="S40"))

    def run_names(self):
        return self.names


def missing(experiment, names):
    count, runs = missing_runs(experiment, Names(names))
    found = [run_name(point_key(point), number) for point, number in runs]
    assert len(found) == count
    return found


def test_what_is_missing_is_what_is_not_there():
    experiment = Experiment("m", {"x": [1.0, 2.0, 3.0]}, replications=4)
    keys = [point_key(experiment.point(k)) for k in range(3)]
    every = [run_name(key, number) for key in keys for number in range(4)]
    assert missing(experiment, []) == every
    assert missing(experiment, every) == []
    there = [every[k] for k in (0, 3, 5, 11)] + [run_name(keys[0], 4), "another-0"]
    assert missing(experiment, there) == [name for name in every if name not in there]


def test_what_is_missing_from_a_large_store_is_found_in_seconds():
    experiment = Experiment("m", {"x": [float(k) for k in range(2000)]}, replications=100)
    keys = [point_key(experiment.point(k)) for k in range(2000)]
    began = time.process_time()
    there = [run_name(key, number) for key in keys for number in range(99)]
    assert len(missing(experiment, there)) == 2000
    # Sorting 198,000 names for each of the points took minutes.
    assert time.process_time() - began < 20.0
