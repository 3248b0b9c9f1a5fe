"""`--set headway.time=0.6` and `--preset my.toml`, for all commands that run models."""

import json

import pytest

from mesa_mobility.crowd import PRESETS, read_preset
from mesa_mobility.experiments import open_store


@pytest.fixture
def mine(command, tmp_path):
    """A preset of one's own, in a file."""
    file = tmp_path / "mine.toml"
    made = command("preset", "--set", "headway.time=0.9", "-o", file)
    assert (made.status, made.err) == (0, f"written to {file}\n")
    return file


def test_preset_lists_numbers_and_writes_them(command, mine):
    told = command("preset", mine, "--set", "right_of_way.weight=2", "--json")
    answer = json.loads(told.out.splitlines()[-1])
    assert answer["preset"] == "mine"
    assert answer["numbers"]["headway.time"] == {
        "value": 0.9,
        "unit": "s",
        "bounds": "more than 0 s",
        "source": "mine.toml",
    }
    assert answer["numbers"]["right_of_way.weight"]["source"] == "command line"
    rules = PRESETS["default"].with_parameters({"headway.time": 0.9})
    assert read_preset(mine).parameters() == rules.parameters()
    assert "headway.time" in command("preset", mine).out


@pytest.mark.parametrize(
    "words",
    [
        ("run", "doorway"),
        ("verify", "rimea-01"),
        ("validate", "walking"),
        ("experiment", "run", "any.toml"),
        ("preset",),
    ],
)
@pytest.mark.parametrize(
    ("option", "said"),
    [
        ("--set headwy.time=1", "unknown parameter 'headwy.time', did you mean 'headway.time'?"),
        ("--set headway.time=0", "headway.time: 0.0, expected more than 0 s"),
        ("--set headway.time=soon", "headway.time: got 'soon', expected a number"),
        ("--set headway.time", "--set headway.time: expected NAME=VALUE"),
        ("--set headway.time=1 --set headway.time=2", "headway.time is set twice"),
        ("--preset none.toml", "none.toml: no such file, expected a preset in TOML"),
        ("--preset defalt", "preset 'defalt' is unknown, did you mean 'default'"),
    ],
)
def test_bad_input_is_one_line(command, words, option, said, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "any.toml").write_text('model = "doorway"\n')
    if words == ("preset",) and option.startswith("--preset"):
        option = option.removeprefix("--preset ")
    outcome = command(*words, *option.split())
    assert (outcome.status, outcome.out) == (2, "")
    assert said in outcome.err
    assert len(outcome.err.splitlines()) == 1


def test_verify_takes_numbers_of_behaviours_alone(command):
    outcome = command("verify", "rimea-01", "--set", "people=3")
    assert outcome.status == 2
    assert "--set people=3: expected a number of a behaviour" in outcome.err


def test_a_model_without_behaviours_refuses_their_numbers(command, plugins):
    outcome = command("run", "corridor", "--set", "headway.time=1")
    assert outcome.status == 2
    assert "model corridor: has no behaviours, expected no --set headway.time" in outcome.err


@pytest.mark.thorough
def test_run_says_and_repeats_what_was_set(command, mine, tmp_path):
    words = [
        "run",
        "doorway",
        "--seed",
        3,
        "--seconds",
        3,
        "--set",
        "pedestrians=6",
        "--record",
        "decisions",
        "--behavior",
        "keep_distance=0.2",
        "--preset",
        mine,
        "--set",
        "keep_distance.distance=1.1",
        "--set",
        "right_of_way.width=0.5",
    ]
    outcome = command(*words, "--out", tmp_path / "run", "--json")
    assert outcome.status == 0, outcome.err
    summary = json.loads(outcome.out.splitlines()[-1])
    assert summary["preset_sha256"] == read_preset(mine).digest
    assert summary["set"] == {"keep_distance.distance": "1.1", "right_of_way.width": "0.5"}
    assert summary["rules"]["settings"]["headway"]["time"] == 0.9
    assert summary["rules"]["settings"]["right_of_way"]["width"] == 0.5
    explain = ["explain", tmp_path / "run", "--person", 2, "--time", 2.0, "--json"]
    assert command(*explain).status == 0
    mine.write_text(mine.read_text().replace("time = 0.9", "time = 0.8"))
    other = command(*explain)
    assert other.status == 2
    assert "the run used the preset" in other.err


@pytest.mark.thorough
def test_numbers_change_what_verification_measures(command, mine, tmp_path):
    page = tmp_path / "page.html"
    plain = command("verify", "rimea-01", "--jobs", 1, "--json")
    onwards = {"target_distance", "preferred_velocity", "facing_deviation"}
    without = [f"{name}.weight=0" for name in PRESETS["default"].terms if name in onwards]
    slow = command(
        "verify",
        "rimea-01",
        "--jobs",
        1,
        "--json",
        "--preset",
        mine,
        "--report",
        page,
        *(part for number in without for part in ("--set", number)),
    )
    assert plain.status == 0
    answers = [json.loads(each.out.splitlines()[-1]) for each in (plain, slow)]
    assert [each["rimea-01"]["preset"] for each in answers] == ["default", "mine"]
    # Nobody wants to go anywhere.
    assert answers[0]["rimea-01"]["passed"]
    assert not answers[1]["rimea-01"]["passed"]
    text = page.read_text(encoding="utf-8")
    assert f"mine, mine.toml, sha256 {read_preset(mine).digest}" in text
    assert "facing_deviation.weight = 0; preferred_velocity.weight = 0" in text


@pytest.mark.thorough
def test_experiments_vary_fix_and_list_numbers(command, mine, tmp_path):
    file = tmp_path / "study.toml"
    file.write_text(
        'model = "doorway"\nseed = 1\nmax_seconds = 2\n[fixed]\npedestrians = 4\n'
        '[grid]\n"headway.time" = [0.5, 1.5]\n'
    )
    words = ("experiment", "run", file, "--workers", 1, "--preset", mine)
    outcome = command(*words, "--set", "right_of_way.weight=2.5")
    assert outcome.status == 0, outcome.err
    store = open_store(tmp_path / "study")
    frame = store.frame()
    assert frame["headway.time"].tolist() == [0.5, 1.5]
    assert frame["right_of_way.weight"].tolist() == [2.5, 2.5]
    inputs = json.loads(frame["inputs"][0])
    assert inputs["preset"] == f"mine, mine.toml, sha256 {read_preset(mine).digest}"
    assert inputs["changed numbers"] == (
        "headway.time = 0.5 s (experiment); right_of_way.weight = 2.5 (experiment)"
    )
    assert sorted(store.table(["headway.time"])["headway.time"].to_pylist()) == [0.5, 1.5]
    mine.write_text(mine.read_text().replace("time = 0.9", "time = 0.8"))
    changed = command(*words, "--set", "right_of_way.weight=2.5")
    assert changed.status == 2
    assert "holds runs with another preset" in changed.err
