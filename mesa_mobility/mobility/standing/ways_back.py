"""No map may trap anybody: ways back to standing, and to turning on the spot."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.errors import MapError
from mesa_mobility.mobility.map_data import MapData

ON_THE_SPOT = 0.5
"""Somebody whose option ends within so many metres has stayed on the spot."""

TURN = np.deg2rad(30.0)
"""Turning by less within one option is none: the pelvis swings, and edits turn people by 20."""


def check_ways_back(map_: MapData) -> None:
    """Check that nobody can be trapped.

    From each cluster, options lead to standing in the end, and a stander can turn on the spot
    either way.

    Raises:
        MapError: naming the clusters that do not lead back, or the turn that is missing.
    """
    back = leads_back(map_.offsets, map_.end_clusters, map_.standing)
    if not back.all():
        lost = np.flatnonzero(~back)
        others = f" and {len(lost) - 1} others" if len(lost) > 1 else ""
        raise MapError(
            f"cluster {lost[0]}{others} of {map_.n_clusters} never leads to standing: expected "
            "recordings in which people also stop, or clips of type 'standing' beside them"
        )
    rows = np.asarray(map_.options_of(map_.standing))
    rows = rows[np.hypot(*map_.end_points[rows].T) <= ON_THE_SPOT]
    turns = map_.end_headings[rows]
    for side, turned in (("left", turns.max(initial=0.0)), ("right", 0.0 - turns.min(initial=0.0))):
        if turned < TURN:
            raise MapError(
                f"standers turn on the spot to the {side} by {np.rad2deg(turned):.0f} degrees at "
                f"most, expected {np.rad2deg(TURN):.0f}: expected recordings of people who turn "
                "both ways, or clips of type 'standing' beside them"
            )


def leads_back(
    offsets: NDArray[np.int64], end_clusters: NDArray[np.integer], standing: int
) -> NDArray[np.bool_]:
    """Whether options lead from each cluster to the standing one, one after another.

    Args:
        offsets: (k + 1,) options of cluster c are ``offsets[c]:offsets[c + 1]``, at least one.
        end_clusters: (m,) cluster in which each option ends.
        standing: the standing cluster.

    Returns:
        (k,) true where they do.
    """
    leads = np.zeros(len(offsets) - 1, dtype=bool)
    leads[standing] = True
    while True:
        more = leads | np.logical_or.reduceat(leads[end_clusters], offsets[:-1])
        if (more == leads).all():
            return leads
        leads = more
