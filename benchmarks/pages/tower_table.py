"""Table of docs/explanation/stairs.md: the model `office_tower`, storey by storey.

python benchmarks/pages/tower_table.py --seeds 5 --out FOLDER
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from blocks import give, table
from stairs_scenes import counted, safety

from mesa_mobility.results import by_level, by_stairs
from mesa_mobility.verification.runs import evacuate
from models.office_tower import OfficeTower

LIMIT_S = 1800.0
"""Simulated seconds at most."""


def main() -> None:
    """Run all seeds, and write the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=5, help="seeds 1 to this")
    parser.add_argument("--out", type=Path, required=True, help="folder for the table")
    given = parser.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    give(given.out, "tower", times([tower(seed) for seed in range(1, given.seeds + 1)]))


def tower(seed: int) -> dict[str, Any]:
    """A run until all are out: when each storey is empty, and who took the lift."""
    model = OfficeTower(record=True, rng=seed)
    run = evacuate(model, LIMIT_S, stop_when_stalled=False)
    building = model.building
    assert building is not None
    on_stairs = by_stairs(run.trajectories, building)
    return {
        **safety(run),
        "carried": int(model.lifts.carried.sum()),
        "down": {name: int(on_stairs.down[f"{name} 0"]) for name in ("west", "east")},
        "clear": by_level(run.trajectories, building).clear_s,
    }


def times(runs: Sequence[dict[str, Any]]) -> str:
    """When each storey was empty, and how people came down."""
    clear = np.array([run["clear"].to_numpy() for run in runs])
    levels = runs[0]["clear"].index
    rows = [
        (str(level), *(f"{value:.0f}" for value in column), f"{column.mean():.0f}")
        for level, column in zip(levels, clear.T, strict=True)
    ]
    rows += [
        ("by the lift, people", *(str(run["carried"]) for run in runs), ""),
        ("by the last flights west and east", *map(_both, runs), ""),
    ]
    heads = ["storey empty, s", *(f"seed {k + 1}" for k in range(len(runs))), "mean"]
    return f"{counted(runs)}\n\n{table(heads, rows)}"


def _both(run: dict[str, Any]) -> str:
    return ", ".join(str(people) for people in run["down"].values())


if __name__ == "__main__":
    main()
