"""As many runs as it takes, sensitivity, and the report."""

import json
import math
import re

import numpy as np
import pytest

from mesa_mobility.errors import ModelError, ResultsError
from mesa_mobility.experiments import (
    Experiment,
    MorrisTrajectories,
    Precision,
    SaltelliSamples,
    morris_screening,
    run_experiment,
    sobol_indices,
    write_report,
)

# Hundreds of runs and resamplings.
pytestmark = pytest.mark.slow

MODELS = "tests.fixtures.experiments.models:"
CUBE = {"x1": (-math.pi, math.pi), "x2": (-math.pi, math.pi), "x3": (-math.pi, math.pi)}


def emptying(seed=1, tolerance=0.05, **keywords):
    precision = Precision(("mean egress_s",), tolerance, occupancy=None, **keywords)
    return Experiment(MODELS + "Emptying", replications="auto", precision=precision, seed=seed)


def test_runs_until_the_mean_is_known(tmp_path):
    store = run_experiment(emptying(), tmp_path / "s", executor="serial")
    [known] = store.assessments().values()
    # A lognormal with sigma 0.2 has a standard deviation of about 0.2 of its mean: the half-width
    # of 5 % takes (1.96 * 0.2 / 0.05) ** 2 = 61 runs, give or take.
    assert 35 <= known.runs <= 100
    assert known.enough
    found = known.estimates["mean egress_s"]
    assert found.half_width <= 0.05 * found.value
    totals = []
    run_experiment(
        emptying(), tmp_path / "s", executor="serial", progress=lambda now: totals.append(now.total)
    )
    assert totals == []


def test_no_more_runs_than_the_most_and_the_report_says_so(tmp_path):
    experiment = emptying(tolerance=0.0001, most=30)
    store = run_experiment(experiment, tmp_path / "s", executor="serial")
    [known] = store.assessments().values()
    assert (known.runs, known.enough) == (30, False)
    text = write_report(store).read_text(encoding="utf-8")
    found = known.estimates["mean egress_s"]
    assert f"{found.value:.4g} ({found.low:.4g} to {found.high:.4g}): not reached" in text
    assert "maximum of runs" in text


def test_as_many_runs_whatever_runs_them(tmp_path):
    runs = [
        run_experiment(emptying(), tmp_path / kind, executor=kind, workers=2).frame().run
        for kind in ("serial", "processes")
    ]
    assert list(runs[0]) == list(runs[1])


@pytest.mark.slow
def test_stated_intervals_hold_the_mean(tmp_path):
    true_mean = math.exp(3.0 + 0.2**2 / 2)
    held = 0
    for seed in range(300):
        store = run_experiment(emptying(seed), tmp_path / f"{seed}", executor="serial")
        [known] = store.assessments().values()
        found = known.estimates["mean egress_s"]
        held += found.low <= true_mean <= found.high
    # 95 % of 300, give or take three standard deviations of a binomial: 285 +- 11.
    assert 0.913 < held / 300 < 0.988


def test_sobol_indices_of_the_ishigami_function(tmp_path):
    pytest.importorskip("SALib", reason="needs the extra sensitivity")
    experiment = Experiment(MODELS + "Ishigami", SaltelliSamples(CUBE, samples=1024))
    store = run_experiment(experiment, tmp_path / "s", executor="serial")
    found = sobol_indices(store, "value")
    a, b = 7.0, 0.1
    v1 = 0.5 * (1 + b * math.pi**4 / 5) ** 2
    v2 = a**2 / 8
    v13 = b**2 * math.pi**8 * (1 / 18 - 1 / 50)
    v = v1 + v2 + v13
    for name, first, total in (
        ("x1", v1 / v, (v1 + v13) / v),
        ("x2", v2 / v, v2 / v),
        ("x3", 0.0, v13 / v),
    ):
        assert found[name]["first"] == pytest.approx(first, abs=0.05)
        assert found[name]["total"] == pytest.approx(total, abs=0.05)
        assert 0 < found[name]["total_conf"] < 0.1
    with pytest.raises(ModelError, match="Morris: the design is sobol_indices, expected morris"):
        morris_screening(store, "value")
    with pytest.raises(ResultsError, match="has no column valeu"):
        sobol_indices(store, "valeu")


