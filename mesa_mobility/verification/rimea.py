"""RiMEA 3.0 and 4.1.1: the tests of level floors."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy import stats

from mesa_mobility.distributions import Uniform
from mesa_mobility.populations import OFF_CURVE, WITHIN
from mesa_mobility.verification import judging
from mesa_mobility.verification.cases import Figures, case
from mesa_mobility.verification.checks import (
    Check,
    Verdict,
    at_least,
    at_most,
    exactly,
    falling,
    less_than,
    more_than,
    rising,
    within,
)
from mesa_mobility.verification.references import bottleneck_envelope, corridor_band
from mesa_mobility.verification.scenarios import (
    cabins,
    halls,
    necks,
    premovement,
    rooms,
    walks,
)
from mesa_mobility.verification.scenarios.tracks.single_file import CASES as SINGLE_FILE
from mesa_mobility.verification.scenarios.tracks.track import DENSITY_BIN, binned, track
from mesa_mobility.verification.suite import VerificationTest

DENSITIES = (0.5, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0)
TRACKS = tuple(
    case(
        track,
        effort=0.5 + 0.7 * density,
        density=density,
        width=2.0,
        speed=1.34,
        settle_s=10.0,
        measure_s=50.0,
    )
    for density in DENSITIES
)
LEAST_ENTRIES = 50
GOALS = (0.0, 2.0, 5.0, 10.0)
WIDTHS = (0.8, 1.0, 1.2)
LONG_NECK = case(necks.neck, effort=3.0, width=1.0, length=5.0, goal=10.0)
SHORT_NECK = case(necks.neck, effort=3.0, width=1.0, length=0.2, goal=10.0)


def fundamental_diagram(runs: Sequence[Figures]) -> Verdict:
    """Speed falls with density, and medians lie within the bands of the reference."""
    speeds = [run["mean_speed"] for run in runs]
    bins = binned(runs, LEAST_ENTRIES)
    low, _, high = corridor_band(bins["density"])
    outside = (bins["p50"] < low) | (bins["p50"] > high)
    figures = {f"v at {d:g}/m2": v for d, v in zip(DENSITIES, speeds, strict=True)}
    figures |= {
        f"J at {d:g}/m2": run["mean_speed"] * run["mean_density"]
        for d, run in zip(DENSITIES, runs, strict=True)
    }
    figures["bins outside"] = [float(d) for d in bins["density"][outside]]
    return Verdict(
        (
            falling("least fall of the mean speed m/s", speeds),
            exactly("bins outside the bands", int(outside.sum()), 0),
            at_least("bins compared", len(outside), 2.0 / DENSITY_BIN),
        ),
        figures,
    )


def starts_on_time(runs: Sequence[Figures]) -> Verdict:
    """People start within one decision period after their pre-movement time, never before it."""
    (room,) = runs
    late = [
        start - assigned
        for start, assigned in zip(room["started"], room["assigned"], strict=True)
        if start is not None
    ]
    return Verdict(
        (
            exactly("people who never started", len(room["started"]) - len(late), 0),
            at_least("earliest start after its time s", min(late, default=None), 0.0),
            at_most("latest start after its time s", max(late, default=None), 1.5),
            *judging.everybody_out(runs),
        )
    )


def speeds_by_age(seeds: Sequence[Sequence[Figures]]) -> Verdict:
    """People walk at their own speed, and speeds are distributed about the age curve as specified.

    The deviation from the curve in units of its standard deviation is normal, cut off where
    ``walking_speed`` truncates it: at three below, and at three above or the highest assigned
    speed.
    """
    walked, assigned, deviation, most = (
        np.array([v for (run,) in seeds for v in run[name]], dtype=np.float64)
        for name in ("walked_mps", "assigned_mps", "deviation", "most")
    )
    arrived = np.isfinite(walked)
    sd = OFF_CURVE.uncut.sd
    rank = stats.truncnorm.cdf(deviation[arrived] / sd, -WITHIN / sd, most[arrived] / sd)
    p_value = float(stats.kstest(rank, stats.uniform.cdf).pvalue)
    return Verdict(
        (
            exactly("walkers who did not arrive", int((~arrived).sum()), 0),
            at_most(
                "greatest error of a speed m/s", float(np.nanmax(np.abs(walked - assigned))), 0.03
            ),
            at_least("KS p", p_value, judging.KS_LEVEL),
            within("mean deviation from the curve sigma", float(np.nanmean(deviation)), -1.0, 1.0),
        )
    )


def two_exits(runs: Sequence[Figures]) -> Verdict:
    """Most leave by the nearer exit, some by the other."""
    (hall,) = runs
    count = hall["by_exit"]
    share = count["exit 1"] / hall["pedestrians"]
    other = count["exit 2"] / hall["pedestrians"]
    return Verdict(
        (
            *judging.everybody_out(runs),
            more_than("share of exit 1", share, 0.5),
            less_than("share of exit 1 at most", share, 1.0),
            more_than("share of exit 2", other, 0.0),
        )
    )


def jam_before_first(runs: Sequence[Figures]) -> Verdict:
    """The crowd forms in front of the first bottleneck, not the second."""
    (run,) = runs
    return Verdict(
        (
            *judging.everybody_out(runs),
            at_least(
                "flow of the neck less that of the exit per s",
                run["flow_per_s"][0] - run["flow_per_s"][1],
                0.0,
            ),
            more_than(
                "peak in front of the neck less that of the exit",
                run["peak"][0] - run["peak"][1],
                0.0,
            ),
        ),
        {
            "flow of the neck per s": run["flow_per_s"][0],
            "flow of the exit per s": run["flow_per_s"][1],
            "peak density in front of the neck per m2": run["peak"][0] / 6.0,
            "peak density in front of the exit per m2": run["peak"][1] / 6.0,
        },
    )


def goal_behind(seeds: Sequence[Sequence[Figures]]) -> Verdict:
    """A goal farther away takes longer to reach and leaves the flow through the neck as it is."""
    columns = list(zip(*seeds, strict=True))
    times = [judging.mean([run["egress_s"] for run in of]) for of in columns]
    flows = [judging.mean([run["flow_per_s"] for run in of]) for of in columns]
    known = [value for value in flows if value is not None]
    spread = None
    if len(known) == len(flows):
        spread = max(abs(value / float(np.mean(known)) - 1.0) for value in known)
    left = sum(run["left_inside"] for row in seeds for run in row)
    return Verdict(
        (
            exactly("left inside", left, 0),
            rising("least rise of the time with the distance s", times, strictly=False),
            at_most("greatest deviation of a flow from their mean", spread, 0.1),
        ),
        {
            **{f"time at a = {a:g} m s": time for a, time in zip(GOALS, times, strict=True)},
            **{f"flow at a = {a:g} m per s": flow for a, flow in zip(GOALS, flows, strict=True)},
        },
    )


def long_neck(seeds: Sequence[Sequence[Figures]]) -> Verdict:
    """People take longer through the long neck than through the short one."""
    short, long = (judging.mean([run["passed_s"] for run in of]) for of in zip(*seeds, strict=True))
    left = sum(run["left_inside"] for row in seeds for run in row)
    return Verdict(
        (exactly("left inside", left, 0), rising("long less short s", [short, long])),
        {"short neck s": short, "long neck s": long},
    )


def queues(runs: Sequence[Figures]) -> Verdict:
    """More people wait in front of the first opening than of the second."""
    (run,) = runs
    return Verdict(
        (
            exactly("through the first opening", run["through"][0], 150),
            exactly("through the second opening", run["through"][1], 150),
            more_than("peak of box 1 less that of box 2", run["peak"][0] - run["peak"][1], 0.0),
            more_than(
                "top 10 of box 1 less those of box 2", run["top_10"][0] - run["top_10"][1], 0.0
            ),
        ),
        {"peak box 1": run["peak"][0], "peak box 2": run["peak"][1]},
    )


def wider_neck(runs: Sequence[Figures]) -> Verdict:
    """Flow rises with width and agrees with measurements at openings of the same width."""
    flows = [run["flow_per_s"] for run in runs]
    checks: list[Check] = [
        *judging.everybody_out(runs),
        rising("least rise of flow with width per s", flows),
    ]
    for width, flow in zip(WIDTHS, flows, strict=True):
        checks.append(within(f"flow at {width:g} m per s", flow, *bottleneck_envelope(width)))
    return Verdict(tuple(checks))


def three_ways(runs: Sequence[Figures]) -> Verdict:
    """Short, round the corner, long: in this order."""
    times = {way: run["egress_s"] for way, run in zip(halls.WAYS, runs, strict=True)}
    ordered = [times["short"], times["corner"], times["long"]]
    return Verdict(
        (
            *judging.everybody_out(runs),
            rising("least step from short to corner to long s", ordered),
        ),
        {f"{way} s": time for way, time in times.items()},
    )


def single_file(seeds: Sequence[Sequence[Figures]]) -> Verdict:
    """Three quarters of the bins lie within the measured range."""
    bins = judging.single_file_bins([run for row in seeds for run in row])
    check, figures = judging.single_file_share(bins)
    return Verdict((check,), figures)


TESTS = {
    "rimea-01": VerificationTest(
        (case(walks.lone_walker, length=40.0, speed=1.33, measured_from=10.0, measured_to=30.0),),
        judge=judging.lone_walk((26.0, 34.0), 1.33),
    ),
    "rimea-04": VerificationTest(TRACKS, judge=fundamental_diagram, chart="corridor"),
    "rimea-05": VerificationTest(
        (case(premovement.late_starters, people=10, times=Uniform(10.0, 100.0)),),
        judge=starts_on_time,
    ),
    "rimea-06": VerificationTest(
        (case(rooms.corner, people=20, start_x=0.0, speed=1.2),), judge=judging.corner(60.0)
    ),
    "rimea-07": VerificationTest(
        (case(walks.speeds_by_age, effort=2.0, people=50, youngest=20.0, oldest=80.0),),
        pooled=speeds_by_age,
    ),
    "rimea-09": VerificationTest(
        (
            case(rooms.hall, effort=5.0, people=1000, exits=4),
            case(rooms.hall, effort=9.0, people=1000, exits=2),
        ),
        judge=judging.closed_exits,
    ),
    "rimea-10": VerificationTest((case(cabins.cabins),), judge=judging.allocated),
    "rimea-11": VerificationTest(
        (case(rooms.two_exits, effort=11.0, people=1000),), judge=two_exits
    ),
    "rimea-12": VerificationTest((case(necks.two_rooms, effort=3.0),), judge=jam_before_first),
    "rimea-12a": VerificationTest(
        tuple(case(necks.neck, effort=3.0, width=1.0, length=0.2, goal=goal) for goal in GOALS),
        pooled=goal_behind,
    ),
    "rimea-12b": VerificationTest((SHORT_NECK, LONG_NECK), pooled=long_neck),
    "rimea-12c": VerificationTest((case(necks.three_rooms, effort=3.0),), judge=queues),
    "rimea-12d": VerificationTest(
        tuple(case(necks.neck, effort=3.0, width=w, length=5.0, goal=10.0) for w in WIDTHS),
        judge=wider_neck,
    ),
    "rimea-15": VerificationTest(
        tuple(case(halls.wide_way, effort=5.0, way=way) for way in halls.WAYS), judge=three_ways
    ),
    "rimea-16": VerificationTest(SINGLE_FILE, pooled=single_file, chart="single file"),
}
