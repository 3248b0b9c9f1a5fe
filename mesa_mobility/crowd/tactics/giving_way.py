"""Giving way at openings through which two wide bodies do not fit side by side.

Three wheelchairs that press towards a door from three sides hold each other up like the stones of
an arch, and none of them can step aside.  Robots that share a doorway or a junction avoid this with
reservations: one at a time may use it, in the order in which they come, and the others keep out of
it (Dresner and Stone, Journal of Artificial Intelligence Research 31, 2008).  Here, of the wide
people who are about to enter an opening too narrow for two of them, the one who is nearest to it
has the right to go first.  The others keep the width of a body clear of the opening until it is
through.  One that is up against a jamb first goes back to the middle, since it cannot step
aside either.  Where two just fit, they go together until they hold each other up.  People on foot
without crutches neither wait nor are waited for.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.hooks import Saved
from mesa_mobility.crowd.state.records import Crowd
from mesa_mobility.floorplan import FloorPlan
from mesa_mobility.floorplan.routing.passages import narrow_mouths

WIDE = 0.2
"""Core radius in metres above which a body is wide.

People on foot, with a cane or with a walking frame slip past one another; those on crutches and
in wheelchairs do not.
"""

CLEARANCE = 0.15
"""Metres between two wide bodies and the jambs with which they get through side by side.

With less they mostly do, but may wedge each other in: then one goes first after all.
"""

REACH = 4.0
"""Metres before an opening at which wide people heed it: the longest movement, 3 m, and room to
stop."""

BESIDE_JAMB = 0.35
"""Metres by which the way of a person going by an opening may miss it: half a wide body."""

AT_JAMB = 0.05
"""Metres from a jamb within which somebody is up against it."""

SECONDS_TO_STOP = 1.5
"""Time in which those who wait come to a halt: the longest movement."""

BACKING = 0.8
"""Highest speed of those who make room, m/s."""

GETTING_NEARER = 0.25
"""Metres that the one who goes first must come nearer for it to count as progress."""

STUCK = 3.0
"""Seconds without progress after which one that is up against a jamb goes back."""

PATIENT = 10.0
"""Seconds without progress after which somebody else goes first."""

NOBODY = -1


class Precedence(Saved):
    """Who of the wide people goes first at each narrow opening of a floor plan.

    Args:
        plan: the floor plan; changes to it are followed.
        widest: greatest half width of the model's types, metres.
        stretch: (types,) radius of a circle that holds a body, in core radii.
    """

    saved = ("_at", "_first", "_nearest", "_since")

    def __init__(self, plan: FloorPlan, widest: float, stretch: NDArray[np.float64]) -> None:
        self._stretch = stretch
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

    def state(self) -> dict[str, Any]:
        """Who goes first where."""
        return {**super().state(), "current": self._version == self._plan.version}

    def restore(self, state: Mapping[str, Any]) -> None:
        """Take over what ``state`` has given."""
        super().restore(state)
        if state["current"]:
            self._look_for_openings()

    def _look_for_openings(self) -> None:
        self._version = self._plan.version
        mouths = narrow_mouths(self._plan, 4.0 * self._widest + CLEARANCE)
        wide_enough = np.hypot(*(mouths[:, 2:4] - mouths[:, :2]).T) > 2.0 * WIDE
        self._mouths = mouths[wide_enough]

    def heed(
        self,
        rows: NDArray[np.int64],
        inside: NDArray[np.int64],
        elapsed: float,
        crowd: Crowd,
        points: NDArray[np.float64],
        speeds: NDArray[np.float64],
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Targets (n, 2) in metres and preferred speeds (n,) in m/s of deciding people.

        Args:
            rows: (n,) the pedestrians.
            inside: rows of everybody inside.
            elapsed: seconds.
            crowd: the crowd; waiting does not count towards impatience.
            points: (n, 2) their targets, metres.
            speeds: (n,) their preferred speeds, m/s.
        """
        mine = np.flatnonzero(crowd.core[rows] > WIDE)
        if len(mine) == 0:
            return points, speeds
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
        who = rows[mine]
        places = np.column_stack([crowd.x[who], crowd.y[who]])
        radii = crowd.core[who] * self._stretch[crowd.type_index[who]]
        self._at[who] = mouths_ahead(self._mouths, places, points[mine], radii)
        heeding = inside[(crowd.core[inside] > WIDE) & (self._at[inside] != NOBODY)]
        for mouth in np.unique(self._at[who]).tolist():
            if mouth != NOBODY:
                self._choose(mouth, heeding[self._at[heeding] == mouth], elapsed, crowd)
        at = self._at[who]
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
        # Long bodies beside one another may have to back off, those who wait as well.
        patient = waits & (self._stretch[crowd.type_index[who]] == 1.0)
        crowd.agenda["since"][who[patient]] = elapsed
        points[own], speeds[own] = wait_clear(
            self._mouths[at[waits]], places[waits], radii[waits], points[own], speeds[own]
        )
        return points, speeds

    def _choose(self, mouth: int, coming: NDArray[np.int64], elapsed: float, crowd: Crowd) -> None:
        """Say who of those ``coming`` goes first: as before, or the nearest."""
        ax, ay, bx, by = self._mouths[mouth, :4]
        ways = np.hypot(crowd.x[coming] - (ax + bx) / 2.0, crowd.y[coming] - (ay + by) / 2.0)
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

    def _too_narrow(
        self,
        who: NDArray[np.int64],
        at: NDArray[np.int64],
        clearance: NDArray[np.float64],
        crowd: Crowd,
    ) -> NDArray[np.bool_]:
        """(n,) whether each and the one who goes first do not fit through its opening together,
        with a clearance in metres."""
        line = self._mouths[at, :4]
        width = np.hypot(line[:, 2] - line[:, 0], line[:, 3] - line[:, 1])
        together = 2.0 * (crowd.core[who] + crowd.core[self._first[at]])
        too_narrow: NDArray[np.bool_] = width < together + clearance
        return too_narrow