def test_morris_screening_of_a_plane(tmp_path):
    pytest.importorskip("SALib", reason="needs the extra sensitivity")
    # Near 0 the function is x1 + 7 x2**2: linear in the first, nothing in the third.
    between = {"x1": (-1e-3, 1e-3), "x2": (0.0, 1e-6), "x3": (0.0, 1e-3)}
    experiment = Experiment(MODELS + "Ishigami", MorrisTrajectories(between, trajectories=4))
    store = run_experiment(experiment, tmp_path / "s", executor="serial")
    found = morris_screening(store, "value")
    assert found["x1"]["mean"] == pytest.approx(2e-3, rel=1e-3)
    assert found["x1"]["sd"] < 1e-8
    assert found["x3"]["mean_abs"] < 1e-12


def test_analyses_need_all_points(tmp_path):
    pytest.importorskip("SALib", reason="needs the extra sensitivity")
    experiment = Experiment(
        MODELS + "Quick", SaltelliSamples({"x": (0.0, 1.0)}, samples=2), fixed={"end": "raise"}
    )
    store = run_experiment(experiment, tmp_path / "s", executor="serial")
    with pytest.raises(ResultsError, match="has no column y"):
        sobol_indices(store, "y")


def test_the_report_needs_no_other_file_and_has_all_of_it(tmp_path):
    experiment = Experiment(
        MODELS + "Quick",
        {"x": [0.0, 1.0], "end": ["well", "raise"]},
        replications=3,
        name="Two <ends>",
    )
    store = run_experiment(experiment, tmp_path / "s", executor="serial")
    text = write_report(store).read_text(encoding="utf-8")
    assert "<h1>Two &lt;ends&gt;</h1>" in text
    assert not re.search(r"(?:src|href)=\"(?!data:|#)", text)
    # Of y and of summary_x each run and mean, and how the mean settles.
    assert text.count("data:image/png;base64,") == 4
    assert "ValueError: a step that fails" in text
    frame = store.frame()
    mean = frame[(frame.x == 1.0) & (frame.end == "well")].y.mean()
    # Three runs have a mean without an interval.
    assert re.search(rf"<td[^>]*>{mean:.4g}</td>", text)
    versions = json.loads((tmp_path / "s" / "experiment.json").read_text())["sessions"][0]
    for value in (*versions["versions"].values(), *versions["inputs"].values()):
        assert value in text


def test_an_empty_store_has_no_report(tmp_path):
    experiment = Experiment(MODELS + "Quick", {"x": [0.0]})
    with pytest.raises(RuntimeError):
        run_experiment(experiment, tmp_path / "s", executor="serial", progress=_stop)
    from mesa_mobility.experiments import open_store

    with pytest.raises(ResultsError, match="has no runs yet"):
        write_report(open_store(tmp_path / "s"))
    with pytest.raises(ResultsError, match=r"has no experiment\.json"):
        open_store(tmp_path)


def _stop(now):
    raise RuntimeError


def test_runs_keep_occupancy_and_trajectories_where_they_are_asked_to(tmp_path):
    from mesa_mobility.results import read_parquet

    experiment = Experiment(
        "straight_walk",
        {"pedestrians": 2},
        fixed={"length": 6.0},
        max_seconds=20,
        keep=["occupancy", "trajectories"],
    )
    store = run_experiment(experiment, tmp_path / "s", executor="serial")
    [row] = store.frame(series=True).to_dict("records")
    assert row["occupancy"][0] == 2
    assert list(np.diff(row["occupancy"]) <= 0) == [True] * (len(row["occupancy"]) - 1)
    [kind] = row["types"]
    assert (kind["type"], kind["people"], kind["left"]) == (0, 2, 2)
    assert kind["longest_s"] == pytest.approx(row["egress_s"], abs=0.05)
    path = tmp_path / "s" / "trajectories" / f"{row['run']}.parquet"
    assert read_parquet(path).people == 2
