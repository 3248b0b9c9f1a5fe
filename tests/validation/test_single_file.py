"""The single file, on speeds made up by hand."""

import numpy as np
import pytest

from mesa_mobility.validation import single_file
from mesa_mobility.verification.references import published
from mesa_mobility.verification.scenarios.tracks.single_file import CASES


def runs(faster: dict[float, float] | None = None, upto: float = 3.0) -> list[dict]:
    """A hundred people in each bin at the measured mean speed, or that many times as fast."""
    reference = published("1D single file")
    density, speed = reference["density"], reference["v_mean"].copy()
    for at, times in (faster or {}).items():
        speed[np.isclose(density, at)] *= times
    kept = density < upto
    found = {"density": np.repeat(density[kept] + 0.01, 100), "along": np.repeat(speed[kept], 100)}
    nobody = {"density": np.empty(0), "along": np.empty(0)}
    return [found, *[nobody] * (len(single_file.EXPERIMENT.cases) - 1)]


def unmet(verdict) -> list[str]:
    return [check.figure for check in verdict.checks if not check.met]


def test_people_as_fast_as_measured_pass():
    verdict = single_file.judge([runs()])
    assert unmet(verdict) == []
    assert [check.figure for check in verdict.checks][1:] == [
        f"dense: v at {density}/m" for density in (1.9, 2.1, 2.3, 2.5, 2.7, 2.9)
    ]


@pytest.mark.parametrize(
    ("density", "times", "met"),
    [
        (1.9, 1.45, True),
        (1.9, 1.55, False),
        (2.3, 0.55, True),
        (2.3, 0.45, False),
        (2.5, 0.0, False),
        (2.7, 0.0, True),
        (2.7, 12.0, False),
    ],
)
def test_dense_bins_are_near_the_mean_and_denser_ones_in_the_range(density, times, met):
    verdict = single_file.judge([runs({density: times})])
    assert unmet(verdict) == ([] if met else [f"dense: v at {density}/m"])


def test_dense_bins_that_nobody_is_in_fail():
    assert "dense: v at 2.3/m" in unmet(single_file.judge([runs(upto=2.2)]))


def test_the_share_of_bins_is_that_of_the_sparse_runs_alone():
    row = runs()
    dense = {"density": np.repeat(1.41, 100), "along": np.repeat(9.0, 100)}
    row[len(CASES)] = dense
    verdict = single_file.judge([row])
    assert verdict.checks[0].value == 1.0
