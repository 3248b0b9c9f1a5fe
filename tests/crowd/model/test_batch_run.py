"""Mesa's ``batch_run`` over the models, whichever way this Mesa takes seeds, and ours."""

import inspect
import subprocess
import sys

import mesa
import pytest
from mesa_mobility.models import OpenSpace, StraightWalk

import mesa_mobility
from mesa_mobility.errors import ModelError


def batch(model, parameters, seeds, **keywords):
    """``mesa.batch_run`` with seeds: a parameter up to 3.4, an argument of its own from 3.5."""
    if "rng" in inspect.signature(mesa.batch_run).parameters:
        keywords["rng"] = seeds
    else:
        parameters = {**parameters, "rng": seeds}
    return mesa.batch_run(model, parameters, display_progress=False, max_steps=100, **keywords)


def figures(rows):
    return sorted(
        (row["pedestrians"], row["elapsed"], row["inside"], row["mean_speed"]) for row in rows
    )


WALKS = {"pedestrians": [2, 3], "length": 6.0}


@pytest.fixture(scope="module")
def in_one_process():
    return batch(StraightWalk, WALKS, [1, 2], number_processes=1)


def test_runs_all_combinations_to_their_end(in_one_process):
    assert len(in_one_process) == 4
    assert {row["pedestrians"] for row in in_one_process} == {2, 3}
    for row in in_one_process:
        assert row["inside"] == 0
        # The slowest, at 0.9 m/s, walks 6 m.
        assert row["elapsed"] == pytest.approx(6.0 / 0.9, abs=1.0)


@pytest.mark.slow
def test_two_processes_of_mesa_itself_give_what_one_gives(in_one_process):
    in_two = batch(StraightWalk, WALKS, [1, 2], number_processes=2)
    assert figures(in_two) == figures(in_one_process)


def test_seeds_reach_the_models():
    rows = batch(OpenSpace, {"pedestrians": 12, "size": 10.0}, [3, 3, 4])
    a, b, c = figures(rows)
    assert len({a, b, c}) == 2


def test_data_collected_along_the_way():
    rows = batch(StraightWalk, {"pedestrians": 2, "length": 6.0}, [1], data_collection_period=1)
    elapsed = [row["elapsed"] for row in rows]
    assert len(rows) > 50
    assert elapsed == sorted(elapsed)
    assert rows[0]["inside"] == 2
    assert rows[-1]["inside"] == 0


def test_preset_is_a_parameter_like_any_other():
    rows = batch(
        StraightWalk, {"pedestrians": 2, "length": 6.0, "preset": ["default", "paper"]}, [1]
    )
    speed = {row["preset"]: row["elapsed"] for row in rows}
    # Without speeds of their own everybody walks as fast as the map goes.
    assert speed["paper"] < speed["default"]


def test_one_call_for_every_mesa(in_one_process):
    rows = mesa_mobility.batch_run(StraightWalk, WALKS, rng=[1, 2], display_progress=False)
    assert figures(rows) == figures(in_one_process)


def test_one_call_for_every_mesa_collects_along_the_way():
    rows = mesa_mobility.batch_run(
        OpenSpace,
        {"pedestrians": 6, "size": 10.0},
        rng=[3, 4],
        max_steps=20,
        data_collection_period=1,
        display_progress=False,
    )
    elapsed = [row["elapsed"] for row in rows]
    assert max(elapsed) == pytest.approx(2.0, abs=0.11)
    assert len(rows) >= 40
    assert len({(row["elapsed"], row["mean_speed"]) for row in rows}) > 22


def test_seeds_among_the_parameters_are_refused():
    with pytest.raises(ModelError, match=r"rng is among the parameters, expected seeds as rng="):
        mesa_mobility.batch_run(StraightWalk, {**WALKS, "rng": [1]}, display_progress=False)


NOTEBOOK = """
import mesa_mobility
from mesa_mobility.errors import ModelError
from mesa_mobility.models import StraightWalk

class Walk(StraightWalk):
    pass
"""
CALL = """
rows = mesa_mobility.batch_run(
    Walk, {"pedestrians": 2, "length": 6.0}, rng=[1, 2], number_processes=2,
    display_progress=False,
)
print(len(rows))
"""


def script(tmp_path, *, source, as_file):
    path = tmp_path / "script.py"
    path.write_text(source)
    given = [str(path)] if as_file else ["-c", source]
    return subprocess.run([sys.executable, *given], capture_output=True, text=True, timeout=300)


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("source", "as_file", "reason"),
    [
        (NOTEBOOK + CALL, False, "it is defined in a notebook or at a prompt"),
        (NOTEBOOK + CALL, True, "its script calls batch_run when it is imported, not below"),
        (
            "def f():\n" + (NOTEBOOK + CALL).replace("\n", "\n    ") + "\nf()",
            True,
            "it is defined within a function",
        ),
    ],
)
def test_what_other_processes_cannot_import_is_refused_at_once(tmp_path, source, as_file, reason):
    done = script(tmp_path, source=source, as_file=as_file)
    last = done.stderr.splitlines()[-1]
    assert last.startswith("mesa_mobility.errors.ModelError: batch_run: other processes cannot")
    assert reason in last
    assert done.stderr.count("Traceback") == 1


@pytest.mark.thorough
def test_a_script_as_it_should_be(tmp_path):
    source = NOTEBOOK + "if __name__ == '__main__':" + CALL.replace("\n", "\n    ")
    done = script(tmp_path, source=source, as_file=True)
    assert done.stdout == "2\n", done.stderr


@pytest.mark.thorough
@pytest.mark.parametrize("processes", [1, 2])
def test_a_run_that_fails_does_not_lose_the_others(processes, in_one_process):
    walks = {"pedestrians": [2, -1, 3], "length": 6.0}
    with pytest.warns(RuntimeWarning, match="2 of 6 runs fail, the first with ModelError: "):
        rows = mesa_mobility.batch_run(
            StraightWalk, walks, rng=[1, 2], display_progress=False, number_processes=processes
        )
    assert [row["RunId"] for row in rows] == list(range(6))
    assert [row["iteration"] for row in rows] == [0, 0, 0, 1, 1, 1]
    failed = [row for row in rows if "error" in row]
    assert [row["pedestrians"] for row in failed] == [-1, -1]
    assert figures(row for row in rows if "error" not in row) == figures(in_one_process)


def test_runs_that_all_fail_are_an_error():
    with pytest.raises(ModelError, match=r"batch_run: 2 of 2 runs fail, the first with TypeError"):
        mesa_mobility.batch_run(StraightWalk, {"no": 1}, rng=[1, 2], display_progress=False)
