"""Leaving by the way by which one came."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Annotated, ClassVar

import numpy as np
from numpy.typing import NDArray

from mesa_mobility import Deciding, ListOf, Pedestrian, Range, RouteChoice, World
from mesa_mobility.buildings import ON_STAIRS
from mesa_mobility.errors import FloorPlanError, ModelError
from mesa_mobility.schema import Array, Kind, Several, Text, Whole


class FamiliarRoutes(RouteChoice):
    """Many people leave by the way by which they came; the others take the shortest way.

    In a fire people moved towards what they knew (Sime 1985, Environment and Behavior 17: 697-724).
    How many do so depends on the place, and ``share`` has to be calibrated. This behaviour does not
    change the exits by which people may leave. For people who leave by the exit that they know, set
    their ``exits``, or use ``FamiliarExit`` instead of this behaviour.

    In a building, names of stairs, ramps, escalators and lifts stand for their gates. People leave
    by the part of the way between their level and that of the entrance (``Building.way_out``).
    Those who are elsewhere, or do not use what is on it, have no familiar way.

    Args:
        came: names of the gates, stairs, ramps, escalators and lifts by which people have come in,
            in order from the exit on; in a building the exit itself may come first. ``know`` sets
            others.
        share: of those who know a way, how many leave by it.

    Raises:
        ModelError: a share out of range.
    """

    name = "familiar_routes"
    saved: ClassVar[Mapping[str, Kind]] = {
        "_again": Array("f8", high=1e9, infinite=True),
        "_known": Several(Whole(below="people"), dict, values=Several(Text("ways"), tuple)),
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
        """Set the gates, stairs, ramps, escalators and lifts by which some have come in, in order;
        they choose again at their next decision.

        Raises:
            ModelError: a single name.
            FloorPlanError: an unknown name.
        """
        names = _names(came)
        for person in people:
            _check(names, person.model)
            self._known[person.row] = names
            if person.row < len(self._again):
                self._again[person.row] = 0.0

    def bind(self, model: World) -> None:
        """Keep the model; FloorPlanError if it lacks a gate or stairs by which people have come."""
        super().bind(model)
        _check(self.came, model)

    def routes(self, deciding: Deciding, who: NDArray[np.int64]) -> list[Sequence[str]]:
        """The gates of the way back, or none."""
        draws = deciding.rng.random(len(who)).tolist()
        rows = deciding.pedestrians[who].tolist()
        came = [tuple(self._known.get(row, self.came)) for row in rows]
        building = self._model.building
        if building is None:
            ways = [each[::-1] for each in came]
        else:
            levels = building.true_places(deciding.positions[who])[1].tolist()
            types = self._model.pedestrian_types
            climbs = [bool(types[k].climbs) for k in deciding.types[who].tolist()]
            keys = list(zip(came, levels, climbs, strict=True))
            found = {
                (way, level, climbing): building.way_out(way, level, climbs=climbing)
                for way, level, climbing in set(keys)
                if level != ON_STAIRS
            }
            ways = [found.get(key, ()) for key in keys]
        return [way if draw < self.share else () for way, draw in zip(ways, draws, strict=True)]


def _check(names: Sequence[str], model: World) -> None:
    """Raise FloorPlanError for a name that is neither a gate's nor, in a building, that of stairs,
    a ramp, an escalator or a lift, or for a way of which it is not known where it begins."""
    if model.building is not None:
        model.building.way_out(names, model.building.levels[0].number)
        return
    exits = {each.name for each in model.floor_plan.exits}
    for name in names:
        model.floor_plan.gate(name)
        if name in exits:
            raise FloorPlanError(f"way in: exit {name!r}, expected names of gates")


def _names(gates: Sequence[str]) -> tuple[str, ...]:
    if isinstance(gates, str):
        raise ModelError(f"gates: got {gates!r}, expected a list of names such as [{gates!r}]")
    return tuple(gates)
