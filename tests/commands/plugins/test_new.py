"""Skeletons of plug-ins, and behaviours switched on for one run."""

import json
import os
import subprocess
import sys
import tomllib

import pytest

from mesa_mobility.commands.models.behaviors import use_behaviors
from mesa_mobility.crowd import PedestrianModel
from mesa_mobility.errors import ModelError
from tests.fixtures.maps import strider
from tests.fixtures.scenes import corridor, model_of


def names(folder):
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file())


def test_what_is_written(command, tmp_path):
    assert command("new", "behavior", "keep_left", "--in", tmp_path).status == 0
    assert command("new", "model", "my_room", "--in", tmp_path).status == 0
    assert names(tmp_path) == ["keep_left.py", "my_room.py", "test_keep_left.py", "test_my_room.py"]
    assert "class KeepLeft(CostTerm):" in (tmp_path / "keep_left.py").read_text()
    assert "@" not in (tmp_path / "test_my_room.py").read_text()


def test_a_package(command, tmp_path):
    assert command("new", "package", "seaside", "--in", tmp_path).status == 0
    assert names(tmp_path / "seaside") == [
        "README.md",
        "pyproject.toml",
        "seaside/__init__.py",
        "seaside/seaside_room.py",
        "seaside/seaside_term.py",
        "tests/test_seaside_room.py",
        "tests/test_seaside_term.py",
    ]
    project = tomllib.loads((tmp_path / "seaside" / "pyproject.toml").read_text())
    entries = project["project"]["entry-points"]
    assert entries["mesa_mobility.behaviors"] == {"seaside_term": "seaside:SeasideTerm"}
    assert entries["mesa_mobility.models"] == {"seaside_room": "seaside:SeasideRoom"}


def test_nothing_is_overwritten_and_names_are_checked(command, tmp_path):
    (tmp_path / "test_keep_left.py").write_text("mine")
    outcome = command("new", "behavior", "keep_left", "--in", tmp_path)
    assert outcome.status == 2
    assert "test_keep_left.py: is there already" in outcome.err
    assert names(tmp_path) == ["test_keep_left.py"]
    for name in ("Keep", "9lives", "class", "a-b", "../up"):
        outcome = command("new", "model", name, "--in", tmp_path)
        assert outcome.status == 2
        assert "expected lower-case letters" in outcome.err


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["behavior", "model", "package"])
def test_its_own_tests_pass(command, tmp_path, kind):
    command("new", kind, "seaside", "--in", tmp_path)
    folder = tmp_path / "seaside" if kind == "package" else tmp_path
    path = os.pathsep.join([str(folder), *filter(None, [os.environ.get("PYTHONPATH")])])
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(folder)],
        capture_output=True,
        text=True,
        cwd=folder,
        env={**os.environ, "PYTHONPATH": path},
    )
    assert done.returncode == 0, done.stdout
    assert "passed" in done.stdout


def test_behaviors_for_one_run():
    model = model_of(corridor(), strider())
    own = {term.name: term.weight for term in model.terms}
    use_behaviors(model, ["headway=3", "preferred_speed=0.5", "walk_together", "quickest_exit"])
    weights = {term.name: term.weight for term in model.terms}
    assert weights == {**own, "headway": 3.0, "preferred_speed": 0.5}
    assert [rule.name for rule in model.speed_rules] == ["walk_together"]
    assert model.target_choice.name == "quickest_exit"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("headwy", "unknown behavior 'headwy', did you mean 'headway'"),
        ("headway=much", "--behavior headway=much: weight 'much', expected a number"),
        ("headway=nan", "expected a finite number"),
        ("walk_together=1", "has no weight, expected walk_together alone"),
    ],
)
def test_behaviors_that_are_refused(text, message):
    with pytest.raises(ModelError, match=message):
        use_behaviors(PedestrianModel(corridor(), mobility_map=strider()), [text])


@pytest.mark.slow
def test_the_command_uses_them(command):
    outcome = command(
        "run",
        "doorway",
        "--set",
        "pedestrians=5",
        "--seed",
        1,
        "--seconds",
        2,
        "--json",
        "--behavior",
        "preferred_speed=0.5",
        "--no-progress",
    )
    assert outcome.status == 0
    assert json.loads(outcome.out.splitlines()[-1])["behaviors"] == ["preferred_speed=0.5"]
