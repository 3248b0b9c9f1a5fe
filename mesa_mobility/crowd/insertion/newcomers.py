"""Who newcomers are: what is given of them, checked and drawn."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesa_mobility.crowd.journeys.visit import Route, Visit
from mesa_mobility.crowd.journeys.waiting import frames_of
from mesa_mobility.crowd.state.fields import field_column
from mesa_mobility.crowd.state.records import Crowd
from mesa_mobility.crowd.tactics.speed_rules import FASTEST
from mesa_mobility.crowd.types.pedestrian_type import PedestrianType, indices_of
from mesa_mobility.distributions import Distribution
from mesa_mobility.errors import ModelError
from mesa_mobility.plugins.output import numbers_given, numbers_in
from mesa_mobility.populations import Population


@dataclass(frozen=True, kw_only=True, eq=False)
class Newcomers:
    """Newcomers, described as in ``PedestrianModel.add_pedestrians``.

    Those with ``velocities``, (n, 2) m/s, come in moving, and need ``headings``.

    Raises:
        ModelError: exits that are one text, a route that is one stop, a loop without a route, or a
            group without a name.
    """

    headings: ArrayLike | None = None
    preferred_speeds: ArrayLike | Distribution | None = None
    pre_movement: ArrayLike | Distribution = 0.0
    exits: Sequence[str] | None = None
    route: Route = ()
    loop: bool = False
    group: str | int | None = None
    type_index: ArrayLike | None = None
    population: Population | None = None
    fields: Mapping[str, ArrayLike] = field(default_factory=dict)
    velocities: ArrayLike | None = None

    def __post_init__(self) -> None:
        if isinstance(self.exits, str):
            raise ModelError(
                f"exits: got {self.exits!r}, expected a list of names such as [{self.exits!r}]"
            )
        if isinstance(self.route, str | Visit):
            raise ModelError(
                f"route: got {self.route!r}, expected a list of names of gates and visits"
            )
        if self.loop and not len(self.route):
            raise ModelError("loop: got no route, expected at least two gates or visits")
        if self.group is not None and not isinstance(self.group, str | int):
            raise ModelError(f"group: got {self.group!r}, expected a name or number")
        if self.type_index is not None and self.population is not None:
            raise ModelError("type_index and population: got both, expected one of them")

    def draw_types(
        self, n: int, types: Sequence[PedestrianType], rng: np.random.Generator
    ) -> NDArray[np.int64]:
        """(n,) index of each one's type.

        Raises:
            ModelError: there is no such type, or another number of them.
        """
        if self.population is not None:
            return indices_of(self.population, types)[self.population.draw(n, rng)]
        return check_types(self.type_index, n, types)

    def draw_speeds(
        self, kinds: NDArray[np.int64], types: Sequence[PedestrianType], rng: np.random.Generator
    ) -> NDArray[np.float64]:
        """(n,) preferred speeds of people of these types, m/s.

        Raises:
            ModelError: another number of them, or one out of range.
        """
        given, n = self.preferred_speeds, len(kinds)
        if given is None:
            given = np.empty(n)
            for kind in distinct(kinds):
                own = kinds == kind
                given[own] = draw_column(
                    "preferred_speeds", types[kind].draw_speeds(int(own.sum()), rng), own.sum(), rng
                )
        speeds = draw_column("preferred_speeds", given, n, rng)
        off = ~((speeds > 0.0) & (speeds <= FASTEST))
        if off.any():
            raise ModelError(
                f"preferred_speeds: got {speeds[off][0]}, expected more than 0 and at most "
                f"{FASTEST:g} m/s"
            )
        return speeds

    def draw_cores(
        self, kinds: NDArray[np.int64], types: Sequence[PedestrianType], rng: np.random.Generator
    ) -> NDArray[np.float64]:
        """(n,) core radii of people of these types, metres."""
        cores = np.empty(len(kinds))
        for kind in np.unique(kinds).tolist():
            own = kinds == kind
            cores[own] = types[kind].draw_cores(int(own.sum()), rng)
        return cores

    def field_columns(self, n: int, crowd: Crowd) -> dict[str, NDArray[Any]]:
        """(n,) values of the given fields.

        Raises:
            ModelError: a field that the model does not declare, or values that do not fit.
        """
        for name in self.fields:
            if name not in crowd.fields:
                known = ", ".join(crowd.fields) or "none"
                raise ModelError(f"field {name!r}: is not declared; the model has {known}")
        return {
            name: field_column(name, crowd.fields[name].dtype, values, n)
            for name, values in self.fields.items()
        }

    def draw_waits(self, n: int, rng: np.random.Generator) -> NDArray[np.int64]:
        """(n,) pre-movement times in frames.

        Raises:
            ModelError: another number of them, or one out of range.
        """
        return frames_of(draw_column("pre_movement", self.pre_movement, n, rng), "pre_movement")


def check_types(
    values: ArrayLike | None, n: int, types: Sequence[PedestrianType]
) -> NDArray[np.int64]:
    """(n,) indices of types; a single one stands for all, None for the first.

    Raises:
        ModelError: there is no such type, or another number of them.
    """
    try:
        given = np.zeros((), dtype=np.int64) if values is None else np.asarray(values)
        whole = np.issubdtype(given.dtype, np.integer) and given.shape in ((n,), ())
    except ValueError:  # rows of unequal length
        whole = False
    if not whole or ((given < 0) | (given >= len(types))).any():
        raise ModelError(
            f"type_index: got {values!r}, expected the index of a type, 0 to {len(types) - 1}, "
            "or one for each person"
        )
    return np.broadcast_to(given, (n,)).astype(np.int64)


def distinct(kinds: NDArray[np.int64]) -> list[int]:
    """The types that there are, each once, in rising order; the first one where nobody is."""
    found: list[int] = np.unique(kinds).tolist()
    return found or [0]


def check_column(name: str, values: ArrayLike, n: int) -> NDArray[np.float64]:
    """(n,) numbers; a single one stands for all.

    Raises:
        ModelError: another length, or not finite.
    """
    column = numbers_in(name, values, f"{n} finite numbers")
    if column.shape not in ((n,), ()) or not np.isfinite(column).all():
        got = f"got {values!r:.80}" if column.size == 1 else f"shape {column.shape}"
        raise ModelError(f"{name}: {got}, expected {n} finite numbers")
    return np.broadcast_to(column, (n,))


def draw_column(
    name: str, values: ArrayLike | Distribution, n: int, rng: np.random.Generator
) -> NDArray[np.float64]:
    """(n,) numbers, drawn if a distribution is given.

    Raises:
        ModelError: another length, or not finite.
    """
    if isinstance(values, Distribution):
        values = numbers_given(
            f"{name}: {type(values).__name__}", "draws", values.draw(n, rng), (n,)
        )
    return check_column(name, values, n)
