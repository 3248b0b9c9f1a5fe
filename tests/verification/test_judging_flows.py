"""Verdicts on flows and densities made up by hand."""

import numpy as np
import pytest

from mesa_mobility.verification import imo, iso, judging, nist, rimea, storeys
from mesa_mobility.verification.references import stair_band
from tests.fixtures.verdicts import out, unmet


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


def necks(flow: tuple[float, float], peak: tuple[int, int], through: tuple = (150, 150)) -> dict:
    return {
        "left_inside": 0,
        "flow_per_s": list(flow),
        "peak": list(peak),
        "top_10": list(peak),
        "through": list(through),
    }


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

    # Seven densities fill five bins up to 5.1/m2 and one beyond; eight are required.
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


def test_jams_are_at_the_neck_and_at_the_foot():
    judge = nist.TESTS["nist-5.1"].judge

    def run(neck: float, corridor: float, foot: float) -> dict:
        return out(neck=neck, corridor=corridor, foot=foot, foot_5_s=foot)

    assert judge([run(6.0, 2.5, 2.0), run(6.0, 4.0, 3.0)]).passed
    assert not judge([run(2.5, 2.5, 2.0), run(6.0, 4.0, 3.0)]).passed
    assert not judge([run(6.0, 2.5, 2.0), run(4.0, 4.0, 3.0)]).passed
    assert not judge([run(6.0, 2.5, 2.0), run(6.0, 4.0, 2.0)]).passed


def foot(**changed: float) -> dict:
    usual = {
        "door_early": 2.9,
        "middle_early": 2.0,
        "foot_early": 1.8,
        "foot_late": 2.6,
        "middle_s": 3.2,
        "foot_s": 3.7,
        "flow_in": 3.5,
        "flow_up": 3.0,
    }
    return {"left_inside": 0, **usual, **changed}


@pytest.mark.parametrize(
    ("changed", "wrong"),
    [
        ({}, []),
        ({"door_early": 2.0}, ["density at the exit less that in the corridor, early 1/m2"]),
        ({"foot_early": 2.7}, ["growth of the density at the foot 1/m2"]),
        ({"middle_s": 3.7}, ["time at the foot less that in the corridor s"]),
        ({"flow_up": 3.5}, ["flow into the corridor less that up the stair 1/s"]),
    ],
)
@pytest.mark.parametrize("test", [storeys.TESTS["rimea-13"], imo.TESTS["imo-11"]])
def test_a_jam_grows_at_the_foot_of_a_stair(changed, wrong, test):
    assert unmet(test.judge([foot(**changed)])) == wrong


def test_a_stair_that_not_all_have_climbed_has_no_jam_to_judge():
    assert len(unmet(storeys.TESTS["rimea-13"].judge([{"left_inside": 3}]))) == 5


def test_measured_speeds_on_stairs_at_one_person_per_m2():
    # Slow and fast, with their standard deviations: .59, .08, .70, .18 down; .49, .08, .65, .21 up.
    assert stair_band(1.0, up=False) == pytest.approx((0.51, 0.88))
    assert stair_band(1.0, up=True) == pytest.approx((0.41, 0.86))


def on_a_stair(mean: float, step: float, densities: int = 10) -> dict:
    """60 speeds at each density from 0.6 persons/m2 on, half a step above and below the mean."""
    density = np.repeat(0.6 + 0.1 * np.arange(densities), 60)
    return out(density=density, along=mean + step * np.tile((-0.5, 0.5), len(density) // 2))


@pytest.mark.parametrize(
    ("down", "up", "wrong"),
    [
        (on_a_stair(0.7, 0.1), on_a_stair(0.6, 0.1), []),
        # Half of the speeds, 0.6 m/s, are within the band: as many as are asked for.
        (on_a_stair(0.85, 0.5), on_a_stair(0.6, 0.1), []),
        (on_a_stair(1.2, 0.1), on_a_stair(0.6, 0.1), ["share of the speeds down within the band"]),
        (on_a_stair(0.7, 0.1), on_a_stair(0.3, 0.1), ["share of the speeds up within the band"]),
        (on_a_stair(0.6, 0.1), on_a_stair(0.6, 0.1), ["least speed down less that up m/s"]),
        (on_a_stair(0.7, 0.1, 8), on_a_stair(0.6, 0.1), ["speeds down"]),
    ],
)
def test_people_walk_on_stairs_as_fast_as_measured_and_down_faster(down, up, wrong):
    assert unmet(storeys.TESTS["rimea-13-speeds"].pooled([[down, up]])) == wrong


def test_speeds_on_stairs_of_all_seeds_count_together():
    slow, fast = on_a_stair(0.6, 0.1), on_a_stair(0.7, 0.1)
    pooled = storeys.TESTS["rimea-13-speeds"].pooled
    # Down 0.6 and 0.7 m/s, 0.65 m/s on average; up 0.6 m/s, or 0.7 m/s.
    assert unmet(pooled([[slow, slow], [fast, slow]])) == []
    assert unmet(pooled([[slow, fast], [fast, fast]])) == ["least speed down less that up m/s"]


def test_speeds_beyond_the_measured_densities_do_not_count():
    crowd = on_a_stair(0.7, 0.1)
    crowd["density"] = crowd["density"] + 1.0
    assert unmet(storeys.TESTS["rimea-13-speeds"].pooled([[crowd, crowd]])) == [
        "speeds down",
        "share of the speeds down within the band",
        "speeds up",
        "share of the speeds up within the band",
        "densities that both have",
        "least speed down less that up m/s",
    ]


def test_the_flow_on_a_stair_rises_with_its_width():
    judge = iso.TESTS["iso-12"].judge
    flows = [1.3, 1.6, 1.9, 2.2, 2.5]
    assert judge([out(flow_per_s=flow) for flow in flows]).passed
    flows[3] = 1.9
    assert unmet(judge([out(flow_per_s=flow) for flow in flows])) == [
        "least rise of the flow with the width 1/s"
    ]
