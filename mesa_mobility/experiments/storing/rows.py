"""What a row of the store says of a run, and where a store has its files."""

from __future__ import annotations

from typing import Any, TypeAlias

DONE, FAILED, STALLED, TIMED_OUT = "done", "failed", "stalled", "timed_out"
BLOCKED = "blocked"
"""Ended, with people inside who stood for a minute without a reason while others could move."""

STATUSES = (DONE, BLOCKED, STALLED, FAILED, TIMED_OUT)
ENDED = {DONE, BLOCKED, STALLED}
"""Statuses of runs that have come to an end by themselves or at ``max_seconds``."""

SERIES = {"types", "occupancy"}
"""Columns that hold lists."""

COMPUTING = {"wall_s", "cpu_s"}
"""Columns of seconds that a run took to compute, which one that stalls has as well."""

REACHED = {"t50_s", "t95_s", "t100_s", "first_s"}
"""Ends of the names of times that a run which stalls later may have come to."""

LASTING = ("stairs.", "lift.", "escalator.")
"""Begins of the names of seconds for which something lasts, but for those in ``REACHED``."""

Row: TypeAlias = dict[str, Any]

RUNS = "runs"
WORK = "work"
TRAJECTORIES = "trajectories"
