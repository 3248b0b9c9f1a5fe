"""Sources: people who come in over time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from numbers import Real
from typing import Any, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray
from shapely.geometry.base import BaseGeometry

from mesa_mobility.crowd.hooks import Saved
from mesa_mobility.crowd.insertion.newcomers import Newcomers, check_types
from mesa_mobility.crowd.options.table import FRAME_SECONDS
from mesa_mobility.crowd.people.pedestrian_type import PedestrianType, indices_of
from mesa_mobility.crowd.scene import Scene
from mesa_mobility.crowd.state.environment import passing_of
from mesa_mobility.crowd.tactics.speed_rules import FASTEST
from mesa_mobility.crowd.tactics.waiting import LONGEST_WAIT
from mesa_mobility.distributions import Distribution
from mesa_mobility.errors import ModelError
from mesa_mobility.floorplan.entrance import Entrance, read_entrance
from mesa_mobility.populations import Population

HIGHEST_RATE = 1000.0
"""Most people a second from one source: the flow through some 800 m of doors."""

LATEST = LONGEST_WAIT
"""Latest time in seconds of an arrival, ``start`` or ``until``."""

MOST_PEOPLE = 10_000_000
"""Most people from one source."""

PLACES_TRIED = 16
"""Places tried in a frame for the next person."""

DECK = 100
"""People of a population who are drawn together."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Source:
    """A place where people come in over time.

    Attributes:
        area: where they appear: a polygon or a line on the floor, shapely or WKT, metres.
        rate: people a second, as a Poisson process from ``start`` on.
        times: (k,) seconds at which they come, instead of a rate.
        start: seconds at which a rate begins.
        until: seconds at which it ends, if ever.
        number: most people.

    The other attributes are as ``PedestrianModel.add_pedestrians`` takes them: numbers or
    distributions, no arrays. Of a population each hundred people together have its shares.

    Raises:
        ModelError: neither a rate nor times, both, or one out of range; shares of a population that
            do not add up to 1.
    """

    area: BaseGeometry | str
    rate: float | None = None
    times: ArrayLike | None = None
    start: float = 0.0
    until: float = np.inf
    number: int | None = None
    exits: Sequence[str] | None = None
    route: Sequence[str] = ()
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
        if self.rate is not None and not (_real(self.rate) and 0.0 < self.rate <= HIGHEST_RATE):
            raise ModelError(
                f"source: rate {self.rate!r}, expected more than 0 and at most {HIGHEST_RATE:g} "
                "people a second"
            )
        if not (
            _real(self.start) and _real(self.until) and 0.0 <= self.start <= LATEST
            and self.start <= self.until
        ):  # fmt: skip
            raise ModelError(
                f"source: start {self.start!r} and until {self.until!r}, expected "
                f"0 <= start <= until and a start of at most {LATEST:g} s"
            )
        if self.number is not None and not (
            isinstance(self.number, int) and 0 <= self.number <= MOST_PEOPLE
        ):
            raise ModelError(f"source: number {self.number!r}, expected 0 to {MOST_PEOPLE} people")
        if self.times is not None:
            try:
                times = np.sort(np.asarray(self.times, dtype=np.float64))
            except (TypeError, ValueError):
                raise ModelError("source: times, expected a row of seconds") from None
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
            _real(speed) and 0.0 < speed <= FASTEST
        ):
            raise ModelError(
                f"source: preferred_speeds {speed!r}, expected a distribution, or more than 0 and "
                f"at most {FASTEST:g} m/s"
            )
        if not isinstance(wait, Distribution) and not (_real(wait) and 0.0 <= wait <= LONGEST_WAIT):
            raise ModelError(
                f"source: pre_movement {wait!r}, expected a distribution, or 0 to "
                f"{LONGEST_WAIT:g} s"
            )

    @property
    def endless(self) -> bool:
        """Whether people come for ever."""
        return self.rate is not None and self.until > LATEST and self.number is None

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


def _real(value: object) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool)


