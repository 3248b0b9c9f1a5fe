"""Comparisons with experiments, on measurements made up by hand."""

import numpy as np
import pytest

from mesa_mobility.validation import corridor
from mesa_mobility.verification.references import corridor_band


def run(speed_at) -> dict:
    """Fifty people in the middle of each bin, all at the speed that belongs to its density."""
    density = np.repeat(np.arange(0.375, 5.2, 0.25), 50)
    along = np.array([speed_at(each) for each in density])
    return {
        "density": density, "along": along, "mean_speed": 1.0, "mean_density": 1.0,
        "fallback_time_share": 0.0,
    }  # fmt: skip


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
