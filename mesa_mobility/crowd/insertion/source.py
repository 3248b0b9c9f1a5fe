"""Sources: places where people come in over time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray
from shapely.geometry.base import BaseGeometry

from mesa_mobility._numbers import is_number
from mesa_mobility.crowd.insertion.newcomers import Newcomers
from mesa_mobility.crowd.insertion.rates import Arriving, Rate, read_rate
from mesa_mobility.crowd.journeys.visit import Route
from mesa_mobility.crowd.journeys.waiting import LONGEST_WAIT
from mesa_mobility.crowd.tactics.speed_rules import FASTEST
from mesa_mobility.crowd.types.pedestrian_type import PedestrianType
from mesa_mobility.distributions import Distribution
from mesa_mobility.errors import ModelError
from mesa_mobility.plugins.output import numbers_in
from mesa_mobility.populations import Population

LATEST = LONGEST_WAIT
"""Latest time in seconds of an arrival, ``start`` or ``until``."""

MOST_PEOPLE = 10_000_000
"""Most people from one source."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Source:
    """A place where people come in over time.

    Attributes:
        area: where they appear: a polygon or a line on the floor, shapely or WKT, metres.
        rate: people a second, as a Poisson process from ``start`` on: a number; steps such as
            ``[(0, 0.5), (600, 2)]``, each from its second on, before the first of which nobody
            comes; or a function of seconds, which is looked up once for the middle of each second
            and needs ``until``. It ends only with ``until``, ``number`` or a last step of 0.
        times: (k,) seconds at which they come, instead of a rate.
        start: seconds at which a rate begins.
        until: seconds from which on nobody comes any more.
        number: most people.

    The other attributes are as ``PedestrianModel.add_pedestrians`` takes them: numbers or
    distributions, no arrays. Types are drawn for a hundred people at a time, so that each hundred
    have the shares of the population.

    Raises:
        ModelError: neither a rate nor times, both, or one out of range; shares of a population that
            do not add up to 1.
    """

    area: BaseGeometry | str
    rate: Rate | NDArray[np.float64] | None = None
    times: ArrayLike | None = None
    start: float = 0.0
    until: float = np.inf
    number: int | None = None
    exits: Sequence[str] | None = None
    route: Route = ()
    loop: bool = False
    group: str | int | None = None
    type_index: int | None = None
    population: Population | Mapping[str | PedestrianType, float] | str | None = None
    preferred_speeds: float | Distribution | None = None
    pre_movement: float | Distribution = 0.0
    fields: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if (self.rate is None) == (self.times is None):
            raise ModelError("source: expected either a rate or times")
        if not (
            is_number(self.start)
            and is_number(self.until)
            and 0.0 <= self.start <= LATEST
            and self.start <= self.until
        ):
            raise ModelError(
                f"source: start {self.start!r} and until {self.until!r}, expected "
                f"0 <= start <= until and a start of at most {LATEST:g} s"
            )
        if self.rate is not None:
            object.__setattr__(self, "rate", read_rate(self.rate, self.start, self.until))
        if self.number is not None and not (
            is_number(self.number)
            and isinstance(self.number, int)
            and 0 <= self.number <= MOST_PEOPLE
        ):
            raise ModelError(f"source: number {self.number!r}, expected 0 to {MOST_PEOPLE} people")
        if self.times is not None:
            times = np.sort(numbers_in("source: times", self.times, "a row of seconds"))
            if times.ndim != 1 or not ((times >= 0.0) & (times <= LATEST)).all():
                raise ModelError(f"source: times, expected a row of seconds, 0 to {LATEST:g}")
            object.__setattr__(self, "times", times)
        if self.population is not None:
            object.__setattr__(self, "population", Population.of(self.population))
        self._check_people()

    def _check_people(self) -> None:
        """Refuse at once what ``add_pedestrians`` would refuse at the first arrival."""
        speed, wait = self.preferred_speeds, self.pre_movement
        if not (speed is None or isinstance(speed, Distribution)) and not (
            is_number(speed) and 0.0 < speed <= FASTEST
        ):
            raise ModelError(
                f"source: preferred_speeds {speed!r}, expected a distribution, or more than 0 and "
                f"at most {FASTEST:g} m/s"
            )
        if not isinstance(wait, Distribution) and not (
            is_number(wait) and 0.0 <= wait <= LONGEST_WAIT
        ):
            raise ModelError(
                f"source: pre_movement {wait!r}, expected a distribution, or 0 to "
                f"{LONGEST_WAIT:g} s"
            )

    @property
    def endless(self) -> bool:
        """Whether people come for ever, or go round for ever."""
        rate = self.arriving
        unlimited = rate is not None and not rate.ends
        return self.loop or (unlimited and self.until > LATEST and self.number is None)

    @property
    def arriving(self) -> Arriving | None:
        """When people come by the rate, if there is one."""
        return None if self.rate is None else Arriving(self.rate)  # type: ignore[arg-type]

    def newcomers(self, type_index: int | None) -> Newcomers:
        """The newcomers of one type."""
        return Newcomers(
            preferred_speeds=self.preferred_speeds,
            pre_movement=self.pre_movement,
            exits=self.exits,
            route=self.route,
            loop=self.loop,
            group=self.group,
            type_index=type_index,
            fields=self.fields,
        )
