"""Verdicts on measurements made up by hand: they pass and fail where they should."""

import numpy as np
import pytest
from scipy import stats

from mesa_mobility.verification import imo, iso, judging, nist, rimea


def unmet(verdict) -> list[str]:
    return [check.figure for check in verdict.checks if check.gates and not check.met]


def out(**figures: object) -> dict:
    return {"left_inside": 0, **figures}


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


@pytest.mark.parametrize(("flow", "passes"), [(1.9, True), (1.70, False), (2.78, False)])
def test_flow_through_1_m_is_judged_by_experiments(flow, passes):
    verdict = imo.TESTS["imo-04"].judge([out(flow_per_s=flow)])
    assert verdict.passed is passes
    cap = next(check for check in verdict.checks if "cap" in check.figure)
    assert not cap.gates
    assert not cap.met


def test_flow_below_the_design_cap_meets_it():
    verdict = imo.TESTS["imo-04"].judge([out(flow_per_s=1.3)])
    assert next(check for check in verdict.checks if "cap" in check.figure).met


def crossing(time: float | None, entered: int = 100, left: int = 0) -> dict:
    return {"last_entered_s": time, "entered": entered, "left_inside": left}


def test_counterflow_passes_when_each_takes_longer():
    times = [50.0, 75.0, 106.9, 136.1]
    verdict = judging.counterflow([crossing(time) for time in times])
    assert verdict.passed
    # FDS+Evac's own times give its own ratios.
    assert verdict.figures["T10/T0"] == pytest.approx(1.5)
    assert verdict.figures["T50/T0"] == pytest.approx(2.138)
    assert verdict.figures["T100/T0"] == pytest.approx(2.722)


@pytest.mark.parametrize(
    "runs",
    [
        [crossing(50.0), crossing(75.0), crossing(74.9), crossing(136.1)],
        [crossing(50.0), crossing(75.0), crossing(106.9), crossing(None, entered=99)],
        [crossing(50.0), crossing(75.0), crossing(106.9), crossing(136.1, left=1)],
    ],
)
def test_counterflow_fails_out_of_order_and_when_people_are_stuck(runs):
    assert not judging.counterflow(runs).passed


@pytest.mark.parametrize(
    ("two", "passes"), [(187.0, True), (169.0, False), (231.0, False), (None, False)]
)
def test_closing_two_of_four_exits_doubles_the_time(two, passes):
    assert judging.closed_exits([out(egress_s=100.0), out(egress_s=two)]).passed is passes


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


def two_exits(one: int, two: int) -> dict:
    return {"left_inside": 0, "pedestrians": 1000, "by_exit": {"exit 1": one, "exit 2": two}}


@pytest.mark.parametrize(
    ("one", "two", "passes"),
    [(700, 300, True), (1000, 0, False), (500, 500, False), (400, 600, False)],
)
def test_the_nearer_exit_is_preferred_and_not_the_only_one(one, two, passes):
    assert rimea.TESTS["rimea-11"].judge([two_exits(one, two)]).passed is passes


def necks(flow: tuple[float, float], peak: tuple[int, int], through: tuple = (150, 150)) -> dict:
    return {
        "left_inside": 0, "flow_per_s": list(flow), "peak": list(peak), "top_10": list(peak),
        "through": list(through),
    }  # fmt: skip


def test_the_jam_is_before_the_first_neck():
    judge = rimea.TESTS["rimea-12"].judge
    assert judge([necks((1.5, 1.4), (30, 10))]).passed
    assert len(unmet(judge([necks((1.4, 1.5), (30, 10))]))) == 1
    assert len(unmet(judge([necks((1.5, 1.4), (10, 10))]))) == 1


def test_the_queue_is_before_the_first_opening():
    judge = rimea.TESTS["rimea-12c"].judge
    assert judge([necks((1.5, 1.4), (30, 10))]).passed
    assert len(unmet(judge([necks((1.5, 1.4), (10, 10))]))) == 2
    assert unmet(judge([necks((1.5, 1.4), (30, 10), (150, 149))])) == ["through the second opening"]


def goals(times: list, flows: list) -> list[list[dict]]:
    return [[out(egress_s=t, flow_per_s=f) for t, f in zip(times, flows, strict=True)]]


def test_a_goal_farther_behind_takes_no_less_time_at_the_same_flow():
    judge = rimea.TESTS["rimea-12a"].pooled
    assert judge(goals([90, 90, 94, 99], [1.7, 1.75, 1.7, 1.7])).passed
    assert not judge(goals([90, 89, 94, 99], [1.7, 1.75, 1.7, 1.7])).passed
    assert not judge(goals([90, 91, 94, 99], [1.7, 1.75, 1.7, 1.3])).passed
    assert not judge(goals([90, None, 94, 99], [1.7, 1.75, 1.7, 1.7])).passed


def test_a_long_neck_is_slower_on_average_over_the_seeds():
    judge = rimea.TESTS["rimea-12b"].pooled

    def pair(short: float, long: float) -> list[dict]:
        return [out(passed_s=short), out(passed_s=long)]

    assert judge([pair(90, 95), pair(92, 91)]).passed
    assert not judge([pair(90, 89), pair(92, 91)]).passed


def test_flow_rises_with_the_width_of_the_neck_within_the_envelope():
    judge = rimea.TESTS["rimea-12d"].judge

    def flows(*values: float) -> list[dict]:
        return [out(flow_per_s=value) for value in values]

    # Envelopes: 0.8 m 1.288 to 1.737, 1.0 m 1.71 to 2.774, 1.2 m 2.033 to 2.751.
    assert judge(flows(1.4, 1.9, 2.3)).passed
    assert unmet(judge(flows(1.4, 1.6, 2.3))) == ["flow at 1 m per s"]
    assert "least rise of flow with width per s" in unmet(judge(flows(1.4, 2.4, 2.3)))


