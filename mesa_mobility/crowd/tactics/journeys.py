"""Journeys: people cross gates in a given order, then leave by an exit or start over.

Crossed gates are found when a pedestrian decides, from the path that it has just walked.  Between
decisions nothing has to be checked, and people without a journey cost nothing.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import astuple, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import entry_point
from mesa_mobility.crowd.hooks import Saved
from mesa_mobility.crowd.options.table import OptionTable
from mesa_mobility.crowd.state.environment import Environment
from mesa_mobility.crowd.state.paths import waypoint
from mesa_mobility.crowd.state.records import Crowd, CrowdState
from mesa_mobility.errors import ModelError
from mesa_mobility.floorplan import FloorPlan
from mesa_mobility.floorplan.routing.route_graph import IN_LINE
from mesa_mobility.floorplan.walls.geometry import point_segment_distance2


@dataclass(frozen=True)
class Journey:
    """The gates of one route.

    Attributes:
        gates: names of the gates, in the order in which they are crossed.
        loop: whether the first gate follows the last.
        legs: destination number of each leg.  Unless it is a loop, one more leg leads from the last
            gate to the exits.
        lines: (legs, 4) line of the gate that ends each leg, metres; nan for the exits.
    """

    gates: tuple[str, ...]
    loop: bool
    legs: NDArray[np.int32]
    lines: NDArray[np.float64]


class Journeys(Saved):
    """The journeys of a model's people.

    Attributes:
        crossed: gates that all people together have crossed so far.
    """

    saved = ("_numbers", "crossed")

    def __init__(self, plan: FloorPlan, site: Environment) -> None:
        self._plan = plan
        self._site = site
        self._known: list[Journey] = []
        self._take_stock()
        self._numbers: dict[tuple[object, ...], int] = {}
        self.crossed = 0

    def state(self) -> dict[str, Any]:
        """The journeys, and how many gates have been crossed."""
        return {**super().state(), "known": [astuple(each) for each in self._known]}

    def restore(self, state: Mapping[str, Any]) -> None:
        """Take over what ``state`` has given."""
        super().restore(state)
        self._known = [Journey(*each) for each in state["known"]]
        self._take_stock()

    def add(
        self, route: Sequence[str], loop: bool, exits: tuple[str, ...] | None, kind: int
    ) -> int:
        """Number, above 0, of this route for people of one pedestrian type.

        Raises:
            ModelError: not a list of gates, one gate twice in a row, or a loop that ends at exits.
            FloorPlanError: an unknown gate, or no way from one to the next.
        """
        names = tuple(route)
        key = names, loop, exits, self._site.body(kind)
        if key in self._numbers:
            return self._numbers[key]
        if isinstance(route, str) or not names:
            raise ModelError(f"route: got {route!r}, expected a list of names of gates")
        following = [*names[1:], names[0]] if loop else names[1:]
        for one, next_one in zip(names, following, strict=False):
            if one == next_one:
                raise ModelError(f"route: gate {one!r} follows itself, expected another one next")
        if loop and exits is not None:
            raise ModelError("exits: got some for a route that goes round for ever, expected none")
        legs = [self._site.crossing(name, kind) for name in names]
        if not loop:
            legs.append(self._site.destination(exits, kind))
        for name, leg in zip(names, [*legs[1:], legs[0]] if loop else legs[1:], strict=True):
            self._site.check_way_on(name, leg)
        lines = [(*self._plan.gate(name).a, *self._plan.gate(name).b) for name in names]
        self._known.append(
            Journey(
                gates=names,
                loop=loop,
                legs=np.array(legs, dtype=np.int32),
                lines=np.array([*lines, *[(np.nan,) * 4] * (not loop)]),
            )
        )
        self._take_stock()
        self._numbers[key] = len(self._known)
        return len(self._known)

    def start(
        self, exits: Sequence[str] | None, route: Sequence[str], loop: bool, type_index: int
    ) -> tuple[int, int]:
        """Numbers of the first destination and of the journey, 0 for none.

        Args:
            exits: names of the exits by which people leave; None stands for all.
            route: names of the gates that they cross before.
            loop: whether they start over after the last gate.
            type_index: index of their type.

        Raises:
            ModelError: see ``add``.
            FloorPlanError: an unknown exit or gate, or no way from one to the next.
        """
        names = None if exits is None else tuple(exits)
        if not len(route):
            return self._site.destination(names, type_index), 0
        number = self.add(route, loop, names, type_index)
        return int(self._known[number - 1].legs[0]), number

    def gates(self, number: int) -> tuple[str, ...]:
        """Names of the gates of the journey with this number."""
        return self._known[number - 1].gates if number else ()

    def exits(self, number: int) -> tuple[str, ...]:
        """Names of the exits at the end of the journey with this number; none if it is a loop."""
        journey = self._known[number - 1]
        return () if journey.loop else self._site.exits(int(journey.legs[-1]))

    def endless(self, rows: NDArray[np.int64], crowd: Crowd) -> bool:
        """Whether the journey of somebody in ``rows`` is a loop."""
        numbers = np.unique(crowd.agenda["journey"][rows]).tolist()
        return any(number > 0 and self._known[number - 1].loop for number in numbers)

    def _take_stock(self) -> None:
        """Lay out the legs of all journeys one after the other."""
        none = Journey((), False, np.zeros(1, dtype=np.int32), np.full((1, 4), np.nan))
        known = [none, *self._known]
        self._counts = np.array([len(each.legs) for each in known], dtype=np.int64)
        self._firsts = np.cumsum(self._counts) - self._counts
        self._legs = np.concatenate([each.legs for each in known])
        self._lines = np.concatenate([each.lines for each in known])

    def _now(self, rows: NDArray[np.int64], crowd: Crowd) -> NDArray[np.int64]:
        """(n,) index of each person's current leg among the legs of all journeys."""
        journey, crossed = crowd.agenda["journey"][rows], crowd.agenda["crossed"][rows]
        legs: NDArray[np.int64] = self._firsts[journey] + crossed % self._counts[journey]
        return legs

    def advance(
        self, rows: NDArray[np.int64], frame: int, crowd: Crowd, table: OptionTable
    ) -> None:
        """Send those in ``rows`` who have crossed their gate to the next one."""
        if not self._known:
            return
        agenda = crowd.agenda
        on = rows[agenda["journey"][rows] > 0]
        while len(on):
            lines = self._lines[self._now(on, crowd)]
            when = np.full(len(on), np.inf)
            _find_crossings(on, lines, frame, agenda["checked"][on], table, crowd.records, when)
            over = np.isfinite(when)
            agenda["checked"][on] = np.where(over, when, frame)
            on = on[over]
            agenda["crossed"][on] += 1
            self.crossed += len(on)
            crowd.destination[on] = self._legs[self._now(on, crowd)]


