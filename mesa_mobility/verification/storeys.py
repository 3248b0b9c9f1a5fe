"""RiMEA 3.0: the tests of several storeys, which ask to document what the model does."""

from __future__ import annotations

from collections.abc import Sequence

from mesa_mobility.verification.cases import Figures, case
from mesa_mobility.verification.checks import Verdict, exactly, falling
from mesa_mobility.verification.judging import everybody_out
from mesa_mobility.verification.scenarios.buildings import storeys
from mesa_mobility.verification.suite import VerificationTest

SPEEDS = (0.5, 0.75, 1.0)
"""Preferred speeds that all people have, m/s."""

SPREADS = ((0.5, 1.0), (0.25, 1.25))
"""Least and greatest preferred speeds, m/s; the mean is that of the second of ``SPEEDS``."""


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
    "rimea-08": VerificationTest(
        tuple(
            case(storeys.full_house, effort=6.0, low=low, high=high)
            for low, high in (*((speed, speed) for speed in SPEEDS), *SPREADS)
        ),
        judge=times_by_speed,
    ),
    "rimea-14": VerificationTest(
        tuple(case(storeys.over_or_round, closed=closed) for closed in (False, True)),
        judge=short_or_long,
    ),
}
