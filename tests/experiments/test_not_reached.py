"""Runs that stall or time out are the slowest: they stay in the statistics."""

import math

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mesa_mobility.errors import ModelError, ResultsError
from mesa_mobility.experiments import (
    Estimate,
    Experiment,
    OccupancyConvergence,
    Precision,
    SaltelliSamples,
    mean_interval,
    quantile_interval,
    run_experiment,
    sobol_indices,
    variance_components,
    write_report,
)
from mesa_mobility.experiments.convergence import assess
from mesa_mobility.experiments.observed import estimate, is_time, observed

MODEL = "tests.fixtures.experiments.models:Partly"
INF, NAN = math.inf, math.nan


def test_the_percentile_of_25_runs_of_which_two_stalled():
    values = np.append(np.arange(304.0, 327.0), [INF, INF])
    # The 95th percentile lies between the 23rd and the 24th in order, which has not come.
    found = quantile_interval(values, 0.95)
    assert (found.value, found.beyond, found.not_reached, found.runs) == (None, 326.0, 2, 25)
    assert str(found) == "> 326, not reached in 2 of 25"
    mean = mean_interval(values)
    assert (mean.value, mean.low) == (None, None)
    assert str(mean) == "not given: 2 of 25 have none"
    # The median is the 13th of 25. Its interval reaches from the 8th to the 18th.
    median = quantile_interval(values, 0.5)
    assert (median.value, median.low, median.high) == (316.0, 311.0, 321.0)
    assert str(median) == "316 (311 to 321), not reached in 2 of 25"


def test_the_end_of_an_interval_may_lie_among_those_not_reached():
    # Of ten values the interval of the median reaches from the second to the ninth.
    found = quantile_interval([*range(1, 9), INF, INF], 0.5)
    assert (found.value, found.low, found.high) == (5.5, 2.0, INF)
    assert found.half_width == INF
    assert str(found) == "5.5 (2 to not reached), not reached in 2 of 10"


def test_a_quantile_between_the_last_reached_and_the_first_not_reached_is_not_given():
    assert quantile_interval([1.0, 2.0, 3.0, INF], 0.75).value is None
    assert quantile_interval([1.0, 2.0, 3.0, 4.0, INF], 0.75).value == 4.0
    assert quantile_interval([INF, INF], 0.5) == Estimate(None, runs=2, not_reached=2)


@given(
    st.lists(st.integers(0, 10**6), min_size=1, max_size=60),
    st.integers(0, 30),
    st.floats(0.01, 0.99),
)
def test_later_than_all_others_means_as_late_as_one_likes(reached, stalled, q):
    """A quantile that is given is the same wherever the late ones lie; else it moves with them."""
    values = np.array([float(each) for each in reached] + [INF] * stalled)
    found = quantile_interval(values, q).value
    late = [np.quantile(np.where(np.isinf(values), at, values), q) for at in (2e6, 3e6)]
    if found is None:
        assert late[1] > late[0]
    else:
        assert late == pytest.approx([found, found])


def runs(status, **columns):
    return pd.DataFrame({"status": status, **columns})


def test_what_counts_as_not_reached():
    rows = runs(
        ["done", "done", "stalled", "timed_out", "failed"],
        egress_s=[10.0, NAN, NAN, NAN, NAN],  # the second ended with people inside
        mean_time_inside_s=[8.0, NAN, 7.0, NAN, 5.0],
        mean_speed_mps=[1.0, 1.1, 0.4, NAN, 9.0],
        wall_s=[2.0, 2.0, 3.0, 4.0, 1.0],
    )
    assert observed(rows, "egress_s").tolist()[:4] == [10.0, INF, INF, INF]
    assert observed(rows, "mean_time_inside_s").tolist()[:4] == [8.0, INF, INF, INF]
    # A crowd that stalls has walked at some speed until then, and has taken time to compute.
    assert observed(rows, "mean_speed_mps").tolist()[:4] == [1.0, 1.1, 0.4, INF]
    assert observed(rows, "wall_s").tolist()[:4] == [2.0, 2.0, 3.0, INF]
    assert all(np.isnan(observed(rows, name)[4]) for name in rows if name != "status")


def test_which_columns_are_times():
    times = ("egress_s", "level.1.clear_s", "stairs.north.t95_s", "door.lift.last_s")
    others = ("flow_per_s", "mean_speed_mps", "lift.car.mean_wait_s", "stairs.north.mean_s")
    assert [is_time(name) for name in times + others] == [True] * 4 + [False] * 4


def test_of_what_is_no_time_no_percentile_is_given_where_one_is_lacking():
    values = np.array([1.0, 2.0, 3.0, INF])
    assert estimate("p50 flow_per_s", values).value is None
    assert estimate("p50 flow_per_s", values[:3]).value == 2.0
    assert estimate("p50 egress_s", values).value == 2.5


