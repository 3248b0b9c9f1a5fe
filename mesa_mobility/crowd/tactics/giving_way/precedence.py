"""Giving way at openings through which two wide bodies do not fit side by side.

Three wheelchairs that press towards a door from three sides hold each other up like the stones of
an arch, and none of them can step aside.  Robots that share a doorway or a junction avoid this with
reservations: one at a time may use it, in the order in which they come, and the others keep out of
it (Dresner and Stone, Journal of Artificial Intelligence Research 31, 2008).  Here, of the wide
people who are about to enter an opening too narrow for two of them, the one who is nearest to it
has the right to go first.  The others keep the width of a body clear of the opening until it is
through.  One that is up against a jamb first goes back to the middle, since it cannot step
aside either.  Where two just fit, they go together until they hold each other up.  People on foot
or with a cane neither wait nor are waited for.  But whoever is behind one that is held up in the
opening makes room for it (``making_room.py``); those who wait do so wherever the first is held up.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.journeys.waiting import waiting
from mesa_mobility.crowd.options.table import FRAME_SECONDS
from mesa_mobility.crowd.saved import Saved
from mesa_mobility.crowd.state.records import Crowd
from mesa_mobility.crowd.tactics.giving_way.making_room import ROOM, steps_aside
from mesa_mobility.crowd.tactics.giving_way.openings import (
    BACKING,
    NOBODY,
    at_a_jamb,
    axis_points,
    clear_of,
    middles,
    mouths_ahead,
    wait_clear,
    widths,
)
from mesa_mobility.floorplan import FloorPlan
from mesa_mobility.floorplan.routing.passages import narrow_mouths
from mesa_mobility.schema import Array, Flag, Kind, check_shape

WIDE = 0.18
"""Core radius in metres above which a body is wide.

People on foot and with a cane slip past one another; those with walking frames, on crutches and in
wheelchairs do not.
"""

ABREAST = 3
"""Wide bodies that wedge each other in side by side at most: wider openings than for so many make
no arch of them."""

CLEARANCE = 0.15
"""Metres between wide bodies and the jambs with which they get through side by side.

