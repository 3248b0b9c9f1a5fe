"""Calibrations of a scenario that takes no time: what was set is found again."""

import json
from functools import partial

import numpy as np
import pytest

from mesa_mobility.calibration import Distance, Free, HeldOut, Search, Seeds, calibrate
from mesa_mobility.crowd import read_preset
from mesa_mobility.errors import ModelError, ResultsError
from mesa_mobility.experiments import open_store
from tests.fixtures.engine import ENGINE
from tests.fixtures.experiments import calibrations as fixture

pytest.importorskip("cmaes", reason="needs the extra calibration")

searched = partial(Search, preset=ENGINE)
FREE = [Free("headway.time", 0.2, 3.0), Free("sideways.weight", 0.1, 10.0, log=True)]
TRUE = {"time": 0.7, "weight": 4.0}


def given(tmp_path, **changes):
    """Arguments of a calibration with a scenario to train on and one that is held out."""
    return {
        "scenarios": {"seen": fixture.rules, "new": partial(fixture.product, factor=2.0)},
        "data": {"seen": TRUE, "new": HeldOut({"product": 5.6})},
        "free": FREE,
        "distances": [fixture.relative],
        "store": tmp_path / "store",
        "search": searched(evaluations=30),
        "executor": "serial",
        **changes,
    }


def contents(folder):
    """All that a calibration has left but the stores, which have times."""
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}


def rows(folder):
    """What was run, and what it gave, without times."""
    found = {}
    for part in ("training", "held_out"):
        frame = open_store(folder / part).frame()
        kept = frame.drop(columns=["began", "wall_s", "cpu_s", "worker", "inputs", "seed"])
        found[part] = kept.to_json()
    return found


@pytest.mark.thorough
def test_numbers_are_found_again_and_held_out_data_agree(tmp_path):
    found = calibrate(**given(tmp_path, search=searched(evaluations=240)))
    assert found.values["headway.time"] == pytest.approx(0.7, rel=0.02)
    assert found.values["sideways.weight"] == pytest.approx(4.0, rel=0.02)
    preset = read_preset(tmp_path / "store" / "preset.toml")
    assert preset.parameters() == ENGINE.parameters() | found.values
    frame = found.frame().set_index(["part", "scenario", "distance"])
    # At the start 1.2 s and 2.2: by hand.
    start = np.mean([1.2 / 0.7 - 1.0, 1.0 - 2.2 / 4.0])
    for part in ("training", "new seeds"):
        row = frame.loc[part, "seen", "relative"]
        assert row.start == pytest.approx(start)
        assert row.found < 0.02
        assert frame.loc[part, "", "objective"].start == pytest.approx(start)
    held_out = frame.loc["held-out data", "new", "relative"]
    assert held_out.start == pytest.approx(1.0 - 2.0 * 1.2 * 2.2 / 5.6)
    assert held_out.found < 0.04
    assert held_out.verdict == "better"
    provenance = preset.provenance
    assert provenance.figures["held-out data: relative, new"] == held_out.found


def test_each_generation_has_new_seeds_and_held_out_data_are_run_in_the_end_alone(tmp_path):
    found = calibrate(**given(tmp_path, seeds=Seeds(each=2, held_out=3)))
    # 4 + 3 ln(2), rounded down.
    assert [len(each.numbers) for each in found.history] == [6] * 5
    training = open_store(tmp_path / "store" / "training").frame()
    assert set(training.scenario) == {"seen"}
    # 30 sets with 2 seeds, and two more sets with the seeds of the last generation.
    assert len(training) == 5 * 6 * 2 + 2 * 2
    seeds = training.groupby("scenario_seed").size()
    assert sorted(seeds) == [6] * 8 + [8] * 2
    held_out = open_store(tmp_path / "store" / "held_out").frame()
    assert held_out.groupby("scenario").size().to_dict() == {"seen": 6, "new": 6}
    assert not set(seeds.index) & set(held_out.scenario_seed)
    assert held_out.scenario_seed.nunique() == 3
    # The numbers of each run are those of its models.
    row = training.iloc[0]
    assert json.loads(row.inputs) == {
        "preset": f"engine, calibration, sha256 {ENGINE.digest}",
        "changed numbers": f"headway.time = {row['headway.time']}; "
        f"sideways.weight = {row['sideways.weight']} (experiment)",
    }
    # Both figures are in the report.
    page = (tmp_path / "store" / "report.html").read_text(encoding="utf-8")
    for said in ("Training: data and seeds", "New seeds: data", "Held-out data: neither"):
        assert said in page


def test_resumed_is_uninterrupted_and_more_evaluations_go_on(tmp_path):
    whole = calibrate(**given(tmp_path / "whole", search=searched(evaluations=24)))
    marks = tmp_path / "marks"
    scenario = partial(fixture.interrupted, marks=str(marks))
    words = given(tmp_path / "other", scenarios={"seen": scenario, "new": fixture.product})
    words["data"] = {"seen": TRUE, "new": HeldOut({"product": 2.8})}
    words["search"] = searched(evaluations=24)
    marks.write_text("9")
    with pytest.raises(KeyboardInterrupt):
        calibrate(**words)
    assert len(open_store(tmp_path / "other" / "store" / "training").frame()) >= 6
    marks.write_text("1000")
    resumed = calibrate(**words)
    assert resumed.values == whole.values
    assert [each.costs for each in resumed.history] == [each.costs for each in whole.history]
    # Nothing was run twice.
    done = 1000 - int(marks.read_text())
    assert done == 24 + 2 + 2 * 5 - 9
    few = calibrate(**given(tmp_path / "more", search=searched(evaluations=12)))
    more = calibrate(**given(tmp_path / "more", search=searched(evaluations=24)))
    assert len(few.history) == 2
    assert contents(tmp_path / "more" / "store") == contents(tmp_path / "whole" / "store")
    assert more.values == whole.values


