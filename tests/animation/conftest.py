"""A short run of two people, of whom one leaves."""

import pytest

from mesa_mobility import Exit, FloorPlan, PedestrianModel
from mesa_mobility.results import Trajectories


@pytest.fixture(scope="package")
def plan() -> FloorPlan:
    return FloorPlan(
        "POLYGON ((0 0, 8 0, 8 4, 0 4, 0 0))", exits=[Exit("door", (8, 1.0), (8, 3.0))]
    )


@pytest.fixture(scope="package")
def run(plan) -> Trajectories:
    model = PedestrianModel(plan, record="decisions", rng=5)
    model.add_pedestrians([(1.0, 1.0), (6.5, 2.0)])
    model.run(max_seconds=3)
    return Trajectories.of(model)
