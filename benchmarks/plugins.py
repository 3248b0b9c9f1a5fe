"""The price of plug-ins: CPU a simulated second of 750 people in a room.

python benchmarks/plugins.py [--out FOLDER]
"""

from __future__ import annotations

import argparse
import statistics
import time
from pathlib import Path
from typing import Any

import numpy as np
from pages.blocks import give, machine, table
from scenarios import room

from mesa_mobility import (
    Candidates,
    CompiledTerm,
    CostTerm,
    Exit,
    FloorPlan,
    Gate,
    Option,
    Pedestrian,
    PedestrianModel,
    pair_kernel,
)

WARM_UP, SECONDS = 1.0, 10.0

ROUNDS = 5


class KeepLeft(CostTerm):
    """A term in NumPy over options."""

    name = "keep_left"

    def cost(self, candidates: Candidates) -> Any:
        """Metres to the right of the way."""
        way = candidates.targets - candidates.positions
        way = way / np.maximum(np.linalg.norm(way, axis=1, keepdims=True), 1e-9)
        step = candidates.points - candidates.positions[candidates.owner]
        ahead = way[candidates.owner]
        return ahead[:, 1] * step[:, 0] - ahead[:, 0] * step[:, 1]


@pair_kernel(fields=("infected",))
def _avoid(option: Option, other: Any) -> float:
    gap = 1.5 - ((other.x - option.x) ** 2 + (other.y - option.y) ** 2) ** 0.5
    return other.infected * gap if gap > 0.0 else 0.0


class Avoid(CompiledTerm):
    """A compiled term over neighbours, with a field."""

    name = "avoid"
    kernel = _avoid


class Counting(Pedestrian):
    """A step in Python that reads and writes a field."""

    def step(self) -> None:
        """Count the steps in which the person walks."""
        if self.speed > 0.5:
            self.mood += 1.0


def make(kind: type[Pedestrian] = Pedestrian, *terms: CostTerm) -> PedestrianModel:
    """The room of the other benchmarks."""
    scenario = room()
    plan = FloorPlan(
        scenario.floor,
        exits=[Exit(name, *line) for name, (line, _) in scenario.exits.items()],
        gates=[Gate(name, *line) for name, line in scenario.doors.items()],
    )
    model = PedestrianModel(
        plan, rng=1, pedestrian_class=kind, fields={"infected": bool, "mood": float}
    )
    model.terms += terms
    ill = np.arange(len(scenario.places)) % 5 == 0
    model.add_pedestrians(
        scenario.places, preferred_speeds=scenario.speeds, fields={"infected": ill}
    )
    return model


def main() -> None:
    """Give the middle of some rounds for each; what is compiled on the way does not count."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, help="folder for the block")
    given = parser.parse_args()
    kinds: dict[str, tuple[type[Pedestrian], tuple[CostTerm, ...]]] = {
        "without plug-ins": (Pedestrian, ()),
        "with a compiled term over neighbours that takes a field": (Pedestrian, (Avoid(0.1),)),
        "with a Python `step()` that reads the speed and writes a field": (Counting, ()),
        "with a term in NumPy over options": (Pedestrian, (KeepLeft(0.1),)),
    }
    seconds: dict[str, list[float]] = {name: [] for name in kinds}
    for turn in range(1 + ROUNDS):
        for name, (kind, terms) in kinds.items():
            model = make(kind, *terms)
            model.run(max_seconds=WARM_UP)
            start = time.process_time()
            model.run(max_seconds=WARM_UP + SECONDS)
            if turn > 0:
                seconds[name].append((time.process_time() - start) / SECONDS)
    rows = [
        (name, f"{statistics.median(each):.3f} ({min(each):.3f} to {max(each):.3f})")
        for name, each in seconds.items()
    ]
    text = table(("model", "CPU s per simulated second, median and range"), rows)
    give(given.out, "plugins", f"{machine()}\n\n{text}")


if __name__ == "__main__":
    main()
