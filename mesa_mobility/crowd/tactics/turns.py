"""Taking turns at passages where two people cannot pass each other.

At a door between two crowds the passing direction changes from time to time: once somebody has got
through, others follow easily, until the pressure of those who wait opposite prevails (Helbing and
Molnar, Physical Review E 51, 1995).  Here, where people want both ways through a passage too narrow
for two, the side from which more people are in it has the turn.  It keeps the turn while somebody
follows, but no longer than people wait patiently.  The others wait clear of the way out.  Where
everybody wants the same way, nothing changes.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import entry_point, internal, kept
from mesa_mobility.crowd.options.table import FRAME_SECONDS
from mesa_mobility.crowd.saved import Saved
from mesa_mobility.crowd.state.records import Crowd, CrowdState
from mesa_mobility.floorplan import FloorPlan
from mesa_mobility.floorplan.routing.passages import FOR_TWO, Passages, narrow_passages
from mesa_mobility.schema import Array, Flag, Kind, check

PATIENT = 30.0
"""Longest turn in seconds while others wait: people who wait for longer become
impatient (Transportation Research Board, Highway Capacity Manual, 2000, chapter 18)."""

REACH = 3.0
"""Metres before a mouth at which people see whose turn it is; no movement is longer."""

ASIDE = 0.3
"""Metres on either side of a mouth that are kept free for those who come out: half a
person's width."""

BESIDE_JAMB = 0.15
"""Share of a mouth's width by which the way of a person going by may miss it: people aim just
past a jamb."""

_MISS = BESIDE_JAMB * FOR_TWO + 1e-6
"""Metres by which a way may miss the box around a passage and still go by one of its mouths, and
rounding."""

SIDESTEP = 0.8
"""Highest speed of those who step aside, m/s."""

NOBODY = -1


