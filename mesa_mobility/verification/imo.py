"""IMO MSC.1/Circ.1533: the tests of level floors and stairs."""

from __future__ import annotations

from collections.abc import Sequence

from scipy import stats

from mesa_mobility.verification import judging, rimea, storeys
from mesa_mobility.verification.cases import Figures, case
from mesa_mobility.verification.checks import Verdict, at_most, less_than, within
from mesa_mobility.verification.references import bottleneck_envelope
from mesa_mobility.verification.scenarios import rooms, walks
from mesa_mobility.verification.scenarios.counterflow import counterflow
from mesa_mobility.verification.suite import VerificationTest

DESIGN_CAP = 1.33
"""Design limit of the flow through 1 m, persons a second; measured crowds exceed it."""

COUNTERFLOW = tuple(
    case(counterflow, effort=0.5 + 0.05 * opposing, opposing=opposing)
    for opposing in (0, 10, 50, 100)
)
ROOM_OF_100 = case(rooms.small_room, effort=2.0, people=100)
CORNER = case(rooms.corner, people=20, start_x=2.0, speed=1.0)

LOW, HIGH = rooms.MALES_30_TO_50


def exit_flow(runs: Sequence[Figures]) -> Verdict:
    """Flow within the measured range for openings of 1 m; the design limit is only reported."""
    flow = runs[0]["flow_per_s"]
    least, most = bottleneck_envelope(1.0)
    return Verdict(
        (
            *judging.everybody_out(runs),
            within("flow per s", flow, least, most),
            at_most("flow per s against the design cap", flow, DESIGN_CAP, gates=False),
        )
    )


def flow_at_high_density(runs: Sequence[Figures]) -> Verdict:
    """Specific flow at 4 to 6 persons/m2 below the highest at 1 to 3 persons/m2."""
    flows = {
        density: run["mean_speed"] * run["mean_density"]
        for density, run in zip(rimea.DENSITIES, runs, strict=True)
    }
    moderate = max(flow for density, flow in flows.items() if 1.0 <= density <= 3.0)
    high = max(flow for density, flow in flows.items() if density >= 4.0)
    return Verdict(
        (less_than("highest flow at 4 to 6/m2 per m s", high, moderate),),
        {"highest flow at 1 to 3/m2 per m s": moderate},
    )


TESTS = {
    "imo-01": VerificationTest(
        (case(walks.lone_walker, length=40.0, speed=1.0, measured_from=10.0, measured_to=30.0),),
        judge=judging.lone_walk((37.7, 43.5), 1.0),
    ),
    "imo-02": VerificationTest((storeys.climb(1.0, up=True),), judge=judging.climbs((1.0,))),
    "imo-03": VerificationTest((storeys.climb(1.0, up=False),), judge=judging.climbs((1.0,))),
    "imo-04": VerificationTest((ROOM_OF_100,), judge=exit_flow),
    "imo-05": rimea.TESTS["rimea-05"],
    "imo-06": VerificationTest((CORNER,), judge=judging.corner(60.0)),
    "imo-07": VerificationTest(
        (case(walks.uniform_speeds, effort=2.0, people=50, low=LOW, high=HIGH),),
        pooled=judging.speed_spread(stats.uniform(LOW, HIGH - LOW), 1.295, 0.188),
    ),
    "imo-08": VerificationTest(COUNTERFLOW, judge=judging.counterflow),
    "imo-09": rimea.TESTS["rimea-09"],
    "imo-10": rimea.TESTS["rimea-10"],
    "imo-11": VerificationTest((storeys.FOOT_OF_STAIR,), judge=storeys.jam_at_the_foot),
    "imo-12": VerificationTest(rimea.TRACKS, judge=flow_at_high_density, chart="corridor"),
}
