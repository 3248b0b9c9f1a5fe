"""Does anybody stand for ever where people get in each other's way?

python -m benchmarks.conflicts runs.jsonl [gate arena corridor ...] [--seeds 0-99] [--minutes 9]
    [--jobs 1] [--plans DIR] [--only TEXT]

Appends one JSON line a run and goes on where the file ends, so that it can be run in pieces. Prints
a table of the runs of these scenes and seeds, and the seeds of those in which anything was wrong;
ends with status 1 if anything was.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

from benchmarks.conflicts import arena, corridor, gate, lone, mixed, narrow, queue
from benchmarks.conflicts.buildings import scene as buildings
from benchmarks.conflicts.resuming import run_missing
from benchmarks.conflicts.table import print_table
from mesa_mobility.verification import Case

Cases = Callable[[Path | None], Sequence[Case]]

SCENES: dict[str, tuple[Cases, int]] = {
    "gate": (lambda _: gate.cases(), 100),
    "arena": (arena.cases, 50),
    "corridor": (lambda _: corridor.cases(), 20),
    "niche": (lambda _: narrow.cases(), 10),
    "mixed": (lambda _: mixed.cases(), 500),
    "lone": (lambda _: lone.cases(), lone.STARTS),
    "queue": (lambda _: queue.cases(), 20),
    "buildings": (lambda _: buildings.cases(), 500),
}
"""The cases of each scene, given the folder of plans, and how many seeds each has."""


def main() -> None:
    """Run the seeds without results yet, then print the table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("file", type=Path, help="one JSON line a run")
    parser.add_argument("scenes", nargs="*", help=f"of {', '.join(SCENES)}; by default all")
    parser.add_argument("--seeds", help="such as 0-99 or 3,5,8-10; by default those of each scene")
    parser.add_argument("--minutes", type=float, default=9.0, help="begin no run after this")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--plans", type=Path, help="folder with plans that are not part of this")
    parser.add_argument("--only", default="", help="only cases whose name has this text")
    given = parser.parse_args()
    for scene in given.scenes:
        if scene not in SCENES:
            parser.error(f"scene {scene!r}: expected one of {', '.join(SCENES)}")
    units = []
    for scene in given.scenes or SCENES:
        cases, count = SCENES[scene]
        seeds = seeds_of(given.seeds) if given.seeds else range(count)
        found = [each for each in cases(given.plans) if given.only in name_of(each)]
        units += [(each, seed) for seed in seeds for each in found]
    rows = run_missing(given.file, units, minutes=given.minutes, jobs=given.jobs, name=name_of)
    sys.exit(1 if print_table(rows) else 0)


def name_of(each: Case) -> str:
    """A case as the file has it: without paths, which differ from computer to computer."""
    numbers = ", ".join(f"{name} {value}" for name, value in each.numbers if name != "file")
    return f"{each.scenario.__name__}({numbers})"


def seeds_of(text: str) -> list[int]:
    """Seeds from a text such as ``3,5,8-10``."""
    seeds: list[int] = []
    for part in text.split(","):
        first, _, last = part.partition("-")
        seeds += range(int(first), int(last or first) + 1)
    return seeds


if __name__ == "__main__":
    main()
