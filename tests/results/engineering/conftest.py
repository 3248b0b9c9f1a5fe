import pytest
from mesa_mobility.models import Doorway

from mesa_mobility.results import Trajectories


@pytest.fixture(scope="package")
def leaving():
    """Thirty people leave by a doorway: plan and tracks."""
    model = Doorway(pedestrians=30, record=True, rng=4)
    model.run(max_seconds=90)
    return model.floor_plan, Trajectories.of(model)
