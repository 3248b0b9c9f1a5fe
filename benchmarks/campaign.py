"""Is anybody ever frozen or lost?  500 runs, each with a seed of its own, counted independently.

python benchmarks/campaign.py campaign.jsonl [--runs 500] [--plans 0] [--minutes 9] [--jobs 2]
    [--out FOLDER]

Appends one JSON line a run and goes on where the file ends, so that it can be run in pieces;
with nothing left to run it prints the figures and ends with status 1 if anybody was frozen or lost.
With --out it writes them as a block for docs/validation.md. With --plans so many random floor plans
are run besides: halls, rooms, corridors, stars and traps.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

from conflicts.resuming import run_missing
from pages.blocks import give, table

from mesa_mobility.validation.bottleneck import bottleneck
from mesa_mobility.verification import Case, case
from mesa_mobility.verification.scenarios.counterflow import counterflow
from mesa_mobility.verification.scenarios.random_plans import SHAPES, random_plan
from mesa_mobility.verification.scenarios.shipped import shipped

ROUND: tuple[Case, ...] = (
    case(shipped, model="doorway"),
    case(bottleneck, width=0.8),
    case(counterflow, opposing=100),
    case(bottleneck, width=0.9),
    case(shipped, model="doorway"),
    case(bottleneck, width=1.0),
    case(counterflow, opposing=50),
    case(bottleneck, width=1.2),
    case(bottleneck, width=1.6),
    case(bottleneck, width=2.0),
    case(counterflow, opposing=100),
    case(shipped, model="auditorium"),
    case(shipped, model="doorway", population="mixed"),
    case(shipped, model="auditorium", population="mixed"),
    case(shipped, model="mixed_evacuation"),
)
"""Scenarios, run in turn; people of all types walk in a fifth of the runs."""

PLANS: tuple[Case, ...] = tuple(
    case(random_plan, shape=shape, both_ways=both_ways)
    for both_ways in (False, True)
    for shape in SHAPES
)
"""Random plans, in turn: each seed is another plan."""

SEED, PLAN_SEED = 10_000, 1_000_000
"""Of the first run, and of the first random plan; each one after it has the next."""

KEPT = (
    "pedestrians",
    "left_inside",
    "stalled",
    "overlaps",
    "wall_crossings",
    "off_floor",
    "min_distance_m",
    "simulated_s",
    "egress_s",
    "fallback_time_share",
    "person_s",
)

HEADS = (
    "scenario",
    "runs",
    "people",
    "frozen or lost",
    "runs with any",
    "overlaps",
    "wall crossings",
    "frames off the floor",
    "fallback, share of time",
)

COUNTED = ("pedestrians", "left_inside", "overlaps", "wall_crossings", "off_floor")


def main() -> None:
    """Run the seeds without results yet, then print the results."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("file", type=Path, help="one JSON line a run")
    parser.add_argument("--runs", type=int, default=500)
    parser.add_argument("--plans", type=int, default=0, help="random floor plans besides")
    parser.add_argument("--minutes", type=float, default=9.0, help="begin no run after this")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--out", type=Path, help="folder for the block")
    given = parser.parse_args()
    units = [(ROUND[k % len(ROUND)], SEED + k) for k in range(given.runs)]
    units += [(PLANS[k % len(PLANS)], PLAN_SEED + k) for k in range(given.plans)]
    wanted = run_missing(given.file, units, minutes=given.minutes, jobs=given.jobs, kept=_kept)
    text, bad = report(wanted)
    if len(wanted) == len(units) or given.out is None:
        give(given.out, "campaign", text)
    sys.exit(1 if bad else 0)


def report(rows: list[dict[str, Any]]) -> tuple[str, bool]:
    """Figures of each scenario, and whether anything was wrong in any run."""
    lines, errors, wrong = [], [], False
    for name in [*dict.fromkeys(row["scenario"] for row in rows), "all"]:
        mine = [row for row in rows if name in (row["scenario"], "all")]
        failed = [row for row in mine if "error" in row]
        good = [row for row in mine if "error" not in row]
        total = {key: sum(row[key] for row in good) for key in COUNTED}
        time_ = sum(row["person_s"] for row in good)
        share = sum(row["fallback_time_share"] * row["person_s"] for row in good) / (time_ or 1.0)
        stuck = sum(row["left_inside"] > 0 for row in good)
        lines.append(
            [
                name,
                len(mine),
                total["pedestrians"],
                total["left_inside"],
                stuck,
                *(total[key] for key in COUNTED[2:]),
                f"{share:.1%}",
            ]
        )
        errors += [f"seed {row['seed']}: {row['error']}" for row in failed if name != "all"]
        wrong |= bool(failed or stuck or any(total[key] for key in COUNTED[1:]))
    return "\n\n".join([table(HEADS, lines), *errors]), wrong


def _kept(figures: dict[str, Any]) -> dict[str, Any]:
    return {name: figures[name] for name in (*KEPT, "error") if name in figures}


if __name__ == "__main__":
    main()
