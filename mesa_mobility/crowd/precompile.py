"""Compiling decisions ahead, in another process.

Numba compiles one function at a time, and decisions take as long as all other functions together.
Another process that compiles them at the same time halves the wait at the first run after
installation.  It leaves them in the cache on disk, where Numba finds them.

Where a wheel brings compiled code, nobody waits. Another process then compiles for this very
processor, and goes on when the run has ended.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import numpy as np
from filelock import FileLock, Timeout

# Mesa looks at each frame of the stack when it is imported. Here the stack is short, which spares a
# tenth of a start.
from mesa_mobility import _mesa  # noqa: F401
from mesa_mobility.compiled import cache
from mesa_mobility.compiled.threads import THREADS
from mesa_mobility.crowd.costs.candidates import Moment
from mesa_mobility.crowd.options.option_groups import make_groups
from mesa_mobility.crowd.options.repertoire import Repertoire
from mesa_mobility.crowd.options.table import OPTION, SAMPLES, OptionTable, boxes
from mesa_mobility.crowd.planning.decision import decide
from mesa_mobility.crowd.planning.decision_order import select_due
from mesa_mobility.crowd.planning.evaluation.term_table import compile_terms
from mesa_mobility.crowd.planning.scheduler import DecisionScheduler
from mesa_mobility.crowd.planning.workspace import Rules
from mesa_mobility.crowd.presets.shipped import PRESETS
from mesa_mobility.crowd.state.advance import move
from mesa_mobility.crowd.state.aggregates import aggregate, split_active
from mesa_mobility.crowd.state.departed import merge, move_on, walk_on
from mesa_mobility.crowd.state.records import Crowd
from mesa_mobility.crowd.state.surroundings import Surroundings
from mesa_mobility.interrupts import cleaning_up, deaf_children

COMPILING = "compiling, once after installation: takes half a minute on two free processors"
"""What a command says while the first run compiles."""

_COMMAND = """
import gc
gc.disable()
from mesa_mobility.crowd.precompile import compile_decisions
compile_decisions()
"""

_NATIVELY = """
import os
if hasattr(os, "nice"):
    os.nice(19)
from mesa_mobility.crowd.precompile import compile_natively
compile_natively()
"""

LOCK = "compiling.lock"
"""A file beside the compiled code: whoever locks it compiles for all."""


@contextmanager
def compiling_ahead() -> Iterator[None]:
    """Compile decisions in another process, if necessary, while the block makes a model.

    Everything else is compiled in this process after the block.
    """
    if THREADS < 2 or _cached_in() is None or is_compiled():
        yield
        if not _is_kept() and is_compiled():
            _compile_in_background()
        return
    with deaf_children():
        other = _start()
    try:
        with cleaning_up(other.kill):
            yield
            compile_the_rest()
            # If the other process fails, this one compiles what is missing.
            other.wait()
    finally:
        other.kill()
        other.wait()


def is_compiled() -> bool:
    """Whether decisions, which take longest to compile, need not be compiled."""
    return _is_kept() or cache.shipped_code() is not None


def _is_kept() -> bool:
    """Whether decisions are kept on disk, as compiled for this processor."""
    where = _cached_in()
    return where is not None and any(where.glob("decision.decide-*.nbi"))


def _cached_in() -> Path | None:
    """The folder of compiled decisions, or None if they are not kept."""
    path = decide.stats.cache_path
    return None if path is None else Path(path)


def _start() -> subprocess.Popen[bytes]:
    return subprocess.Popen(
        [sys.executable, "-c", _COMMAND], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )


def _compile_in_background() -> None:
    """Compile for this processor in another process, which nobody waits for."""
    if os.environ.get("MESA_MOBILITY_NATIVE") == "0":
        return
    cache.say_once(
        "compiling for this processor, in the background and at low priority: later runs are faster"
    )
    nothing = subprocess.DEVNULL
    command = [sys.executable, "-c", _NATIVELY]
    subprocess.Popen(command, stdin=nothing, stdout=nothing, stderr=nothing, start_new_session=True)


def compile_natively() -> None:
    """Compile for this processor what a wheel has for its level, unless another process does."""
    where = cache.folder()
    assert where is not None
    # A file system may have no locks.
    with suppress(Timeout, OSError, NotImplementedError), FileLock(where / LOCK, timeout=0):
        cache.compile_natively()
        compile_the_rest()
        # Last: its file says that all is there.
        compile_decisions()


def compile_the_rest() -> None:
    """Compile the rest that a run needs: movement, aggregates, tactics and cost terms."""
    nobody, crowd = np.empty(0, dtype=np.int64), Crowd(2)
    select_due(nobody, 0, crowd.records, nobody)
    move(nobody, 0, 1, _table(), crowd.records)
    walk_on(nobody, 0, np.empty((0, 4)), np.empty((3, 2)), crowd.records)
    move_on(nobody, 0, crowd.records)
    merge(nobody, nobody, nobody)
    aggregate(nobody, 0, crowd, np.empty((0, 2)))
    split_active(nobody, crowd.records, nobody, nobody)
    preset = PRESETS["default"]
    for tactic in preset.make_tactics():
        tactic.compile_ahead()
    compile_terms(preset.make_terms())


def _table() -> OptionTable:
    """A table of one option."""
    return OptionTable(
        offsets=np.array([0, 1], dtype=np.int64),
        groups=np.zeros(1, dtype=np.int64),
        farthest=np.zeros(1),
        options=np.ones(1, dtype=OPTION).view(np.recarray),
        heading=np.zeros(1, dtype=np.float32),
        path=np.zeros((1, 3, SAMPLES), dtype=np.float32),
    )


def compile_decisions() -> None:
    """Compile decisions by deciding for an empty crowd."""
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
        steps=np.empty((0, 4)),
        climbs=np.ones(1, dtype=np.bool_),
        most_walls=0,
    )
    first = np.zeros(1, dtype=np.int64)
    standing = np.zeros(1, dtype=np.int32)
    metre = np.ones(1)
    repertoire = Repertoire(
        (), table, make_groups(table, boxes(table.path)), standing, first, standing, metre, metre
    )
    decisions = DecisionScheduler(
        repertoire, Rules(1.0, metre[None], True, standing, first), least_core=1.0, types=[""]
    )
    nobody, crowd = np.empty(0, dtype=np.int64), Crowd(2)
    moment = Moment(0, np.random.default_rng(0))
    decisions.take(nobody, moment, nobody, crowd, around, terms=[])
