"""Lining up before counters."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, ClassVar

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray

from mesa_mobility import (
    Deciding,
    Desired,
    ListOf,
    Range,
    Tactic,
    Visit,
    World,
    check_fields,
)
from mesa_mobility.distributions import Distribution
from mesa_mobility.errors import ModelError
from mesa_mobility.floorplan import lines_of_sight
from mesa_mobility.schema import Kind, Several, Whole

# Radius of the place where people are served, metres, and the least distance in the line: only
# one person is there at a time.
_SERVED, _CLOSEST = 0.25, 0.5

# Core radius of those whose spacing a counter gives, metres.
_CORE = 0.14

# Seconds in which somebody gets to their place, and their least speed on the last steps, m/s.
_GETS_THERE, _LEAST = 1.0, 0.4

# Metres from the end of the line at which somebody joins it; from their place in the line at which
# they stand; and from which they move up again.
_JOINS, _STANDS, _MOVES_UP = 1.0, 0.15, 0.3

# Greatest speed of somebody who stands, m/s.
_SETTLED = 0.05


@dataclass(frozen=True)
class Counter:
    """A counter, and the line that people form before it.

    ``visit`` stands in a route, like any place to visit.

    Attributes:
        line: (x, y) points in metres, from where people are served to the end of the line, beyond
            which it goes on straight.
        service: seconds that it takes to serve somebody, or a distribution of them.
        spacing: metres between two people in the line with cores of 0.14 m. Others keep as much
            free between their cores.

    Raises:
        ModelError: fewer than two points, one of them twice in a row, or numbers out of range.
    """

    line: Sequence[tuple[float, float]]
    service: float | Distribution
    spacing: Annotated[float, Range(_CLOSEST, unit="m")] = 0.6

    def __post_init__(self) -> None:
        try:
            points = np.asarray(self.line)
        except ValueError:  # rows of unequal length
            points = np.empty(0)
        shape = points.shape if points.dtype.kind in "iuf" else ()
        if len(shape) != 2 or shape[1] != 2 or shape[0] < 2:
            raise ModelError(f"counter: line {self.line!r:.80}, expected two points (x, y) or more")
        if not np.isfinite(points).all() or not np.diff(points, axis=0).any(axis=1).all():
            raise ModelError(f"counter: line {self.line!r:.80}, expected finite, different points")
        check_fields(self, "counter")
        object.__setattr__(self, "line", tuple(map(tuple, points.astype(np.float64).tolist())))
        Visit(self.line[0], stay=self.service)  # refuses what is no time

    @cached_property
    def visit(self) -> Visit:
        """The place where people are served, for a route."""
        return Visit(shapely.Point(self.line[0]).buffer(_SERVED), stay=self.service)

    def places(self, count: int) -> NDArray[np.float64]:
        """(count, 2) places in the line, metres, of people with cores of 0.14 m; the first is where
        people are served."""
        return self._at(np.arange(count, dtype=np.float64) * self.spacing)

    def places_of(self, cores: ArrayLike) -> NDArray[np.float64]:
        """(n, 2) places in the line, metres, of people with (n,) core radii, the first one first.

        Two of them have as much free between their cores as two with cores of 0.14 m.
        """
        radii = np.asarray(cores, dtype=np.float64)
        apart = radii[1:] + radii[:-1] + (self.spacing - 2.0 * _CORE)
        return self._at(np.cumsum([0.0, *apart])[: len(radii)])

    def _at(self, along: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n, 2) points of the line that are ``along`` metres from its beginning."""
        points = np.array(self.line)
        steps = np.diff(points, axis=0)
        lengths = np.hypot(*steps.T)
        ends = np.cumsum(lengths)
        on = np.minimum(np.searchsorted(ends, along, side="left"), len(steps) - 1)
        beyond = along - (ends[on] - lengths[on])
        found: NDArray[np.float64] = points[on] + steps[on] * (beyond / lengths[on])[:, None]
        return found


