import json
import math
import os
import signal
import subprocess
import sys

import pytest

from mesa_mobility.results import read_parquet
from tests.fixtures.interrupting import RUN_FILES

pytestmark = pytest.mark.usefixtures("plugins")


def last_line(outcome):
    return json.loads(outcome.out.splitlines()[-1])


def test_json_is_the_last_line_and_the_rest_goes_to_standard_error(command, tmp_path):
    outcome = command("run", "corridor", "--seed", 5, "--json", "--out", tmp_path / "out")
    assert outcome.status == 0
    assert len(outcome.out.splitlines()) == 1
    assert f"written to {tmp_path / 'out'}" in outcome.err
    summary = last_line(outcome)
    # Walking 1 m/s from 3.0, 2.5 and 2.0 m, they are beyond 4 m after 1.1, 1.6 and 2.1 s.
    expected = {
        "model": "corridor",
        "preset": "default",
        "seed": 5,
        "pedestrians": 3,
        "simulated_s": 2.1,
        "egress_s": 2.1,
        "left_inside": 0,
        "overlaps": 0,
        "min_distance_m": pytest.approx(math.sqrt(1.25)),
        "wall_crossings": 0,
        "off_floor": 0,
        "stalled": False,
        "stall_reason": None,
        "interrupted": False,
    }
    assert {key: summary[key] for key in expected} == expected
    assert 0 <= summary["wall_s"] < 10
    assert 0 <= summary["cpu_s"] < 10


def test_out_holds_the_run(command, tmp_path):
    command("run", "corridor", "--seed", 5, "--out", tmp_path / "out")
    assert {path.name for path in (tmp_path / "out").iterdir()} == RUN_FILES
    run = read_parquet(tmp_path / "out" / "trajectories.parquet")
    assert (run.people, run.frames, run.remaining.tolist()) == (3, 22, [])
    assert run.exit_frames.tolist() == [11, 16, 21]


def test_the_checks_are_made_over_what_was_recorded(command):
    outcome = command(
        "run", "corridor", "--json", "--seconds", 0.5, "--set", "people=7", "--set", "lane=shared"
    )
    # Starts repeat after 6 people: one pair on one spot in each of 6 frames.
    assert last_line(outcome)["overlaps"] == 6
    assert last_line(outcome)["min_distance_m"] == 0.0


def test_figures_for_people_to_read(command):
    outcome = command("run", "corridor", "--seed", 5)
    assert outcome.status == 0
    assert "after 2.1 s" in outcome.out
    assert "corridor, preset default, seed 5" in outcome.out


def test_seconds_cut_a_run_short_without_blame(command):
    outcome = command("run", "corridor", "--seconds", 1.5, "--json")
    assert outcome.status == 0
    assert (last_line(outcome)["egress_s"], last_line(outcome)["left_inside"]) == (None, 2)


def test_a_stalled_evacuation_ends_with_status_one(command, tmp_path):
    outcome = command("run", "corridor", "--set", "stuck=yes", "--json", "--out", tmp_path)
    assert outcome.status == 1
    assert "stalled: 3 people left inside after 2.0 s: the belt stands\n" in outcome.err
    assert last_line(outcome)["stalled"] is True
    assert (tmp_path / "trajectories.parquet").exists()


def test_people_who_block_each_other_are_told_in_the_last_line(command):
    model = "tests.fixtures.face_to_face:FaceToFace"
    outcome = command("run", model, "--seconds", "61", "--json", "--no-progress")
    assert outcome.status == 0, outcome.err
    said = "2 people stood for a minute without a reason (0 and 1)"
    assert outcome.err.splitlines()[-1] == f"blocked: {said}"
    summary = last_line(outcome)
    assert summary["stalled"] is False
    assert [(each["person"], each["since_s"], each["ring"]) for each in summary["blocked"]] == [
        (0, 0.0, [1, 0]),
        (1, 0.0, [0, 1]),
    ]
    outcome = command("run", model, "--set", "waiting=0", "--no-progress")
    assert outcome.status == 1
    assert outcome.err.splitlines()[-1].endswith(
        f"nobody has come nearer to an exit for 60 s: people 0 and 1 are in each other's way; "
        f"blocked: {said}"
    )
    assert f"Blocked            {said}" in outcome.out


