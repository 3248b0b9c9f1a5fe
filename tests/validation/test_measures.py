"""Comparisons with experiments, on measurements made up by hand."""

import numpy as np
import pytest

from mesa_mobility.validation import corridor, motion
from mesa_mobility.verification.references import corridor_band


def run(speed_at) -> dict:
    """Fifty people in the middle of each bin, all at the speed that belongs to its density."""
    density = np.repeat(np.arange(0.375, 5.2, 0.25), 50)
    along = np.array([speed_at(each) for each in density])
    return {
        "density": density,
        "along": along,
        "mean_speed": 1.0,
        "mean_density": 1.0,
        "fallback_time_share": 0.0,
    }


def unmet(verdict) -> list[str]:
    return [check.figure for check in verdict.checks if check.gates and not check.met]


def measured(density: float) -> float:
    return float(corridor_band(density)[1])


def slow(density: float) -> float:
    return 1.238 if density < 0.75 else measured(density)


@pytest.mark.parametrize(
    ("preset", "recorded", "wrong"),
    [
        (measured, measured, []),
        (slow, measured, ["v at 0.5/m2"]),
        (measured, slow, ["speeds as recorded: v at 0.5/m2"]),
    ],
)
def test_each_crowd_of_the_corridor_is_judged_on_its_own(preset, recorded, wrong):
    runs = [[run(preset)] * 8 + [run(recorded)] * 8 for _ in range(2)]
    verdict = corridor.judge(runs)
    assert unmet(verdict) == wrong
    # p10 of the reference, interpolated by hand between 1.2366 at 0.375 and 1.2415 at 0.625/m2.
    limits = {check.figure: check.wanted for check in verdict.checks}
    assert limits["v at 0.5/m2"].startswith("1.239 to ")


def test_the_second_crowd_of_the_corridor_walks_as_fast_alone_as_those_recorded():
    speeds = [dict(each.numbers)["speed"] for each in corridor.EXPERIMENT.cases]
    assert speeds[:8] == [None] * 8
    drawn = speeds[8].draw(4000, np.random.default_rng(1))
    assert drawn.mean() == pytest.approx(1.55, abs=0.005)
    assert drawn.std() == pytest.approx(0.18, abs=0.005)


def moving(**changes) -> list[dict]:
    """A run of each case of the motion experiment in which people move as the recorded ones."""
    rng = np.random.default_rng(1)

    def walked(turn_deg, across, change, lag=0.0, fastest=0.5, **condition) -> dict:
        pairs = rng.multivariate_normal([0, 0], [[1, lag], [lag, 1]], 4000)
        return {
            "turns": np.radians(rng.normal(0, turn_deg, 4000)),
            "across": rng.normal(0, across, 4000),
            "speed_changes": rng.normal(0, change, 4000),
            "successive": pairs,
            # Of a uniform distribution the percentiles are known: p50 0.25, p99 0.495.
            "accelerations": np.linspace(0, fastest, 1001),
            "jumps": np.linspace(0, 0.3, 1001),
            **condition,
        }

    runs = {
        "alone": walked(4.4, 0.126, 0.06, lag=-0.33, speed=1.6),
        "corridor": walked(4.5, 0.092, 0.084, density=1.2, speed=1.1, flow=2.3),
        "exit": walked(9.7, 0.074, 0.093, fastest=0.6, density=2.2, speed=0.6, flow=2.4),
        "both ways": walked(5.0, 0.1, 0.1, density=1.1, speed=1.2),
        "door 0.5": {"back": np.array([0.0] * 97 + [0.5] * 3)},
        "door 0.9": {"back": np.zeros(100)},
        "doorway": {"angles": np.full(1000, 0.1)},
        "head-on": {"closest": np.full(20, 0.8)},
        "crossing": {"closest": np.full(20, 0.9)},
        "standing": {"closest": np.full(20, 0.6)},
        "group": {"through": 0.05},
        "start": {"first_second": np.full(20, 0.5)},
    }
    for name, change in changes.items():
        runs[name.replace("_", " ")].update(change)
    return list(runs.values())


def test_people_who_move_as_recorded_pass():
    assert unmet(motion.judge([moving()])) == []


@pytest.mark.parametrize(
    ("changes", "wrong"),
    [
        # 1.4 times 4.506 degrees are 6.31, 0.7 times 3.15.
        ({"corridor": {"turns": np.radians([-6.4, 6.4])}}, "corridor: sd of direction change deg"),
        ({"corridor": {"turns": np.radians([-3.1, 3.1])}}, "corridor: sd of direction change deg"),
        # 0.7 times 0.624 are 0.437.
        ({"corridor": {"accelerations": np.full(9, 0.2)}}, "corridor: acceleration m/s2, p99"),
        # Measured: 2.06 persons/m2 at 0.66 m/s, which are 2.45 persons/s in 1.8 m.
        ({"exit": {"density": 1.1}}, "condition of before an exit of 1.2 m: density 1/m2"),
        ({"exit": {"density": 5.4}}, "condition of before an exit of 1.2 m: density 1/m2"),
        ({"exit": {"speed": 1.34}}, "condition of before an exit of 1.2 m: speed m/s"),
        ({"exit": {"flow": None}}, "condition of before an exit of 1.2 m: flow 1/s"),
        ({"corridor": {"flow": 2.05}}, "condition of corridor: flow 1/s"),
        ({"both_ways": {"density": 0.7}}, "condition of both ways: density 1/m2"),
        ({"alone": {"speed": 1.3}}, "condition of alone: speed m/s"),
        ({"alone": {"turns": np.radians([-3.0, 3.0])}}, "alone: sd of direction change deg"),
        (
            {"exit": {"jumps": np.full(9, 0.42)}},
            "before an exit of 1.2 m: jump of speed over 0.1 s, p99 m/s",
        ),
        (
            {"door_0.9": {"back": np.array([0.31] * 7 + [0.29] * 93)}},
            "door of 0.9 m: share who walk back 0.3 m",
        ),
        (
            {"doorway": {"angles": np.array([0.8] * 4 + [0.7] * 996)}},
            "doorway: share of walking sideways",
        ),
        (
            {"standing": {"closest": np.full(20, 0.49)}},
            "past somebody standing: closest approach m",
        ),
        ({"start": {"first_second": np.full(20, 1.04)}}, "first second from standing m"),
    ],
)
def test_each_way_of_moving_is_judged_on_its_own(changes, wrong):
    assert unmet(motion.judge([moving(**changes)])) == [wrong]