class Inflow(Saved):
    """A source in a model, with its counts.

    Args:
        source: the source.
        newcomers: people of each type, by its index.
        entrances: where they come in, likewise.
        population: whose shares they have, or None for those of ``source.type_index``.
        frame: the current frame, before which nobody comes.
        rng: the model's generator.

    Attributes:
        source: the source.
        arrived: people who have come, those held back included.
        entered: those of them who have entered.
    """

    saved = ("arrived", "entered", "_next", "_deck")

    def __init__(
        self,
        source: Source,
        newcomers: Mapping[int, Newcomers],
        entrances: Mapping[int, Entrance],
        population: Population | None,
        frame: int,
        rng: np.random.Generator,
    ) -> None:
        self.source = source
        self.arrived = 0
        self.entered = 0
        self._entrances = entrances
        self._newcomers = newcomers
        self._kinds = list(entrances)
        self._population = population
        self._deck: list[int] = []
        self._rng = rng
        times = source.times
        self._times: NDArray[np.float64] | None = None if times is None else np.asarray(times)
        self._next = max(source.start, frame * FRAME_SECONDS)
        self._draw_next()

    @property
    def next_type(self) -> int:
        """Index of the type of the next person to enter."""
        if not self._deck:
            self._deck = [self._kinds[0]]
            if self._population is not None:
                drawn = self._population.draw(DECK, self._rng)
                self._deck = [self._kinds[k] for k in drawn.tolist()]
        return self._deck[-1]

    @property
    def entrance(self) -> Entrance:
        """Where the next person comes in."""
        return self._entrances[self.next_type]

    @property
    def newcomers(self) -> Newcomers:
        """The next person."""
        return self._newcomers[self.next_type]

    def let_in(self) -> None:
        """The next person has entered."""
        self._deck.pop()
        self.entered += 1

    @property
    def waiting(self) -> int:
        """Number of arrivals that wait for a free place."""
        return self.arrived - self.entered

    @property
    def finished(self) -> bool:
        """Whether everybody has come and entered."""
        return self.waiting == 0 and self._next == np.inf

    def count(self, frame: int) -> None:
        """Count the arrivals until ``frame``."""
        now = frame * FRAME_SECONDS + 1e-9
        while self._next <= now:
            self.arrived += 1
            self._draw_next()

    def _draw_next(self) -> None:
        source = self.source
        if self._times is None:
            assert source.rate is not None
            self._next += self._rng.exponential(1.0 / source.rate)
        else:
            self._next = self._times[self.arrived] if self.arrived < len(self._times) else np.inf
        full = source.number is not None and self.arrived >= source.number
        if full or self._next >= source.until:
            self._next = np.inf


class Sources(Sequence[Inflow], Saved):
    """A model's sources: an ``Inflow`` for each, in the order in which they were added.

    Args:
        scene: the floor and what people can do on it.
    """

    def __init__(self, scene: Scene) -> None:
        self._scene = scene
        self._inflows: list[Inflow] = []

    @overload
    def __getitem__(self, index: int) -> Inflow: ...

    @overload
    def __getitem__(self, index: slice) -> list[Inflow]: ...

    def __getitem__(self, index: int | slice) -> Inflow | list[Inflow]:
        return self._inflows[index]

    def __len__(self) -> int:
        return len(self._inflows)

    def state(self) -> dict[str, Any]:
        """The sources, and who has come by each."""
        return {"inflows": [(each.source, each.state()) for each in self._inflows]}

    def restore(self, state: Mapping[str, Any]) -> None:
        """Take over what ``state`` has given."""
        del self._inflows[len(state["inflows"]) :]
        for number, (source, inflow) in enumerate(state["inflows"]):
            if number == len(self._inflows):
                self.add(source, 0, np.random.default_rng(0))
            self._inflows[number].restore(inflow)

    @property
    def expecting(self) -> bool:
        """Whether a source has more people to come."""
        return not all(inflow.finished for inflow in self._inflows)

    @property
    def endless(self) -> bool:
        """Whether people come for ever."""
        return any(inflow.source.endless for inflow in self._inflows)

    def add(self, source: Source, frame: int, rng: np.random.Generator) -> Inflow:
        """Let people in from ``frame`` on; ``PedestrianModel.add_source`` says what is refused."""
        scene, area = self._scene, read_entrance(source.area)
        if source.type_index is not None and source.population is not None:
            raise ModelError("source: type_index and population, expected one of them")
        population = None if source.population is None else Population.of(source.population)
        if source.type_index is None and population is None:
            population = scene.shares
        kinds = check_types(source.type_index, 1, scene.types)
        if population is not None:
            kinds = indices_of(population, scene.types)
        newcomers = {kind: source.newcomers(kind) for kind in kinds.tolist()}
        entrances: dict[int, Entrance] = {}
        for kind in newcomers:
            core = scene.types[kind].core_radius
            entrances[kind] = Entrance(
                scene.plan, area, clearance=core + 0.01, passing=passing_of(core)
            )
            destination, _ = scene.journeys.start(source.exits, source.route, source.loop, kind)
            somewhere = entrances[kind].room.representative_point()
            scene.environment.check_way_out(np.array([[somewhere.x, somewhere.y]]), destination)
        inflow = Inflow(source, newcomers, entrances, population, frame, rng)
        self._inflows.append(inflow)
        return inflow
