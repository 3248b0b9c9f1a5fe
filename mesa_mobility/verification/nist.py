"""NIST Technical Note 1822: the tests of level floors, stairs and lifts."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy import stats

from mesa_mobility.distributions import Gamma, LogNormal, Uniform, Weibull
from mesa_mobility.verification import imo, judging, rimea
from mesa_mobility.verification.cases import Figures, case
from mesa_mobility.verification.checks import (
    Verdict,
    at_least,
    at_most,
    exactly,
    less_than,
    more_than,
    rising,
    within,
)
from mesa_mobility.verification.scenarios import (
    choices,
    closures,
    groups,
    impaired,
    premovement,
    stair_foot,
    walks,
)
from mesa_mobility.verification.scenarios.buildings import lifts, stairs
from mesa_mobility.verification.suite import VerificationTest

PRE_MOVEMENT = {
    "uniform": (Uniform(10.0, 100.0), stats.uniform(10.0, 90.0)),
    "gamma": (Gamma(1.291, 103.901), stats.gamma(1.291, scale=103.901)),
    "log-normal": (LogNormal(4.586, 0.967), stats.lognorm(0.967, scale=98.1013)),
    "Weibull": (Weibull(139.285, 1.195), stats.weibull_min(1.195, scale=139.285)),
}
"""Pre-movement distributions, ours and SciPy's; exp(4.586) = 98.1013."""

NARROW, WIDE = 1.2, 4.0
TRIALS = 40
_STEPS: dict[str, Any] = {"risers": 200, "riser": 0.22, "tread": math.sqrt(100**2 - 44**2) / 199}
LONG_STAIR = [
    {**_STEPS, "up": up, "preferred": stairs.preferred_for(1.0, up=up, **_STEPS)}
    for up in (True, False)
]
"""100 m along the slope, walked at 1 m/s."""

SLOW_CAR: dict[str, Any] = {"speed": 1.0, "door_s": 3.0}
FAST_CAR: dict[str, Any] = {"speed": 2.5, "door_s": 1.5}
RIDERS, CAPACITY = 10, 4
LATE_S = 0.3
"""Seconds by which a ride may end later or earlier than its numbers say."""
CHANGE_S = 8.0
"""Seconds that people may take to get out of a car and into it, beyond those that it stays open."""


def lift_usage(runs: Sequence[Figures]) -> Verdict:
    """People get out at the level to which they have to go, after as many rides as the capacity
    asks for, each as long as doors and speed say."""
    *lone, many = runs
    there_and_back = 2.0 * lifts.way_s(1, **SLOW_CAR) + lifts.OPEN_S
    return Verdict(
        (
            *judging.everybody_out(runs),
            exactly("people on a wrong level", sum(run["elsewhere"] for run in runs), 0),
            *(
                within(
                    f"arrival {k} s",
                    run["arrived_s"],
                    run["expected_s"] - LATE_S,
                    run["expected_s"] + LATE_S,
                )
                for k, run in enumerate(lone, 1)
            ),
            exactly("rides of many", many["rides"], math.ceil(RIDERS / CAPACITY)),
            exactly("most people of a ride", many["most"], CAPACITY),
            at_least(
                "least time between rides s", min(many["between_s"], default=None), there_and_back
            ),
            at_most(
                "greatest time between rides s",
                max(many["between_s"], default=None),
                there_and_back + CHANGE_S,
            ),
        )
    )


def impaired_person(seeds: Sequence[Sequence[Figures]]) -> Verdict:
    """The impaired person holds the others up in the narrow passage; in the wide one they pass."""
    control, narrow, wide = zip(*seeds, strict=True)
    times = [judging.mean([run["egress_s"] for run in of]) for of in (control, narrow)]
    overtakers = judging.mean([run["overtaken_by"] for run in wide])
    left = sum(run["left_inside"] for row in seeds for run in row)
    return Verdict(
        (
            exactly("left inside", left, 0),
            rising("T with the impaired person less T without s", times),
            at_least("people who overtake where it is wide", overtakers, 1.0),
        ),
        {
            "T without s": times[0],
            "T with s": times[1],
            "people who overtake where it is narrow": judging.mean(
                [run["overtaken_by"] for run in narrow]
            ),
        },
    )


def other_exit(runs: Sequence[Figures]) -> Verdict:
    """Heads for exit 1 until that closes, and leaves by exit 2."""
    (run,) = runs
    return Verdict(
        (
            exactly("by exit 2", run["by_exit_2"], 1),
            exactly("by exit 1", run["by_exit_1"], 0),
            at_least("x when exit 1 closes m", run["x_when_closed"], 6.1),
            less_than("out after s", run["egress_s"], 60.0),
        )
    )


def social_influence(seeds: Sequence[Sequence[Figures]]) -> Verdict:
    """A lone person takes both exits equally often; another heading for exit 2 attracts it."""
    alone, other, trials = _shares(seeds)
    # The range of 99 of 100 fair coins in as many throws.
    spread = 2.576 * (0.25 / trials) ** 0.5
    return Verdict(
        (
            within("share of exit 2 alone", alone, 0.5 - spread, 0.5 + spread),
            more_than("rise of the share of exit 2", other - alone, 0.0),
        ),
        {"share of exit 2 with another": other, "trials": trials},
    )


