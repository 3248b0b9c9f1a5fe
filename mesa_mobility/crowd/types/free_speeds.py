"""Free walking speeds of a type, as its map's metadata have them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from mesa_mobility.crowd.options.table import FRAMES_A_SECOND
from mesa_mobility.distributions import Constant, Distribution, TruncatedNormal
from mesa_mobility.errors import MapError, ModelError
from mesa_mobility.mobility import MobilityMap

MEAN, DEVIATION = 1.34, 0.26
LEAST, MOST = 0.6, 2.0
ADULTS = TruncatedNormal(MEAN, DEVIATION, LEAST, MOST)
"""Weidmann (1993): 1.34 +- 0.26 m/s, within the range of recordings of walking adults."""

STEADY = "p75"
"""Quantile of recorded speeds that stands for a steady walk: clips are full of starts and turns."""

SLOWEST = 0.05
"""Least preferred speed where no source states one, m/s: the slowest at which people get anywhere.
Where deviations are half the mean, a normal curve reaches people who do not move."""


def free_speeds(mobility_map: MobilityMap) -> Distribution:
    """Distribution of the preferred speeds of people of a map, m/s.

    By the map's metadata, in this order:

    1. ``preferred_speed_m_s``: ``mean`` and ``standard_deviation`` of a published source, and
       ``least`` and ``most``, the speeds of the slowest and the fastest who were measured.
    2. ``walking_speed_m_s``: quantiles of the recorded speeds. Mean and deviation are those of
       adults, scaled to the steady walk that was recorded.
    3. Neither: those of adults.

    The distribution is normal, with this mean and deviation within its bounds. These are ``least``
    and ``most``. Without them they lie as many deviations from the mean as those of adults do, but
    not below ``SLOWEST``. Nobody prefers more than the fastest option of the map reaches. Where
    the fastest option is too slow for any distribution with this mean and deviation, it is no
    bound: people then walk as fast as they can.

    The mean is always that of the source. Within ``least`` and ``most``, a deviation that is too
    large for them is the largest that they allow. Few people were measured, and no normal
    distribution is as wide as they were.

    Raises:
        MapError: the metadata hold something else than speeds, a mean that is not between
            ``least`` and ``most``, one of these alone, or without them a deviation that is too
            large for positive speeds with this mean.
    """
    metadata = mobility_map.metadata
    recorded = _numbers(mobility_map, "walking_speed_m_s", metadata.get("walking_speed_m_s"))
    published = _numbers(mobility_map, "preferred_speed_m_s", metadata.get("preferred_speed_m_s"))
    if published:
        if "mean" not in published:
            raise _not_speeds(mobility_map, "preferred_speed_m_s", "a mean")
        if ("least" in published) != ("most" in published):
            raise _not_speeds(mobility_map, "preferred_speed_m_s", "'least' and 'most' together")
        extremes = (published["least"], published["most"]) if "least" in published else None
        deviation = published.get("standard_deviation", 0.0)
        return _about(published["mean"], deviation, extremes, mobility_map)
    if STEADY in recorded:
        factor = recorded[STEADY] / MEAN
        return _about(MEAN * factor, DEVIATION * factor, None, mobility_map)
    return ADULTS


def _about(
    mean: float,
    deviation: float,
    extremes: tuple[float, float] | None,
    mobility_map: MobilityMap,
) -> Distribution:
    """A normal distribution within the bounds of ``free_speeds``, m/s."""
    if deviation == 0.0:
        return Constant(mean)
    steps = np.hypot(*mobility_map.end_points.T)
    fastest = float((steps / mobility_map.durations).max()) * FRAMES_A_SECOND
    # Those whose mean is near the least are slower still.
    least, most = extremes or (
        max(mean - deviation * (MEAN - LEAST) / DEVIATION, min(SLOWEST, mean / 4.0)),
        mean + deviation * (MOST - MEAN) / DEVIATION,
    )
    try:
        return TruncatedNormal(mean, deviation, least, min(most, fastest))
    except ModelError:
        pass
    within = TruncatedNormal.nearest if extremes else TruncatedNormal
    try:
        return within(mean, deviation, least, most)
    except ModelError as error:
        raise MapError(f"{_where(mobility_map, 'preferred_speed_m_s')}, {error}") from None


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
        if (
            isinstance(entry, bool)
            or not isinstance(entry, int | float)
            or not (least <= entry <= 100.0)
        ):
            raise _not_speeds(mobility_map, key, f"{name!r} of more than 0 and at most 100 m/s")
        found[name] = float(entry)
    return found


def _not_speeds(mobility_map: MobilityMap, key: str, expected: str) -> MapError:
    return MapError(f"{_where(mobility_map, key)}, expected {expected}")


def _where(mobility_map: MobilityMap, key: str) -> str:
    return f"mobility map of {mobility_map.pedestrian_type!r}: metadata {key!r}"
