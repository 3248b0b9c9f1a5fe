"""Sources: people who come in over time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from shapely.geometry.base import BaseGeometry

from mesa_mobility.crowd.options import FRAME_SECONDS
from mesa_mobility.distributions import Distribution
from mesa_mobility.errors import ModelError

PLACES_TRIED = 16
"""Places looked at in a frame for whoever is next."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Source:
    """Where, when and who.

    Attributes:
        area: where they appear: a polygon or a line on the floor, shapely or WKT, metres.
        rate: people a second, at random (a Poisson process) from ``start`` on.
        times: (k,) seconds at which they come, instead of a rate.
        start: seconds before which a rate lets nobody come.
        until: seconds from which on nobody more comes, if ever.
        number: people at most.
        exits, route, loop, group, kind, preferred_speeds, pre_movement: as
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
    kind: int = 0
    preferred_speeds: float | Distribution | None = None
    pre_movement: float | Distribution = 0.0

    def __post_init__(self) -> None:
        if (self.rate is None) == (self.times is None):
            raise ModelError("source: expected either a rate or times")
        if self.rate is not None and not 0.0 < self.rate < np.inf:
            raise ModelError(f"source: rate {self.rate}, expected more than 0 people a second")
        if not (0.0 <= self.start < np.inf and self.until >= self.start):
            raise ModelError(
                f"source: start {self.start} and until {self.until}, expected 0 <= start <= until"
            )
        if self.number is not None and not (isinstance(self.number, int) and self.number >= 0):
            raise ModelError(f"source: number {self.number!r}, expected 0 or more people")
        if self.times is not None:
            try:
                times = np.sort(np.asarray(self.times, dtype=np.float64))
            except (TypeError, ValueError):
                raise ModelError("source: times, expected a row of seconds") from None
            if times.ndim != 1 or not ((times >= 0.0) & (times < np.inf)).all():
                raise ModelError("source: times, expected a row of seconds of 0 or more")
            object.__setattr__(self, "times", times)

    @property
    def endless(self) -> bool:
        """Whether people come for ever."""
        return self.rate is not None and self.until == np.inf and self.number is None

    def keywords(self) -> dict[str, Any]:
        """What ``add_pedestrians`` is told of each of them."""
        names = ("exits", "route", "loop", "group", "kind", "preferred_speeds", "pre_movement")
        return {name: getattr(self, name) for name in names}


class Inflow:
    """A source at work: who has come, who waits to come in, whether that is all.

    Args:
        source: the source.
        frame: now; nobody comes before.
        rng: the model's generator.

    Attributes:
        source: the source.
        arrived: people who have come, those held back included.
        entered: people of them who have come in.
    """

    def __init__(self, source: Source, frame: int, rng: np.random.Generator) -> None:
        self.source = source
        self.arrived = 0
        self.entered = 0
        self._rng = rng
        times = source.times
        self._times: NDArray[np.float64] | None = None if times is None else np.asarray(times)
        self._next = max(source.start, frame * FRAME_SECONDS)
        self._draw_next()

    @property
    def waiting(self) -> int:
        """People who have come and are held back for want of room."""
        return self.arrived - self.entered

    @property
    def finished(self) -> bool:
        """Whether everybody has come, and has come in."""
        return self.waiting == 0 and self._next == np.inf

    def count(self, frame: int) -> None:
        """Count those who have come by ``frame``."""
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