@entry_point()
def _find_crossings(
    rows: NDArray[np.int64],
    lines: NDArray[np.float64],
    frame: int,
    since: NDArray[np.float64],
    table: OptionTable,
    state: CrowdState,
    when: NDArray[np.float64],
) -> None:
    """Write the frame at which people first crossed their line after ``since``, if they have."""
    for a in range(len(rows)):
        i = rows[a]
        cx, cy, dx, dy = lines[a]
        vx, vy = dx - cx, dy - cy
        bx, by = state.from_x[i], state.from_y[i]
        for k in range(state.knots[i] - 1):
            ax, ay = bx, by
            bx, by = waypoint(state, table, i, k + 1)
            begin = state.start[i] + k * state.spacing[i]
            if begin + state.spacing[i] <= since[a] or begin >= frame:
                continue
            ux, uy = bx - ax, by - ay
            det = ux * vy - uy * vx
            if det == 0.0:
                continue
            wx, wy = cx - ax, cy - ay
            u = (wx * vy - wy * vx) / det
            v = (wx * uy - wy * ux) / det
            t = begin + u * state.spacing[i]
            if 0.0 <= u <= 1.0 and 0.0 <= v <= 1.0 and since[a] < t <= frame:
                when[a] = t
                break
        # The router treats people this near to the line as past it.
        if math.isinf(when[a]) and since[a] < frame:
            d2 = point_segment_distance2(state.x[i], state.y[i], cx, cy, dx, dy)
            if d2 <= IN_LINE * IN_LINE:
                when[a] = frame
