"""Designs, compared in pairs of runs with common seeds."""

import math

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from mesa_mobility.errors import ModelError, ResultsError
from mesa_mobility.experiments import Experiment, compare, run_experiment
from mesa_mobility.experiments.comparing import compare_pairs, smallest_difference
from mesa_mobility.experiments.definition import from_definition, to_definition
from mesa_mobility.experiments.observed import observed
from mesa_mobility.results import read_parquet

LEAVING = "tests.fixtures.experiments.models:Leaving"


def store_of(tmp_path, **given):
    keywords = {"parameters": {"width": [1.0, 1.1]}, "replications": 20, "seeds": "common"}
    experiment = Experiment(LEAVING, **{**keywords, **given})
    return run_experiment(experiment, tmp_path / "store", executor="serial")


def drawn(rng, ratio, pairs=20, common=0.05, own=0.02):
    """Times of two designs: people that both have in common, and chance of each run."""
    people = rng.normal(0.0, common, (pairs, 1))
    return np.array([100.0, 100.0 * ratio]) * (1 + people + rng.normal(0.0, own, (pairs, 2)))


def test_common_seeds_are_the_same_at_all_points(tmp_path):
    seeds = {}
    for kind in ("common", "independent"):
        frame = store_of(tmp_path / kind, seeds=kind, replications=3).frame()
        seeds[kind] = [set(of.seed) for _, of in frame.groupby("width")]
        assert all(len(each) == 3 for each in seeds[kind])
    assert seeds["common"][0] == seeds["common"][1]
    assert not seeds["independent"][0] & seeds["independent"][1]


def test_the_file_says_which_seeds_and_a_store_keeps_to_them(tmp_path):
    experiment = Experiment(LEAVING, {"width": [1.0]}, seeds="common")
    assert from_definition(to_definition(experiment)).seeds == "common"
    run_experiment(experiment, tmp_path, executor="serial")
    with pytest.raises(ModelError, match="holds runs with seeds common, got independent"):
        run_experiment(Experiment(LEAVING, {"width": [1.0]}), tmp_path, executor="serial")
    with pytest.raises(ModelError, match="seeds is 'same', expected independent or common"):
        Experiment(LEAVING, seeds="same")


def test_a_comparison_is_the_paired_test_of_the_field(tmp_path):
    store = store_of(tmp_path)
    [found] = compare(store, by="width", figure="egress_s")
    wide = store.frame().pivot(index="replication", columns="width", values="egress_s")
    before, after = wide[1.0].to_numpy(), wide[1.1].to_numpy()
    theirs = stats.ttest_rel(after, before)
    assert (found.first, found.second) == (1.0, 1.1)
    assert found.p == pytest.approx(theirs.pvalue)
    interval = theirs.confidence_interval(0.95)
    assert found.difference.value == pytest.approx((after - before).mean())
    assert (found.difference.low, found.difference.high) == pytest.approx(tuple(interval))
    assert found.effect == pytest.approx(theirs.statistic / math.sqrt(20))
    assert found.relative == pytest.approx((after - before).mean() / before.mean())
    assert found.correlation == pytest.approx(np.corrcoef(before, after)[0, 1])
    assert found.correlation > 0.7
    assert found.greater + found.less == 20
    assert found.different
    assert "different (p = " in str(found)


def test_independent_seeds_have_no_correlation_and_find_less(tmp_path):
    common = compare(store_of(tmp_path / "a"), by="width", figure="egress_s")[0]
    apart = compare(store_of(tmp_path / "b", seeds="independent"), "width", "egress_s")[0]
    assert abs(apart.correlation) < 0.5
    assert apart.detectable > 1.5 * common.detectable


def test_a_difference_of_five_percent_is_found_in_nine_of_ten_tries():
    rng = np.random.default_rng(1)
    found = [compare_pairs("a", "b", drawn(rng, 1.05)).different for _ in range(200)]
    assert np.mean(found) >= 0.9


def test_equal_designs_are_rarely_called_different():
    rng = np.random.default_rng(2)
    found = [compare_pairs("a", "b", drawn(rng, 1.0)).different for _ in range(200)]
    assert np.mean(found) <= 0.08


def test_equal_designs_among_six_are_rarely_called_different(tmp_path):
    """Of 15 comparisons at once, with the confidence of all together."""
    rng = np.random.default_rng(3)
    wrong = 0
    for _ in range(60):
        times = 100 * (1 + rng.normal(0, 0.05, (20, 1)) + rng.normal(0, 0.02, (20, 6)))
        pairs = [times[:, [i, k]] for i in range(6) for k in range(i + 1, 6)]
        wrong += any(compare_pairs(0, 1, p, confidence=1 - 0.05 / 15).different for p in pairs)
    assert wrong <= 0.12 * 60
    store = store_of(tmp_path, parameters={"width": [1.0, 1.1, 1.2]}, replications=5)
    found = compare(store, "width", "egress_s")
    assert [(f.first, f.second) for f in found] == [(1.0, 1.1), (1.0, 1.2), (1.1, 1.2)]
    frame = store.frame().pivot(index="replication", columns="width", values="egress_s")
    wider = stats.ttest_rel(frame[1.1], frame[1.0]).confidence_interval(1 - 0.05 / 3)
    assert found[0].difference.low == pytest.approx(wider.low)