def test_the_way_round_the_corner_lies_between_the_others():
    judge = rimea.TESTS["rimea-15"].judge

    def ways(long: float, corner: float, short: float) -> list[dict]:
        return [out(egress_s=long), out(egress_s=corner), out(egress_s=short)]

    assert judge(ways(90.0, 80.0, 60.0)).passed
    assert not judge(ways(90.0, 91.0, 60.0)).passed
    assert not judge(ways(90.0, 60.0, 60.0)).passed


def density_runs(speed_of) -> list[dict]:
    runs = []
    for density in rimea.DENSITIES:
        local = np.full(200, density + 0.125)
        runs.append(
            {
                "density": local,
                "along": np.full(200, speed_of(density)),
                "mean_speed": speed_of(density),
                "mean_density": density,
            }
        )
    return runs


def test_the_fundamental_diagram_passes_on_the_references_own_medians():
    from mesa_mobility.verification.references import corridor_band

    def median(density: float) -> float:
        return float(corridor_band(density + 0.125)[1]) - 0.001 * density

    # Seven densities fill five bins up to 5.1/m2 and one beyond; eight are asked for.
    verdict = rimea.fundamental_diagram(density_runs(median))
    assert unmet(verdict) == ["bins compared"]
    assert verdict.figures["bins outside"] == []
    slow = rimea.fundamental_diagram(density_runs(lambda density: 0.9 * median(density) - 0.2))
    assert "bins outside the bands" in unmet(slow)
    flat = rimea.fundamental_diagram(density_runs(lambda density: 0.4))
    assert "least fall of the mean speed m/s" in unmet(flat)


def test_flow_at_high_density_is_below_that_at_moderate_density():
    judge = imo.TESTS["imo-12"].judge
    assert judge(density_runs(lambda density: 1.4 * np.exp(-0.4 * density))).passed
    assert not judge(density_runs(lambda density: 1.0)).passed


def test_single_file_needs_three_quarters_of_the_bins():
    from mesa_mobility.verification.references import published

    reference = published("1D single file")

    def share(speeds: np.ndarray) -> float | None:
        figures = {
            "density": np.repeat(reference["density"], 60),
            "along": np.repeat(speeds, 60),
        }
        check, _ = judging.single_file_share(judging.single_file_bins([figures]))
        assert check.met is (check.value >= 0.75)
        return check.value

    assert share(reference["v_mean"]) == 1.0
    # Fourteen bins; four of them too fast leave 10 / 14 = 71 %.
    fast = reference["v_mean"].copy()
    fast[:4] = reference["v_max"][:4] + 0.1
    assert share(fast) == pytest.approx(10 / 14)


def transit(speeds: list, flows: list) -> list[dict]:
    return [
        out(speed=v, flow=j, density=n / 120)
        for v, j, n in zip(speeds, flows, iso.PEOPLE, strict=True)
    ]


def test_flow_humps_in_the_corridor_of_iso_13():
    judge = iso.TESTS["iso-13"].judge
    assert judge(transit([1.0, 0.9, 0.7, 0.5, 0.3], [0.5, 0.9, 1.4, 1.5, 1.2])).passed
    assert len(unmet(judge(transit([1.0, 0.9, 0.7, 0.5, 0.3], [0.5, 0.9, 1.4, 1.5, 1.6])))) == 1
    assert len(unmet(judge(transit([1.1, 0.9, 0.7, 0.5, 0.3], [0.5, 0.9, 1.4, 1.5, 1.2])))) == 1
    assert len(unmet(judge(transit([0.9, 0.9, 0.7, 0.5, 0.3], [0.5, 0.9, 1.4, 1.5, 1.2])))) == 1
    assert len(unmet(judge(transit([0.9, 0.8, 0.7, 0.5, None], [0.5, 0.9, 1.4, 1.5, 1.2])))) == 1


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


def test_the_shortest_way():
    judge = iso.TESTS["iso-17"].judge

    def run(near: int, far: int) -> dict:
        return {"by_near": near, "by_far": far}

    assert judge([run(1, 0), run(0, 1), run(0, 1)]).passed
    assert not judge([run(0, 1), run(0, 1), run(0, 1)]).passed
    assert not judge([run(1, 0), run(1, 0), run(0, 1)]).passed
    assert not judge([run(1, 0), run(0, 1), run(1, 0)]).passed


def test_a_group_stays_together_where_it_would_otherwise_part():
    judge = nist.TESTS["nist-2.9"].judge

    def runs(group: float | None, alone: float | None) -> list[dict]:
        return [out(spread_s=group), out(spread_s=alone)]

    assert judge(runs(10.0, 43.0)).passed
    assert not judge(runs(10.1, 43.0)).passed
    assert not judge(runs(None, 43.0)).passed
    assert not judge(runs(5.0, 9.0)).passed


def test_jams_are_at_the_neck_and_at_the_foot():
    judge = nist.TESTS["nist-5.1"].judge

    def run(neck: float, corridor: float, foot: float) -> dict:
        return out(neck=neck, corridor=corridor, foot=foot, foot_5_s=foot)

    assert judge([run(6.0, 2.5, 2.0), run(6.0, 4.0, 3.0)]).passed
    assert not judge([run(2.5, 2.5, 2.0), run(6.0, 4.0, 3.0)]).passed
    assert not judge([run(6.0, 2.5, 2.0), run(4.0, 4.0, 3.0)]).passed
    assert not judge([run(6.0, 2.5, 2.0), run(6.0, 4.0, 2.0)]).passed


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
