"""The paper's doorway and auditorium under both presets: docs/paper_results.md.

python benchmarks/pages/paper_results.py --seeds 5 --out FOLDER
"""

from __future__ import annotations

import argparse
import shutil
import statistics
import tempfile
from pathlib import Path
from typing import Any

from blocks import give, table
from mesa_mobility.models import Auditorium, Doorway

from mesa_mobility import PedestrianModel
from mesa_mobility.results import Trajectories, check_safety
from mesa_mobility.results.run import write_run
from mesa_mobility.results.safety import SafetyReport

HEADS = (
    "model", "preset", "all out after, s", "fallback, share of time",
    "fallback, share of decisions", "overlaps", "least distance, m", "wall crossings",
)  # fmt: skip


def main() -> None:
    """Run, and write two blocks and the pictures of the first run in the auditorium."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=5, help="seeds 1 to this")
    parser.add_argument("--out", type=Path, help="folder for blocks and pictures")
    given = parser.parse_args()
    lines = []
    curves: dict[str, list[dict[float, int]]] = {"default": [], "paper": []}
    for model_class in (Doorway, Auditorium):
        for preset in curves:
            rows = []
            for seed in range(1, given.seeds + 1):
                model = model_class(preset=preset, record=True, rng=seed)
                model.run(max_seconds=900)
                safety = check_safety(Trajectories.of(model), model.floor_plan.walls)
                rows.append((model.summary(), safety))
                if model_class is Auditorium:
                    curves[preset].append(dict(model.statistics.occupancy))
                    if given.out is not None and preset == "default" and seed == 1:
                        draw(model, given.out)
            lines.append((model_class.__name__.lower(), preset, *_cells(rows)))
    give(given.out, "paper-results", f"Seeds 1 to {given.seeds}.\n\n{table(HEADS, lines)}")
    heads = ("people inside at", "the paper", *(f"preset `{preset}`" for preset in curves))
    inside = [
        (
            f"{time} s",
            paper,
            *(", ".join(str(_inside(c, time)) for c in some) for some in curves.values()),
        )
        for time, paper in Auditorium.reference_occupancy.items()
    ]
    give(given.out, "paper-occupancy", f"Seeds 1 to {given.seeds}.\n\n{table(heads, inside)}")


def draw(model: PedestrianModel, folder: Path) -> None:
    """The pictures that `mesa-mobility run --out` writes."""
    with tempfile.TemporaryDirectory() as temporary:
        run = Path(temporary) / "run"
        write_run(
            run,
            summary={"model": "auditorium", "preset": "default", "seed": 1},
            trajectories=Trajectories.of(model),
            plan=model.floor_plan,
            reference_occupancy=Auditorium.reference_occupancy,
        )
        folder.mkdir(parents=True, exist_ok=True)
        for name in ("occupancy", "trajectories"):
            shutil.copyfile(run / f"{name}.png", folder / f"auditorium_{name}.png")


def _cells(rows: list[tuple[dict[str, Any], SafetyReport]]) -> list[str]:
    def spread(values: list[float], form: str) -> str:
        low, mid, high = min(values), statistics.median(values), max(values)
        return f"{mid:{form}} ({low:{form}} to {high:{form}})"

    summaries = [summary for summary, _ in rows]
    return [
        spread([s["egress_s"] or float("inf") for s in summaries], ".1f"),
        spread([100 * s["fallback_time_share"] for s in summaries], ".1f") + " %",
        spread([100 * s["fallback_decision_share"] for s in summaries], ".1f") + " %",
        spread([safety.overlaps for _, safety in rows], ".0f"),
        spread([safety.min_distance_m for _, safety in rows], ".3f"),
        spread([safety.wall_crossings for _, safety in rows], ".0f"),
    ]


def _inside(curve: dict[float, int], time: float) -> int:
    # Noted every second while anybody is inside.
    last = max(t for t in curve if t <= time)
    return curve[last] if time - last < 1.0 else 0


if __name__ == "__main__":
    main()
