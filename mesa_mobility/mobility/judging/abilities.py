"""What the people of a map can do, and what they cannot."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.mobility.map import MobilityMap
from mesa_mobility.mobility.ways_back import ON_THE_SPOT, TURN

SIDE_STEP = 0.15
"""Metres to the side, and at most as far forwards, of an option that is a side step."""

FEW_OPTIONS = 100
"""Options a cluster (median) below which a crowd gets stuck; see the decision record on maps."""


def abilities_of(map_: MobilityMap) -> dict[str, Any]:
    """What the options of a map let people do.

    Returns:
        ``turn_on_the_spot_deg``: farthest turns to the left and to the right of a stander
        within one option; ``first_step_m``: how far a stander gets in 1.5 s;
        ``side_step_m``: farthest steps to the left and to the right;
        ``clusters_that_stop_at_once``: share of clusters with an option that ends standing;
        ``warnings``: what will not serve a crowd, one line each.
    """
    ends, headings = map_.end_points, map_.end_headings
    standing = np.asarray(map_.options_of(map_.standing))
    turns = headings[standing][np.hypot(*ends[standing].T) <= ON_THE_SPOT]
    ahead, aside = ends[standing].T
    stepped = aside[(np.abs(ahead) <= np.abs(aside)) & (np.abs(headings[standing]) <= TURN)]
    stops = np.logical_or.reduceat(map_.end_clusters == map_.standing, map_.offsets[:-1])
    found = {
        "turn_on_the_spot_deg": _both_ways(np.rad2deg(turns), 1),
        "first_step_m": round(float(np.hypot(*ends[standing].T).max()), 2),
        "side_step_m": _both_ways(stepped, 2),
        "clusters_that_stop_at_once": round(float(stops.mean()), 3),
    }
    return {**found, "warnings": _warnings(map_, found)}


def _both_ways(values: NDArray[np.floating], digits: int) -> list[float]:
    """How far to the left and how far to the right, both positive."""
    values = np.append(values, 0.0)
    return [round(float(values.max()), digits), round(float(-values.min()) + 0.0, digits)]


def _warnings(map_: MobilityMap, found: dict[str, Any]) -> list[str]:
    warnings = []
    for side, metres in zip(("left", "right"), found["side_step_m"], strict=True):
        if metres < SIDE_STEP:
            warnings.append(f"nobody steps to the {side}: people line up with doors by turning")
    median = float(np.median(np.diff(map_.offsets)))
    if median < FEW_OPTIONS:
        warnings.append(
            f"{median:g} options a cluster (median), {FEW_OPTIONS} are wanted: "
            "people of this map may get stuck in a crowd"
        )
    return warnings
