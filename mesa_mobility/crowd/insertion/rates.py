"""Rates of arrivals that vary in time."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility._numbers import is_number
from mesa_mobility.crowd.journeys.waiting import LONGEST_WAIT
from mesa_mobility.errors import ModelError
from mesa_mobility.plugins.output import numbers_in

HIGHEST_RATE = 1000.0
"""Most people a second from one source: the flow through some 800 m of doors."""

MOST_STEPS = 100_000
"""Most steps of a rate, and most seconds for which a function of time is looked up."""

Rate = float | Sequence[tuple[float, float]] | Callable[[float], float]
"""People a second; steps (seconds, people a second from then on); or a function of seconds."""


def read_rate(rate: Any, start: float, until: float) -> float | NDArray[np.float64]:
    """A rate as a number, or as (k, 2) steps: the seconds at which each begins, and its rate.

    Args:
        rate: as given.
        start: seconds from which on people come.
        until: seconds from which on nobody comes any more.

    Raises:
        ModelError: none of these, numbers out of range, steps whose times do not rise, or a
            function without an end.
    """
    if is_number(rate):
        if not 0.0 < rate <= HIGHEST_RATE:
            raise ModelError(
                f"source: rate {rate!r}, expected more than 0 and at most {HIGHEST_RATE:g} "
                "people a second"
            )
        return float(rate)
    steps = _looked_up(rate, start, until) if callable(rate) else _steps(rate)
    times, rates = steps.T
    if not ((rates >= 0.0) & (rates <= HIGHEST_RATE)).all() or not rates.any():
        off = rates[~((rates >= 0.0) & (rates <= HIGHEST_RATE))]
        got = f"{off[0]:g}" if len(off) else "0 at all times"
        raise ModelError(
            f"source: rate {got}, expected 0 to {HIGHEST_RATE:g} people a second, not always 0"
        )
    if not (times[0] >= 0.0 and times[-1] <= LONGEST_WAIT and (np.diff(times) > 0.0).all()):
        raise ModelError(
            f"source: times of rates, expected rising seconds from 0 to {LONGEST_WAIT:g}"
        )
    return steps


def _steps(rate: Any) -> NDArray[np.float64]:
    expected = "a number, steps [(seconds, people a second), ...] or a function of seconds"
    if isinstance(rate, str):
        raise ModelError(f"source: rate {rate!r:.60}, expected {expected}")
    steps = numbers_in("source: rate", rate, expected)
    if steps.ndim != 2 or steps.shape[1] != 2 or not 0 < len(steps) <= MOST_STEPS:
        raise ModelError(f"source: rate {rate!r:.60}, expected {expected}, at most {MOST_STEPS:,}")
    return np.array(steps, dtype=np.float64)


def _looked_up(rate: Callable[[float], float], start: float, until: float) -> NDArray[np.float64]:
    """Steps of one second, each with the value of a function at its middle."""
    first, last = math.floor(start), math.ceil(min(until, start + 2.0 * MOST_STEPS))
    if not 0 < last - first <= MOST_STEPS:
        raise ModelError(
            f"source: rate is a function from {start:g} to {until:g} s, expected an end, until, "
            f"within {MOST_STEPS:,} s"
        )
    values = [rate(second + 0.5) for second in range(first, last)]
    off = [each for each in values if not is_number(each)]
    if off:
        raise ModelError(f"source: rate gave {off[0]!r:.60}, expected people a second")
    rates = np.array(values, dtype=np.float64)
    # A step begins where the value is another one.
    begins = np.flatnonzero(np.append(True, np.diff(rates) != 0.0))
    return np.column_stack([first + begins, rates[begins]])


class Arriving:
    """When people come whose rate is a step function of time: a Poisson process.

    Args:
        rate: people a second, or (k, 2) steps.
    """

    def __init__(self, rate: float | NDArray[np.float64]) -> None:
        steps = np.array([[0.0, rate]]) if isinstance(rate, float) else rate
        self._times: list[float] = steps[:, 0].tolist()
        self._rates: list[float] = steps[:, 1].tolist()

    @property
    def ends(self) -> bool:
        """Whether nobody comes any more at the end."""
        return self._rates[-1] == 0.0

    def after(self, time: float, people: float) -> float:
        """Seconds at which the integral of the rate from ``time`` on is ``people``; may be inf."""
        count = len(self._times)
        step = max(int(np.searchsorted(self._times, time, side="right")) - 1, 0)
        time = max(time, self._times[0])
        while step < count:
            end, rate = self._times[step + 1] if step + 1 < count else math.inf, self._rates[step]
            if rate > 0.0:
                later = time + people * (1.0 / rate)
                if later <= end:
                    return later
                people = max(people - rate * (end - time), 0.0)
            time, step = end, step + 1
        return math.inf
