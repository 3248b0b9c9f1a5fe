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
from mesa_mobility.crowd.insertion import Newcomers
from mesa_mobility.crowd.options.table import FRAME_SECONDS
from mesa_mobility.crowd.scene import Scene
from mesa_mobility.crowd.state.environment import passing_of
from mesa_mobility.crowd.tactics.speed_rules import FASTEST
from mesa_mobility.crowd.tactics.waiting import LONGEST_WAIT
from mesa_mobility.distributions import Distribution
from mesa_mobility.errors import ModelError
from mesa_mobility.floorplan.entrance import Entrance, read_entrance

HIGHEST_RATE = 1000.0
"""Most people a second from one source: the flow through some 800 m of doors."""

LATEST = LONGEST_WAIT
"""Latest time in seconds of an arrival, ``start`` or ``until``."""

MOST_PEOPLE = 10_000_000
"""Most people from one source."""

PLACES_TRIED = 16
"""Places tried in a frame for the next person."""


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
        exits, route, loop, group, type_index, preferred_speeds, pre_movement, fields: as
            ``PedestrianModel.add_pedestrians`` takes them; numbers or distributions, no arrays.

    Raises:
        ModelError: neither a rate nor times, both, or one out of range.
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
    type_index: int = 0
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

    def newcomers(self) -> Newcomers:
        """The newcomers."""
        return Newcomers(
            preferred_speeds=self.preferred_speeds,
            pre_movement=self.pre_movement,
            exits=self.exits,
            route=self.route,
            loop=self.loop,
            group=self.group,
            type_index=self.type_index,
            fields=self.fields,
        )


def _real(value: object) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool)


class Inflow(Saved):
    """A source in a model, with its counts.

    Args:
        source: the source.
        entrance: where they come in.
        frame: the current frame, before which nobody comes.
        rng: the model's generator.

    Attributes:
        source: the source.
        entrance: where they come in.
        newcomers: who comes.
        arrived: people who have come, those held back included.
        entered: those of them who have entered.
    """

    saved = ("arrived", "entered", "_next")

    def __init__(
        self, source: Source, entrance: Entrance, frame: int, rng: np.random.Generator
    ) -> None:
        self.source = source
        self.entrance = entrance
        self.newcomers = source.newcomers()
        self.arrived = 0
        self.entered = 0
        self._rng = rng
        times = source.times
        self._times: NDArray[np.float64] | None = None if times is None else np.asarray(times)
        self._next = max(source.start, frame * FRAME_SECONDS)
        self._draw_next()

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
        scene = self._scene
        core = scene.type_at(source.type_index).core_radius
        entrance = Entrance(
            scene.plan,
            read_entrance(source.area),
            clearance=core + 0.01,
            passing=passing_of(core),
        )
        inflow = Inflow(source, entrance, frame, rng)
        destination, _ = scene.journeys.start(
            source.exits, source.route, source.loop, source.type_index
        )
        somewhere = entrance.room.representative_point()
        scene.environment.check_way_out(np.array([[somewhere.x, somewhere.y]]), destination)
        self._inflows.append(inflow)
        return inflow
