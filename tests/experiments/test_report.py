"""The report of an experiment: its figures, and what a file says of them."""

import json
import re

import numpy as np
import pandas as pd
import pytest

from mesa_mobility.errors import ModelError, ResultsError
from mesa_mobility.experiments import (
    Experiment,
    ReportOptions,
    read_experiment,
    run_experiment,
    write_report,
)
from mesa_mobility.experiments.reporting.estimates import known_of
from mesa_mobility.experiments.reporting.labels import labels_of
from mesa_mobility.experiments.reporting.pictures import _step

MODELS = "tests.fixtures.experiments.models:"


def page_of(tmp_path, experiment):
    store = run_experiment(experiment, tmp_path / "store", executor="serial")
    return store, write_report(store).read_text(encoding="utf-8")


def test_the_figures_that_a_file_asks_for_by_its_words(tmp_path):
    file = tmp_path / "own.toml"
    file.write_text(
        f'model = "{MODELS}Quick"\nreplications = 6\n[grid]\nx = [0.0, 1.0]\n'
        '[report]\nfigures = ["y"]\nlabels = {y = "yield (kg)", x = "dose (g)"}\n'
    )
    experiment = read_experiment(file)
    assert experiment.report == ReportOptions(["y"], {"y": "yield (kg)", "x": "dose (g)"})
    store, text = page_of(tmp_path, experiment)
    assert "Yield (kg), by point of the design" in text
    assert '<th class="number">dose <span class="unit">(g)</span></th>' in text
    assert "summary x" not in text
    # The store keeps them, and the file of the report means the same.
    assert store.experiment().report == experiment.report
    said = tmp_path / "again.json"
    said.write_text(json.dumps(store.definition()["experiment"]))
    assert read_experiment(said) == experiment
    # Each point has six runs: means have intervals.
    frame = store.frame()
    mean = frame[frame.x == 1.0].y.mean()
    assert re.search(rf"<td[^>]*>{mean:.4g} \(", text)


def test_another_report_of_the_same_runs(tmp_path):
    experiment = Experiment(MODELS + "Quick", {"x": [0.0]}, replications=2)
    run_experiment(experiment, tmp_path / "store", executor="serial")
    other = Experiment(
        MODELS + "Quick", {"x": [0.0]}, replications=2, report=ReportOptions(("summary_x",))
    )
    store = run_experiment(other, tmp_path / "store", executor="serial")
    assert len(store.frame()) == 2
    assert "Summary x, by point" in write_report(store).read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("keywords", "said"),
    [
        ({"figures": "y"}, "report: figures is 'y', expected a list of columns"),
        ({"figures": [1]}, r"report: figures is \[1\]"),
        ({"figures": 3}, "report: figures is 3"),
        ({"labels": {"y": 2}}, "report: labels is"),
        ({"labels": ["y"]}, "report: labels is"),
    ],
)
def test_what_is_no_figure_is_refused(keywords, said):
    with pytest.raises(ModelError, match=said):
        ReportOptions(**keywords)


def test_an_unknown_key_of_a_report_is_refused(tmp_path):
    file = tmp_path / "own.toml"
    file.write_text(f'model = "{MODELS}Quick"\n[report]\nfigure = ["y"]\n')
    with pytest.raises(ModelError, match=r"report: .*figure"):
        read_experiment(file)


def test_a_column_that_runs_do_not_have_is_said(tmp_path):
    for name in ("z", "seen"):
        experiment = Experiment(MODELS + "Quick", {"x": [0.0]}, report=ReportOptions((name,)))
        store = run_experiment(experiment, tmp_path / name, executor="serial")
        with pytest.raises(
            ResultsError, match=f"report: the runs have no column of numbers '{name}'"
        ):
            write_report(store)


def test_no_interval_below_five_runs():
    values = np.array([3.0, 4.0, 5.0, 6.0])
    assert str(known_of("mean", "egress_s", values)) == "4.5"
    assert str(known_of("mean", "egress_s", np.append(values, 7.0))).startswith("5 (")