def familiarity(seeds: Sequence[Sequence[Figures]]) -> Verdict:
    """People who know the far exit use it more often."""
    unknown, known, trials = _shares(seeds)
    return Verdict(
        (more_than("rise of the share of the far exit", known - unknown, 0.0),),
        {"share unknown": unknown, "share known": known, "trials": trials},
    )


def _shares(seeds: Sequence[Sequence[Figures]]) -> tuple[float, float, int]:
    """Share of exit 2 in either case over all seeds, and how many trials each is of."""
    first, second = (
        float(np.mean([run["share"] for run in of])) for of in zip(*seeds, strict=True)
    )
    return first, second, sum(row[0]["trials"] for row in seeds)


def group_together(runs: Sequence[Figures]) -> Verdict:
    """The group arrives together; without it, the fast ones would have run away."""
    group, alone = runs
    return Verdict(
        (
            *judging.everybody_out(runs),
            at_most("spread of the group's arrivals s", group["spread_s"], 10.0),
            more_than("spread of the same people on their own s", alone["spread_s"], 10.0),
        )
    )


def jams(runs: Sequence[Figures]) -> Verdict:
    """Densest at the neck, and at the foot of the slow stretch once there is one."""
    plain, slow = runs
    return Verdict(
        (
            *judging.everybody_out(runs),
            more_than(
                "peak at the neck less that in the corridor per m2",
                plain["neck"] - plain["corridor"],
                0.0,
            ),
            more_than(
                "slow stretch: peak at the neck less that beyond its foot per m2",
                slow["neck"] - slow["corridor"],
                0.0,
            ),
            more_than(
                "5 s peak at its foot with the slow stretch less without per m2",
                slow["foot_5_s"] - plain["foot_5_s"],
                0.0,
            ),
        ),
        {
            **{f"{name} per m2": plain[name] for name in ("neck", "corridor", "foot")},
            **{f"slow stretch: {name} per m2": slow[name] for name in ("neck", "corridor", "foot")},
        },
    )


TESTS = {
    "nist-1.1": VerificationTest(
        tuple(
            case(premovement.late_starters, effort=3.0, people=10, times=times)
            for times, _ in PRE_MOVEMENT.values()
        ),
        pooled=judging.starts_follow(
            list(PRE_MOVEMENT), [reference for _, reference in PRE_MOVEMENT.values()]
        ),
    ),
    "nist-2.1": VerificationTest(
        (case(walks.lone_walker, length=60.0, speed=1.0, measured_from=10.0, measured_to=50.0),),
        judge=judging.lone_walk((56.7, 64.6), 1.0),
    ),
    "nist-2.2": VerificationTest(
        tuple(case(stairs.lone_climber, effort=2.0, **each) for each in LONG_STAIR),
        judge=judging.climbs((1.0, 1.0), ("up", "down")),
    ),
    "nist-2.3": VerificationTest((imo.CORNER,), judge=judging.corner(60.0)),
    "nist-2.4": VerificationTest(
        (case(walks.normal_speeds, effort=2.0, people=100, mean=1.2, sd=0.2),),
        pooled=judging.speed_spread(stats.norm(1.2, 0.2), 1.2, 0.2),
    ),
    "nist-2.7": VerificationTest(
        (
            case(lifts.one_rider, car=1, start=1, goal=0, **SLOW_CAR),
            case(lifts.one_rider, car=0, start=1, goal=2, **SLOW_CAR),
            case(lifts.one_rider, car=2, start=0, goal=2, **FAST_CAR),
            case(lifts.many_riders, people=RIDERS, capacity=CAPACITY, **SLOW_CAR),
        ),
        judge=lift_usage,
    ),
    "nist-2.8": VerificationTest(imo.COUNTERFLOW, judge=judging.counterflow),
    "nist-2.9": VerificationTest(
        (case(groups.group_behind, together=True), case(groups.group_behind, together=False)),
        judge=group_together,
    ),
    "nist-2.10": VerificationTest(
        (
            case(impaired.passage, width=NARROW, impaired=False),
            case(impaired.passage, width=NARROW, impaired=True),
            case(impaired.passage, width=WIDE, impaired=True),
        ),
        pooled=impaired_person,
    ),
    "nist-3.1": rimea.TESTS["rimea-10"],
    "nist-3.2": VerificationTest(
        (
            case(choices.influenced, effort=2.0, trials=TRIALS, other=False),
            case(choices.influenced, effort=2.0, trials=TRIALS, other=True),
        ),
        pooled=social_influence,
    ),
    "nist-3.3": VerificationTest(
        (
            case(choices.familiar, trials=TRIALS // 2, knows=False),
            case(choices.familiar, trials=TRIALS // 2, knows=True),
        ),
        pooled=familiarity,
    ),
    "nist-4.1": VerificationTest((case(closures.closing_exit),), judge=other_exit),
    "nist-5.1": VerificationTest(
        (case(stair_foot.into_corridor, slow=False), case(stair_foot.into_corridor, slow=True)),
        judge=jams,
    ),
    "nist-5.2": VerificationTest((imo.ROOM_OF_100,), judge=imo.exit_flow),
}
