"""People of a scenario: where they start, when, how fast they walk, and where they go."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from shapely.geometry.base import BaseGeometry

from mesa_mobility.distributions import Distribution
from mesa_mobility.errors import FloorPlanError, ModelError

MOST = 20_000
"""People of a scenario."""


@dataclass(frozen=True)
class Stop:
    """An area that people visit, for how long they stay, in seconds, and how many may stay there at
    once; None for any number."""

    area: BaseGeometry
    stay: float = 0.0
    capacity: int | None = None


@dataclass(frozen=True)
class People:
    """People who start alike.

    Attributes:
        name: for messages.
        area: where they start, metres.
        number: how many.
        times: seconds at which each comes, in order; none where all are there from the start.
        speed: speed at which they like to walk, m/s; None for that of their type.
        pre_movement: seconds for which they wait before they set off; None for 0.
        stops: areas that they visit, in this order.
        exits: names of areas by which they leave; exits are called so, or so with a side. None for
            all exits.
        spots: places at which they start, instead of ``area``.
    """

    name: str
    area: BaseGeometry
    number: int
    times: tuple[float, ...] = ()
    speed: Distribution | None = None
    pre_movement: Distribution | None = None
    stops: tuple[Stop, ...] = ()
    exits: tuple[str, ...] | None = None
    spots: tuple[tuple[float, float], ...] = ()


def checked(kind: type[Distribution], at: str, *numbers: float) -> Distribution:
    """A distribution.

    Args:
        kind: its class.
        at: what error messages call it.
        numbers: its numbers.

    Raises:
        FloorPlanError: numbers that it does not take.
    """
    try:
        return kind(*numbers)
    except (ModelError, ValueError) as error:
        raise FloorPlanError(f"{at}: {error}") from None


def count_of(value: Any, at: str) -> int:
    """A number of people; FloorPlanError if it is none."""
    whole = isinstance(value, int | float) and not isinstance(value, bool) and value == value
    if not whole or not 0 <= value <= MOST or value != int(value):
        raise FloorPlanError(f"{at}: got {value!r:.40}, expected 0 to {MOST:,} people")
    return int(value)


def total_of(before: int, more: int, at: str) -> int:
    """The sum of two numbers of people; FloorPlanError if a scenario may not have so many."""
    if before + more > MOST:
        raise FloorPlanError(f"{at}: more than {MOST:,} people in all, expected at most that")
    return before + more


def left_out(counts: Mapping[str, int]) -> list[str]:
    """A note on what of a scenario is not read; none where all is."""
    said = [f"{count} {kind}" for kind, count in counts.items() if count]
    return [f"left out {', '.join(said)}"] if said else []
