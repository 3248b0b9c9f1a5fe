"""What matters: Sobol' indices and Morris screening from the runs of a store."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.errors import ModelError, ResultsError
from mesa_mobility.experiments.design.points import point_key
from mesa_mobility.experiments.design.sensitivity import (
    MorrisTrajectories,
    SaltelliSamples,
    salib,
)
from mesa_mobility.experiments.observed import warn_of_failed

if TYPE_CHECKING:
    from mesa_mobility.experiments.store import Store


def sobol_indices(store: Store, figure: str) -> dict[str, dict[str, float]]:
    """Sobol' indices of a figure: the share of its variance that comes from each parameter.

    Args:
        store: of an experiment whose design is ``SaltelliSamples``.
        figure: a column of numbers; replications of a point count with their mean. Those that have
            failed are left out, with a warning.

    Returns:
        For each parameter ``first`` (alone), ``total`` (with all its interactions) and the
        half-widths ``first_conf`` and ``total_conf`` of their 95 % intervals.

    Raises:
        ModelError: another design, or SALib is not installed.
        ResultsError: points without the figure.
    """
    design = store.experiment().design
    if not isinstance(design, SaltelliSamples):
        raise ModelError(
            f"Sobol' indices: the design is {design.kind}, expected {SaltelliSamples.kind}"
        )
    values = _values(store, figure)
    salib()
    from SALib.analyze import sobol

    found = sobol.analyze(design.problem, values, calc_second_order=False, seed=design.seed)
    return _by_parameter(
        design.bounds,
        first=found["S1"],
        total=found["ST"],
        first_conf=found["S1_conf"],
        total_conf=found["ST_conf"],
    )


def morris_screening(store: Store, figure: str) -> dict[str, dict[str, float]]:
    """Elementary effects of the parameters on a figure over their whole range.

    Args:
        store: of an experiment whose design is ``MorrisTrajectories``.
        figure: a column of numbers; replications of a point count with their mean. Those that have
            failed are left out, with a warning.

    Returns:
        For each parameter ``mean`` effect, ``mean_abs`` (the mean of its size) and ``sd``.

    Raises:
        ModelError: another design, or SALib is not installed.
        ResultsError: points without the figure.
    """
    design = store.experiment().design
    if not isinstance(design, MorrisTrajectories):
        raise ModelError(f"Morris: the design is {design.kind}, expected {MorrisTrajectories.kind}")
    values = _values(store, figure)
    salib()
    from SALib.analyze import morris

    found = morris.analyze(
        design.problem, design.unit, values, num_levels=design.levels, seed=design.seed
    )
    return _by_parameter(
        design.bounds, mean=found["mu"], mean_abs=found["mu_star"], sd=found["sigma"]
    )


def _values(store: Store, figure: str) -> NDArray[np.float64]:
    """(points,) mean of the figure over the replications of each point, in the design's order."""
    experiment = store.experiment()
    found = store.estimates(f"mean {figure}")
    means = [
        found[key].value if (key := point_key(experiment.point(i))) in found else None
        for i in range(len(experiment.design))
    ]
    known = [value for value in means if value is not None]
    if len(known) < len(means):
        raise ResultsError(
            f"{store}: {len(means) - len(known)} of {len(means)} points have no mean {figure}, as "
            "runs are missing, failed or did not reach it; expected all of them"
        )
    warn_of_failed(store, store.table([])["status"].to_pylist())
    return np.array(known)


def _by_parameter(names: Any, **columns: Any) -> dict[str, dict[str, float]]:
    return {
        name: {key: float(values[k]) for key, values in columns.items()}
        for k, name in enumerate(names)
    }
