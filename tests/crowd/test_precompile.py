"""Precompilation covers the functions that runs need."""

import pytest
from mesa_mobility.behaviors.steering import (
    anticipation,
    course_choice,
    people_ahead,
    speed_adaptation,
)
from mesa_mobility.models import Doorway

from mesa_mobility.crowd import PRESETS, precompile
from mesa_mobility.crowd.conflicts import hindrance
from mesa_mobility.crowd.planning import decision, decision_order
from mesa_mobility.crowd.state import advance, aggregates, departed, people_grid

FUNCTIONS = [
    decision.decide,
    decision_order.select_due,
    advance._move,
    people_grid.build_grid,
    people_grid._sorted,
    people_grid._fill,
    departed.walk_on,
    departed.move_on,
    departed.merge,
    hindrance.find_hindered,
    hindrance.wait_behind,
    aggregates._look_over,
    aggregates.split_active,
]
OF_TACTICS = {
    "anticipation": [people_ahead.note_motion, anticipation._turn_aside],
    "course_choice": [course_choice._choose_courses],
    "speed_adaptation": [speed_adaptation._adapt_speeds],
}


def test_what_is_compiled_ahead_is_what_a_run_calls():
    Doorway(pedestrians=60, rng=1).run(max_seconds=20.0)
    tactics = PRESETS["default"].tactics
    functions = FUNCTIONS + [each for name in tactics for each in OF_TACTICS.get(name, [])]
    needed = [set(function.signatures) for function in functions]
    precompile.compile_decisions()
    precompile.compile_the_rest()
    assert [set(function.signatures) for function in functions] == needed
    assert all(needed)


def test_the_other_process_can_import_what_it_calls():
    found = {}
    lines = [line for line in precompile._COMMAND.splitlines() if "import" in line]
    exec("\n".join(lines), found)
    assert found["compile_decisions"] is precompile.compile_decisions


def test_decisions_are_compiled_ahead_once(monkeypatch, tmp_path):
    started = []
    monkeypatch.setattr(precompile, "THREADS", 2)
    monkeypatch.setattr(precompile, "_cached_in", lambda: tmp_path)
    monkeypatch.setattr(precompile, "_COMMAND", "pass")
    monkeypatch.setattr(
        precompile, "_start", lambda start=precompile._start: started.append(1) or start()
    )
    with precompile.compiling_ahead():
        pass
    assert len(started) == 1
    (tmp_path / "decision.decide-40.py311.nbi").touch()
    with precompile.compiling_ahead():
        pass
    assert len(started) == 1


def test_trouble_within_ends_the_other_process(monkeypatch, tmp_path):
    others = []
    monkeypatch.setattr(precompile, "THREADS", 2)
    monkeypatch.setattr(precompile, "_cached_in", lambda: tmp_path)
    monkeypatch.setattr(precompile, "_COMMAND", "import time; time.sleep(60)")
    monkeypatch.setattr(
        precompile, "_start", lambda start=precompile._start: others.append(start()) or others[0]
    )
    with pytest.raises(ValueError, match="bad input"), precompile.compiling_ahead():
        raise ValueError("bad input")
    assert others[0].returncode is not None