def test_designs_with_common_seeds_are_compared(tmp_path):
    experiment = Experiment(
        MODELS + "Leaving", {"width": [1.0, 1.2]}, replications=20, seeds="common"
    )
    _, text = page_of(tmp_path, experiment)
    part = text.split("Comparison of designs</h2>")[1].split("</table>")[0]
    row = re.findall(r"<td[^>]*>(.*?)</td>", part)
    assert row[:2] == ["1", "1.2"]
    assert row[-1] == "different"
    independent = Experiment(MODELS + "Leaving", {"width": [1.0, 1.2]}, replications=3)
    _, text = page_of(tmp_path / "other", independent)
    assert "Comparison of designs" not in text


@pytest.mark.thorough
def test_plan_people_doors_and_maps_of_a_crowd(tmp_path):
    experiment = Experiment(
        "doorway",
        {"door_width": [1.0, 1.2]},
        fixed={"pedestrians": 3},
        replications=2,
        max_seconds=60,
        keep=["doors", "trajectories"],
    )
    store, text = page_of(tmp_path, experiment)
    assert "Floor plan with the numbers of doors and exits" in text
    assert "those of the first run (door width 1 m), at its start. Other runs differ" in text
    assert 'able bodied</td><td class="number">3</td>' in text
    frame = store.frame()
    mean = frame[frame.door_width == 1.0]["door.first door.first_s"].mean()
    doors = text.split("Doors, exits and clearing times</h2>")[1].split("</table>")[0]
    assert f">{mean:.4g}<" in doors
    cleared = text.split("have left for good; means over the runs")[1].split("</table>")[0]
    mean = frame[frame.door_width == 1.2]["room.room 1.t95_s"].mean()
    assert "<td>room 1</td>" in cleared
    assert f">{mean:.4g}<" in cleared
    assert "These maps are those of a single run" in text
    assert "Level of service at the greatest density of each cell" in text


@pytest.mark.thorough
def test_people_by_type(tmp_path):
    experiment = Experiment(
        "doorway",
        {"door_width": [1.0]},
        fixed={"pedestrians": 6, "population": "able_bodied: 0.5, child: 0.5"},
        replications=3,
        max_seconds=60,
    )
    store, text = page_of(tmp_path, experiment)
    part = text.split("People by type: means over the runs")[1].split("</table>")[0]
    rows = [re.findall(r"<td[^>]*>(.*?)</td>", row) for row in part.split("<tr>")[2:]]
    runs = store.frame(series=True).types
    assert [row[1] for row in rows] == ["able bodied", "child"]
    for number, row in enumerate(rows):
        own = [each for run in runs for each in run if each["type"] == number]
        assert row[2] == f"{np.mean([each['people'] for each in own]):.4g}"
        assert row[4] == f"{np.mean([each['mean_s'] for each in own]):.4g}"


def test_parameters_have_the_units_that_the_model_says():
    experiment = Experiment(
        "doorway",
        {"door_width": [1.0, 1.2], "headway.time": [1.0, 1.5], "pedestrians": [5, 6]},
        fixed={"pre_movement": 3.0},
        report=ReportOptions((), {"pedestrians": "occupants"}),
    )
    assert labels_of(experiment) == {
        "pre_movement": "pre movement (s)",
        "door_width": "door width (m)",
        "headway.time": "headway time (s)",
        "pedestrians": "occupants",
    }


def test_runs_that_end_with_people_inside_are_counted(tmp_path):
    experiment = Experiment("doorway", {"pedestrians": [2]}, replications=2, max_seconds=1)
    _, text = page_of(tmp_path, experiment)
    assert '<td>done</td><td class="number">2</td>' in text
    assert '<td>done, but with people inside at the end</td><td class="number">2</td>' in text


def test_single_runs_are_drawn_near_their_value():
    # A sixth of the range at most, so that they do not look like other values.
    assert _step(pd.Series([0.8, 1.2])) == pytest.approx(0.4 / 6)
    assert _step(pd.Series([0.0, 0.1, 1.2])) == pytest.approx(0.1)
    assert _step(pd.Series([1.0, 1.0])) == 1.0


def test_runs_that_all_lack_a_figure_are_drawn(tmp_path):
    experiment = Experiment(MODELS + "Partly", {"stalling": [1.0]}, replications=2)
    _, text = page_of(tmp_path, experiment)
    assert "Time until everybody is out (s): not reached in 2 of 2 runs (2 stalled)" in text
