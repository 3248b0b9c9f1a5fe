"""Free walking speeds of a type, as its map's metadata have them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from mesa_mobility.distributions import Clipped, Distribution, Normal
from mesa_mobility.errors import MapError
from mesa_mobility.mobility import MobilityMap

MEAN, DEVIATION = 1.34, 0.26
LEAST, MOST = 0.6, 2.0
ADULTS = Clipped(Normal(MEAN, DEVIATION), LEAST, MOST)
"""Weidmann (1993): 1.34 +- 0.26 m/s, within the range of recordings of walking adults."""

STEADY = "p75"
"""Quantile of recorded speeds that stands for a steady walk: clips are full of starts and turns."""

SLOWEST = 0.25
"""Least preferred speed of a type, as a share of its mean. Where published deviations are half the
mean, a normal curve reaches people who do not move."""


def free_speeds(mobility_map: MobilityMap) -> Distribution:
    """Distribution of the preferred speeds of people of a map, m/s.

    By the map's metadata, in this order:

    1. ``preferred_speed_m_s``: ``mean`` and ``standard_deviation`` of a published source, cut off
       as many deviations from the mean as those of adults are, and below a quarter of it. No
       preferred speed exceeds the ``p95`` of ``walking_speed_m_s``, if there is one.
    2. ``walking_speed_m_s``: quantiles of the recorded speeds. The distribution is that of adults,
       scaled to the steady walk that was recorded.
    3. Neither: that of adults.

    Raises:
        MapError: the metadata hold something else than speeds.
    """
    metadata = mobility_map.metadata
    recorded = _numbers(mobility_map, "walking_speed_m_s", metadata.get("walking_speed_m_s"))
    published = _numbers(mobility_map, "preferred_speed_m_s", metadata.get("preferred_speed_m_s"))
    if published:
        if "mean" not in published:
            raise _not_speeds(mobility_map, "preferred_speed_m_s", "a mean")
        return _about(published["mean"], published.get("standard_deviation", 0.0),
                      recorded.get("p95", np.inf))  # fmt: skip
    if STEADY in recorded:
        factor = recorded[STEADY] / MEAN
        return Clipped(Normal(MEAN * factor, DEVIATION * factor), LEAST * factor, MOST * factor)
    return ADULTS


def _about(mean: float, deviation: float, fastest: float) -> Distribution:
    """A normal distribution with the bounds of ``free_speeds``, m/s."""
    if (mean, deviation) == (MEAN, DEVIATION):
        return ADULTS
    least = max(mean + deviation * (LEAST - MEAN) / DEVIATION, SLOWEST * mean)
    most = min(mean + deviation * (MOST - MEAN) / DEVIATION, max(fastest, mean))
    return Clipped(Normal(mean, deviation), least, most)


def _numbers(mobility_map: MobilityMap, key: str, value: Any) -> dict[str, float]:
    """The entries that are speeds; others, such as the source, are left out."""
    if value is None:
        return {}
    if not isinstance(value, Mapping):
        raise _not_speeds(mobility_map, key, "an object of speeds")
    found = {}
    for name, entry in value.items():
        if isinstance(entry, str) or entry is None:
            continue
        least = 0.0 if name == "standard_deviation" else 1e-3
        if isinstance(entry, bool) or not isinstance(entry, int | float) or not (
            least <= entry <= 100.0
        ):  # fmt: skip
            raise _not_speeds(mobility_map, key, f"{name!r} of more than 0 and at most 100 m/s")
        found[name] = float(entry)
    return found


def _not_speeds(mobility_map: MobilityMap, key: str, expected: str) -> MapError:
    return MapError(
        f"mobility map of {mobility_map.pedestrian_type!r}: metadata {key!r}, expected {expected}"
    )
