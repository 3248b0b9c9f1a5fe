"""Experiments: many runs of a model, on one machine or many, kept in a store.

Names are imported when they are first used: a command that runs one model needs none of them.
"""

from __future__ import annotations

from mesa_mobility._lazy import names_of

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mesa_mobility.experiments.convergence import (
        Assessment,
        OccupancyConvergence,
        Precision,
    )
    from mesa_mobility.experiments.definition import read_experiment
    from mesa_mobility.experiments.designs import Grid, LatinHypercube, SobolSequence, Table
    from mesa_mobility.experiments.driver import Progress, run_experiment
    from mesa_mobility.experiments.experiment import Experiment
    from mesa_mobility.experiments.intervals import (
        Estimate,
        mean_interval,
        quantile_interval,
    )
    from mesa_mobility.experiments.reporting.report import write_report
    from mesa_mobility.experiments.sensitivity import morris_screening, sobol_indices
    from mesa_mobility.experiments.sensitivity_designs import MorrisTrajectories, SaltelliSamples
    from mesa_mobility.experiments.store import Store, open_store
    from mesa_mobility.experiments.variance import VarianceComponent, variance_components

_MODULES = {
    "Assessment": "convergence",
    "Estimate": "intervals",
    "Experiment": "experiment",
    "Grid": "designs",
    "LatinHypercube": "designs",
    "MorrisTrajectories": "sensitivity_designs",
    "OccupancyConvergence": "convergence",
    "Precision": "convergence",
    "Progress": "driver",
    "SaltelliSamples": "sensitivity_designs",
    "SobolSequence": "designs",
    "Store": "store",
    "Table": "designs",
    "VarianceComponent": "variance",
    "mean_interval": "intervals",
    "morris_screening": "sensitivity",
    "open_store": "store",
    "quantile_interval": "intervals",
    "read_experiment": "definition",
    "run_experiment": "driver",
    "sobol_indices": "sensitivity",
    "variance_components": "variance",
    "write_report": "reporting.report",
}

__all__ = [
    "Assessment",
    "Estimate",
    "Experiment",
    "Grid",
    "LatinHypercube",
    "MorrisTrajectories",
    "OccupancyConvergence",
    "Precision",
    "Progress",
    "SaltelliSamples",
    "SobolSequence",
    "Store",
    "Table",
    "VarianceComponent",
    "mean_interval",
    "morris_screening",
    "open_store",
    "quantile_interval",
    "read_experiment",
    "run_experiment",
    "sobol_indices",
    "variance_components",
    "write_report",
]

__getattr__, __dir__ = names_of(__name__, _MODULES)
