"""Verdicts on walks, starts and speeds made up by hand."""

import numpy as np
import pytest
from scipy import stats

from mesa_mobility.verification import imo, iso, judging, nist, rimea, storeys
from tests.fixtures.verdicts import out, unmet


def walk(time: float | None, speed: float | None, low: float = 0.5, high: float = 1.5) -> dict:
    return {"egress_s": time, "speed_mps": speed, "least_y_m": low, "greatest_y_m": high}


@pytest.mark.parametrize(
    ("figures", "wrong"),
    [
        (walk(30.0, 1.33), []),
        (walk(25.9, 1.33), ["travel time s"]),
        (walk(34.1, 1.33), ["travel time s"]),
        (walk(None, None), ["travel time s", "speed m/s"]),
        (walk(30.0, 1.26), ["speed m/s"]),
        (walk(30.0, 1.40), ["speed m/s"]),
        (walk(30.0, 1.33, low=-0.01), ["least y m"]),
        (walk(30.0, 1.33, high=2.01), ["greatest y m"]),
    ],
)
def test_rimea_1(figures, wrong):
    assert unmet(rimea.TESTS["rimea-01"].judge([figures])) == wrong


def corner(left: int = 0, outside: int = 0, time: float | None = 30.0) -> dict:
    return {"left_inside": left, "points_outside": outside, "egress_s": time}


@pytest.mark.parametrize(
    ("figures", "wrong"),
    [
        (corner(), []),
        (corner(outside=1), ["points outside"]),
        (corner(time=60.0), ["all out s"]),
        (corner(left=1, time=None), ["left inside", "all out s"]),
    ],
)
def test_corner(figures, wrong):
    assert unmet(rimea.TESTS["rimea-06"].judge([figures])) == wrong


def climbed(speed: float | None, left: int = 0) -> dict:
    return {"left_inside": left, "speed_mps": speed, "ground_mps": speed}


@pytest.mark.parametrize(
    ("speeds", "wrong"),
    [
        ([0.5, 0.7, 1.0], []),
        ([0.526, 0.7, 1.0], ["speed where 0.5 m/s is set m/s"]),
        ([0.5, 0.664, 1.051], ["speed where 0.7 m/s is set m/s", "speed where 1 m/s is set m/s"]),
        ([0.5, None, 1.0], ["speed where 0.7 m/s is set m/s"]),
    ],
)
@pytest.mark.parametrize("name", ["rimea-02", "rimea-03"])
def test_climbs(speeds, wrong, name):
    assert unmet(storeys.TESTS[name].judge([climbed(speed) for speed in speeds])) == wrong


def test_somebody_who_is_still_on_the_stair_fails():
    assert unmet(imo.TESTS["imo-02"].judge([climbed(1.0, left=1)])) == ["left inside"]
    assert unmet(nist.TESTS["nist-2.2"].judge([climbed(0.96), climbed(0.94)])) == ["speed down m/s"]


def test_half_speed_on_stairs():
    judge = iso.TESTS["iso-03"].judge
    assert judge([climbed(0.451), climbed(0.549)]).passed
    assert unmet(judge([climbed(0.44), climbed(0.5)])) == ["speed up m/s"]
    assert unmet(judge([climbed(0.5), climbed(0.56)])) == ["speed down m/s"]


def spread(walked: np.ndarray) -> list[list[dict]]:
    return [[{"walked_mps": walked.tolist(), "assigned_mps": walked.tolist()}]]


def test_speeds_of_the_distribution_pass_and_others_do_not():
    judge = nist.TESTS["nist-2.4"].pooled
    # Quantiles of the distribution itself.
    exact = stats.norm(1.2, 0.2).ppf((np.arange(500) + 0.5) / 500)
    assert judge(spread(exact)).passed
    assert unmet(judge(spread(exact + 0.06))) == ["mean m/s", "KS p"]
    assert "sd m/s" in unmet(judge(spread(1.2 + 1.3 * (exact - 1.2))))
    lost = exact.copy()
    lost[0] = np.nan
    assert unmet(judge(spread(lost))) == ["walkers who did not arrive"]


def late(*pairs: tuple[float | None, float], left: int = 0) -> list[dict]:
    started, assigned = zip(*pairs, strict=True)
    return [{"started": list(started), "assigned": list(assigned), "left_inside": left}]


def test_starts_are_on_time_within_a_decision_period():
    judge = rimea.TESTS["rimea-05"].judge
    assert judge(late((10.3, 10.0), (51.5, 50.0))).passed
    assert unmet(judge(late((10.3, 10.0), (51.6, 50.0)))) == ["latest start after its time s"]
    assert unmet(judge(late((9.9, 10.0)))) == ["earliest start after its time s"]
    assert unmet(judge(late((10.3, 10.0), (None, 50.0)))) == ["people who never started"]


def test_starts_follow_their_distribution():
    judge = judging.starts_follow(["uniform"], [stats.uniform(10, 90)])
    times = np.linspace(11, 99, 50)
    good = [[{"started": (times + 0.3).tolist(), "assigned": times.tolist()}]]
    assert judge(good).passed
    bunched = [[{"started": (times / 2).tolist(), "assigned": (times / 2).tolist()}]]
    assert unmet(judge(bunched)) == ["uniform: KS p"]


def test_speeds_by_age():
    judge = rimea.TESTS["rimea-07"].pooled
    deviation = stats.norm.ppf((np.arange(50) + 0.5) / 50)
    walked = np.full(50, 1.3)

    def run(error: float, shift: float) -> list[list[dict]]:
        return [
            [
                {
                    "walked_mps": walked.tolist(),
                    "assigned_mps": (walked + error).tolist(),
                    "deviation": (deviation + shift).tolist(),
                    "most": [3.0] * 50,
                }
            ]
        ]

    assert judge(run(0.029, 0.0)).passed
    assert unmet(judge(run(0.031, 0.0))) == ["greatest error of a speed m/s"]
    assert unmet(judge(run(0.0, 0.5))) == ["KS p"]
    assert "mean deviation from the curve sigma" in unmet(judge(run(0.0, 1.1)))


def test_the_way_round_the_corner_lies_between_the_others():
    judge = rimea.TESTS["rimea-15"].judge

    def ways(long: float, corner: float, short: float) -> list[dict]:
        return [out(egress_s=long), out(egress_s=corner), out(egress_s=short)]

    assert judge(ways(90.0, 80.0, 60.0)).passed
    assert not judge(ways(90.0, 91.0, 60.0)).passed
    assert not judge(ways(90.0, 60.0, 60.0)).passed


def test_the_shortest_way():
    judge = iso.TESTS["iso-17"].judge

    def run(near: int, far: int) -> dict:
        return {"by_near": near, "by_far": far}

    assert judge([run(1, 0), run(0, 1), run(0, 1)]).passed
    assert not judge([run(0, 1), run(0, 1), run(0, 1)]).passed
    assert not judge([run(1, 0), run(1, 0), run(0, 1)]).passed
    assert not judge([run(1, 0), run(0, 1), run(1, 0)]).passed
