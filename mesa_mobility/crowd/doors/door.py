"""What a door of a model does by itself: let people by at a rate, close at times, or when full."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from mesa_mobility._numbers import is_number
from mesa_mobility.crowd.journeys.waiting import LONGEST_WAIT
from mesa_mobility.errors import ModelError

HIGHEST_RATE = 1000.0
"""Most people a second by one door."""

MOST_PEOPLE = 10_000_000
"""Most people by one door."""

MOST_TIMES = 10_000
"""Most times at which one door closes."""

SAVED_UP = 2.0
"""Seconds for which a door saves up its rate while nobody passes: people take so long to start."""


@dataclass(frozen=True, kw_only=True)
class Door:
    """A gate or an exit that lets people by at a rate, closes at times, or closes when full.

    Attributes:
        name: of the gate or exit.
        rate: people a second who may pass in the long run, such as those of a turnstile. The others
            wait before it; routes lead through it all the same. While nobody passes it saves up one
            person and the rate of two seconds. Those who are in the door when it shuts still pass,
            at the cost of later ones.
        closed: (from, to) seconds for which it is closed; None for a last ``to`` that never comes.
            People look for another way meanwhile.
        capacity: people after whom it closes for good; each counts once, whichever way they go.
            Those who are in the door by then still pass it.

    Raises:
        ModelError: none of these, or one out of range.
    """

    name: str
    rate: float | None = None
    closed: Sequence[tuple[float, float | None]] = ()
    capacity: int | None = None

    def __post_init__(self) -> None:
        where = f"door {self.name!r:.60}"
        if self.rate is None and self.capacity is None and not len(self.closed):
            raise ModelError(
                f"{where}: expected a rate, times for which it is closed or a capacity"
            )
        if self.rate is not None and not (is_number(self.rate) and 0.0 < self.rate <= HIGHEST_RATE):
            raise ModelError(
                f"{where}: rate {self.rate!r:.60}, expected more than 0 and at most "
                f"{HIGHEST_RATE:g} people a second"
            )
        if self.capacity is not None and not (
            isinstance(self.capacity, int)
            and not isinstance(self.capacity, bool)
            and 1 <= self.capacity <= MOST_PEOPLE
        ):
            raise ModelError(
                f"{where}: capacity {self.capacity!r:.60}, expected 1 to {MOST_PEOPLE:,} people"
            )
        object.__setattr__(self, "closed", _times(self.closed, where))

    @property
    def most_saved(self) -> float:
        """People whom it lets by at once after a while in which nobody has passed."""
        return 1.0 + SAVED_UP * (self.rate or 0.0)

    def closed_at(self, time: float) -> bool:
        """Whether it is closed at so many seconds, if it has not closed for good."""
        return any(
            begin <= time + 1e-9 and (end is None or time + 1e-9 < end)
            for begin, end in self.closed
        )


def _times(
    given: Sequence[tuple[float, float | None]], where: str
) -> tuple[tuple[float, float | None], ...]:
    expected = (
        f"expected pairs of rising seconds, 0 to {LONGEST_WAIT:g}, such as [(60, 120), (300, None)]"
    )
    if isinstance(given, str) or not isinstance(given, Sequence) or len(given) > MOST_TIMES:
        raise ModelError(f"{where}: closed {given!r:.60}, {expected}")
    found: list[tuple[float, float | None]] = []
    last = 0.0
    for pair in given:
        fits = isinstance(pair, Sequence) and not isinstance(pair, str) and len(pair) == 2
        begin, end = pair if fits else (None, None)
        until = math.inf if end is None else end
        if not (is_number(begin) and is_number(until) and last <= begin < until):
            raise ModelError(f"{where}: closed {pair!r:.60}, {expected}")
        if begin > LONGEST_WAIT or (end is not None and end > LONGEST_WAIT):
            raise ModelError(f"{where}: closed {pair!r:.60}, {expected}")
        found.append((float(begin), None if end is None else float(end)))
        last = until
    return tuple(found)
