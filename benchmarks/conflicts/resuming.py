"""Runs that are kept one JSON line each, and go on where the file ends."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any, TypeAlias

from mesa_mobility.results.files import json_text
from mesa_mobility.verification import Case
from mesa_mobility.verification.cases import Figures, run_units

Row: TypeAlias = dict[str, Any]
Name: TypeAlias = Callable[[Case], str]


def run_missing(
    file: Path,
    units: Sequence[tuple[Case, int]],
    *,
    minutes: float,
    jobs: int,
    name: Name = str,
    kept: Callable[[Figures], Figures] = dict,
) -> list[Row]:
    """Run the units that the file lacks, append a line for each, and give the rows of all.

    Args:
        file: one JSON line a run, with ``scenario`` and ``seed``.
        units: cases with their seeds, each pair once.
        minutes: begin no run after this.
        jobs: processes.
        name: of a case, in the file.
        kept: what of the figures goes into the file.
    """
    done = {(row["scenario"], row["seed"]): row for row in read_rows(file)}
    begun = time.monotonic()

    def missing() -> Iterator[tuple[Case, int]]:
        for each, seed in units:
            if time.monotonic() - begun > 60.0 * minutes:
                return
            if (name(each), seed) not in done:
                yield each, seed

    with file.open("a", encoding="utf-8") as out:
        for each, seed, figures in run_units(missing(), jobs):
            row = {"scenario": name(each), "seed": seed, **kept(figures)}
            out.write(json_text(row) + "\n")
            out.flush()
            done[name(each), seed] = row
    keys = [(name(each), seed) for each, seed in units]
    rows = [done[key] for key in keys if key in done]
    print(f"{len(rows)} of {len(units)} runs")
    return rows


def read_rows(file: Path) -> list[Row]:
    """The rows of a file; none where there is no file."""
    if not file.exists():
        return []
    return [json.loads(line) for line in file.read_text(encoding="utf-8").splitlines()]
