"""Mesa's ``batch_run`` over the models, whichever way this Mesa takes seeds, and ours."""

import inspect

import mesa
import pytest
from mesa_mobility.models import OpenSpace, StraightWalk

import mesa_mobility


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


def test_two_processes_give_what_one_gives(in_one_process):
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
    rows = batch(StraightWalk, {"pedestrians": 2, "length": 6.0, "preset": ["default", "paper"]},
                 [1])  # fmt: skip
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
