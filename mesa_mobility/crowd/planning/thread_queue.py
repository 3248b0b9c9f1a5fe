"""The queue by which threads share the decisions of a frame.

People decide in order, since each decision depends on the paths to which people before are
committed. Nothing beyond the search radius matters: two people farther apart, on every sheet on
which they are seen, may decide in either order, or at once, with the same result to the last bit.
So each thread takes the first person of whom no predecessor within that radius is undecided.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import internal
from mesa_mobility.compiled.intrinsics import (
    load_acquire,
    rest,
    store_release,
    take_number,
)
from mesa_mobility.crowd.planning.workspace import FrameContext
from mesa_mobility.crowd.state.records import CrowdState
from mesa_mobility.crowd.state.twins import Twins

NOBODY_LEFT = -1

_AHEAD = 16
"""People at the head of the queue among whom a thread looks for one who may decide."""

_PATIENCE = 500
"""Looks at the queue before the thread rests. A decision takes some 30 microseconds, and a thread
that has lost its processor takes milliseconds."""


class Queue(NamedTuple):
    """Decisions under way, as all threads see them.

    Attributes:
        taken: (n,) 0 for those whom no thread has taken.
        done: (n,) 1 for those who have decided.
        end: (1,) from this index on nobody is taken any more.
    """

    taken: NDArray[np.int64]
    done: NDArray[np.int64]
    end: NDArray[np.int64]


def new_queue(people: int) -> Queue:
    """A queue of undecided people."""
    return Queue(
        np.zeros(people, np.int64), np.zeros(people, np.int64), np.array([people], np.int64)
    )


@internal()
def take(first: int, rows: NDArray[np.int64], queue: Queue, scene: FrameContext) -> tuple[int, int]:
    """Take somebody who may decide, once there is one.

    Args:
        first: so many people at the head of the queue have decided, at least.
        rows: everybody in the queue.
        queue: shared by all threads.
        scene: the frame.

    Returns:
        Index in ``rows``, or ``NOBODY_LEFT``, and how many at the head have decided by now.
    """
    patience = _PATIENCE
    while True:
        end = load_acquire(queue.end, 0)
        while first < end and load_acquire(queue.done, first) == 1:
            first += 1
        last = min(first + _AHEAD, end)
        left = last < end
        for d in range(first, last):
            if load_acquire(queue.taken, d) == 0:
                left = True
                if _may_decide(d, first, rows, queue, scene) and take_number(queue.taken, d) == 0:
                    return d, first
        if not left:
            return NOBODY_LEFT, first
        patience -= 1
        if patience < 0:
            rest()


@internal()
def give_back(d: int, fine: bool, queue: Queue) -> None:
    """Note that the person at index d has decided; unless that was ``fine``, the queue ends."""
    if not fine and d < load_acquire(queue.end, 0):
        store_release(queue.end, 0, d)
    store_release(queue.done, d, 1)


@internal()
def _may_decide(
    d: int, first: int, rows: NDArray[np.int64], queue: Queue, scene: FrameContext
) -> bool:
    """Whether no undecided predecessor of the person at index d is near.

    Those who are near are within the search radius, or have a twin there, or are as near to a twin
    of the person.
    """
    i, state, twins = rows[d], scene.state, scene.twins
    radius = scene.rules.search_radius
    for e in range(first, d):
        if load_acquire(queue.done, e) == 1:
            continue
        if _near(i, rows[e], radius, state):
            return False
        if len(twins.follow) > 0 and (
            _near_twin(i, rows[e], radius, twins, state)
            or _near_twin(rows[e], i, radius, twins, state)
        ):
            return False
    return True


@internal()
def _near(i: int, j: int, radius: float, state: CrowdState) -> bool:
    """Whether j is within ``radius`` of i."""
    dx, dy = state.x[j] - state.x[i], state.y[j] - state.y[i]
    return bool(dx * dx + dy * dy <= radius * radius)


@internal()
def _near_twin(i: int, j: int, radius: float, twins: Twins, state: CrowdState) -> bool:
    """Whether j is within ``radius`` of a twin of i."""
    t = twins.follow[i]
    while t >= 0:
        if _near(t, j, radius, state):
            return True
        t = twins.follow[t]
    return False
