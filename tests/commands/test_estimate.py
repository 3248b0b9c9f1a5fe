"""`mesa-mobility estimate`."""

import json
from pathlib import Path

import pytest

from mesa_mobility.crowd import PRESETS
from tests.estimation.tracks import corridor, rows_of, walking


@pytest.fixture
def plan(tmp_path: Path) -> str:
    path = tmp_path / "plan.geojson"
    corridor().write_geojson(path)
    return str(path)


def written(tmp_path: Path, rows, name: str = "run.txt") -> str:
    path = tmp_path / name
    lines = ["# framerate: 10 fps", "# id frame x/m y/m z/m"]
    lines += [f"{int(p)} {int(f)} {x:.4f} {y:.4f} 1.7" for f, p, x, y in rows]
    path.write_text("\n".join(lines))
    return str(path)


def test_tracks_of_one_person_give_one_line_and_status_2(command, tmp_path, plan):
    rows = rows_of(walking())
    file = written(tmp_path, rows[rows[:, 1] == 3])

    done = command("estimate", file, "--plan", plan, "--no-progress")

    assert done.status == 2
    errors = [line for line in done.err.splitlines() if line.startswith("error")]
    assert errors == [f"error: {file}: only person 3 (frames 0 to 59), expected two people or more"]


def test_an_unknown_term_is_refused(command, tmp_path, plan):
    file = written(tmp_path, rows_of(walking()))

    done = command("estimate", file, "--plan", plan, "--term", "no_such_term", "--no-progress")

    assert done.status == 2
    assert "no_such_term" in done.err


def test_a_term_that_the_preset_lacks_cannot_be_left_out(command, tmp_path, plan):
    file = written(tmp_path, rows_of(walking()))

    done = command("estimate", file, "--plan", plan, "--without", "queueing", "--no-progress")

    assert done.status == 2
    terms = ", ".join(PRESETS["default"].terms)
    assert f"--without queueing: preset 'default' has {terms}" in done.err


@pytest.mark.slow
def test_two_files_give_weights_and_what_they_tell_of_each_other(command, tmp_path, plan):
    files = [
        written(tmp_path, rows_of(walking(people=9, seconds=8.0)), "a.txt"),
        written(tmp_path, rows_of(walking(people=9, seconds=8.0, speed=1.0)), "b.txt"),
    ]
    kept = {"preferred_velocity", "velocity_change"}
    others = [name for name in PRESETS["default"].terms if name not in kept]
    without = [part for name in others for part in ("--without", name)]

    done = command(
        "estimate", *files, "--plan", plan, *without, "--choices", "60", "--json", "--no-progress"
    )

    assert done.status == 0, done.err
    answer = json.loads(done.out.splitlines()[-1])
    assert set(answer["terms"]) == kept
    assert answer["terms"]["velocity_change"]["weight"] > 0.0
    assert set(answer["left_out"]) == set(files)
    assert answer["measures"]["choices"] == 120
    assert "velocity_change" in done.out
