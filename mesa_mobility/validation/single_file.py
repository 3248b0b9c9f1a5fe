"""Single file: speed against density on a narrow oval."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from mesa_mobility.validation.experiment import Experiment, Runs
from mesa_mobility.verification import Verdict, case
from mesa_mobility.verification.checks import Check, within
from mesa_mobility.verification.diagrams import single_file_diagram
from mesa_mobility.verification.judging import single_file_bins, single_file_share
from mesa_mobility.verification.references import published
from mesa_mobility.verification.scenarios.tracks.single_file import CASES, single_file

DENSE = (54, 60, 66, 72)
"""People on the oval of 26.85 m: 2.0 to 2.7 a metre."""
DENSE_FROM, DENSEST = 1.9, 2.9
"""Bins that must be there, persons/m."""
NEAR_MEAN_TO = 2.5
"""Up to here the speed must be near the mean, persons/m; above, between least and greatest."""
NEAR = 0.5, 1.5


def judge(runs: Runs) -> Verdict:
    """Judge the median speed in each density bin.

    In the runs of ``CASES``, the median must lie between the least and the greatest measured speed
    in at least three quarters of the bins.

    In all runs together, each bin from ``DENSE_FROM`` to ``DENSEST`` must have a median. At
    densities up to ``NEAR_MEAN_TO`` it must be 0.5 to 1.5 times the measured mean. At higher
    densities it must lie between the least and the greatest measured speed.

    Args:
        runs: for each seed, the figures of ``CASES`` and then those of ``DENSE``.
    """
    sparse, dense = (
        single_file_bins([figures for row in runs for figures in part(row)])
        for part in (lambda row: row[: len(CASES)], lambda row: row)
    )
    check, figures = single_file_share(sparse)
    table = {name: values.tolist() for name, values in dense.items()}
    return Verdict((check, *_dense(dense)), {**figures, "bins": table})


def _dense(bins: dict[str, NDArray[np.float64]]) -> list[Check]:
    """A check of the median speed in each dense bin of the reference."""
    checks = []
    reference = published("1D single file")
    for density, least, mean, greatest in zip(
        *(reference[name] for name in ("density", "v_min", "v_mean", "v_max")), strict=True
    ):
        if not DENSE_FROM - 1e-6 <= density <= DENSEST + 1e-6:
            continue
        found = bins["p50"][np.abs(bins["density"] - density) < 0.05]
        low, high = least, greatest
        if density <= NEAR_MEAN_TO + 1e-6:
            low, high = (each * mean for each in NEAR)
        value = float(found[0]) if len(found) else None
        checks.append(within(f"dense: v at {density:.1f}/m", value, float(low), float(high)))
    return checks


def draw(figures: dict[str, Any]) -> Figure:
    """Speed against density."""
    return single_file_diagram({name: np.array(of) for name, of in figures["bins"].items()})


EXPERIMENT = Experiment(
    name="single_file",
    what="speed against density of people one behind the other",
    source="single files of BaSiGo 2013 and of the caserne 2006 (data archive of "
    "Forschungszentrum Jülich)",
    criterion="The median speed lies between the least and the greatest measured speed in three "
    "quarters of the bins of density; in dense files up to 2.5 persons/m it is 0.5 to "
    "1.5 times the measured mean, above that between least and greatest",
    cases=(*CASES, *(case(single_file, effort=4.0, people=people) for people in DENSE)),
    judge=judge,
    draw=draw,
)
