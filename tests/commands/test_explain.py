"""`mesa-mobility explain`: the decision of a saved run, as it was taken."""

import json
import shutil

import numpy as np
import pytest
from mesa_mobility.models import Doorway

from mesa_mobility.crowd import FREE, WALL, Watch

PERSON, SECONDS = 7, 2.5

pytestmark = pytest.mark.thorough


@pytest.fixture(scope="module")
def saved(tmp_path_factory):
    """A short run with decisions, in a folder."""
    import contextlib
    import io
    import signal
    import sys

    from mesa_mobility.cli import main

    folder = tmp_path_factory.mktemp("saved") / "run"
    words = [
        "run",
        "doorway",
        "--seed",
        "3",
        "--seconds",
        "4",
        "--set",
        "pedestrians=20",
        "--set",
        "pre_movement=uniform(0, 0.5)",
        "--behavior",
        "keep_distance=0.2",
        "--record",
        "decisions",
        "--out",
        folder,
    ]
    before, arguments = signal.getsignal(signal.SIGINT), sys.argv
    try:
        sys.argv = ["mesa-mobility", *map(str, words)]
        with contextlib.redirect_stdout(io.StringIO()), pytest.raises(SystemExit) as ended:
            main()
    finally:
        sys.argv = arguments
        signal.signal(signal.SIGINT, before)
    assert ended.value.code == 0
    return folder


@pytest.fixture
def run_folder(saved, tmp_path):
    """A copy of the saved run."""
    return shutil.copytree(saved, tmp_path / "run")


def taken_live(person=PERSON, seconds=SECONDS):
    """A decision of that run, watched while the model runs, and the model."""
    from mesa_mobility.behaviors import KeepDistance

    from mesa_mobility.distributions import Uniform

    model = Doorway(pedestrians=20, pre_movement=Uniform(0.0, 0.5), frames_per_step=1, rng=3)
    model.terms.append(KeepDistance(weight=0.2))
    model.watch, last = Watch(person), None
    while model.frame <= seconds * 30:
        model.step()
        last = model.watch.decision or last
    return last, model


@pytest.mark.parametrize(("person", "seconds"), [(PERSON, SECONDS), (0, 0.8), (19, 3.9)])
def test_the_answer_is_that_of_the_decision_when_it_was_taken(command, saved, person, seconds):
    live, model = taken_live(person, seconds)
    assert live.taken
    outcome = command("explain", saved, "--person", person, "--time", seconds, "--json")
    assert outcome.status == 0, outcome.err
    answer = json.loads(outcome.out)
    assert (answer["person"], answer["frame"]) == (person, live.frame)
    assert answer["position"] == live.candidates.positions[0].tolist()
    assert answer["target"] == live.candidates.targets[0].tolist()
    assert answer["blocked_by"] == (None if live.blocked_by < 0 else live.blocked_by)
    options = answer["options"]
    assert len(options) == len(live.candidates) > 100
    costs = [each["cost"] for each in options]
    assert costs == sorted(live.totals.tolist())
    # Each option by its own numbers, wherever it is in the list.
    parts = model.capabilities[0].parts
    expected = {
        (int(parts.rows[o]), float(parts.share[o])): (
            live.candidates.points[k].tolist(),
            None
            if live.verdicts[k] == FREE
            else "wall"
            if live.verdicts[k] == WALL
            else int(live.blockers[k]),
            (live.weights * live.costs[:, k]).tolist(),
            k == live.chosen,
        )
        for k, o in enumerate(live.candidates.options.tolist())
    }
    for each in options:
        found = (each["ends_at"], each["in_the_way"], list(each["costs"].values()), each["taken"])
        assert found == expected[each["option"], each["share"]]
    assert list(options[0]["costs"]) == list(live.terms)
    assert "keep_distance" in live.terms
    (taken,) = [each for each in options if each["taken"]]
    free = [each["cost"] for each in options if each["in_the_way"] is None]
    assert taken["cost"] == min(free)


def test_the_table_shows_the_option_taken_and_what_it_was_chosen_over(command, saved):
    outcome = command("explain", saved, "--person", PERSON, "--time", SECONDS)
    assert outcome.status == 0, outcome.err
    live, _ = taken_live()
    assert f"Decided  at {live.frame / 30:.2f} s" in outcome.out
    assert f"{len(live.candidates)}, of which {(live.verdicts == FREE).sum()} hit" in outcome.out
    (line,) = [each for each in outcome.out.splitlines() if each.startswith("taken ")]
    assert f"{live.totals[live.chosen]:.3f}" in line


def refused(command, *arguments):
    outcome = command("explain", *arguments)
    assert (outcome.status, outcome.out) == (2, "")
    assert len(outcome.err.splitlines()) == 1
    return outcome.err


def change(folder, **values):
    path = folder / "summary.json"
    path.write_text(json.dumps(json.loads(path.read_text()) | values))


def test_a_run_that_does_not_repeat_itself_is_told(command, run_folder):
    change(run_folder, seed=4, versions={"python": "3.9", "numpy": np.__version__})
    text = refused(command, run_folder, "--person", PERSON, "--time", SECONDS)
    assert "the run does not repeat itself (python 3.9, here 3." in text


def test_other_maps_are_told(command, run_folder):
    maps = {"able_bodied": {"file": "mine.npz", "sha256": "ab" * 32}}
    change(run_folder, maps=maps)
    text = refused(command, run_folder, "--person", PERSON, "--time", SECONDS)
    assert "used mine.npz (sha256 abababababab...), here it is able_bodied.npz" in text


def test_a_run_without_decisions_is_told(command, run_folder):
    (run_folder / "decisions.parquet").unlink()
    text = refused(command, run_folder, "--person", PERSON, "--time", SECONDS)
    assert "expected one of `mesa-mobility run --record decisions`" in text


def test_a_summary_of_another_version_is_told(command, run_folder):
    path = run_folder / "summary.json"
    summary = json.loads(path.read_text())
    del summary["parameters"]
    path.write_text(json.dumps(summary))
    text = refused(command, run_folder, "--person", PERSON, "--time", SECONDS)
    assert "lacks parameters, expected a run of this version" in text


@pytest.mark.parametrize(
    ("person", "seconds", "message"),
    [
        (500, 1, "person 500: has taken no decision"),
        (7, 90, "got a time of 90 s"),
        (7, -1, "got a time of -1 s"),
        (7, "nan", "got a time of nan s"),
    ],
)
def test_nobody_and_no_time_are_told(command, saved, person, seconds, message):
    assert message in refused(command, saved, "--person", person, f"--time={seconds}")
