"""Every input of every run, with its sha256."""

import hashlib
import json
import re
from pathlib import Path
from types import SimpleNamespace

import pytest

from mesa_mobility.errors import ModelError
from mesa_mobility.experiments import Experiment, run_experiment, write_report
from mesa_mobility.mobility import shipped_map_path
from mesa_mobility.plugins.parameters import parameters
from mesa_mobility.populations import Population
from mesa_mobility.reports.inputs import inputs_of
from tests.fixtures.experiments.models import Peopled

MODEL = "tests.fixtures.experiments.models:Peopled"
PLAN = "walkable floor POLYGON ((0 0, {0} 0, {0} 4, 0 4, 0 0))\nexit door LINESTRING (0 1, 0 3)\n"


@pytest.fixture
def plans(tmp_path):
    found = []
    for width in (5, 6):
        found.append(tmp_path / f"{width}.wkt")
        found[-1].write_text(PLAN.format(width))
    return [str(each) for each in found]


def sha256(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


def table_of(text):
    """Rows of the report's table of inputs."""
    part = text.split("Inputs of the runs")[1].split("</table>")[0]
    rows = re.findall(r"<tr>(<td.*?)</tr>", part)
    cells = [re.findall(r"<td[^>]*>(.*?)</td>", row) for row in rows]
    return [[re.sub("<[^>]+>", "", cell) for cell in row] for row in cells]


@pytest.mark.thorough
def test_a_crowd_of_four_types_lists_the_maps_of_all_four(plans, tmp_path):
    population = "able_bodied: 0.7, child: 0.1, older_adult: 0.1, wheelchair_manual: 0.1"
    design = {"plan": plans, "population": ["able_bodied: 0.5, child: 0.5", population]}
    store = run_experiment(
        Experiment(MODEL, design, replications=3), tmp_path / "s", executor="serial"
    )
    rows = table_of(write_report(store).read_text(encoding="utf-8"))
    # A type of both populations is the same for all; the others are those of six runs.
    for name in ("able_bodied", "child"):
        digest = sha256(shipped_map_path(name))
        assert ["12", f"map of {name.replace('_', ' ')}", f"{name}.npz, sha256 {digest}"] in rows
    assert ["12", "preset", "default"] in rows
    # Each of the four sets with the number of its runs.
    for name in ("older_adult", "wheelchair_manual"):
        digest = sha256(shipped_map_path(name))
        assert (
            rows.count(["3", f"map of {name.replace('_', ' ')}", f"{name}.npz, sha256 {digest}"])
            == 2
        )
    for path in plans:
        assert rows.count(["3", "plan", f"{Path(path).name}, sha256 {sha256(Path(path))}"]) == 2
    assert rows.count(["3", "population", population]) == 2
    floors = {row[2] for row in rows if row[1] == "floor plan as GeoJSON"}
    assert len(floors) == 2
    # Each row of the store says the same.
    for row in store.frame().itertuples():
        inputs = json.loads(row.inputs)
        assert {name[7:] for name in inputs if name.startswith("map of ")} == {
            *Population.of(row.population).shares
        }


def test_the_shares_of_a_population_known_by_name():
    kinds = [SimpleNamespace(name=n, mobility_map=SimpleNamespace(file=None)) for n in "ab"]
    model = SimpleNamespace(pedestrian_types=kinds, preset="paper")
    found = inputs_of(model, parameters(Peopled), {})
    assert found == {
        "map of a": "made by the model",
        "map of b": "made by the model",
        "preset": "paper",
        "population": f"care_home ({Population.of('care_home')})",
    }


def test_a_plan_that_has_changed_is_refused(plans, tmp_path):
    def run(replications):
        experiment = Experiment(
            MODEL, {"plan": plans[:1]}, replications, fixed={"population": "child"}
        )
        return run_experiment(experiment, tmp_path / "s", executor="serial")

    run(1)
    run(2)
    with open(plans[0], "w") as file:
        file.write(PLAN.format(7))
    with pytest.raises(ModelError, match=r"holds runs with another plan .*5\.wkt"):
        run(3)


def test_a_run_that_fails_before_it_begins_names_no_inputs(tmp_path):
    experiment = Experiment(MODEL, {"population": ["nobody"]})
    store = run_experiment(experiment, tmp_path / "s", executor="serial")
    assert store.frame().inputs.isna().all()
    assert "Inputs of the runs" not in write_report(store).read_text(encoding="utf-8")
