"""Leaving by a familiar exit."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Annotated

import numpy as np
from mesa_mobility.behaviors.exits.exit_choice import Choosing
from mesa_mobility.behaviors.exits.random_utility import RandomUtility
from numpy.typing import NDArray

from mesa_mobility import FloorPlan, ListOf, Pedestrian, Range
from mesa_mobility.errors import ModelError
from mesa_mobility.schema import Array, Kind, Several, Text


class FamiliarExit(RandomUtility):
    """People leave by an exit that they know, unless another is much nearer.

    Place affiliation (Sime 1985, Environment and Behavior 17: 697-724): an exit that somebody
    knows, mostly the one by which they came, is worth ``affiliation`` metres of route. Apart from
    personal taste (see ``RandomUtility``), people take an unknown exit only if it is nearer by more
    than that. The value depends on the place and has to be calibrated; the default is 15 m.

    Args:
        familiar: names of the exits that people know by default; ``know`` sets others. Unknown
            names raise ModelError when people first choose.
        affiliation: what a known exit is worth, metres.
        scale: of people's tastes, metres.
        interval: mean seconds between two choices.

    Raises:
        ModelError: a parameter out of range.
    """

    name = "familiar_exit"

    def __init__(
        self,
        familiar: Annotated[Iterable[str], ListOf(str)] = (),
        affiliation: Annotated[float, Range(0.0, unit="m")] = 15.0,
        scale: float = 2.0,
        interval: float = 2.0,
    ) -> None:
        super().__init__(scale, interval)
        self.affiliation = affiliation
        self.familiar = familiar
        self._known = np.empty((0, 0), dtype=np.bool_)

    def members(self) -> Mapping[str, Kind]:
        """What the members of ``state`` are."""
        return {
            **super().members(),
            "familiar": Several(Text("exits")),
            "_known": Array("?", (None, "exit_numbers")),
        }

    def know(self, people: Iterable[Pedestrian], exits: Iterable[str]) -> None:
        """Set the exits that some people know; they choose again at their next decision.

        Raises:
            ModelError: a name that is not an exit's.
        """
        names = _names(exits)
        for person in people:
            plan = person.model.floor_plan
            self._make_known(person.row, plan)
            self._known[person.row] = self._mask(names, plan)
            self.forget(person.row)

    def bonus(self, choosing: Choosing) -> NDArray[np.float64]:
        """(k, e) metres: the affiliation where an exit is known."""
        self._make_known(int(choosing.pedestrians.max()), choosing.deciding.site.plan)
        return self.affiliation * self._known[choosing.pedestrians]

    def _make_known(self, row: int, plan: FloorPlan) -> None:
        """Have rows for everybody up to this one."""
        more = row + 1 - len(self._known)
        if more > 0:
            new = np.tile(self._mask(frozenset(self.familiar), plan), (more, 1))
            self._known = np.concatenate([self._known.reshape(-1, new.shape[1]), new])

    def _mask(self, names: frozenset[str], plan: FloorPlan) -> NDArray[np.bool_]:
        """(e,) which exits have one of these names."""
        there = [exit_.name for exit_ in plan.exits]
        for name in sorted(names.difference(there)):
            raise ModelError(
                f"{self.name}: exit {name!r} is unknown, expected one of {', '.join(there)}"
            )
        return np.array([name in names for name in there], dtype=np.bool_)


def _names(exits: Iterable[str]) -> frozenset[str]:
    if isinstance(exits, str):
        raise ModelError(f"exits: got {exits!r}, expected a list of names such as [{exits!r}]")
    return frozenset(exits)
