"""What a row of the store says of a run, and where a store has its files."""

from __future__ import annotations

from typing import Any, TypeAlias

DONE, FAILED, STALLED, TIMED_OUT = "done", "failed", "stalled", "timed_out"
STATUSES = (DONE, FAILED, STALLED, TIMED_OUT)

SERIES = {"types", "occupancy"}
"""Columns that hold lists."""

COMPUTING = {"wall_s", "cpu_s"}
"""Columns of seconds that a run took to compute, which one that stalls has as well."""

Row: TypeAlias = dict[str, Any]

RUNS = "runs"
WORK = "work"
TRAJECTORIES = "trajectories"
