"""Behaviours may give arrays of any making: compiled functions are given what they take."""

from dataclasses import replace

import numpy as np
import pytest
from mesa_mobility.behaviors import NearestExit

from mesa_mobility import PedestrianModel, SpeedRule, Targets
from mesa_mobility.errors import ModelError
from tests.behaviors.steering.test_corner_spreading import halls

PLACES = [(8.0 + 1.5 * (k % 5), 30.0 + 1.5 * (k // 5)) for k in range(20)]


class Strided(NearestExit):
    """The nearest exit, in arrays that are not contiguous or of other types."""

    def targets(self, deciding):
        found = super().targets(deciding)
        return Targets(
            found.points.copy(order="F"),
            np.repeat(found.gates, 2)[::2],
            np.repeat(found.distances, 2)[::2],
            found.corners.astype(np.int32).copy(order="F"),
        )


class Cut(NearestExit):
    """The nearest exit, with corners cut to another shape."""

    def __init__(self, cut) -> None:
        super().__init__()
        self._cut = cut

    def targets(self, deciding):
        found = super().targets(deciding)
        return replace(found, corners=found.corners[self._cut])


class Slower(SpeedRule):
    """Everybody a tenth slower."""

    name = "slower"

    def __init__(self, step: int) -> None:
        self._step = step

    def speeds(self, deciding, speeds):
        return np.repeat(0.9 * speeds, self._step)[:: self._step]


def places(choice, step: int):
    model = PedestrianModel(halls(), target_choice=choice, rng=1)
    model.speed_rules.append(Slower(step))
    model.add_pedestrians(PLACES)
    model.run(max_seconds=5.0)
    return np.column_stack([model.crowd.x[:20], model.crowd.y[:20]])


def test_arrays_of_any_making_do():
    # First the usual ones: compiled functions go by the types of their first call.
    expected = places(NearestExit(), 1)
    assert (places(Strided(), 3) == expected).all()


@pytest.mark.parametrize("cut", [np.s_[:, 0], np.s_[:1]])
def test_corners_of_another_shape_are_refused(cut):
    places(NearestExit(), 1)
    with pytest.raises(
        ModelError, match=r"'nearest_exit': gave corners of shape \(.*\), expected \(20, 2\)"
    ):
        places(Cut(cut), 1)
