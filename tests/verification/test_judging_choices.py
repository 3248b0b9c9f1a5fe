"""Verdicts on choices of exits and on groups made up by hand."""

import pytest

from mesa_mobility.verification import judging, nist, rimea, storeys
from tests.fixtures.verdicts import out, unmet


@pytest.mark.parametrize(
    ("two", "passes"), [(187.0, True), (169.0, False), (231.0, False), (None, False)]
)
def test_closing_two_of_four_exits_doubles_the_time(two, passes):
    assert judging.closed_exits([out(egress_s=100.0), out(egress_s=two)]).passed is passes


def two_exits(one: int, two: int) -> dict:
    return {"left_inside": 0, "pedestrians": 1000, "by_exit": {"exit 1": one, "exit 2": two}}


@pytest.mark.parametrize(
    ("one", "two", "passes"),
    [(700, 300, True), (1000, 0, False), (500, 500, False), (400, 600, False)],
)
def test_the_nearer_exit_is_preferred_and_not_the_only_one(one, two, passes):
    assert rimea.TESTS["rimea-11"].judge([two_exits(one, two)]).passed is passes


@pytest.mark.parametrize(
    ("main", "secondary", "astray", "passes"),
    [(15, 8, 0, True), (14, 8, 1, False), (15, 7, 0, False), (15, 8, 1, False)],
)
def test_allocated_exits(main, secondary, astray, passes):
    figures = {"to_main": main, "to_secondary": secondary, "astray": astray}
    assert judging.allocated([figures]).passed is passes


def test_an_exit_that_closes_is_left_for_the_other():
    judge = nist.TESTS["nist-4.1"].judge

    def run(one: int, two: int, x: float = 6.5, time: float | None = 10.0) -> list[dict]:
        return [{"by_exit_1": one, "by_exit_2": two, "x_when_closed": x, "egress_s": time}]

    assert judge(run(0, 1)).passed
    assert not judge(run(1, 0)).passed
    assert not judge(run(0, 0, time=None)).passed
    assert not judge(run(0, 1, x=5.9)).passed


def test_an_impaired_person_holds_others_up():
    judge = nist.TESTS["nist-2.10"].pooled

    def seed(without: float, with_one: float, overtakers: int) -> list[dict]:
        return [
            out(egress_s=without, overtaken_by=0),
            out(egress_s=with_one, overtaken_by=3),
            out(egress_s=30.0, overtaken_by=overtakers),
        ]

    assert judge([seed(33.0, 41.0, 18)]).passed
    assert not judge([seed(41.0, 40.9, 18)]).passed
    assert not judge([seed(33.0, 41.0, 0)]).passed


def test_a_group_stays_together_where_it_would_otherwise_part():
    judge = nist.TESTS["nist-2.9"].judge

    def runs(group: float | None, alone: float | None) -> list[dict]:
        return [out(spread_s=group), out(spread_s=alone)]

    assert judge(runs(10.0, 43.0)).passed
    assert not judge(runs(10.1, 43.0)).passed
    assert not judge(runs(None, 43.0)).passed
    assert not judge(runs(5.0, 9.0)).passed


def shares(*pairs: tuple[float, float], trials: int = 40) -> list[list[dict]]:
    return [[{"share": share, "trials": trials} for share in pair] for pair in pairs]


def test_another_persons_way_raises_the_share_of_its_exit():
    judge = nist.TESTS["nist-3.2"].pooled
    assert judge(shares((0.5, 0.8))).passed
    assert not judge(shares((0.5, 0.5))).passed
    # 40 fair coins: 0.5 +- 2.576 sqrt(0.25 / 40) = 0.296 to 0.704; of 400 only 0.436 to 0.564.
    assert judge(shares((0.30, 0.8))).passed
    assert not judge(shares((0.29, 0.8))).passed
    assert not judge(shares(*[(0.43, 0.8)] * 10)).passed
    assert judge(shares(*[(0.44, 0.8)] * 10)).passed


def test_those_who_know_the_far_exit_use_it_more():
    judge = nist.TESTS["nist-3.3"].pooled
    assert judge(shares((0.1, 0.2))).passed
    assert not judge(shares((0.2, 0.2))).passed


def test_the_time_to_leave_a_house_falls_with_the_speed():
    judge = storeys.TESTS["rimea-08"].judge
    times = [448.0, 358.0, 320.0, 372.0, 417.0]
    verdict = judge([out(egress_s=time) for time in times])
    assert verdict.passed
    assert verdict.measured["least fall of the time with the speed s"] == 38.0
    assert verdict.figures["from 0.25 to 1.25 m/s: all out s"] == 417.0
    times[2] = 358.0
    assert unmet(judge([out(egress_s=time) for time in times])) == [
        "least fall of the time with the speed s"
    ]


@pytest.mark.parametrize(
    ("free", "closed", "share", "wrong"),
    [
        ((20, 0), (0, 20), 1.0, []),
        ((5, 15), (0, 20), 0.25, []),
        ((20, 0), (1, 19), 1.0, ["over closed stairs", "round, of all, with closed stairs"]),
        ((19, 0), (0, 20), 0.95, ["over or round, of all"]),
    ],
)
def test_people_take_the_short_or_the_long_way(free, closed, share, wrong):
    runs = [
        out(pedestrians=20, over=over, round=round_, egress_s=35.0)
        for over, round_ in (free, closed)
    ]
    verdict = storeys.TESTS["rimea-14"].judge(runs)
    assert verdict.figures["share over the stairs"] == share
    assert unmet(verdict) == wrong
