"""What the options of a map let people do; ``mesa_mobility.examination`` tests what they cannot."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.mobility.map import MobilityMap
from mesa_mobility.mobility.standing.accelerations import is_gentle
from mesa_mobility.mobility.standing.ways_back import ON_THE_SPOT, TURN


def abilities_of(map_: MobilityMap) -> dict[str, Any]:
    """What the options of a map let people do.

    Returns:
        ``turn_on_the_spot_deg``: farthest turns to the left and to the right that somebody who
        stands makes within one option; ``first_step_m``: how far they get in 1.5 s;
        ``side_step_m``: farthest steps to the left and to the right;
        ``clusters_that_stop_at_once``: share of clusters with an option that ends standing.
        Turns and side steps count only if they start gently enough for the default preset. For
        ``first_step_m`` all options count.
    """
    ends, headings = map_.end_points, map_.end_headings
    standing = np.asarray(map_.options_of(map_.standing))
    gentle = standing[is_gentle(map_.durations[standing], map_.path_offsets[standing], map_.paths)]
    turns = headings[gentle][np.hypot(*ends[gentle].T) <= ON_THE_SPOT]
    ahead, aside = ends[gentle].T
    stepped = aside[(np.abs(ahead) <= np.abs(aside)) & (np.abs(headings[gentle]) <= TURN)]
    stops = np.logical_or.reduceat(map_.end_clusters == map_.standing, map_.offsets[:-1])
    return {
        "turn_on_the_spot_deg": _both_ways(np.rad2deg(turns), 1),
        "first_step_m": round(float(np.hypot(*ends[standing].T).max()), 2),
        "side_step_m": _both_ways(stepped, 2),
        "clusters_that_stop_at_once": round(float(stops.mean()), 3),
    }


def _both_ways(values: NDArray[np.floating], digits: int) -> list[float]:
    """How far to the left and how far to the right, both positive."""
    values = np.append(values, 0.0)
    return [round(float(values.max()), digits), round(float(-values.min()) + 0.0, digits)]
