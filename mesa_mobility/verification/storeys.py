"""RiMEA 3.0 and 4.1.1: the tests of stairs and of several storeys."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from mesa_mobility.verification.cases import Case, Figures, case
from mesa_mobility.verification.checks import Verdict, at_least, exactly, falling, more_than
from mesa_mobility.verification.judging import climbs, everybody_out
from mesa_mobility.verification.references import STAIR_DENSITIES, stair_band
from mesa_mobility.verification.scenarios.buildings import stairs, storeys
from mesa_mobility.verification.suite import VerificationTest

STAIR: dict[str, Any] = {"risers": 28, "riser": 6.0 / 28.0, "tread": 8.0 / 27.0}
"""10 m along the slope."""
CLIMBS = (0.5, 0.7, 1.0)
"""Speeds on it, m/s."""
FOOT_OF_STAIR = case(stairs.up_from_a_corridor, effort=4.0, riser=0.2, tread=0.25)

SPEEDS = (0.5, 0.75, 1.0)
"""Preferred speeds that all people have, m/s."""

SPREADS = ((0.5, 1.0), (0.25, 1.25))
"""Least and greatest preferred speeds, m/s; the mean is that of the second of ``SPEEDS``."""


def climb(speed: float, *, up: bool) -> Case:
    """A case of one person on ``STAIR``, at this speed along the slope, m/s."""
    preferred = stairs.preferred_for(speed, up=up, **STAIR)
    return case(stairs.lone_climber, up=up, preferred=preferred, **STAIR)


def jam_at_the_foot(runs: Sequence[Figures]) -> Verdict:
    """The exit of the room jams, and a jam grows at the foot of the stair.

    A jam that begins at the foot grows along the corridor, and ends at the foot. So people spend
    more time at the foot than in the corridor, though the jam is as dense there once it has grown.
    """
    (run,) = runs
    door, foot = (
        None if name not in run else run[name] - run[other]
        for name, other in (("door_early", "middle_early"), ("foot_s", "middle_s"))
    )
    growth = run["foot_late"] - run["foot_early"] if "foot_late" in run else None
    excess = run["flow_in"] - run["flow_up"] if "flow_in" in run else None
    return Verdict(
        (
            *everybody_out(runs),
            more_than("density at the exit less that in the corridor, early 1/m2", door, 0.0),
            more_than("time at the foot less that in the corridor s", foot, 0.0),
            more_than("growth of the density at the foot 1/m2", growth, 0.0),
            more_than("flow into the corridor less that up the stair 1/s", excess, 0.0),
        ),
        {name: run[name] for name in ("flow_in", "flow_up") if name in run},
    )


def stair_diagram(seeds: Sequence[Sequence[Figures]]) -> Verdict:
    """Half of the speeds lie within the band of the reference, and people walk down faster."""
    checks, means = list(everybody_out([run for row in seeds for run in row])), []
    for way, runs in zip(("down", "up"), zip(*seeds, strict=True), strict=True):
        density, speed = measured_on_stairs(runs)
        low, high = stair_band(density, up=way == "up")
        share = float(np.mean((speed >= low) & (speed <= high))) if len(speed) else None
        checks += [
            more_than(f"speeds {way}", len(speed), 500),
            at_least(f"share of the speeds {way} within the band", share, 0.5),
        ]
        means.append(pd.Series(speed).groupby(np.round(density, 1)).mean())
    more = (means[0] - means[1]).dropna()
    least = float(more.min()) if len(more) else None
    checks += [
        at_least("densities that both have", len(more), 5),
        more_than("least speed down less that up m/s", least, 0.0),
    ]
    return Verdict(tuple(checks))


def measured_on_stairs(
    runs: Sequence[Figures],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Densities and speeds of some runs at which there are measured speeds on stairs."""
    density, speed = (np.concatenate([run[name] for run in runs]) for name in ("density", "along"))
    kept = (density >= STAIR_DENSITIES[0]) & (density <= STAIR_DENSITIES[1])
    return density[kept], speed[kept]


def times_by_speed(runs: Sequence[Figures]) -> Verdict:
    """Times to leave for each speed, and for each spread of speeds; the former must fall."""
    times = [run["egress_s"] for run in runs]
    names = [f"all at {speed} m/s" for speed in SPEEDS]
    names += [f"from {low} to {high} m/s" for low, high in SPREADS]
    return Verdict(
        (
            *everybody_out(runs),
            falling("least fall of the time with the speed s", times[: len(SPEEDS)]),
        ),
        {f"{name}: all out s": time for name, time in zip(names, times, strict=True)},
    )


def short_or_long(runs: Sequence[Figures]) -> Verdict:
    """Which way people take of their own accord, and that they take the other if it is closed."""
    free, closed = runs
    return Verdict(
        (
            *everybody_out(runs),
            exactly("over closed stairs", closed["over"], 0),
            exactly("round, of all, with closed stairs", closed["round"], closed["pedestrians"]),
            exactly("over or round, of all", free["over"] + free["round"], free["pedestrians"]),
        ),
        {
            "share over the stairs": free["over"] / free["pedestrians"],
            "all out s": free["egress_s"],
            "all out with closed stairs s": closed["egress_s"],
        },
    )


TESTS = {
    "rimea-02": VerificationTest(
        tuple(climb(speed, up=True) for speed in CLIMBS), judge=climbs(CLIMBS)
    ),
    "rimea-03": VerificationTest(
        tuple(climb(speed, up=False) for speed in CLIMBS), judge=climbs(CLIMBS)
    ),
    "rimea-08": VerificationTest(
        tuple(
            case(storeys.full_house, effort=6.0, low=low, high=high)
            for low, high in (*((speed, speed) for speed in SPEEDS), *SPREADS)
        ),
        judge=times_by_speed,
    ),
    "rimea-13": VerificationTest((FOOT_OF_STAIR,), judge=jam_at_the_foot),
    "rimea-13-speeds": VerificationTest(
        tuple(
            case(stairs.along_a_stair, effort=3.0, up=up, riser=0.17, tread=0.29)
            for up in (False, True)
        ),
        pooled=stair_diagram,
        chart="stairs",
    ),
    "rimea-14": VerificationTest(
        tuple(case(storeys.over_or_round, closed=closed) for closed in (False, True)),
        judge=short_or_long,
    ),
}