def mouths_ahead(
    mouths: NDArray[np.float64],
    places: NDArray[np.float64],
    points: NDArray[np.float64],
    radii: NDArray[np.float64],
) -> NDArray[np.int64]:
    """(n,) the nearest mouth within reach that each is about to enter, or -1.

    Its straight way to its target leads through the mouth, or ends right before it: there routes
    bend into an opening.

    Args:
        mouths: (m, 6) as ``narrow_mouths`` gives them.
        places: (n, 2) where they are, metres.
        points: (n, 2) their targets, metres.
        radii: (n,) of the circles that hold their bodies, metres.
    """
    start, inward = mouths[:, :2], mouths[:, 4:]
    along = mouths[:, 2:4] - start
    width = np.hypot(along[:, 0], along[:, 1])
    along = along / width[:, None]
    off = ((places[:, None] - start) * inward).sum(axis=2)
    off_target = ((points[:, None] - start) * inward).sum(axis=2)
    outside = off < 0.0
    through = outside & (off_target > 0.0)
    share = off / np.where(through, off - off_target, 1.0)
    crossing = places[:, None] + np.where(through, share, 0.0)[:, :, None] * (
        points[:, None] - places[:, None]
    )
    lateral = ((crossing - start) * along).sum(axis=2)
    through &= (lateral >= -BESIDE_JAMB) & (lateral <= width + BESIDE_JAMB)
    middle = (start + mouths[:, 2:4]) / 2.0
    before = np.hypot(*(points[:, None] - middle).transpose(2, 0, 1))
    stays = (points == places).all(axis=1)
    before_it = (before < clear_of(width, radii[:, None])) & outside & ~stays[:, None]
    way = np.hypot(*(places[:, None] - middle).transpose(2, 0, 1))
    way = np.where(through | before_it, way, np.inf)
    nearest = way.argmin(axis=1)
    found: NDArray[np.int64] = np.where(
        way[np.arange(len(places)), nearest] <= REACH, nearest, NOBODY
    )
    return found


def clear_of(width: NDArray[np.float64], radii: NDArray[np.float64]) -> NDArray[np.float64]:
    """Metres from the middle of a mouth that a body's width beside it reaches to."""
    return width / 2.0 + 2.0 * radii


def at_a_jamb(
    mouths: NDArray[np.float64], places: NDArray[np.float64], cores: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """(n,) whether each is up against a jamb of the mouth that it is at, and cannot go on."""
    lines = mouths[:, :4].reshape(-1, 2, 2)
    to_jamb = np.hypot(*(lines - places[:, None]).transpose(2, 0, 1)).min(axis=1)
    along = lines[:, 1] - lines[:, 0]
    width = np.hypot(along[:, 0], along[:, 1])
    aside = ((places - lines.mean(axis=1)) * along).sum(axis=1) / width
    against: NDArray[np.bool_] = (to_jamb < cores + AT_JAMB) & (abs(aside) > width / 2.0 - cores)
    return against


def axis_points(mouths: NDArray[np.float64], radii: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n, 2) where people may turn into the mouth that each is at: a body before its middle."""
    points: NDArray[np.float64] = (mouths[:, :2] + mouths[:, 2:4]) / 2.0 - 2.0 * radii[
        :, None
    ] * mouths[:, 4:]
    return points


def wait_clear(
    mouths: NDArray[np.float64],
    places: NDArray[np.float64],
    radii: NDArray[np.float64],
    points: NDArray[np.float64],
    speeds: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Targets and speeds of people who keep a body's width clear of the mouth that each is at.

    Those who are nearer go away from it. The others stop half a body before, so that those who go
    away have room.
    """
    from_mouth = places - (mouths[:, :2] + mouths[:, 2:4]) / 2.0
    way = np.hypot(from_mouth[:, 0], from_mouth[:, 1])
    width = np.hypot(mouths[:, 2] - mouths[:, 0], mouths[:, 3] - mouths[:, 1])
    free = way - clear_of(width, radii)
    away = from_mouth / np.maximum(way, 1e-9)[:, None]
    left = np.maximum(free - radii, 0.0)
    on = points - places
    on *= np.minimum(1.0, left / np.maximum(np.hypot(on[:, 0], on[:, 1]), 1e-9))[:, None]
    too_near = free < 0.0
    return (
        places + np.where(too_near[:, None], 2.0 * away, on),
        np.where(too_near, np.minimum(speeds, BACKING), np.minimum(speeds, left / SECONDS_TO_STOP)),
    )
