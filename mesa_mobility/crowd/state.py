"""The state of the crowd: one set of arrays that the model owns.

A pedestrian keeps its row for ever; rows of people who left are simply not
active any more.  ``Pedestrian`` objects are views of a row.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.options import SAMPLES


class CrowdState(NamedTuple):
    """Arrays with one row a pedestrian.

    Now: ``x``, ``y``, ``heading`` (metres, radians), ``vx``, ``vy`` (mean velocity of the movement
    under way, m/s), ``active`` (in the model).  Person: ``preferred`` speed (m/s), ``core`` radius
    (m), ``kind`` (index of the pedestrian type), ``destination`` (the router's number).  Movement
    under way: ``option`` (row of the option table; -1 none yet, -2 fallback), ``cluster`` (at its
    end), ``start`` and ``end`` frames, ``gone`` (frame at which the person has crossed an exit,
    or -1), ``spacing`` (frames between knots), ``knots`` (their number), ``path`` (n, 3, 16) world
    x, y, heading at the knots, ``box`` (n, 4) what the path covers: least x, least y, greatest x,
    greatest y, ``sweep`` (n, 3) x, y and radius of a circle around that, ``stride``
    most metres on the way in the time between two samples.  Where to: ``target_x``, ``target_y``,
    ``route`` (metres left).
    Counters: ``decisions``, ``fallbacks``, ``fallback_frames``, ``active_frames``.
    """

    x: NDArray[np.float64]
    y: NDArray[np.float64]
    heading: NDArray[np.float64]
    vx: NDArray[np.float64]
    vy: NDArray[np.float64]
    active: NDArray[np.bool_]
    preferred: NDArray[np.float64]
    core: NDArray[np.float64]
    kind: NDArray[np.int32]
    destination: NDArray[np.int32]
    option: NDArray[np.int64]
    cluster: NDArray[np.int32]
    start: NDArray[np.int64]
    end: NDArray[np.int64]
    gone: NDArray[np.int64]
    spacing: NDArray[np.int32]
    knots: NDArray[np.int32]
    path: NDArray[np.float64]
    box: NDArray[np.float64]
    sweep: NDArray[np.float64]
    stride: NDArray[np.float64]
    target_x: NDArray[np.float64]
    target_y: NDArray[np.float64]
    route: NDArray[np.float64]
    decisions: NDArray[np.int64]
    fallbacks: NDArray[np.int64]
    fallback_frames: NDArray[np.int64]
    active_frames: NDArray[np.int64]


NO_OPTION = -1
FALLBACK = -2


def empty_state(capacity: int) -> CrowdState:
    """Arrays for ``capacity`` people, none of them active."""
    kinds: dict[str, type[np.generic]] = {"active": np.bool_}
    kinds |= dict.fromkeys(("kind", "destination", "cluster", "spacing", "knots"), np.int32)
    kinds |= dict.fromkeys(("option", "start", "end", "gone"), np.int64)
    kinds |= dict.fromkeys(("decisions", "fallbacks", "fallback_frames", "active_frames"), np.int64)
    shapes = {"path": (3, SAMPLES), "box": (4,), "sweep": (3,)}
    arrays: list[NDArray[Any]] = [
        np.zeros((capacity, *shapes.get(name, ())), dtype=kinds.get(name, np.float64))
        for name in CrowdState._fields
    ]
    return CrowdState(*arrays)


def grown(state: CrowdState, capacity: int) -> CrowdState:
    """The same people in larger arrays."""
    larger = empty_state(capacity)
    for name in CrowdState._fields:
        old = getattr(state, name)
        getattr(larger, name)[: len(old)] = old
    return larger
