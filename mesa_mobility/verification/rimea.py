"""RiMEA 3.0 and 4.1.1: the tests of a level floor."""

from __future__ import annotations

from mesa_mobility.verification import judging
from mesa_mobility.verification.cases import case
from mesa_mobility.verification.scenarios import rooms, walks
from mesa_mobility.verification.suite import VerificationTest

TESTS = {
    "rimea-01": VerificationTest(
        (case(walks.lone_walker, length=40.0, speed=1.33, measured_from=10.0, measured_to=30.0),),
        judge=judging.lone_walk((26.0, 34.0), 1.33),
    ),
    "rimea-06": VerificationTest(
        (case(rooms.corner, people=20, start_x=0.0, speed=1.2),), judge=judging.corner(60.0)
    ),
    "rimea-09": VerificationTest(
        (
            case(rooms.hall, effort=10.0, people=1000, exits=4, population="default"),
            case(rooms.hall, effort=20.0, people=1000, exits=2, population="default"),
        ),
        judge=judging.closed_exits,
    ),
}
