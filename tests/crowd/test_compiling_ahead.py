"""What is compiled ahead is what runs need."""

import pytest
from mesa_mobility.models import Doorway

from mesa_mobility.crowd import (
    ahead,
    beyond,
    choice,
    motion,
    neighbours,
    overview,
    patience,
)

FUNCTIONS = [
    choice.decide,
    motion.due.__wrapped__,
    motion._move.__wrapped__,
    neighbours.build_grid,
    neighbours._write_headways.__wrapped__,
    beyond.walk_on.__wrapped__,
    beyond.move_on.__wrapped__,
    beyond.merge.__wrapped__,
    patience.pick.__wrapped__,
    patience.turn.__wrapped__,
    overview._look_over.__wrapped__,
    overview.sort_out.__wrapped__,
]


def test_what_is_compiled_ahead_is_what_a_run_calls():
    Doorway(pedestrians=60, rng=1).run(max_seconds=20.0)
    needed = [set(function.signatures) for function in FUNCTIONS]
    ahead.compile_decisions()
    ahead.compile_the_rest()
    assert [set(function.signatures) for function in FUNCTIONS] == needed
    assert all(needed)


def test_decisions_are_compiled_ahead_once(monkeypatch, tmp_path):
    started = []
    monkeypatch.setattr(ahead, "THREADS", 2)
    monkeypatch.setattr(ahead, "_cached_in", lambda: tmp_path)
    monkeypatch.setattr(ahead, "_COMMAND", "pass")
    monkeypatch.setattr(ahead, "_start", lambda start=ahead._start: started.append(1) or start())
    with ahead.compiling_ahead():
        pass
    assert len(started) == 1
    (tmp_path / "choice.decide-40.py311.nbi").touch()
    with ahead.compiling_ahead():
        pass
    assert len(started) == 1


def test_trouble_within_ends_the_other_process(monkeypatch, tmp_path):
    others = []
    monkeypatch.setattr(ahead, "THREADS", 2)
    monkeypatch.setattr(ahead, "_cached_in", lambda: tmp_path)
    monkeypatch.setattr(ahead, "_COMMAND", "import time; time.sleep(60)")
    monkeypatch.setattr(
        ahead, "_start", lambda start=ahead._start: others.append(start()) or others[0]
    )
    with pytest.raises(ValueError, match="bad input"), ahead.compiling_ahead():
        raise ValueError("bad input")
    assert others[0].returncode is not None
