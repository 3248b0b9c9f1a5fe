"""Comparison with experiments: measured and simulated crowds."""

from __future__ import annotations

from collections.abc import Sequence

from mesa_mobility.errors import ModelError
from mesa_mobility.plugins.registry import did_you_mean
from mesa_mobility.validation import (
    bidirectional,
    bottleneck,
    corridor,
    fallback,
    motion,
    single_file,
    standing,
    walking,
)
from mesa_mobility.validation.experiment import Experiment, judged
from mesa_mobility.validation.scenes import corners, counter, jams, wide_necks

EXPERIMENTS = {
    each.EXPERIMENT.name: each.EXPERIMENT
    for each in (
        walking,
        motion,
        single_file,
        corridor,
        bidirectional,
        bottleneck,
        jams,
        wide_necks,
        corners,
        counter,
        standing,
        fallback,
    )
}


def chosen(names: Sequence[str]) -> list[Experiment]:
    """Experiments by name; all of them where none is named.

    Raises:
        ModelError: an unknown name.
    """
    for name in names:
        if name not in EXPERIMENTS:
            raise ModelError(
                f"unknown experiment {name!r}{did_you_mean(name, EXPERIMENTS)}; "
                f"there are {', '.join(EXPERIMENTS)}"
            )
    return [EXPERIMENTS[name] for name in (dict.fromkeys(names) or EXPERIMENTS)]


__all__ = ["EXPERIMENTS", "Experiment", "chosen", "judged"]