def test_settings_preset_map_and_seed_reach_the_model(command, tmp_path):
    map_file = tmp_path / "some.npz"
    map_file.touch()
    outcome = command(
        "run",
        "corridor",
        "--set",
        "people=2",
        "--set",
        "note=a=b",
        "--preset",
        "paper",
        "--map",
        map_file,
        "--seed",
        7,
        "--json",
    )
    summary = last_line(outcome)
    expected = {"pedestrians": 2, "note": "a=b", "preset": "paper", "seed": 7}
    assert {key: summary[key] for key in expected} == expected


def test_a_folder_with_the_name_of_a_model_is_no_plan(command, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "corridor").mkdir()
    outcome = command("run", "corridor", "--seed", 5, "--json", "--out", tmp_path / "out")
    assert (outcome.status, last_line(outcome)["model"]) == (0, "corridor")


def test_a_seed_is_drawn_and_printed(command):
    seeds = {last_line(command("run", "corridor", "--json"))["seed"] for _ in range(3)}
    assert len(seeds) == 3


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["coridor"], "error: unknown model 'coridor', did you mean 'corridor'?; installed: "),
        (["absent"], "error: model absent (no_such_module:Model, from corridors 1.2) cannot be"),
        (["forgetful"], "error: model forgetful: its constructor does not take record"),
        (["corridor", "--set", "peple=3"], "error: model corridor: unknown parameter 'peple'"),
        (
            ["corridor", "--set", "people=x"],
            "error: model corridor: people: got 'x', expected",
        ),
        (["corridor", "--set", "people=0"], "error: people: got 0, expected 1 or more"),
        (
            ["corridor", "--set", "lane=wide"],
            "error: model corridor: lane: got 'wide', expected apart or",
        ),
        (["corridor", "--map", "none.npz"], "error: none.npz: no such map"),
        (["corridor", "--population", "mixed"], "error: model corridor: unknown parameter 'popu"),
        (["straight_walk", "--population", "giraffe"], "error: no map named 'giraffe' ships with"),
        (
            ["straight_walk", "--population", "able_bodied: 0.6, able: 0.3"],
            "error: population: the shares add up to 0.9, expected 1",
        ),
        (["straight_walk", "--set", "population=a: x"], "error: population 'a: x': got 'a: x', "),
        (
            ["straight_walk", "--population", "able_bodied", "--set", "population=able_bodied"],
            "error: --set population=able_bodied: population is set twice",
        ),
        (["corridor", "--set", "seed=3"], "error: --set seed=3: use --seed"),
        (["picky", "--seed", "7"], "error: --seed: got 7, expected an even number"),
        (["seedless"], "error: model seedless: its constructor does not take rng (--seed)"),
        (["corridor", "--seconds", "0"], "error: --seconds 0: expected a positive number"),
        (["corridor", "--seconds", "nan"], "error: --seconds nan: expected a positive number"),
    ],
)
def test_bad_input_is_one_line_and_status_two(command, tmp_path, arguments, message):
    outcome = command("run", *arguments, "--out", tmp_path / "out")
    assert outcome.status == 2
    assert outcome.err.startswith(message)
    assert len(outcome.err.splitlines()) == 1
    assert outcome.out == ""
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    "arguments", [[], ["--bogus"], ["corridor", "--seed", "-1"], ["corridor", "--seed", "x"]]
)
def test_wrong_usage_has_status_two(command, arguments):
    outcome = command("run", *arguments)
    assert outcome.status == 2
    assert "Traceback" not in outcome.err


