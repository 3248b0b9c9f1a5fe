"""How fast to walk: behaviours that slow people down for reasons of their own."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.target_choice import Deciding
from mesa_mobility.errors import ModelError


class Pace(ABC):
    """A behaviour that says how fast those who decide would like to walk now.

    Subclasses set ``name`` and give ``speeds``.  A model has any number of them in
    ``model.paces``, and each is given what the one before says.
    """

    name: ClassVar[str]

    @abstractmethod
    def speeds(self, deciding: Deciding, speeds: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n,) preferred speeds for now, m/s, at least 0.

        Args:
            deciding: the pedestrians who decide.
            speeds: (n,) what they would be without this behaviour.
        """


def ask_paces(
    paces: Iterable[Pace], deciding: Deciding, speeds: NDArray[np.float64]
) -> NDArray[np.float64]:
    """The speeds that paces agree on, checked.

    Raises:
        ModelError: speeds that are negative or not finite, or an array of another shape.
    """
    for pace in paces:
        given = np.asarray(pace.speeds(deciding, speeds), dtype=np.float64, order="C")
        if given.shape != speeds.shape or not ((given >= 0.0) & (given < np.inf)).all():
            raise ModelError(
                f"behaviour {pace.name!r}: gave speeds of shape {given.shape}, expected "
                f"{len(speeds)} finite ones of 0 or more"
            )
        speeds = given
    return speeds
