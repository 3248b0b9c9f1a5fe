"""Compiling the decisions ahead, in a process of its own.

Numba compiles one function at a time, and decisions take it as long as all the rest:
another process that compiles them meanwhile halves the wait at the first run after installation.
It leaves them in the cache on disk, where Numba looks for them.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from mesa_mobility.crowd.beyond import merge, move_on, walk_on
from mesa_mobility.crowd.choice import decide
from mesa_mobility.crowd.collision import Surroundings
from mesa_mobility.crowd.decisions import Decisions
from mesa_mobility.crowd.groups import make_groups
from mesa_mobility.crowd.motion import due, move
from mesa_mobility.crowd.options import OPTION, SAMPLES, OptionTable, boxes
from mesa_mobility.crowd.overview import look_over, sort_out
from mesa_mobility.crowd.patience import pick, turn
from mesa_mobility.crowd.presets import preset_named
from mesa_mobility.crowd.repertoire import Repertoire
from mesa_mobility.crowd.rules import Rules
from mesa_mobility.crowd.state import Crowd
from mesa_mobility.crowd.terms_table import compile_terms
from mesa_mobility.threads import THREADS

_COMMAND = """
import gc
gc.disable()
from mesa_mobility.crowd.ahead import compile_decisions
compile_decisions()
"""


@contextmanager
def compiling_ahead() -> Iterator[None]:
    """Have decisions compiled, if they are not yet, while whatever is within makes a model.

    When it is made, what is left is compiled here.
    """
    if THREADS < 2 or any(_cached_in().glob("choice.decide-*.nbi")):
        yield
        return
    other = _start()
    try:
        yield
        compile_the_rest()
        # If it comes to grief, this process compiles what is missing.
        other.wait()
    finally:
        other.kill()
        other.wait()


def _cached_in() -> Path:
    """Where Numba keeps compiled decisions."""
    return Path(decide.stats.cache_path)


def _start() -> subprocess.Popen[bytes]:
    return subprocess.Popen(
        [sys.executable, "-c", _COMMAND], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )


def compile_the_rest() -> None:
    """Compile what a run needs beside decisions and a model: what moves people and looks at them
    once a step, and cost terms."""
    nobody, nothing, crowd = np.empty(0, dtype=np.int64), np.empty(0), Crowd(2)
    due(nobody, 0, crowd.records, nobody)
    move(nobody, 0, 1, _table(), crowd.records)
    walk_on(nobody, 0, np.empty((0, 4)), np.empty((3, 2)), crowd.records)
    move_on(nobody, 0, crowd.records)
    merge(nobody, nobody, nobody)
    pick(nothing, nobody, nothing)
    turn(nobody, nothing, nothing, crowd.records)
    look_over(nobody, 0, crowd, np.empty((0, 2)))
    sort_out(nobody, crowd.records, nobody, nobody)
    compile_terms(preset_named("default").make_terms())


def _table() -> OptionTable:
    """A table of one option."""
    return OptionTable(
        offsets=np.array([0, 1]),
        groups=np.zeros(1, dtype=np.int64),
        farthest=np.zeros(1),
        options=np.ones(1, dtype=OPTION).view(np.recarray),
        heading=np.zeros(1, dtype=np.float32),
        path=np.zeros((1, 3, SAMPLES), dtype=np.float32),
    )


def compile_decisions() -> None:
    """Compile what makes people decide, by the decisions of nobody."""
    table = _table()
    around = Surroundings(
        segments=np.empty((0, 4)),
        x0=0.0,
        y0=0.0,
        nx=1,
        ny=1,
        size=1.0,
        offsets=np.zeros(2, dtype=np.int64),
        indices=np.empty(0, dtype=np.int32),
        exits=np.empty((0, 4)),
        leads_out=np.zeros((1, 0), dtype=np.bool_),
    )
    first = np.zeros(1, dtype=np.int64)
    standing = np.zeros(1, dtype=np.int32)
    repertoire = Repertoire(
        (), table, make_groups(table, boxes(table.path)), standing, first, standing, 1.0, 1.0
    )
    decisions = Decisions(repertoire, Rules(1.0, True, standing, first), least_core=1.0)
    nobody, crowd = np.empty(0, dtype=np.int64), Crowd(2)
    decisions.take(nobody, 0, nobody, crowd, around, terms=[])
