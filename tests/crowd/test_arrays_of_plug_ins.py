"""Behaviours may give arrays of any making: compiled functions are given what they take."""

import numpy as np
from mesa_mobility.behaviors import NearestExit

from mesa_mobility import Pace, PedestrianModel, Targets
from tests.crowd.test_abreast import halls

PLACES = [(8.0 + 1.5 * (k % 5), 30.0 + 1.5 * (k // 5)) for k in range(20)]


class Strided(NearestExit):
    """The nearest exit, told in arrays that are not contiguous or of other numbers."""

    def targets(self, deciding):
        found = super().targets(deciding)
        return Targets(
            found.points.copy(order="F"),
            np.repeat(found.gates, 2)[::2],
            np.repeat(found.distances, 2)[::2],
            found.corners.astype(np.int32).copy(order="F"),
        )


class Slower(Pace):
    """Everybody a tenth slower."""

    name = "slower"

    def __init__(self, step: int) -> None:
        self._step = step

    def speeds(self, deciding, speeds):
        return np.repeat(0.9 * speeds, self._step)[:: self._step]


def places(choice, step: int):
    model = PedestrianModel(halls(), target_choice=choice, rng=1)
    model.paces.append(Slower(step))
    model.add_pedestrians(PLACES)
    model.run(max_seconds=5.0)
    return np.column_stack([model.crowd.x[:20], model.crowd.y[:20]])


def test_arrays_of_any_making_do():
    # First the usual ones: compiled functions go by the types of their first call.
    expected = places(NearestExit(), 1)
    assert (places(Strided(), 3) == expected).all()