@pytest.mark.thorough
def test_the_same_bytes_whatever_the_number_of_processes(tmp_path):
    found = {}
    for name, executor, workers in (("one", "serial", None), ("two", "processes", 2)):
        words = given(tmp_path / name, executor=executor, workers=workers)
        calibrate(**words | {"search": searched(evaluations=12)})
        found[name] = contents(tmp_path / name / "store"), rows(tmp_path / name / "store")
    assert found["one"] == found["two"]


@pytest.mark.slow
def test_the_same_on_dask(tmp_path, dask_cluster):
    found = {}
    for name, executor in (("one", "serial"), ("dask", dask_cluster)):
        words = given(tmp_path / name, executor=executor, search=searched(evaluations=12))
        calibrate(**words)
        found[name] = contents(tmp_path / name / "store"), rows(tmp_path / name / "store")
    assert found["one"] == found["dask"]


def test_sets_whose_runs_fail_are_the_worst_and_are_counted(tmp_path):
    scenario = partial(fixture.failing, above=1.5)
    words = given(tmp_path, scenarios={"seen": scenario}, data={"seen": {"time": 0.9}})
    found = calibrate(**words | {"free": [Free("headway.time", 0.2, 3.0)]})
    failed = sum(each.failed for each in found.history)
    times = [each["headway.time"] for of in found.history for each in of.numbers]
    assert failed == sum(time > 1.5 for time in times) > 0
    for of in found.history:
        # In the order of the search: all that failed cost more than all others.
        by_cost = sorted(zip(of.costs, of.numbers, strict=True), key=lambda each: each[0])
        late = [each["headway.time"] > 1.5 for _, each in by_cost]
        assert late == sorted(late)
    assert found.values["headway.time"] < 1.5


def test_where_all_fail_the_reason_is_one_line(tmp_path):
    words = given(tmp_path, scenarios={"seen": partial(fixture.failing, above=0.0)})
    words["data"] = {"seen": TRUE}
    with pytest.raises(ResultsError, match="all runs of these numbers fail, the first: ") as no:
        calibrate(**words)
    assert str(no.value).endswith("ValueError: too long")
    words = given(tmp_path / "nan", distances=[fixture.undefined])
    with pytest.raises(ResultsError, match="seen: distance undefined is nan, expected a finite"):
        calibrate(**words)


def test_weights_scenarios_and_seeds_make_the_objective(tmp_path):
    noisy = partial(fixture.rules, noise=0.1)
    found = calibrate(
        **given(
            tmp_path,
            scenarios={"a": noisy, "b": fixture.product},
            data={"a": {"time": 1.0}, "b": {"product": 2.0}},
            distances={
                "a": [Distance(fixture.squared, 3.0), Distance(fixture.relative, 0.5, "share")],
                "b": [fixture.squared],
            },
            seeds=Seeds(each=2, held_out=4, first=7),
            search=searched(evaluations=6),
        )
    )
    training = open_store(tmp_path / "store" / "training").frame()
    ((numbers, costs),) = [(each.numbers, each.costs) for each in found.history]
    for values, cost in zip(numbers, costs, strict=True):
        own = training[training["headway.time"] == values["headway.time"]]
        a, b = own[own.scenario == "a"], own[own.scenario == "b"]
        expected = 3.0 * a["distance squared"].mean() + 0.5 * a["distance share"].mean()
        assert cost == pytest.approx((expected + b["distance squared"].mean()) / 2.0)
        # By hand, from the numbers and the noise of the seeds.
        for row in a.itertuples():
            drawn = np.random.default_rng(row.scenario_seed).normal(0.0, 0.1)
            off = values["headway.time"] + drawn - 1.0
            assert a.loc[row.Index, "distance squared"] == pytest.approx(off**2)
            assert a.loc[row.Index, "distance share"] == pytest.approx(abs(off))


def test_data_of_files_are_read_by_functions_and_have_digests(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "numbers.txt"
    file.write_text("time 0.7\nweight 4.0\n")
    data = {"seen": partial(fixture.Reader.read, "numbers.txt"), "new": HeldOut({"product": 5.6})}
    found = calibrate(**given(tmp_path, data=data, search=searched(evaluations=6)))
    import hashlib

    digest = hashlib.sha256(file.read_bytes()).hexdigest()
    assert found.preset.provenance.data == {"numbers.txt": digest}
    assert digest in (tmp_path / "store" / "report.html").read_text(encoding="utf-8")
    file.write_text("time 0.8\nweight 4.0\n")
    with pytest.raises(ModelError, match="holds a calibration with other files, expected another"):
        calibrate(**given(tmp_path, data=data, search=searched(evaluations=6)))


@pytest.mark.thorough
def test_models_are_run_and_their_trajectories_compared(tmp_path):
    found = calibrate(
        {"walkers": fixture.Walkers, "doorway": "tests.fixtures.experiments.calibrations:Walkers"},
        {"walkers": 4.0, "doorway": HeldOut(4.0)},
        free=[Free("keep_distance.distance", 0.5, 3.0, start=1.5), Free("headway.time", 0.2, 3.0)],
        distances=[fixture.mean_time],
        store=tmp_path / "store",
        search=Search(evaluations=6, max_seconds=20.0),
        executor="serial",
    )
    frame = found.frame().set_index(["part", "scenario"])
    # The same model under two names, with the same seeds.
    assert frame.loc["new seeds", "walkers"].start == frame.loc["held-out data", "doorway"].start
    # 5 m and 4 m at 1 m/s, at the earliest.
    assert 0.0 < frame.loc["training", "walkers"].start < 16.0
