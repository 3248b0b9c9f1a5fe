"""What the calibrated preset is calibrated on."""

import math

import pytest

from benchmarks.default_preset import goals, measured
from benchmarks.default_preset.__main__ import BOUNDS, scenarios
from benchmarks.default_preset.closeness import beyond, off
from mesa_mobility.calibration import HeldOut
from mesa_mobility.crowd import PRESETS


def test_each_figure_is_off_in_units_of_its_tolerance_and_by_six_at_most():
    # A tenth of a logarithm with a tolerance of a tenth, and twice as much below.
    assert off({"a": (math.exp(0.1), 0.1)}) == pytest.approx(1.0)
    assert off({"a": (math.exp(0.1), 0.1), "b": (math.exp(-0.2), 0.1)}) == pytest.approx(2.5)
    for ratio in (0.0, -1.0, math.inf, math.nan, 1e9):
        assert off({"a": (ratio, 0.1)}) == 36.0


@pytest.mark.parametrize(
    ("value", "expected"),
    [(1.0, 0.0), (2.0, 0.0), (2.2, 4.0), (0.9, 1.0), (99.0, 36.0), (math.inf, 36.0)],
)
def test_what_is_outside_a_range_counts_by_its_tolerance(value, expected):
    assert beyond(value, 1.0, 2.0, 0.1) == pytest.approx(expected)


@pytest.mark.parametrize("fold", [None, *measured.FOLDS])
def test_runs_of_a_fold_are_hidden_from_the_search(tmp_path, fold):
    simulates, data, distances = scenarios(tmp_path, fold)
    hidden = [name for name, known in data.items() if isinstance(known, HeldOut)]
    assert hidden == list(measured.FOLDS[fold] if fold else ())
    assert simulates.keys() == data.keys() == distances.keys()
    assert {*measured.RUNS, *goals.GOALS, "alone"} <= simulates.keys()


def test_each_run_is_in_one_fold():
    assert sorted(name for fold in measured.FOLDS.values() for name in fold) == sorted(
        measured.RUNS
    )


def test_the_numbers_that_are_free_are_the_presets_and_in_their_ranges():
    values = PRESETS["default"].parameters()
    for name, (low, high) in BOUNDS.items():
        assert low <= values[name] <= high, name
    assert {name for name in values if name.endswith(".weight")} <= BOUNDS.keys()


@pytest.mark.parametrize("run", measured.RUNS.values(), ids=measured.RUNS)
def test_people_can_walk_where_a_run_is_measured(run):
    plan = run.plan()
    for area in run.areas:
        assert plan.free.buffer(0.2).contains(area.intersection(plan.walkable))
        assert area.intersection(plan.free).area > 0.5 * area.area


def test_somebody_gets_round_a_person_whom_they_stand_behind():
    low, high, _ = goals.GOALS["round_somebody"]
    assert low <= goals.round_somebody(3) <= high