def test_the_smallest_difference_is_found_with_the_power_asked_for():
    least = smallest_difference(2.0, 20, power=0.9)
    # As tables of the field have it: (1.96 + 1.28) * 2 / sqrt(20) for large samples.
    assert 1.45 < least < 1.7
    rng = np.random.default_rng(4)
    drawn_ = rng.normal(least, 2.0, (4000, 20))
    p = stats.ttest_1samp(drawn_, 0.0, axis=1).pvalue
    assert np.mean(p <= 0.05) == pytest.approx(0.9, abs=0.02)
    assert smallest_difference(0.0, 20) == 0.0
    assert smallest_difference(2.0, 2) > smallest_difference(2.0, 3) > least
    assert smallest_difference(2.0, 2, confidence=0.9999, power=0.999) > 1000.0


def test_other_parameters_are_the_same_in_a_pair(tmp_path):
    parameters = {"width": [1.0, 1.1], "hall": [0, 500]}
    [found] = compare(
        store_of(tmp_path, parameters=parameters, replications=4), "width", "egress_s"
    )
    assert found.difference.runs == 8
    # Halls differ by 500 s, which would hide everything if runs of different halls made pairs.
    assert abs(found.difference.value) < 60.0


def test_runs_that_stall_are_later_than_all_others(tmp_path):
    [found] = compare(store_of(tmp_path, fixed={"stalling": 0.3}), "width", "egress_s")
    # Common seeds stall at both points: these pairs say nothing of which is the slower.
    assert found.difference.value is None
    assert 0 < found.difference.not_reached < 20
    assert found.greater + found.less == 20 - found.difference.not_reached
    assert found.p == stats.binomtest(found.greater, found.greater + found.less).pvalue
    one = np.array([[1.0, np.inf]] * 8)
    slower = compare_pairs("a", "b", one)
    assert (slower.greater, slower.less, slower.different) == (8, 0, True)
    assert compare_pairs("a", "b", np.full((5, 2), np.inf)).p == 1.0


def test_no_scatter_at_all():
    same = compare_pairs("a", "b", np.full((4, 2), 7.0))
    assert (same.p, same.different, same.effect, same.correlation) == (1.0, False, None, None)
    apart = compare_pairs("a", "b", np.array([[7.0, 8.0]] * 4))
    assert (apart.p, apart.different, apart.detectable) == (0.0, True, 0.0)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"by": "depth"}, "no parameter 'depth', expected one of hall, width"),
        ({"by": "hall"}, "runs at 1 values of hall, expected two or more"),
        ({"figure": "flow"}, "has no column flow"),
        ({"figure": "worker"}, "column worker has no numbers"),
        ({"confidence": 1.0}, "confidence is 1.0"),
        ({"power": 0.01}, "power is 0.01, expected a number between 1 - confidence and 1"),
    ],
)
def test_what_cannot_be_compared(tmp_path, given, said):
    store = store_of(tmp_path, fixed={"hall": 0}, replications=2)
    with pytest.raises((ModelError, ResultsError), match=said):
        compare(store, **{"by": "width", "figure": "egress_s", **given})


def test_one_pair_is_too_few(tmp_path):
    with pytest.raises(ResultsError, match="1 pairs of runs at width"):
        compare(store_of(tmp_path, replications=1), "width", "egress_s")


def test_doors_of_runs_are_columns_to_compare(tmp_path):
    experiment = Experiment(
        "doorway",
        {"door_width": [0.9, 1.4]},
        fixed={"pedestrians": 12},
        replications=2,
        max_seconds=60,
        seeds="common",
        keep=["doors", "trajectories"],
    )
    store = run_experiment(experiment, tmp_path, executor="serial")
    frame = store.frame().set_index("run")
    for run, row in frame.iterrows():
        tracks = read_parquet(tmp_path / "trajectories" / f"{run}.parquet")
        left = np.sort(tracks.exit_frames) / 30
        assert (row.t50_s, row.t100_s) == (left[5], left[11])
        assert row.t100_s == pytest.approx(row.egress_s, abs=1e-5)
        assert row["door.first door.people"] == 12
    [found] = compare(store, "door_width", "door.first door.flow_per_s")
    assert found.difference.runs == 2
    known = store.estimates("mean door.first door.flow_per_s")
    flows = frame.groupby("point")["door.first door.flow_per_s"].mean()
    assert {key: each.value for key, each in known.items()} == pytest.approx(flows.to_dict())


def test_people_inside_at_the_end_are_censored(tmp_path):
    experiment = Experiment("doorway", fixed={"pedestrians": 12}, max_seconds=4, keep=["doors"])
    store = run_experiment(experiment, tmp_path, executor="serial")
    assert store.frame().t100_s.isna().all()
    [known] = store.estimates("p50 t100_s").values()
    assert (known.value, known.not_reached, known.runs) == (None, 1, 1)


def test_times_that_were_reached_before_a_stall_count():
    runs = pd.DataFrame(
        {
            "status": ["done", "stalled", "stalled", "failed"],
            "t50_s": [10.0, 12.0, np.nan, np.nan],
            "door.east.last_s": [20.0, 15.0, np.nan, np.nan],
        }
    )
    np.testing.assert_array_equal(observed(runs, "t50_s"), [10.0, 12.0, np.inf, np.nan])
    np.testing.assert_array_equal(
        observed(runs, "door.east.last_s"), [20.0, np.inf, np.inf, np.nan]
    )
