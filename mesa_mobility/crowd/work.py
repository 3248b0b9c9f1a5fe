"""What the choice works with: space that serves one pedestrian after the other."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.barriers import BARRIER_FIELDS
from mesa_mobility.crowd.clearing import Bodies, Fences
from mesa_mobility.crowd.close import Close, make_close
from mesa_mobility.crowd.costs import COST, SPEED
from mesa_mobility.crowd.options import LEVELS, SAMPLES
from mesa_mobility.lanes import AT_ONCE, LANES, WIDE


class Setting(NamedTuple):
    """What the search needs to know of a decision.

    Fields: ``frame`` now; ``firm`` walls among ``barriers``; ``stay`` the group to look at first,
    or -1; people in ``close``: ``found`` from the start and those from ``touching`` to the end;
    ``neighbours`` in ``others``, ``foremost`` in the array of this name, of whom some are marked if
    bounds are ``rough``; ``exits_from`` metres to the nearest way out; ``eager``, whether costs
    over pairs may be negative and are needed of all options; ``ranked``, whether groups are opened
    by and by.
    """

    frame: int
    firm: int
    stay: int
    found: int
    touching: int
    neighbours: int
    foremost: int
    rough: bool
    exits_from: float
    eager: bool
    ranked: bool


class Work(NamedTuple):
    """Space to work in, the same for one pedestrian after the other.

    Fields: ``near`` rows of the neighbours, ``others`` the same as the terms see them, ``sweeps``
    (3, n) circles around all that they cover, ``foremost`` those of them who are likely to cost
    most, ``dropped`` by neighbour; ``close`` those who may come in the way, ``unsure`` rows of
    those whom only the exact test can tell; ``bodies`` who is where at the levels, ``fences`` the
    walls there; ``walls`` those in reach, ``barriers`` the same seen from the pedestrian; groups:
    which are certainly ``blocked``, the ``bounds`` of all; of those just opened, which are
    ``picked``, bits of their options that are ``free``, and of 8 options each, ``lanes`` where they
    end and ``lane_costs``; by option looked at, ``rows`` in the table, ``ends``, ``costs`` but for
    pairs, ``least`` that all costs may be, and ``rough``, whether little more work tells more of
    that; ``sums`` by term over pairs, and the ``telling`` one, to begin with; ``path`` one path.
    """

    near: NDArray[np.int64]
    unsure: NDArray[np.int64]
    others: NDArray[np.float64]
    sweeps: NDArray[np.float64]
    foremost: NDArray[np.float64]
    marks: NDArray[np.int64]
    some: NDArray[np.float64]
    dropped: NDArray[np.int32]
    close: Close
    bodies: Bodies
    fences: Fences
    walls: NDArray[np.float64]
    barriers: NDArray[np.float32]
    bounds: NDArray[np.float64]
    blocked: NDArray[np.int32]
    picked: NDArray[np.int64]
    free: NDArray[np.int64]
    lanes: NDArray[np.float64]
    lane_costs: NDArray[np.float64]
    rows: NDArray[np.int64]
    ends: NDArray[np.float64]
    costs: NDArray[np.float64]
    least: NDArray[np.float64]
    rough: NDArray[np.bool_]
    sums: NDArray[np.float64]
    telling: NDArray[np.int64]
    path: NDArray[np.float64]


def make_work(people: int, walls: int, options: int, groups: int, terms: int) -> Work:
    """Space for so many people, walls near one place, options and groups of one cluster, terms."""
    lanes = LANES * groups
    return Work(
        near=np.empty(people + LANES, np.int64),
        unsure=np.empty(people, np.int64),
        others=np.empty((COST + 1, people + LANES)),
        sweeps=np.empty((3, people + LANES)),
        foremost=np.empty((COST + 1, people + LANES)),
        marks=np.empty(people, np.int64),
        some=np.empty((COST + 1, people + LANES)),
        dropped=np.empty(people, np.int32),
        close=make_close(people),
        bodies=Bodies(
            np.empty(len(LEVELS), np.int64), np.empty((len(LEVELS), 3, people + 1), np.float32)
        ),
        fences=Fences(
            np.empty(len(LEVELS), np.int64),
            np.empty((len(LEVELS), BARRIER_FIELDS, walls), np.float32),
        ),
        walls=np.empty((walls, 5)),
        barriers=np.empty((BARRIER_FIELDS, walls), np.float32),
        bounds=np.empty(groups + AT_ONCE),
        blocked=np.empty(groups + WIDE, np.int32),
        picked=np.empty(groups + LANES, np.int64),
        free=np.empty(groups, np.int64),
        lanes=np.empty((SPEED + 1, lanes)),
        lane_costs=np.empty(lanes),
        rows=np.empty(options + LANES, np.int64),
        ends=np.empty((SPEED + 1, options + LANES)),
        costs=np.empty(options + LANES),
        least=np.empty(options + AT_ONCE),
        rough=np.empty(options, np.bool_),
        sums=np.empty(terms),
        telling=np.zeros(1, np.int64),
        path=np.empty((3, SAMPLES)),
    )