def test_an_output_folder_that_cannot_be_written_is_said_before_the_run(command, tmp_path):
    (tmp_path / "taken").write_text("mine")
    # A run would stop itself here, and end with another status.
    outcome = command("run", "corridor", "--out", tmp_path / "taken", "--set", "interrupt_at=0.1")
    assert outcome.status == 2
    expected = f"error: {tmp_path / 'taken'}: is not a folder, nothing can be written there\n"
    assert outcome.err == expected
    assert (tmp_path / "taken").read_text() == "mine"


def test_control_c_writes_what_there_is(command, tmp_path):
    # Asked after 0.3 s, it stops at the next full second, with two left.
    outcome = command(
        "run",
        "corridor",
        "--set",
        "interrupt_at=0.3",
        "--set",
        "pace=0.5",
        "--json",
        "--out",
        tmp_path / "out",
    )
    assert outcome.status == 130
    summary = last_line(outcome)
    assert (summary["interrupted"], summary["simulated_s"], summary["left_inside"]) == (
        True,
        1.0,
        3,
    )
    assert "interrupted after 1.0 simulated seconds" in outcome.err
    assert {path.name for path in (tmp_path / "out").iterdir()} == RUN_FILES
    assert read_parquet(tmp_path / "out" / "trajectories.parquet").frames == 11


def test_control_c_while_writing_does_not_lose_the_run(command, monkeypatch, tmp_path):
    from mesa_mobility import results

    def write_run(*arguments, **keywords):
        os.kill(os.getpid(), signal.SIGINT)
        return results.run.write_run(*arguments, **keywords)

    monkeypatch.setattr(results, "write_run", write_run)
    outcome = command("run", "corridor", "--json", "--out", tmp_path / "out")
    assert outcome.status == 0
    assert last_line(outcome)["interrupted"] is False
    assert {path.name for path in (tmp_path / "out").iterdir()} == RUN_FILES


def test_what_nobody_foresaw_is_one_line_too(command, monkeypatch):
    import corridor_plugin

    def fail(self, **keywords):
        raise ZeroDivisionError("by\nzero")

    monkeypatch.setattr(corridor_plugin.Corridor, "run", fail)
    outcome = command("run", "corridor")
    assert outcome.status == 2
    assert outcome.err.startswith("error: unexpected ZeroDivisionError: by zero [fail, ")
    assert len(outcome.err.splitlines()) == 1


def test_the_module_is_the_command(tmp_path):
    environment = os.environ | {"PYTHONPATH": str(tmp_path / "site" / "corridors")}
    done = subprocess.run(
        [sys.executable, "-m", "mesa_mobility", "run", "corridor", "--seed", "5", "--json"],
        capture_output=True,
        text=True,
        env=environment,
        timeout=60,
    )
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout.splitlines()[-1])["egress_s"] == 2.1


@pytest.mark.thorough
def test_the_same_seed_gives_the_same_bytes_in_another_process(map_file, tmp_path):
    for name in ("first", "second"):
        done = subprocess.run(
            [
                sys.executable,
                "-m",
                "mesa_mobility",
                "run",
                "doorway",
                "--map",
                map_file,
                "--seed",
                "3",
                "--seconds",
                "6",
                "--set",
                "pedestrians=8",
                "--json",
                "--out",
                tmp_path / name,
            ],
            capture_output=True,
            text=True,
        )
        assert done.returncode == 0, done.stderr
        summary = json.loads(done.stdout.splitlines()[-1])
        expected = {"model": "doorway", "pedestrians": 8, "overlaps": 0, "wall_crossings": 0}
        assert {key: summary[key] for key in expected} == expected
        assert summary["occupancy"][0] == [0.0, 8]
        assert summary["occupancy"][-1][0] == 6.0
    for file in RUN_FILES - {"summary.json"}:
        assert (tmp_path / "first" / file).read_bytes() == (tmp_path / "second" / file).read_bytes()
    assert read_parquet(tmp_path / "first" / "trajectories.parquet").frames == 181
