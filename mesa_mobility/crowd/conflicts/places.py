"""Where somebody may stand who makes way for another."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.floorplan import FloorPlan, lines_of_sight

AHEAD = 4.0
"""Metres of a way that are left free: the longest movement, 3 m, and room to stop."""

ROOM = 0.1
"""Metres between the cores of two who pass each other: bodies sway by 3 to 12 cm."""

CLEAR = 0.05
"""Metres between a core and the walls beside the way of somebody who sets out again."""

ROOMS = (1.0, 0.85, 0.7, 0.5)
"""Shares of the core and ``CLEAR`` that a way keeps from walls, the best first. Targets of wide
bodies lie near walls, and ways to them cut corners that bodies go round in an arc."""

TAKEN = 0.5
"""Metres that somebody would rather go than ask another to move."""

EFFORT = 0.1
"""Metres along a way or aside of it that a metre of walking is worth where no place is free."""

FAR = 100.0
"""Metres that somebody would rather go to a place that leaves the ways free."""

TRIED = 40
"""Most places that are tried until somebody can move to one."""

AROUND = 2.4
"""Metres within which a place is looked for."""

_DISTANCES = AROUND * np.array([0.1, 0.2, 0.3, 0.4, 0.6, 0.8, 1.0])
_ANGLES = np.deg2rad(np.arange(0.0, 360.0, 15.0))
_STEPS = np.concatenate(
    [[[0.0, 0.0]]]
    + [far * np.column_stack([np.cos(_ANGLES), np.sin(_ANGLES)]) for far in _DISTANCES]
)


class Body(NamedTuple):
    """Where somebody is, (2,) metres, their core radius, metres, and whether they use stairs."""

    place: NDArray[np.float64]
    core: float
    climbs: bool = True


class Way(NamedTuple):
    """Somebody who is to pass, and (k, 2) points of their way, metres."""

    body: Body
    points: NDArray[np.float64]


def places_aside(
    plan: FloorPlan,
    me: Body,
    ways: Sequence[Way],
    taken: NDArray[np.float64],
    cores: NDArray[np.float64],
) -> NDArray[np.float64]:
    """The places at which somebody leaves the ways of others free, the nearest first.

    Each person who stands at a place, or is about to, counts as ``TAKEN`` metres more. Then come
    places that block a way, those farthest along the ways and farthest beside them first. A person
    who finds no free place walks ahead of the people whom they make way for.

    Args:
        plan: the floor plan.
        me: who makes way.
        ways: those that are to be free.
        taken: (m, 2) where others stand or are about to, metres.
        cores: (m,) their core radii, metres.

    Returns:
        (k, 2) metres, at most ``TRIED``. Places that are worse than staying are left out. The
        person's own place is the last one, unless ``TRIED`` others are better.
    """
    ends, can = _within_reach(plan, me)
    for way in ways:
        # Nobody makes way through those who are to pass, nor comes nearer to them.
        apart = _distances_to_legs(way.body.place, me.place, ends)
        can &= apart >= min(me.core + way.body.core, apart[0]) - 1e-6
    can[0] = True
    ends, far = ends[can], np.hypot(*_STEPS[can].T)
    along, aside = np.zeros(len(ends)), np.full(len(ends), np.inf)
    for way in ways:
        off, on = distances_to_way(ends, way.points)
        along, aside = along + on, np.minimum(aside, off)
    clear = leaves_free(ends, me.core, ways)
    cost = np.where(clear, far, FAR - along - aside + EFFORT * far)
    cost += _cost_of_others(ends, me, taken, cores)
    # None is worse than to stay, which comes first among all of them.
    order = cost.argsort(kind="stable")
    return ends[order[: int(np.flatnonzero(order == 0)[0]) + 1][:TRIED]]


def leaves_free(places: NDArray[np.float64], core: float, ways: Sequence[Way]) -> NDArray[np.bool_]:
    """(n,) whether somebody of this core radius leaves all ways free at places (n, 2)."""
    free = np.ones(len(places), np.bool_)
    for way in ways:
        free &= distances_to_way(places, way.points)[0] >= core + way.body.core + ROOM
    return free


def places_to_set_out(
    plan: FloorPlan,
    me: Body,
    aims: Callable[[NDArray[np.float64]], NDArray[np.float64]],
    taken: NDArray[np.float64],
    cores: NDArray[np.float64],
) -> NDArray[np.float64]:
    """The places from which somebody's way to their target keeps clear of walls, nearest first.

    The way keeps a share of the core radius and ``CLEAR`` from walls: the first of ``ROOMS`` that
    some place allows. Each person who stands at a place, or is about to, counts as ``TAKEN``
    metres more.

    Args:
        plan: the floor plan.
        me: who goes to such a place, since walls are in their way from where they are.
        aims: gives the targets (n, 2) of places (n, 2), metres.
        taken: (m, 2) where others stand or are about to, metres.
        cores: (m,) their core radii, metres.

    Returns:
        (k, 2) metres, at most ``TRIED``, maybe none.
    """
    ends, can = _within_reach(plan, me)
    can[0] = False  # their own place
    ends, far = ends[can], np.hypot(*_STEPS[can].T)
    targets = aims(ends)
    for share in ROOMS:
        room = gets_straight(plan, me, ends, targets, share * (me.core + CLEAR))
        if room.any():
            break
    ends, far = ends[room], far[room]
    cost = far + _cost_of_others(ends, me, taken, cores)
    return ends[cost.argsort(kind="stable")[:TRIED]]


def _within_reach(plan: FloorPlan, me: Body) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """(k, 2) places around somebody, their own the first, metres, and whether they can get to each
    past the walls."""
    ends = me.place + _STEPS
    starts = np.broadcast_to(me.place, ends.shape)
    return ends, gets_straight(plan, me, starts, ends, me.core) & plan.contains(ends)


def gets_straight(
    plan: FloorPlan,
    me: Body,
    starts: NDArray[np.float64],
    ends: NDArray[np.float64],
    clearance: float,
) -> NDArray[np.bool_]:
    """(n,) whether somebody gets straight from places (n, 2) to others (n, 2), metres.

    They keep a clearance in metres from walls, and from stairs if they do not use them.
    """
    clear = lines_of_sight(plan, starts, ends, clearance)
    if not me.climbs:
        clear &= lines_of_sight(plan.steps, starts, ends, clearance)
    return clear


def _cost_of_others(
    places: NDArray[np.float64],
    me: Body,
    taken: NDArray[np.float64],
    cores: NDArray[np.float64],
) -> NDArray[np.float64]:
    """(n,) metres that count for the people who stand at (n, 2) places, or are about to."""
    to = places[:, None] - taken
    cost: NDArray[np.float64] = TAKEN * (np.hypot(to[..., 0], to[..., 1]) < cores + me.core).sum(
        axis=1
    )
    return cost


def distances_to_way(
    points: NDArray[np.float64], way: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(n,) metres from points (n, 2) to a way (k, 2), and along it to the nearest place on it."""
    start, step = way[:-1], np.diff(way, axis=0)
    length = np.maximum(np.hypot(step[:, 0], step[:, 1]), 1e-9)
    share = np.clip(((points[:, None] - start) * step).sum(axis=2) / length**2, 0.0, 1.0)
    off = points[:, None] - start - share[..., None] * step
    away = np.hypot(off[..., 0], off[..., 1])
    rows, nearest = np.arange(len(points)), away.argmin(axis=1)
    before = np.cumsum(length) - length
    return away[rows, nearest], (before + share * length)[rows, nearest]


def _distances_to_legs(
    point: NDArray[np.float64], start: NDArray[np.float64], ends: NDArray[np.float64]
) -> NDArray[np.float64]:
    """(n,) metres from a point to straight legs from one start."""
    step = ends - start
    length2 = np.maximum((step**2).sum(axis=1), 1e-12)
    share = np.clip(((point - start) * step).sum(axis=1) / length2, 0.0, 1.0)
    off = start + share[:, None] * step - point
    distances: NDArray[np.float64] = np.hypot(off[:, 0], off[:, 1])
    return distances
