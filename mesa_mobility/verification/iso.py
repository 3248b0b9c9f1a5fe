"""ISO 20414: the tests of a level floor that the other standards do not have."""

from __future__ import annotations

from collections.abc import Sequence

from mesa_mobility.verification import judging
from mesa_mobility.verification.cases import Figures, case
from mesa_mobility.verification.checks import Verdict, at_most, exactly, falling, more_than
from mesa_mobility.verification.scenarios import closures, halls
from mesa_mobility.verification.suite import VerificationTest

PEOPLE = (60, 120, 240, 360, 480)
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


TESTS = {
    "iso-13": VerificationTest(
        tuple(
            case(halls.full_corridor, effort=1.0 + n / 100, people=n, speed=FREE_SPEED)
            for n in PEOPLE
        ),
        judge=corridor_flow,
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
