"""Exit choice as a logit model: the nearer the better, with other reasons and tastes added."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from typing import Annotated

import numpy as np
from mesa_mobility.behaviors.exits.exit_choice import Choosing, ExitChoice
from numpy.typing import NDArray

from mesa_mobility import Range
from mesa_mobility.errors import ModelError
from mesa_mobility.schema import Array, Kind


class RandomUtility(ExitChoice):
    """Everybody takes the exit of the greatest utility, in metres of way.

    The utility of an exit is minus the way to it, plus what ``bonus`` says, plus the person's taste
    for it. Tastes are Gumbel distributed, and drawn once for each person and exit: so nobody
    wavers, and the shares of the exits are those of a multinomial logit model with scale ``scale``.

    Args:
        scale: of the tastes, metres; with 0 everybody chooses alike.
        interval: mean seconds between two choices.

    Raises:
        ModelError: a parameter out of range.
    """

    def __init__(
        self, scale: Annotated[float, Range(0.0, unit="m")] = 2.0, interval: float = 2.0
    ) -> None:
        super().__init__(interval)
        self.scale = scale
        self._tastes: NDArray[np.float64] = np.empty((0, 0))

    def members(self) -> Mapping[str, Kind]:
        """What the members of ``state`` are."""
        return {
            **super().members(),
            "_tastes": Array("f8", (None, "exit_numbers"), -1e12, 1e12, missing=True),
        }

    @abstractmethod
    def bonus(self, choosing: Choosing) -> NDArray[np.float64]:
        """(k, e) metres that people would walk farther for the sake of each exit."""

    def choose(self, choosing: Choosing) -> NDArray[np.int64]:
        """(k,) number of the exit of the greatest utility."""
        bonus = np.asarray(self.bonus(choosing))
        if bonus.shape != choosing.distances.shape or not np.isfinite(bonus).all():
            raise ModelError(
                f"behaviour {self.name!r}: gave a bonus of shape {bonus.shape}, expected "
                f"{choosing.distances.shape} finite numbers"
            )
        utility = bonus - choosing.distances
        return (utility + self._tastes_of(choosing)).argmax(axis=1)

    def _tastes_of(self, choosing: Choosing) -> NDArray[np.float64]:
        """(k, e) tastes; those of people without any yet are drawn."""
        rows, exits = choosing.pedestrians, choosing.distances.shape[1]
        more = int(rows.max(initial=-1)) + 1 - len(self._tastes)
        if more > 0:
            rest = np.full((more, exits), np.nan)
            self._tastes = np.concatenate([self._tastes.reshape(-1, exits), rest])
        new = rows[np.isnan(self._tastes[rows, 0])]
        self._tastes[new] = self.scale * choosing.deciding.rng.gumbel(size=(len(new), exits))
        return self._tastes[rows]
