"""What the choice works with: space that serves one pedestrian after the other."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.clearing import Bodies, Circles
from mesa_mobility.crowd.close import Close, make_close
from mesa_mobility.crowd.costs import COST, SPEED
from mesa_mobility.crowd.options import LEVELS, SAMPLES
from mesa_mobility.crowd.pairs import LANES


class Setting(NamedTuple):
    """What the search needs to know of a decision.

    Fields: ``frame`` now; people in ``close``: ``found`` from the start and those from
    ``touching`` to the end; ``neighbours`` in ``others``, ``foremost`` in the array of this name;
    ``exits_from`` metres to the nearest way out; ``eager``, whether costs over pairs may be
    negative and are needed of all options.
    """

    frame: int
    found: int
    touching: int
    neighbours: int
    foremost: int
    exits_from: float
    eager: bool


class Work(NamedTuple):
    """Space to work in, the same for one pedestrian after the other.

    Fields: ``near`` rows of the neighbours, ``others`` the same as the terms see them, ``foremost``
    those of them who are likely to cost most, ``dropped`` by neighbour; ``close`` those who may
    come in the way, ``unsure`` rows of those whom only the exact test can tell; ``bodies`` who is
    where at the levels; ``walls`` those in reach; groups: ``alive`` those not certainly blocked,
    their ``bounds``, and those of ``every`` group; ``circles`` for clearing; by option looked at,
    ``rows`` in the table, ``ends``, ``costs`` but for pairs, ``least`` that all costs may be, and
    ``leaving``, the frame of leaving by an exit or -1 once it is known that nothing is hit;
    heap of ``key`` and ``item``; ``slot`` by row of the cluster, which of those looked at it is;
    ``path`` one path.
    """

    near: NDArray[np.int64]
    unsure: NDArray[np.int64]
    others: NDArray[np.float64]
    foremost: NDArray[np.float64]
    dropped: NDArray[np.int32]
    close: Close
    bodies: Bodies
    walls: NDArray[np.float64]
    bounds: NDArray[np.float64]
    alive: NDArray[np.int64]
    every: NDArray[np.float64]
    circles: Circles
    rows: NDArray[np.int64]
    ends: NDArray[np.float64]
    costs: NDArray[np.float64]
    least: NDArray[np.float64]
    leaving: NDArray[np.int64]
    key: NDArray[np.float64]
    item: NDArray[np.int64]
    slot: NDArray[np.int64]
    path: NDArray[np.float64]


def make_work(people: int, walls: int, options: int) -> Work:
    """Space for so many people, walls near one place, and options of one cluster."""
    return Work(
        near=np.empty(people, np.int64),
        unsure=np.empty(people, np.int64),
        others=np.empty((COST + 1, people + LANES)),
        foremost=np.empty((COST + 1, people + LANES)),
        dropped=np.empty(people, np.int32),
        close=make_close(people),
        bodies=Bodies(
            np.empty(len(LEVELS), np.int64), np.empty((len(LEVELS), 3, people), np.float32)
        ),
        walls=np.empty((walls, 5)),
        bounds=np.empty(options),
        alive=np.empty(options, np.int64),
        every=np.empty(options),
        circles=Circles(np.empty((3, options), np.float32), np.empty(options, np.int32)),
        rows=np.empty(options, np.int64),
        ends=np.empty((SPEED + 1, options + LANES)),
        costs=np.empty(options),
        least=np.empty(options + LANES),
        leaving=np.empty(options, np.int64),
        key=np.empty(options),
        item=np.empty(options, np.int64),
        slot=np.empty(options, np.int64),
        path=np.empty((3, SAMPLES)),
    )
