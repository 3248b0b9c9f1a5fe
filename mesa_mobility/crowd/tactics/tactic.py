"""Tactics: the steps from a target to what somebody wants of its next movement."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.hooks import Plugin
from mesa_mobility.crowd.tactics.target_choice import Deciding
from mesa_mobility.floorplan import Targets


@dataclass
class Desired:
    """What n deciding pedestrians want, as the tactics before have left it.

    A tactic sets new arrays; those that it gets are not to be changed.

    Attributes:
        points: (n, 2) where each wants to go, metres; at first its target.
        speeds: (n,) how fast, m/s; at first its unhindered preferred speed.
        targets: what the target choice has given.
        newcomers: whether the pedestrians have only just been put on the floor, and get a target
            to face even if they are to wait.
    """

    points: NDArray[np.float64]
    speeds: NDArray[np.float64]
    targets: Targets
    newcomers: bool = False

    def stand(self, who: NDArray[Any], positions: NDArray[np.float64]) -> None:
        """Let some stand where they are with their next movement.

        Whoever stands for long gets impatient; ``Deciding.hold`` is for those who wait.

        Args:
            who: which: (n,) of them true, or (k,) indices.
            positions: (n, 2) where all of them are, metres.
        """
        self.points, self.speeds = self.points.copy(), self.speeds.copy()
        self.points[who], self.speeds[who] = positions[who], 0.0


class Tactic(Plugin):
    """A behaviour that changes what deciding pedestrians want: where to go, and how fast.

    Subclasses set ``name`` and define ``apply``. A model applies those in ``model.tactics`` in
    order.

    Attributes:
        after: name of the tactic behind which ``PedestrianModel.add_tactic`` puts this one; by
            default it goes to the end.
    """

    after: ClassVar[str | None] = None

    @abstractmethod
    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """Change points and speeds for the next movement.

        Args:
            deciding: the pedestrians who decide.
            desired: what they want so far.
        """
