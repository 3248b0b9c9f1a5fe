"""Types of pedestrians: a mobility map, bodies and preferred speeds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Self

import numpy as np
from numpy.typing import NDArray

from mesa_mobility._numbers import is_number
from mesa_mobility.crowd.types.free_speeds import free_speeds
from mesa_mobility.distributions.base import EXTREMES, Distribution
from mesa_mobility.errors import ModelError
from mesa_mobility.human_limits import SLIMMEST_CORE
from mesa_mobility.mobility import MobilityMap
from mesa_mobility.mobility.map_data import CORE_RADIUS
from mesa_mobility.populations import Population

_LEAST, _GREATEST = EXTREMES

_SEATED = "wheelchair"
"""With this begin the types of maps of people in wheelchairs."""

_STEP_OVER_STEP = "able_bodied", "child", "older_adult"
"""Types of maps of people who put one foot on each tread."""


@dataclass(frozen=True, kw_only=True)
class PedestrianType:
    """Pedestrians who share one mobility map.

    Attributes:
        mobility_map: the type's clustered mobility map.
        name: by default the map's own.
        preferred_speed: distribution of preferred speeds, m/s, or one speed for everybody; by
            default that of the map (see ``free_speeds``).
        core_radius: radius of the body, a disc about the person's position that no other body
            enters, metres, or a distribution of radii; by default the map's.
        climbs: whether they use stairs; by default all do but those with a map of a wheelchair.
        up: the map by which they walk up stairs, as `mesa-mobility map build --stairs` makes them;
            by default that of able-bodied people for types of this gait: able-bodied people,
            children and older adults. Other types walk by ``mobility_map``, more slowly.
        down: the same, down.
    """

    mobility_map: MobilityMap
    name: str = ""
    preferred_speed: Distribution | float | None = None
    core_radius: Distribution | float = field(default=0.0)
    climbs: bool | None = None
    up: MobilityMap | None = None
    down: MobilityMap | None = None

    def __post_init__(self) -> None:
        if not self.name:
            object.__setattr__(self, "name", self.mobility_map.pedestrian_type)
        if not isinstance(self.core_radius, Distribution) and not is_number(self.core_radius):
            raise ModelError(
                f"type {self.name!r}: core_radius {self.core_radius!r:.60}, "
                f"expected {SLIMMEST_CORE} to 1 m"
            )
        if self.core_radius == 0.0:
            body = self.mobility_map.metadata.get("body", {})
            object.__setattr__(self, "core_radius", float(body.get("core_radius_m", CORE_RADIUS)))
        if not (self._bound(_LEAST) >= SLIMMEST_CORE and self._bound(_GREATEST) < 1.0):
            raise ModelError(
                f"type {self.name!r}: core_radius {self.core_radius}, "
                f"expected {SLIMMEST_CORE} to 1 m"
            )
        if self.climbs is None:
            seated = self.mobility_map.pedestrian_type.startswith(_SEATED)
            object.__setattr__(self, "climbs", not seated)
        elif not isinstance(self.climbs, bool):
            raise ModelError(f"type {self.name!r}: climbs {self.climbs!r:.60}, expected a bool")
        if self.preferred_speed is None:
            object.__setattr__(self, "preferred_speed", free_speeds(self.mobility_map))
        elif not isinstance(self.preferred_speed, Distribution):
            speed = self.preferred_speed
            if not (is_number(speed) and 0.0 < speed < np.inf):
                raise ModelError(
                    f"type {self.name!r}: preferred_speed {speed!r}, expected a distribution or "
                    "more than 0 m/s"
                )

    def __repr__(self) -> str:
        told = [repr(self.name), repr(self.mobility_map)]
        told += [f"{name}={getattr(self, name)!r}" for name in ("preferred_speed", "core_radius")]
        return f"<PedestrianType {', '.join(told)}>"

    @classmethod
    def named(cls, name: str) -> Self:
        """The type of a map that ships, such as ``"child"`` or ``"wheelchair_manual"``.

        Raises:
            MapError: no such map ships; the message lists those that do.
        """
        return cls(mobility_map=MobilityMap.named(name), name=name)

    @classmethod
    def all_of(cls, population: Population) -> tuple[PedestrianType, ...]:
        """The pedestrian types of a population, in the order of its shares.

        Raises:
            MapError: no map ships for one of them.
        """
        return tuple(
            cls.named(kind) if isinstance(kind, str) else kind for kind in population.shares
        )

    def on_stairs(self, tread: float, *, up: bool) -> MobilityMap:
        """The map by which they walk on stairs.

        Args:
            tread: depth of the treads, metres.
            up: whether they walk up, or down.

        Raises:
            MapError: a map of stairs with something else than the depth of a tread.
        """
        own = self.up if up else self.down
        if own is None and self.climbs and self.mobility_map.pedestrian_type in _STEP_OVER_STEP:
            own = MobilityMap.named(f"able_bodied_{'up' if up else 'down'}")
        return self.mobility_map if own is None else own.for_treads(tread)

    @property
    def least_core(self) -> float:
        """Least core radius, metres."""
        return self._bound(_LEAST)

    @property
    def half_width(self) -> float:
        """Greatest core radius, half the width of the widest body, metres."""
        return self._bound(_GREATEST)

    def _bound(self, share: float) -> float:
        if isinstance(self.core_radius, Distribution):
            return float(self.core_radius.quantile(np.array([share]))[0])
        return float(self.core_radius)

    def draw_cores(self, n: int, rng: np.random.Generator) -> NDArray[np.float64]:
        """(n,) core radii, metres; nothing is drawn from the generator if all have the same."""
        if isinstance(self.core_radius, Distribution):
            return self.core_radius.draw(n, rng)
        return np.full(n, float(self.core_radius))

    def draw_speeds(self, n: int, rng: np.random.Generator) -> NDArray[np.float64]:
        """(n,) preferred speeds, m/s."""
        if isinstance(self.preferred_speed, Distribution):
            return self.preferred_speed.draw(n, rng)
        assert self.preferred_speed is not None
        return np.full(n, float(self.preferred_speed))


def types_of(
    mobility_map: MobilityMap | str | Path | None,
    types: Sequence[PedestrianType] | None,
    population: Population | None,
) -> tuple[PedestrianType, ...]:
    """A model's types: those given, of a population, or a single one for a map, its file, or the
    map that ships.

    Raises:
        ModelError: two of them are given, or no types at all.
        MapError: an unusable map file, or a population's type of which no map ships.
    """
    given = {"mobility_map": mobility_map, "pedestrian_types": types, "population": population}
    names = [name for name, value in given.items() if value is not None]
    if len(names) > 1:
        raise ModelError(f"{' and '.join(names)}: got both, expected one of them")
    if population is not None:
        return PedestrianType.all_of(population)
    if types is None:
        if not isinstance(mobility_map, MobilityMap):
            mobility_map = MobilityMap.load(mobility_map)
        return (PedestrianType(mobility_map=mobility_map),)
    if not types:
        raise ModelError("pedestrian_types: got none, expected at least one")
    return tuple(types)


def indices_of(population: Population, types: Sequence[PedestrianType]) -> NDArray[np.int64]:
    """Index among a model's types of each type of a population.

    Raises:
        ModelError: the model does not have one of them.
    """
    names = [kind.name for kind in types]
    found = []
    for kind, name in zip(population.shares, population.names, strict=True):
        same = [
            k
            for k, other in enumerate(types)
            if other is kind or (isinstance(kind, str) and other.name == name)
        ]
        if not same:
            raise ModelError(
                f"population: the model has no type {name!r}, expected one of {', '.join(names)}"
            )
        found.append(same[0])
    return np.array(found, dtype=np.int64)
