"""Sources and counters of a plan: where people come in, and where they are served on their way."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from shapely.geometry.base import BaseGeometry

from mesa_mobility._numbers import is_number
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.formats.people import MOST, People, Stop, count_of, total_of

SOURCE, COUNTER = KINDS = "source", "counter"

LONGEST = 1e6
"""Seconds over which people come in, or for which they are served."""


class Drawn(NamedTuple):
    """A source or a counter: its name, its area, its further properties, and where it is in a file,
    for messages."""

    name: str
    area: BaseGeometry
    given: Mapping[str, Any]
    at: str


def people_of(sources: Sequence[Drawn], counters: Sequence[Drawn]) -> list[People]:
    """The people of sources, who go to the counters in turn and then leave.

    A source has its ``number`` of people, and ``seconds`` over which they come one by one; at 0 s
    all are there from the start. A counter serves each for ``stay`` seconds, so many at once as its
    ``capacity``.

    Raises:
        FloorPlanError: a number that is none, or out of range.
    """
    stops = [_stop(each) for each in counters]
    found: list[People] = []
    total = 0
    for number, each in enumerate(sources, start=1):
        count = count_of(each.given.get("number", 0), f"{each.at}: number")
        before, total = total, total_of(total, count, each.at)
        seconds = _seconds(each, "seconds")
        times = np.linspace(0.0, seconds, count, endpoint=False).tolist() if seconds else []
        for k in range(max(len(stops), 1)):
            own = range(count)[(k - before) % max(len(stops), 1) :: max(len(stops), 1)]
            if own:
                way = (stops[k],) if stops else ()
                when = tuple(times[i] for i in own) if seconds else ()
                name = each.name or f"source {number}"
                found.append(People(name, each.area, len(own), when, stops=way))
    return found


def _stop(counter: Drawn) -> Stop:
    capacity = counter.given.get("capacity")
    if capacity is not None and (type(capacity) is not int or not 1 <= capacity <= MOST):
        raise FloorPlanError(
            f"{counter.at}: capacity: got {capacity!r:.40}, expected 1 to {MOST:,} people"
        )
    return Stop(counter.area, _seconds(counter, "stay"), capacity)


def _seconds(drawn: Drawn, name: str) -> float:
    value = drawn.given.get(name, 0.0)
    if not is_number(value) or not 0.0 <= value <= LONGEST:
        raise FloorPlanError(
            f"{drawn.at}: {name}: got {value!r:.40}, expected 0 to {LONGEST:,.0f} s"
        )
    return float(value)
