"""The example package: installed, it is listed, runs, and passes its own tests."""

import json
import os
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

FOLDER = Path(__file__).parents[3] / "examples" / "plugin_package"


@pytest.fixture
def extras(install, monkeypatch) -> None:
    """The package as pip would install it in place."""
    groups = tomllib.loads((FOLDER / "pyproject.toml").read_text())["project"]["entry-points"]
    lines = [
        line
        for group, entries in groups.items()
        for line in (f"[{group}]", *(f"{name} = {target}" for name, target in entries.items()))
    ]
    install("crowd_extras_site", "\n".join(lines))
    monkeypatch.syspath_prepend(str(FOLDER))
    for name in [name for name in sys.modules if name.split(".")[0] == "crowd_extras"]:
        monkeypatch.delitem(sys.modules, name)


@pytest.mark.usefixtures("extras")
def test_it_is_listed(command):
    behaviors, models = command("behaviors"), command("models")
    assert behaviors.status == models.status == 0
    for name in ("keep_left", "keep_away", "see_the_doctor"):
        assert any(line.startswith(f"{name} ") for line in behaviors.out.splitlines())
    assert "People leave a waiting room" in models.out
    assert "broken" not in behaviors.err + models.err


@pytest.mark.slow
@pytest.mark.usefixtures("extras")
def test_it_runs(command, tmp_path):
    outcome = command(
        "run",
        "clinic",
        "--seed",
        1,
        "--set",
        "pedestrians=12",
        "--behavior",
        "keep_left=0.5",
        "--out",
        tmp_path / "out",
        "--json",
        "--no-progress",
    )
    assert outcome.status == 0, outcome.err
    summary = json.loads(outcome.out.splitlines()[-1])
    assert (summary["left_inside"], summary["overlaps"]) == (0, 0)
    from mesa_mobility.results import read_parquet

    infected = read_parquet(tmp_path / "out" / "trajectories.parquet").fields["infected"]
    assert infected.dtype == bool
    assert 0 < infected.mean() < 1


@pytest.mark.slow
def test_its_own_tests_pass():
    path = os.pathsep.join([str(FOLDER), *filter(None, [os.environ.get("PYTHONPATH")])])
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(FOLDER)],
        capture_output=True,
        text=True,
        cwd=FOLDER,
        env={**os.environ, "PYTHONPATH": path},
    )
    assert done.returncode == 0, done.stdout


@pytest.mark.usefixtures("extras")
def test_its_formats_are_used_from_the_command_line(command, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    from mesa_mobility import Exit, FloorPlan, PedestrianModel, Trajectories
    from mesa_mobility.results import write_run

    (tmp_path / "hall.rooms").write_text(
        "room 0 0 600 400\nroom 600 100 900 300\ndoor the street 900 100 900 300\n"
    )
    plan = command(
        "plan",
        tmp_path / "hall.rooms",
        "--set",
        "scale=0.01",
        "--json",
        "-o",
        tmp_path / "hall.geojson",
    )
    assert plan.status == 0, plan.err
    assert json.loads(plan.out)["free_area_m2"] == 30.0
    assert json.loads(plan.out)["exits"] == {"the street": 2.0}
    wrong = command("plan", tmp_path / "hall.rooms", "--set", "scael=0.01")
    assert "format rooms: unknown option 'scael', did you mean 'scale'?" in wrong.err
    assert FloorPlan.from_file(tmp_path / "hall.rooms", scale=0.01).exits[0].length == 2.0

    hall = FloorPlan.from_file(tmp_path / "hall.geojson")
    assert isinstance(hall.exits[0], Exit)
    model = PedestrianModel(hall, record=True, rng=1)
    model.add_pedestrians([(1.0, 2.0), (2.0, 2.0)])
    model.run(max_seconds=1)
    tracks = Trajectories.of(model)
    write_run(tmp_path / "run", summary=model.summary(), trajectories=tracks, plan=hall)
    out = tmp_path / "run.csv"
    done = command("export", tmp_path / "run", "-o", out, "--people", 1, "--set", "every=15")
    assert done.status == 0, done.err
    lines = out.read_text().splitlines()
    assert lines[:2] == ["time,person,x,y", "0.000,1,2.000,2.000"]
    assert [line.split(",")[0] for line in lines[1:]] == ["0.000", "0.500", "1.000"]
    listed = command("formats")
    assert any(line.startswith("rooms ") for line in listed.out.splitlines())
    assert any(line.startswith("csv ") for line in listed.out.splitlines())
    assert listed.err == ""
