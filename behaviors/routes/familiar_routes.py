"""Leaving by the way by which one came."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Annotated, ClassVar

import numpy as np
from numpy.typing import NDArray

from mesa_mobility import Deciding, ListOf, Pedestrian, Range, RouteChoice
from mesa_mobility.errors import ModelError
from mesa_mobility.schema import Array, Kind, Several, Text, Whole


class FamiliarRoutes(RouteChoice):
    """Many people leave by the way by which they came; the others take the shortest way.

    In a fire people moved towards what they knew (Sime 1985, Environment and Behavior 17: 697-724).
    How many do so depends on the place, and ``share`` has to be calibrated. This behaviour does not
    change the exits by which people may leave. For people who leave by the exit that they know, set
    their ``exits``, or use ``FamiliarExit`` in place of this behaviour.

    Args:
        came: names of the gates by which people have come in, in order; ``know`` sets others.
        share: of those who know a way, how many leave by it.

    Raises:
        ModelError: a share out of range.
    """

    name = "familiar_routes"
    saved: ClassVar[Mapping[str, Kind]] = {
        "_again": Array("f8", high=1e9, infinite=True),
        "_known": Several(Whole(below="people"), dict, values=Several(Text("gates"), tuple)),
    }

    def __init__(
        self,
        came: Annotated[Sequence[str], ListOf(str)] = (),
        share: Annotated[float, Range(0.0, 1.0)] = 0.75,
    ) -> None:
        super().__init__()
        self.share = share
        self.came = came
        self._known: dict[int, tuple[str, ...]] = {}

    def know(self, people: Iterable[Pedestrian], came: Sequence[str]) -> None:
        """Set the gates by which some have come in, in order; they choose again at their next
        decision.

        Raises:
            ModelError: a single name.
            FloorPlanError: the name of an unknown gate.
        """
        names = _names(came)
        for person in people:
            for name in names:
                person.model.floor_plan.gate(name)
            self._known[person.row] = names
            if person.row < len(self._again):
                self._again[person.row] = 0.0

    def routes(self, deciding: Deciding, who: NDArray[np.int64]) -> list[Sequence[str]]:
        """The gates of the way back, or none."""
        draws = deciding.rng.random(len(who)).tolist()
        return [
            self._known.get(row, self.came)[::-1] if draw < self.share else ()
            for row, draw in zip(deciding.pedestrians[who].tolist(), draws, strict=True)
        ]


def _names(gates: Sequence[str]) -> tuple[str, ...]:
    if isinstance(gates, str):
        raise ModelError(f"gates: got {gates!r}, expected a list of names such as [{gates!r}]")
    return tuple(gates)
