"""Egress times and speeds of each type of people: a table of docs/explanation/mixed_ability.md.

python benchmarks/pages/times_by_type.py --seeds 5 [--out FOLDER]
"""

from __future__ import annotations

import argparse
from pathlib import Path

import pandas as pd
from blocks import give, table
from mesa_mobility.models import Auditorium, MixedEvacuation

from mesa_mobility import PedestrianModel, Trajectories
from mesa_mobility.populations import presets
from mesa_mobility.results import by_type

LIMIT_S = 900.0
COLUMNS = {
    "people": ("people", "{:.4g}"),
    "mean_egress_s": ("mean, s", "{:.0f}"),
    "p95_egress_s": ("95th percentile, s", "{:.0f}"),
    "mean_speed_mps": ("speed, m/s", "{:.2f}"),
}


def crowd(name: str, seed: int) -> PedestrianModel:
    """One of the two crowds, recorded to its end."""
    if name == "mixed_evacuation":
        model: PedestrianModel = MixedEvacuation(record=True, rng=seed)
    else:
        model = Auditorium(population="mixed", record=True, rng=seed)
    model.run(max_seconds=LIMIT_S)
    return model


def main() -> None:
    """Run, and write the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=5, help="seeds 1 to this")
    parser.add_argument("--out", type=Path, help="folder for the block")
    given = parser.parse_args()
    means, ends = {}, []
    for name in ("mixed_evacuation", "auditorium"):
        models = [crowd(name, seed) for seed in range(1, given.seeds + 1)]
        tables = [by_type(Trajectories.of(model)) for model in models]
        means[name] = pd.concat(tables).groupby(level=0).mean()
        # A type that nobody is of in a run counts there as nobody, not as missing.
        people = pd.concat([each.people for each in tables], axis=1).fillna(0.0)
        means[name]["people"] = people.mean(axis=1)
        egress = sorted(model.elapsed for model in models)
        left = sum(model.inside for model in models)
        ends.append(f"{egress[0]:.0f} to {egress[-1]:.0f} s ({name}, {left} still inside)")
    rows = [
        (kind, *(cell for found in means.values() for cell in cells(found, kind)))
        for kind in presets()["every_type"].shares
        if any(kind in found.index for found in means.values())
    ]
    heads = ["", *(title for title, _ in COLUMNS.values()), *(t for t, _ in COLUMNS.values())]
    for name, at in zip(means, (1, 1 + len(COLUMNS)), strict=True):
        heads[at] = f"`{name}`: people"
    told = f"Means over seeds 1 to {given.seeds}. Runs ended after {' and '.join(ends)}."
    give(given.out, "times-by-type", f"{told}\n\n{table(heads, rows)}")


def cells(found: pd.DataFrame, kind: str) -> list[str]:
    """The figures of a type in one crowd."""
    if kind not in found.index:
        return ["-", *[""] * (len(COLUMNS) - 1)]
    return [form.format(found.loc[kind, name]) for name, (_, form) in COLUMNS.items()]


if __name__ == "__main__":
    main()
