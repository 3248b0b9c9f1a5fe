"""The conditions that scenes stand for: density, speed and flow of the measured crowd.

A scene that has other conditions compares other things than it says. So each condition is a check
of its own, which fails the comparison.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from shapely import Polygon

from mesa_mobility.results import crossings, flow
from mesa_mobility.results.distances import View, compare
from mesa_mobility.results.tracks import Tracks
from mesa_mobility.verification.cases import Figures
from mesa_mobility.verification.checks import Check, within

NEAR = 0.8, 1.2
"""How many times as large as measured density and speed of a scene may be."""
NEAR_FLOW = 0.88, 1.12
UNITS = {"density": "1/m2", "speed": "m/s", "flow": "1/s"}


def condition_of(
    tracks: Tracks,
    area: Polygon,
    line: tuple[tuple[float, float], tuple[float, float]] | None = None,
    *,
    after: float = 0.0,
    until: float | None = None,
) -> Figures:
    """Mean ``density`` (1/m2) and ``speed`` over 1.5 s (m/s) of people in an area, and their
    ``flow`` over a line (1/s); None where there is nothing to measure.

    Args:
        tracks: the run.
        area: polygon, metres.
        line: both ends, metres; without it there is no flow.
        after: seconds from which on people count.
        until: seconds until which they count; to the end if None.
    """
    view = View(direction=(1.0, 0.0), area=area, after=after, until=until)
    found = compare(tracks, tracks, view, figures=["density", "speed"])
    values = {name: each.measured for name, each in found.distances.items()}
    if line is not None:
        times = crossings(view.of(tracks), *line).time
        rate = flow(times)
        values["flow"] = float("nan") if rate is None else rate
    return {name: value if np.isfinite(value) else None for name, value in values.items()}


def conditions(
    scene: str,
    runs: Sequence[Figures],
    measured: Mapping[str, float],
    **ranges: tuple[float, float],
) -> list[Check]:
    """Checks that a scene has the measured condition, in the median over its runs.

    Args:
        scene: its name.
        runs: with the figures of ``condition_of``.
        measured: density, speed or flow by name.
        ranges: times the measured value that are allowed, by name.
    """
    allowed = {"density": NEAR, "speed": NEAR, "flow": NEAR_FLOW, **ranges}
    checks = []
    for name, value in measured.items():
        low, high = (share * value for share in allowed[name])
        checks.append(
            within(
                f"condition of {scene}: {name} {UNITS[name]}",
                median([each[name] for each in runs]),
                low,
                high,
            )
        )
    return checks


def median(values: Sequence[float | None]) -> float | None:
    """Median over the seeds; None if one of them has no value."""
    known = [value for value in values if value is not None]
    return float(np.median(known)) if known and len(known) == len(values) else None
