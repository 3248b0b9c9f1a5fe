"""The paper's doorway and auditorium under both presets, as the table of docs/paper_results.md.

python benchmarks/paper_results.py --seeds 5
"""

from __future__ import annotations

import argparse
import statistics

from mesa_mobility.models import Auditorium, Doorway

from mesa_mobility.results import Trajectories, check_safety

HEADER = (
    "| model | preset | all out after, s | fallback, share of time | fallback, share of decisions "
    "| overlaps | least distance, m | wall crossings |"
)


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=5, help="seeds 1 to this")
    seeds = range(1, parser.parse_args().seeds + 1)
    print(HEADER)
    print("|---" * 8 + "|")
    curves = []
    for model_class in (Doorway, Auditorium):
        for preset in ("default", "paper"):
            rows = []
            for seed in seeds:
                model = model_class(preset=preset, record=True, rng=seed)
                model.run(max_seconds=900)
                safety = check_safety(Trajectories.of(model), model.floor_plan.walls)
                rows.append((model, safety))
                if model_class is Auditorium:
                    curves.append((preset, seed, dict(model.statistics.occupancy)))
            print(_line(model_class.__name__.lower(), preset, rows))
    print("\n| inside at | paper | " + " | ".join(f"{p}, seed {s}" for p, s, _ in curves) + " |")
    print("|---" * (2 + len(curves)) + "|")
    for time, paper in Auditorium.reference_occupancy.items():
        now = [str(_inside(curve, time)) for _, _, curve in curves]
        print(f"| {time} s | {paper} | " + " | ".join(now) + " |")


def _line(name: str, preset: str, rows: list) -> str:
    def spread(values: list[float], form: str) -> str:
        low, mid, high = min(values), statistics.median(values), max(values)
        return f"{mid:{form}} ({low:{form}} to {high:{form}})"

    summaries = [model.summary() for model, _ in rows]
    return (
        f"| {name} | {preset} "
        f"| {spread([s['egress_s'] or float('inf') for s in summaries], '.1f')} "
        f"| {spread([100 * s['fallback_time_share'] for s in summaries], '.1f')} % "
        f"| {spread([100 * s['fallback_decision_share'] for s in summaries], '.1f')} % "
        f"| {spread([safety.overlaps for _, safety in rows], '.0f')} "
        f"| {spread([safety.min_distance_m for _, safety in rows], '.3f')} "
        f"| {spread([safety.wall_crossings for _, safety in rows], '.0f')} |"
    )


def _inside(curve: dict[float, int], time: float) -> int:
    # Noted every second while anybody is inside.
    last = max(t for t in curve if t <= time)
    return curve[last] if time - last < 1.0 else 0


if __name__ == "__main__":
    main()
