"""Single file: speed against density on a narrow oval."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from mesa_mobility.validation import drawing
from mesa_mobility.validation.experiment import Experiment, Runs
from mesa_mobility.verification import Verdict
from mesa_mobility.verification.judging import single_file_bins, single_file_share
from mesa_mobility.verification.references import published
from mesa_mobility.verification.scenarios.tracks.single_file import CASES


def judge(runs: Runs) -> Verdict:
    """Three quarters of the bins lie within the measured range."""
    bins = single_file_bins([figures for row in runs for figures in row])
    check, figures = single_file_share(bins)
    table = {name: values.tolist() for name, values in bins.items()}
    return Verdict((check,), {**figures, "bins": table})


def draw(figures: dict[str, Any]) -> Figure:
    """Speed against density."""
    figure, axes = drawing.panels(1)
    reference = published("1D single file")
    drawing.band(
        axes[0], reference["density"], reference["v_min"], reference["v_mean"],
        reference["v_max"], drawing.MEASURED,
    )  # fmt: skip
    bins = {name: np.array(values) for name, values in figures["bins"].items()}
    drawing.band(axes[0], bins["density"], bins["p10"], bins["p50"], bins["p90"], drawing.OURS)
    axes[0].set_xlabel("density (1/m)")
    axes[0].set_ylabel("speed (m/s)")
    drawing.finish(axes)
    return figure


EXPERIMENT = Experiment(
    name="single_file",
    what="speed against density of people one behind the other",
    source="single file of BaSiGo and caserne (fd_juelich_published.csv)",
    cases=CASES,
    judge=judge,
    draw=draw,
)
