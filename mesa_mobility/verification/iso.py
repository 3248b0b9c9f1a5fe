"""ISO 20414: the tests of level floors and stairs that the other standards do not have."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from mesa_mobility.verification import judging
from mesa_mobility.verification.cases import Figures, case
from mesa_mobility.verification.checks import (
    Verdict,
    at_most,
    exactly,
    falling,
    more_than,
    rising,
    within,
)
from mesa_mobility.verification.scenarios import closures, halls
from mesa_mobility.verification.scenarios.buildings import stairs
from mesa_mobility.verification.suite import VerificationTest

PEOPLE = (60, 120, 240, 360, 480)
WIDTHS = (1.0, 1.2, 1.4, 1.6, 1.8)
"""Of stairs, metres."""
FREE_SPEED = 1.0
FASTER_BY = 0.05
"""Allowed excess over the assigned speed, m/s, as in the tests of lone walkers."""


def corridor_flow(runs: Sequence[Figures]) -> Verdict:
    """Speed falls with density; flow rises to a highest value and falls again."""
    speeds, flows = [run["speed"] for run in runs], [run["flow"] for run in runs]
    fastest = max((v for v in speeds if v is not None), default=None)
    return Verdict(
        (
            *judging.everybody_out(runs),
            falling("least fall of speed with density m/s", speeds),
            at_most("highest speed m/s", fastest, FREE_SPEED + FASTER_BY),
            more_than("highest flow less that at 0.5/m2 per m s", max(flows) - flows[0], 0.0),
            more_than("highest flow less that at 4/m2 per m s", max(flows) - flows[-1], 0.0),
        ),
        {
            **{f"v of {n} people m/s": v for n, v in zip(PEOPLE, speeds, strict=True)},
            **{f"J of {n} people per m s": j for n, j in zip(PEOPLE, flows, strict=True)},
            **{
                f"density of {n} people per m2": run["density"]
                for n, run in zip(PEOPLE, runs, strict=True)
            },
        },
    )


def shortest_way(runs: Sequence[Figures]) -> Verdict:
    """The near exit is taken, unless the way to it is longer or the far exit is assigned."""
    plain, screen, assigned = runs
    return Verdict(
        (
            exactly("near exit, clear way", plain["by_near"], 1),
            exactly("far exit, near one screened", screen["by_far"], 1),
            exactly("far exit, assigned", assigned["by_far"], 1),
        )
    )


def half_speed(runs: Sequence[Figures]) -> Verdict:
    """People cover ground on the stair at half their speed on a level floor, within 0.05 m/s."""
    return Verdict(
        tuple(
            within(f"speed {way} m/s", run["ground_mps"], 0.45, 0.55)
            for way, run in zip(("up", "down"), runs, strict=True)
        )
    )


HALF_SPEED: tuple[dict[str, Any], ...] = (
    {"up": True, "risers": 38, "riser": 0.18},
    {"up": False, "risers": 40, "riser": 0.22},
)
"""Stairs of 10 m in plan on which people cover half the ground that they do on a level floor."""


def flow_by_width(runs: Sequence[Figures]) -> Verdict:
    """The flow on a stair rises with its width."""
    flows = [run["flow_per_s"] for run in runs]
    return Verdict(
        (*judging.everybody_out(runs), rising("least rise of the flow with the width 1/s", flows)),
        {f"flow at {width:g} m 1/s": flow for width, flow in zip(WIDTHS, flows, strict=True)},
    )


TESTS = {
    "iso-03": VerificationTest(
        tuple(
            case(stairs.lone_climber, tread=10 / (steps["risers"] - 1), preferred=1.0, **steps)
            for steps in HALF_SPEED
        ),
        judge=half_speed,
    ),
    "iso-12": VerificationTest(
        tuple(
            case(
                stairs.down_from_a_room, effort=3.0, width=width, riser=0.22, tread=0.25, going=6.0
            )
            for width in WIDTHS
        ),
        judge=flow_by_width,
    ),
    "iso-13": VerificationTest(
        tuple(
            case(halls.full_corridor, effort=1.0 + n / 100, people=n, speed=FREE_SPEED)
            for n in PEOPLE
        ),
        judge=corridor_flow,
        chart="filled corridor",
    ),
    "iso-17": VerificationTest(
        (
            case(closures.shortest_way),
            case(closures.shortest_way, screen=True),
            case(closures.shortest_way, assigned="far"),
        ),
        judge=shortest_way,
    ),
}