class Turns(Saved):
    """The turns at the narrow passages of a floor plan.

    Args:
        plan: the floor plan; changes to it are followed.
    """

    saved: ClassVar[Mapping[str, Kind]] = {
        "_holder": Array("i8", ("passages",), low=NOBODY),
        "_since": Array("f8", ("passages",), 0.0, 1e9),
    }

    def __init__(self, plan: FloorPlan) -> None:
        self._plan = plan
        self._version = -1
        self._passages: Passages
        self._holder = np.empty(0, dtype=np.int64)
        self._since = np.empty(0)

    def members(self) -> Mapping[str, Kind]:
        """What the members of ``state`` are."""
        return {**self.saved, "current": Flag()}

    def state(self) -> dict[str, Any]:
        """Who has the turn where."""
        return {**super().state(), "current": self._version == self._plan.version}

    def restore(self, state: Mapping[str, Any]) -> None:
        """Take over what ``state`` has given."""
        super().restore(state)
        if state["current"]:
            self._version = self._plan.version
            self._passages = narrow_passages(self._plan)
            passages, mouths = len(self._passages.first_mouth) - 1, len(self._passages.mouths)
            kind = Array("i8", (passages,), low=NOBODY, high=mouths - 1)
            check(self._holder, kind, "_holder")

    def check_mouths(self, crowd: Crowd) -> None:
        """Raise ContentError if somebody is at a mouth that there is not."""
        if self._version == self._plan.version:
            most = len(self._passages.mouths)
            check(crowd.agenda["mouth"], Array("i4", None, -most, most), "agenda, mouth")

    def take(
        self,
        rows: NDArray[np.int64],
        inside: NDArray[np.int64],
        frame: int,
        crowd: Crowd,
        points: NDArray[np.float64],
        speeds: NDArray[np.float64],
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Targets (n, 2) in metres and preferred speeds (n,) in m/s, with waiting where others have
        the turn.

        Args:
            rows: (n,) the pedestrians.
            inside: rows of everybody inside.
            frame: now.
            crowd: the crowd; its agenda gets the mouth at which each is.
            points: (n, 2) their targets, metres.
            speeds: (n,) their preferred speeds, m/s.
        """
        if self._version != self._plan.version:
            self._version = self._plan.version
            self._passages = narrow_passages(self._plan)
            self._holder = np.full(len(self._passages.first_mouth) - 1, NOBODY, dtype=np.int64)
            self._since = np.zeros(len(self._holder))
            crowd.agenda["mouth"] = 0
        if len(self._holder) == 0:
            return points, speeds
        elapsed = frame * FRAME_SECONDS
        find_mouths(rows, self._passages, crowd.records, crowd.agenda, points)
        may_enter = np.ones(len(self._passages.mouths), dtype=np.bool_)
        if not give_turns(
            inside, elapsed, self._passages, crowd.agenda, self._holder, self._since, may_enter
        ):
            return points, speeds
        points, speeds = points.copy(), speeds.copy()
        _wait(rows, elapsed, self._passages, crowd.records, crowd.agenda, may_enter, points, speeds)
        return points, speeds


@entry_point()
def find_mouths(
    rows: NDArray[np.int64],
    passages: Passages,
    state: CrowdState,
    agenda: NDArray[np.void],
    points: NDArray[np.float64],
) -> None:
    """Note at which mouth those in ``rows`` are who go to ``points``: m + 1 if they are about to
    enter by mouth m, -(m + 1) if they are in a passage and leave it by mouth m, else 0."""
    mouths = passages.mouths
    for k in range(len(rows)):
        i = rows[k]
        x, y = state[i].x, state[i].y
        px, py = points[k, 0], points[k, 1]
        # A box around the part of the way on which mouths count.
        west, east = max(min(x, px), x - REACH) - _MISS, min(max(x, px), x + REACH) + _MISS
        south, north = max(min(y, py), y - REACH) - _MISS, min(max(y, py), y + REACH) + _MISS
        agenda[i]["mouth"] = 0
        nearest = REACH
        for p in range(len(passages.first_mouth) - 1):
            x0, y0, x1, y1 = passages.boxes[p]
            if east < x0 or west > x1 or north < y0 or south > y1:
                continue
            # Outside the box, nobody is within the outline.
            if not (x0 <= x <= x1 and y0 <= y <= y1 and _within(passages, p, x, y)):
                for m in range(passages.first_mouth[p], passages.first_mouth[p + 1]):
                    way, inward = _way_to(mouths[m], x, y, px, py)
                    if inward and way < nearest:
                        nearest = way
                        agenda[i]["mouth"] = m + 1
                continue
            # On the way out, or where the passage bends, towards the mouth next to the target.
            out, least = passages.first_mouth[p], np.inf
            for m in range(passages.first_mouth[p], passages.first_mouth[p + 1]):
                way, inward = _way_to(mouths[m], x, y, px, py)
                if inward or way == np.inf:
                    mx = 0.5 * (mouths[m, 0] + mouths[m, 2])
                    my = 0.5 * (mouths[m, 1] + mouths[m, 3])
                    way = 1e6 + np.hypot(mx - px, my - py)
                if way < least:
                    out, least = m, way
            agenda[i]["mouth"] = -(out + 1)
            break


@internal()
def _way_to(
    mouth: NDArray[np.float64], x: float, y: float, px: float, py: float
) -> tuple[float, bool]:
    """Metres to where the straight way from (x, y) to (px, py) crosses a mouth, inf where it does
    not, and whether that leads into the passage. A way just past a jamb goes by the mouth."""
    ax, ay, bx, by, nx, ny = mouth
    dx, dy, vx, vy = px - x, py - y, bx - ax, by - ay
    inward = dx * nx + dy * ny > 0.0
    det = dx * vy - dy * vx
    if det == 0.0:
        return np.inf, inward
    u = ((ax - x) * vy - (ay - y) * vx) / det
    v = ((ax - x) * dy - (ay - y) * dx) / det
    if 0.0 <= u <= 1.0 and -BESIDE_JAMB <= v <= 1.0 + BESIDE_JAMB:
        return u * np.hypot(dx, dy), inward
    return np.inf, inward


@internal()
def _within(passages: Passages, p: int, x: float, y: float) -> bool:
    """Whether (x, y) is within the outline of passage p."""
    corners, within = passages.outline, False
    for k in range(passages.first_corner[p], passages.first_corner[p + 1] - 1):
        ax, ay, bx, by = corners[k, 0], corners[k, 1], corners[k + 1, 0], corners[k + 1, 1]
        if (ay > y) != (by > y) and x < ax + (y - ay) / (by - ay) * (bx - ax):
            within = not within
    return within


@kept(nogil=True)
def give_turns(
    inside: NDArray[np.int64],
    elapsed: float,
    passages: Passages,
    agenda: NDArray[np.void],
    holder: NDArray[np.int64],
    since: NDArray[np.float64],
    may_enter: NDArray[np.bool_],
) -> bool:
    """Write by which mouths people may enter; returns whether anybody has to wait.

    ``holder`` has the mouth that has the turn at each passage; ``since`` when the turn began, s.
    """
    coming, leaving = np.zeros(len(may_enter), np.int64), np.zeros(len(may_enter), np.int64)
    for i in inside:
        mouth = agenda[i]["mouth"]
        if mouth > 0:
            coming[mouth - 1] += 1
        elif mouth < 0:
            leaving[-mouth - 1] += 1
    some_wait = False
    for p in range(len(holder)):
        first, last = passages.first_mouth[p], passages.first_mouth[p + 1]
        from_sides, against, in_it = 0, False, 0
        for m in range(first, last):
            from_sides += int(coming[m] > 0)
            against = against or (coming[m] > 0 and leaving[m] > 0)
            in_it += leaving[m]
        if from_sides < 2 and not against:
            holder[p] = NOBODY
            continue
        h = holder[p]
        over = h != NOBODY and (coming[h] == 0 or elapsed - since[p] > PATIENT)
        if h == NOBODY or (over and from_sides > int(coming[h] > 0)):
            # The first turn goes to the side with more people inside, a later one to more in front.
            best, most = NOBODY, np.int64(-1)
            for m in range(first, last):
                rank = coming[m] + (in_it - leaving[m]) * len(inside) * int(h == NOBODY)
                if m != h and coming[m] > 0 and rank > most:
                    best, most = m, rank
            h = holder[p] = best
            since[p] = elapsed
        if leaving[h] > 0:
            since[p] = elapsed  # the turn begins when the way is clear
        for m in range(first, last):
            may_enter[m] = m == h and leaving[m] == 0
        some_wait = True
    return some_wait


@kept(nogil=True)
def _wait(
    rows: NDArray[np.int64],
    elapsed: float,
    passages: Passages,
    state: CrowdState,
    agenda: NDArray[np.void],
    may_enter: NDArray[np.bool_],
    points: NDArray[np.float64],
    speeds: NDArray[np.float64],
) -> None:
    """Make those in ``rows`` wait who may not enter by their mouth.

    They stand or, if they are in the way of those who come out, step aside. Waiting for a turn
    does not count towards impatience.
    """
    for k in range(len(rows)):
        i = rows[k]
        m = agenda[i]["mouth"] - 1
        if m < 0 or may_enter[m]:
            continue
        ax, ay, bx, by = passages.mouths[m, :4]
        across = np.hypot(bx - ax, by - ay)
        tx, ty = (bx - ax) / across, (by - ay) / across
        x, y = state[i].x, state[i].y
        aside = (x - 0.5 * (ax + bx)) * tx + (y - 0.5 * (ay + by)) * ty
        agenda[i]["since"] = elapsed
        points[k, 0], points[k, 1] = x, y
        if abs(aside) < 0.5 * across + ASIDE:
            side = 1.0 if aside >= 0.0 else -1.0
            points[k, 0], points[k, 1] = x + 2.0 * side * tx, y + 2.0 * side * ty
            speeds[k] = min(speeds[k], SIDESTEP)
        else:
            speeds[k] = 0.0