With less they mostly do, but may wedge each other in: then one goes first after all.
"""

GETTING_NEARER = 0.25
"""Metres that the one who goes first must come nearer for it to count as progress."""

STUCK = 3.0
"""Seconds without progress after which others make room, and one that is up against a jamb goes
back."""

PATIENT = 10.0
"""Seconds without progress after which somebody else goes first."""


class Precedence(Saved):
    """Who of the wide people goes first at each narrow opening of a floor plan.

    Args:
        plan: the floor plan; changes to it are followed.
        widest: greatest half width of the model's types, metres.
    """

    saved: ClassVar[Mapping[str, Kind]] = {
        "_first": Array("i8", ("openings_found",), low=NOBODY, below="people"),
        "_nearest": Array("f8", ("openings_found",), 0.0, 1e9, infinite=True),
        "_since": Array("f8", ("openings_found",), 0.0, 1e9),
        "_at": Array("i8", low=NOBODY, below="openings_found"),
    }

    def __init__(self, plan: FloorPlan, widest: float) -> None:
        self._plan = plan
        self._widest = widest
        self._version = -1
        self._mouths = np.empty((0, 6))
        # Opening that each person is about to enter.
        self._at = np.empty(0, dtype=np.int64)
        # Of each opening: who goes first, its least distance so far, and since when.
        self._first = np.empty(0, dtype=np.int64)
        self._nearest = np.empty(0)
        self._since = np.empty(0)

    def members(self) -> Mapping[str, Kind]:
        """What the members of ``state`` are."""
        return {**self.saved, "current": Flag()}

    def state(self) -> dict[str, Any]:
        """Who goes first where."""
        return {**super().state(), "current": self._version == self._plan.version}

    def restore(self, state: Mapping[str, Any]) -> None:
        """Take over what ``state`` has given."""
        super().restore(state)
        if state["current"]:
            self._look_for_openings()
            check_shape(self._first.shape, (len(self._mouths),), "_first", {})

    def _look_for_openings(self) -> None:
        self._version = self._plan.version
        # A corridor for three may lead to a door for two, which has a mouth of its own.
        mouths = np.concatenate(
            [
                narrow_mouths(self._plan, 2.0 * abreast * self._widest + CLEARANCE)
                for abreast in range(2, ABREAST + 1)
            ]
        )
        mouths = np.unique(mouths, axis=0)
        self._mouths = mouths[widths(mouths) > 2.0 * WIDE]

    def heed(
        self,
        rows: NDArray[np.int64],
        inside: NDArray[np.int64],
        frame: int,
        crowd: Crowd,
        points: NDArray[np.float64],
        speeds: NDArray[np.float64],
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Targets (n, 2) in metres and preferred speeds (n,) in m/s of deciding people.

        Args:
            rows: (n,) the pedestrians.
            inside: rows of everybody inside.
            frame: now.
            crowd: the crowd; waiting does not count towards impatience.
            points: (n, 2) their targets, metres.
            speeds: (n,) their preferred speeds, m/s.
        """
        if self._version != self._plan.version:
            self._look_for_openings()
            self._at = np.full(len(crowd.core), NOBODY, dtype=np.int64)
            self._first = np.full(len(self._mouths), NOBODY, dtype=np.int64)
            self._nearest = np.full(len(self._mouths), np.inf)
            self._since = np.zeros(len(self._mouths))
        if len(self._mouths) == 0:
            return points, speeds
        if len(self._at) < len(crowd.core):
            more = np.full(len(crowd.core) - len(self._at), NOBODY, dtype=np.int64)
            self._at = np.append(self._at, more)
        desired = self._let_first(rows, inside, frame, crowd, points, speeds)
        elapsed = frame * FRAME_SECONDS
        held_up, in_it = self._held_up(inside, elapsed, crowd)
        if held_up.any():
            given = points, speeds
            return self._make_room(held_up, in_it, rows, inside, elapsed, crowd, given, desired)
        return desired

    def _let_first(
        self,
        rows: NDArray[np.int64],
        inside: NDArray[np.int64],
        frame: int,
        crowd: Crowd,
        points: NDArray[np.float64],
        speeds: NDArray[np.float64],
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Targets and speeds of deciding people of whom the wide ones let others go first.

        Those who wait for something else are about to enter no opening.
        """
        mine = np.flatnonzero(crowd.core[rows] > WIDE)
        if len(mine) == 0:
            return points, speeds
        who, elapsed = rows[mine], frame * FRAME_SECONDS
        places = np.column_stack([crowd.x[who], crowd.y[who]])
        radii = crowd.core[who]
        stays = waiting(who, frame, crowd)
        at = mouths_ahead(self._mouths, places, points[mine], radii)
        self._at[who] = at = np.where(stays, NOBODY, at)
        self._first[np.isin(self._first, who[stays])] = NOBODY
        heeding = inside[(crowd.core[inside] > WIDE) & (self._at[inside] != NOBODY)]
        for mouth in np.unique(at).tolist():
            if mouth != NOBODY:
                self._choose(mouth, heeding[self._at[heeding] == mouth], elapsed, crowd)
        held_up = elapsed - self._since[at] > STUCK
        waits = (at != NOBODY) & (self._first[at] != who)
        waits &= self._too_narrow(who, at, np.where(held_up, CLEARANCE, 0.0), crowd)
        stuck = (at != NOBODY) & ~waits & held_up
        stuck[stuck] = at_a_jamb(self._mouths[at[stuck]], places[stuck], crowd.core[who[stuck]])
        if not (waits.any() or stuck.any()):
            return points, speeds
        points, speeds = points.copy(), speeds.copy()
        points[mine[stuck]] = axis_points(self._mouths[at[stuck]], radii[stuck])
        own = mine[waits]
        self._keep_patient(who[waits], elapsed, crowd)
        points[own], speeds[own] = wait_clear(
            self._mouths[at[waits]], places[waits], radii[waits], points[own], speeds[own]
        )
        return points, speeds

    def _choose(self, mouth: int, coming: NDArray[np.int64], elapsed: float, crowd: Crowd) -> None:
        """Say who of those ``coming`` goes first: as before, or the nearest."""
        places = np.column_stack([crowd.x[coming], crowd.y[coming]])
        ways = np.hypot(*(places - middles(self._mouths[[mouth]])).T)
        now = np.flatnonzero(coming == self._first[mouth])
        if len(now) and ways[now[0]] < self._nearest[mouth] - GETTING_NEARER:
            self._nearest[mouth], self._since[mouth] = ways[now[0]], elapsed
        if len(now) and elapsed - self._since[mouth] > PATIENT and len(coming) > 1:
            ways[now[0]] = np.inf
        elif len(now):
            return
        best = int(ways.argmin())
        self._first[mouth], self._nearest[mouth] = coming[best], ways[best]
        self._since[mouth] = elapsed

    def _held_up(
        self, inside: NDArray[np.int64], elapsed: float, crowd: Crowd
    ) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
        """(m,) at which openings the one who goes first makes no progress; (m,) whether it is in
        the opening."""
        first = self._first
        there = np.isin(first, inside) & (self._at[first] == np.arange(len(first)))
        places = np.column_stack([crowd.x[first], crowd.y[first]])
        way = np.hypot(*(places - middles(self._mouths)).T)
        held_up = there & (elapsed - self._since > STUCK)
        return held_up, way < clear_of(widths(self._mouths), crowd.core[first])

    def _make_room(
        self,
        held_up: NDArray[np.bool_],
        in_it: NDArray[np.bool_],
        rows: NDArray[np.int64],
        inside: NDArray[np.int64],
        elapsed: float,
        crowd: Crowd,
        given: tuple[NDArray[np.float64], NDArray[np.float64]],
        desired: tuple[NDArray[np.float64], NDArray[np.float64]],
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Targets and speeds of deciding people of whom those make room who are behind somebody
        held up. Whom another tactic lets stand stays.

        People on foot make room for somebody in the opening; before it they queue, as it does.
        Wide people make room before it, too: it may be them for whom it cannot go on.

        Args:
            held_up: (m,) at which openings somebody is.
            in_it: (m,) whether it is in the opening.
            rows: (n,) the pedestrians.
            inside: rows of everybody inside.
            elapsed: seconds.
            crowd: the crowd; making room does not count towards impatience.
            given: targets (n, 2) in metres and speeds (n,) in m/s of their routes.
            desired: targets and speeds so far.
        """
        routes, most = given
        points, speeds = desired
        places = np.column_stack([crowd.x[rows], crowd.y[rows]])
        at = mouths_ahead(self._mouths, places, routes, crowd.core[rows])
        first = self._first[at]
        stuck = np.column_stack([crowd.x[first], crowd.y[first]])
        middle = middles(self._mouths[at])
        gap = np.hypot(*(places - stuck).T) - crowd.core[rows] - crowd.core[first]
        behind = np.hypot(*(places - middle).T) > np.hypot(*(stuck - middle).T)
        makes = (at != NOBODY) & held_up[at] & (rows != first) & behind & (gap < ROOM)
        makes &= in_it[at] | (crowd.core[rows] > WIDE)
        own = np.flatnonzero(makes & (most > 0.0))
        who = rows[own]
        if len(who) == 0:
            return desired
        ends, can = steps_aside(
            self._plan,
            places[own],
            crowd.core[who],
            stuck[own],
            np.column_stack([crowd.x[inside], crowd.y[inside]]),
            crowd.core[inside],
        )
        points, speeds = points.copy(), speeds.copy()
        points[own[can]] = ends[can]
        speeds[own] = np.where(can, np.minimum(most[own], BACKING), 0.0)
        self._keep_patient(who, elapsed, crowd)
        return points, speeds

    def _keep_patient(self, rows: NDArray[np.int64], elapsed: float, crowd: Crowd) -> None:
        """Let people wait without getting impatient."""
        crowd.agenda["since"][rows] = elapsed

    def _too_narrow(
        self,
        who: NDArray[np.int64],
        at: NDArray[np.int64],
        clearance: NDArray[np.float64],
        crowd: Crowd,
    ) -> NDArray[np.bool_]:
        """(n,) whether each and the one who goes first do not fit through its opening together,
        with a clearance in metres."""
        together = 2.0 * (crowd.core[who] + crowd.core[self._first[at]])
        too_narrow: NDArray[np.bool_] = widths(self._mouths[at]) < together + clearance
        return too_narrow
