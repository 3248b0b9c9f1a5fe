"""The price of plug-ins: CPU a simulated second of 750 people in a room.

python benchmarks/plugins.py
"""

from __future__ import annotations

import time
from typing import Any

import numpy as np
from scenarios import room

from mesa_mobility import (
    Candidates,
    CompiledTerm,
    CostTerm,
    Exit,
    FloorPlan,
    Gate,
    Pedestrian,
    PedestrianModel,
    pair_kernel,
)

WARM_UP, SECONDS = 1.0, 10.0


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
def _avoid(
    x: float, y: float, ux: float, uy: float, duration: float, speed: float, sx: float, sy: float,
    tx: float, ty: float, nx: float, ny: float, nvx: float, nvy: float, nex: float, ney: float,
    lead: float, mine: float, theirs: float, p: tuple[float, ...],
) -> float:  # fmt: skip
    gap = 1.5 - ((nx - x) ** 2 + (ny - y) ** 2) ** 0.5
    return theirs * gap if gap > 0.0 else 0.0


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
    """Print a line for each."""
    for name, model in (
        ("nothing", make()),
        ("a compiled term with a field", make(Pedestrian, Avoid(0.1))),
        ("step() in Python", make(Counting)),
        ("a term in NumPy over options", make(Pedestrian, KeepLeft(0.1))),
    ):
        model.run(max_seconds=WARM_UP)
        start = time.process_time()
        model.run(max_seconds=WARM_UP + SECONDS)
        print(f"{name}: {(time.process_time() - start) / SECONDS:.4f} CPU s", flush=True)


if __name__ == "__main__":
    main()