class Queueing(Tactic):
    """People who are to be served line up before their counter, in the order in which they come.

    They join the line within a metre of its end, face along it while they stand, and move up as
    those before them do. The first in line steps up to the counter, is served, and goes on with
    their route.
    Those who stand in the line count as waiting.

    Args:
        counters: the counters; ``counters`` may be added to while the model runs.
    """

    name = "queueing"
    after = "speed_rules"
    saved: ClassVar[Mapping[str, Kind]] = {  # counters are given again
        "_lines": Several(Several(Whole(below="people"))),
        "_standing": Several(Whole(below="people"), set),
    }

    _model: World

    def __init__(self, counters: Annotated[Iterable[Counter], ListOf(Counter)] = ()) -> None:
        self.counters: list[Counter] = counters  # type: ignore[assignment]
        self._lines: list[list[int]] = []
        self._standing: set[int] = set()

    def bind(self, model: World) -> None:
        """Keep the model, whose people line up."""
        self._model = model

    def line(self, counter: Counter) -> list[int]:
        """Rows of those who are served or stand in line before a counter, the first one first."""
        number = self.counters.index(counter)
        return list(self._lines[number]) if number < len(self._lines) else []

    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """Send those who are to be served to the end of the line, or to their place in it."""
        if desired.newcomers:
            return
        self._lines += [[] for _ in self.counters[len(self._lines) :]]
        crowd, rows = self._model.crowd, deciding.pedestrians
        desired.points, desired.speeds = desired.points.copy(), desired.speeds.copy()
        bound = [self._counter_of(row) for row in rows.tolist()]
        for number, counter in enumerate(self.counters):
            self._lines[number] = [
                row
                for row in self._lines[number]
                if crowd.active[row] and self._counter_of(row) == number
            ]
            who = np.flatnonzero([each == number for each in bound])
            # Two may come to an empty counter at once, and the second one step up to it first.
            self._lines[number].sort(key=lambda row: not self._is_served(row))
            if len(who):
                self._let_by(counter, self._lines[number])
                self._line_up(counter, self._lines[number], who, deciding, desired)
        self._standing.intersection_update(row for line in self._lines for row in line)

    def _counter_of(self, row: int) -> int:
        """Number of the counter to which somebody goes, or -1."""
        crowd, journeys = self._model.crowd, self._model.journeys
        if not crowd.agenda["journey"][row]:
            return -1
        stop = journeys.next_stop(row, crowd)
        return next((n for n, each in enumerate(self.counters) if each.visit == stop), -1)

    def _let_by(self, counter: Counter, line: list[int]) -> None:
        """Let those go first who stand in front of the person before them, or are in the way of
        somebody before them.

        People who come from aside join behind somebody who is still on the way to their place. If
        they get there first, neither could pass the other.
        """
        crowd = self._model.crowd
        for k in range(len(line) - 1):
            place = counter.places_of(crowd.core[line])[k]
            pair = line[k : k + 2]
            away = np.hypot(crowd.x[pair] - place[0], crowd.y[pair] - place[1])
            if self._is_served(pair[0]):
                continue
            if away[1] < away[0] - _MOVES_UP:
                line[k : k + 2] = pair[::-1]
            elif away[0] > _MOVES_UP:
                other = self._in_the_way(line[k], line[k + 1 :], place)
                if other is not None:
                    line.remove(other)
                    line.insert(k, other)

    def _in_the_way(self, row: int, behind: list[int], place: NDArray[np.float64]) -> int | None:
        """The person behind who is in the way of somebody who stands before their place; None if
        that is nobody, or if they are in each other's way to the same place."""
        crowd = self._model.crowd
        away = np.hypot(crowd.x[behind] - crowd.x[row], crowd.y[behind] - crowd.y[row])
        touching = away < crowd.core[behind] + crowd.core[row] + _MOVES_UP
        near = [row, *np.array(behind)[touching].tolist()]
        if len(near) == 1 or math.hypot(crowd.vx[row], crowd.vy[row]) > _SETTLED:
            return None
        points, speeds = np.tile(place, (len(near), 1)), crowd.agenda["speed"][near]
        blockers = self._model.wishes(np.array(near), points, speeds).blockers.tolist()
        other = blockers[0]
        return None if other not in near[1:] or blockers[near.index(other)] == row else other

    def _line_up(
        self,
        counter: Counter,
        line: list[int],
        who: NDArray[np.intp],
        deciding: Deciding,
        desired: Desired,
    ) -> None:
        """Set points and speeds of those ``who`` decide and go to a counter."""
        rows, held, ahead = deciding.pedestrians, [], []
        cores = self._model.crowd.core
        ends = np.array([counter.places_of(cores[[*line, row]])[-1] for row in rows[who]])
        seen = lines_of_sight(deciding.site.plan, deciding.positions[who], ends)
        away = np.hypot(*(deciding.positions[who] - ends).T)
        # The nearest to the end of the line joins it first.
        for k in np.lexsort((rows[who], away)).tolist():
            row, here = int(rows[who[k]]), deciding.positions[who[k]]
            if row not in line:
                places = counter.places_of(cores[[*line, row]])
                if np.hypot(*(places - here).T).min() <= _JOINS:
                    line.append(row)
                elif seen[k]:
                    desired.points[who[k]] = places[-1]
                    continue
                else:
                    continue
            places, place = counter.places_of(cores[line]), line.index(row)
            off = float(np.hypot(*(places[place] - here)))
            stands = off <= (_MOVES_UP if row in self._standing else _STANDS) and place > 0
            if stands:
                self._standing.add(row)
                held.append(who[k])
                ahead.append(places[place - 1])
            else:
                self._standing.discard(row)
                if place > 0 or not self._is_served(row):
                    desired.points[who[k]] = places[place]
                    slowly = max(off / _GETS_THERE, _LEAST)
                    desired.speeds[who[k]] = min(desired.speeds[who[k]], slowly)
        if held:
            deciding.hold(desired, np.array(held), facing=np.array(ahead))

    def _is_served(self, row: int) -> bool:
        return self._model.journeys.stays.stands(row)
