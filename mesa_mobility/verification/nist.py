"""NIST Technical Note 1822: the tests of a level floor."""

from __future__ import annotations

from scipy import stats

from mesa_mobility.verification import imo, judging
from mesa_mobility.verification.cases import case
from mesa_mobility.verification.scenarios import walks
from mesa_mobility.verification.suite import VerificationTest

TESTS = {
    "nist-2.1": VerificationTest(
        (case(walks.lone_walker, length=60.0, speed=1.0, measured_from=10.0, measured_to=50.0),),
        judge=judging.lone_walk((56.7, 64.6), 1.0),
    ),
    "nist-2.3": VerificationTest((imo.CORNER,), judge=judging.corner(60.0)),
    "nist-2.4": VerificationTest(
        (case(walks.normal_speeds, effort=2.0, people=100, mean=1.2, sd=0.2),),
        pooled=judging.speed_spread(stats.norm(1.2, 0.2), 1.2, 0.2),
    ),
    "nist-2.8": VerificationTest(imo.COUNTERFLOW, judge=judging.counterflow),
    "nist-5.2": VerificationTest((imo.ROOM_OF_100,), judge=imo.exit_flow),
}