def test_more_runs_are_done_only_where_they_can_make_something_known():
    precision = Precision(tolerance=0.05, occupancy=None)
    values = np.array([100.0 + k % 3 for k in range(89)] + [INF])
    found = assess(precision, 90, {"egress_s": values}, [])
    # One in 90: no mean, but a percentile, of which the interval is not known yet.
    assert (found.met["mean egress_s"], found.estimates["p95 egress_s"].value) == (False, 102.0)
    assert found.estimates["p95 egress_s"].high == INF
    assert not found.hopeless
    # The percentile is known then, and the mean never.
    many = np.array([100.0 + k % 3 for k in range(399)] + [INF])
    found = assess(precision, 400, {"egress_s": many}, [])
    assert found.met == {"mean egress_s": False, "p95 egress_s": True}
    assert found.hopeless
    assert not found.unseen
    # Half of them stall: the percentile lies among these, as far as its interval goes.
    half = np.array([100.0, INF] * 50)
    assert assess(precision, 100, {"egress_s": half}, []).hopeless


def test_the_curve_is_not_known_where_a_run_has_timed_out():
    asked = Precision(("mean egress_s",), occupancy=OccupancyConvergence(consecutive=3))
    values = {"egress_s": np.full(20, 5.0)}
    assert assess(asked, 20, values, [[5, 3, 0]] * 20).enough
    found = assess(asked, 20, values, [[5, 3, 0]] * 19 + [None])
    assert (found.met["occupancy"], found.without_curve, found.hopeless) == (False, 1, True)


@pytest.fixture(scope="module")
def partly(tmp_path_factory):
    """30 runs without stalls, and 30 of which some stall and some time out."""
    experiment = Experiment(
        MODEL,
        {"stalling": [0.0, 0.2]},
        replications=30,
        seed=2,
        time_limit=0.03,
        fixed={"slow": 0.1},
    )
    place = tmp_path_factory.mktemp("partly") / "s"
    return run_experiment(experiment, place, executor="serial")


def test_the_report_names_the_runs_that_did_not_reach_a_figure(partly):
    frame = partly.frame()
    stalled, late = (int((frame.status == each).sum()) for each in ("stalled", "timed_out"))
    assert stalled > 2
    assert late > 2
    text = write_report(partly).read_text(encoding="utf-8")
    assert (
        f"Time until everybody is out (s): not reached in {stalled + late} of 60 runs ({stalled} "
        f"stalled, {late} timed out). They count as later than all others"
    ) in text
    lacking = int((frame[frame.stalling == 0.2].status != "done").sum())
    reached = frame[frame.stalling == 0.2].egress_s.max()
    assert f"<td>&gt; {reached:.4g}, not reached in {lacking} of 30</td>" in text
    assert f"<td>not given: {lacking} of 30 have none</td>" in text
    # The speed is lacking in those alone that timed out.
    assert (
        f"Mean speed, waiting included (m/s): not reached in {late} of 60 runs ({late} timed out)."
        in text
    )


def test_a_store_s_estimates_count_them_as_well(partly):
    found = partly.estimates("p50 egress_s")
    assert [each.runs for each in found.values()] == [30, 30]
    frame = partly.frame()
    for key, each in found.items():
        of = frame[frame.point == key].egress_s
        assert each.value == np.median(of.fillna(1e9))
        assert each.not_reached == of.isna().sum()
    with pytest.raises(ModelError, match="figure 'egress_s': expected one such as"):
        partly.estimates("egress_s")
    with pytest.raises(ResultsError, match="has no column egres_s"):
        partly.estimates("mean egres_s")


def test_shares_of_a_variance_need_all_runs(partly):
    frame = partly.frame()
    lacking = int(frame.egress_s.isna().sum())
    with pytest.raises(
        ResultsError, match=f"{lacking} of 60 runs have no egress_s: they stalled, timed out"
    ):
        variance_components(partly, "egress_s", ["stalling"])


def test_indices_need_a_mean_of_every_point(tmp_path):
    pytest.importorskip("SALib", reason="needs the extra sensitivity")
    design = SaltelliSamples({"stalling": (0.3, 0.6)}, samples=2)
    store = run_experiment(
        Experiment(MODEL, design, replications=5, seed=1), tmp_path / "s", executor="serial"
    )
    assert store.frame().groupby("point").egress_s.apply(lambda of: of.isna().any()).all()
    with pytest.raises(ResultsError, match="6 of 6 points have no mean egress_s"):
        sobol_indices(store, "egress_s")


def test_failed_runs_are_left_out_with_a_warning(tmp_path):
    experiment = Experiment(
        "tests.fixtures.experiments.models:Quick",
        {"end": ["well", "raise"]},
        replications=3,
        seed=1,
    )
    store = run_experiment(experiment, tmp_path / "s", executor="serial")
    with (
        pytest.warns(RuntimeWarning, match="3 of 6 runs have failed, and are left out"),
        pytest.raises(ResultsError, match="1 groups of end"),
    ):
        variance_components(store, "y", ["end"])
