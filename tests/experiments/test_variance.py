"""Variance components: by hand, against the textbook's coefficients, and how often they hold."""

import importlib.util
import re
import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa
import pytest

from mesa_mobility.errors import ModelError, ResultsError
from mesa_mobility.experiments import variance_components
from mesa_mobility.experiments.variance import _expected
from mesa_mobility.mobility import shipped_map_path

EXAMPLE = Path(__file__).parents[2] / "examples" / "experiments" / "recordings.py"


class Rows:
    """What stands for a store: rows of figures."""

    def __init__(self, rows):
        self.rows = pd.DataFrame(rows, columns=["map", "people", "y"])

    def __str__(self):
        return "rows"

    def table(self, columns):
        frame = self.rows.assign(status="done")
        return pa.Table.from_pandas(frame[[c for c in ("status", *columns) if c in frame]])


def nested(rng, maps, crowds, runs, deviations):
    rows = []
    for a in range(maps):
        of_map = rng.normal(0, deviations[0])
        for b in range(crowds):
            of_crowd = rng.normal(0, deviations[1])
            rows += [(a, b, of_map + of_crowd + rng.normal(0, deviations[2])) for _ in range(runs)]
    return Rows(rows)


def test_two_maps_two_crowds_two_runs_by_hand():
    # Mean squares 128, 16 and 2: variances (128 - 16) / 4, (16 - 2) / 2 and 2.
    rows = [
        (1, 1, 1),
        (1, 1, 3),
        (1, 2, 5),
        (1, 2, 7),
        (2, 3, 9),
        (2, 3, 11),
        (2, 4, 13),
        (2, 4, 15),
    ]
    found = variance_components(Rows(rows), "y", ["map", "people"])
    assert [(each.source, each.groups) for each in found] == [
        ("map", 2),
        ("people", 4),
        ("chance", 8),
    ]
    assert [each.variance for each in found] == pytest.approx([28, 7, 2])
    assert [each.share.value for each in found] == pytest.approx([28 / 37, 7 / 37, 2 / 37])
    for each in found:
        assert 0 <= each.share.low <= each.share.value <= each.share.high <= 1
    # Names of inner groups count within outer ones only.
    again = [(a, b % 2, y) for a, b, y in rows]
    assert variance_components(Rows(again), "y", ["map", "people"]) == found


def test_one_level_is_the_one_way_analysis():
    # Means 2 and 6, squares within 4 and between 16 of 1 degree: (16 - 2) / 2.
    rows = [(1, 0, 1), (1, 0, 3), (2, 0, 5), (2, 0, 7)]
    assert [each.variance for each in variance_components(Rows(rows), "y", ["map"])] == (
        pytest.approx([7, 2])
    )


def test_groups_of_unequal_size_have_the_textbook_s_coefficients():
    sizes = [[3, 1], [2, 2, 4], [5]]
    people, maps = [], []
    for a, of in enumerate(sizes):
        for n in of:
            people += [len(set(people))] * n
            maps += [a] * n
    n = len(maps)
    groups = [np.zeros(n, int), np.array(maps), np.array(people), np.arange(n)]
    by_map = [sum(of) for of in sizes]
    within = sum(sum(k**2 for k in of) / sum(of) for of in sizes)
    cells = sum(k**2 for of in sizes for k in of)
    assert _expected(groups) == pytest.approx(
        np.array(
            [
                [n - sum(m**2 for m in by_map) / n, within - cells / n, 3 - 1],
                [0, n - within, 6 - 3],
                [0, 0, n - 6],
            ]
        )
    )


def test_nothing_but_chance_has_no_other_share():
    found = variance_components(
        nested(np.random.default_rng(1), 20, 10, 5, (0, 0, 1)), "y", ["map", "people"]
    )
    assert found[2].share.value > 0.95
    assert found[0].share.low == found[1].share.low == 0.0


@pytest.mark.slow
def test_intervals_hold_the_shares():
    true = np.array([1.0, 4.0, 2.0]) / 7.0
    held, rounds = np.zeros(3), 300
    for seed in range(rounds):
        rows = nested(np.random.default_rng(seed), 8, 8, 4, (1.0, 2.0, 2.0**0.5))
        found = variance_components(rows, "y", ["map", "people"])
        held += [
            each.share.low <= t <= each.share.high for each, t in zip(found, true, strict=True)
        ]
    # Three standard deviations of a binomial below 95 %; generalised intervals are rather wide.
    assert (held / rounds > 0.912).all(), held / rounds


@pytest.mark.parametrize(
    ("rows", "levels", "error", "message"),
    [
        ([(1, 1, 1), (1, 1, 3)], ["map"], ResultsError, "1 groups of map in 1 of the level above"),
        ([(1, 1, 1), (2, 1, 3)], ["map"], ResultsError, "2 groups of chance in 2 of the level"),
        ([(1, 1, 1)], [], ModelError, "levels is "),
        ([(1, 1, 1)], "map", ModelError, "levels is 'map'"),
        ([(1, 1, 1)], ["crowd"], ResultsError, "rows: has no column crowd"),
        ([], ["map"], ResultsError, "0 groups of map in 0"),
    ],
)
def test_what_is_no_nested_experiment(rows, levels, error, message):
    with pytest.raises(error, match=message):
        variance_components(Rows(rows), "y", levels)


@pytest.mark.slow
def test_the_example_finds_nothing_where_all_maps_are_one(tmp_path, capsys):
    spec = importlib.util.spec_from_file_location("recordings", EXAMPLE)
    example = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(example)
    (tmp_path / "maps").mkdir()
    for number in range(3):
        shutil.copy(shipped_map_path("able_bodied"), tmp_path / "maps" / f"{number}.npz")
    picture = tmp_path / "picture.png"
    example.main(tmp_path / "maps", tmp_path / "store", picture, crowds=3, replications=2)
    printed = capsys.readouterr().out
    assert "18 runs" in printed
    shares = [int(n) for n in re.findall(r"share (\d+)%", printed)]
    assert sum(shares) == pytest.approx(100, abs=1)
    # The intervals of the recordings' share reach down to nothing.
    assert re.search(r"recordings: .* \(0% to ", printed)
    assert picture.stat().st_size > 10_000
