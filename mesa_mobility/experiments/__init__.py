"""Experiments: many runs of a model, on one machine or many, kept in a store.

Names are imported when they are first used: a command that runs one model needs none of them.
"""

from __future__ import annotations

from mesa_mobility._lazy import names_of

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mesa_mobility.experiments.comparing import Comparison as Comparison
    from mesa_mobility.experiments.comparing import compare as compare
    from mesa_mobility.experiments.convergence import Assessment as Assessment
    from mesa_mobility.experiments.convergence import OccupancyConvergence as OccupancyConvergence
    from mesa_mobility.experiments.convergence import Precision as Precision
    from mesa_mobility.experiments.definition import read_experiment as read_experiment
    from mesa_mobility.experiments.design.designs import Grid as Grid
    from mesa_mobility.experiments.design.designs import LatinHypercube as LatinHypercube
    from mesa_mobility.experiments.design.designs import SobolSequence as SobolSequence
    from mesa_mobility.experiments.design.designs import Table as Table
    from mesa_mobility.experiments.design.sensitivity import (
        MorrisTrajectories as MorrisTrajectories,
    )
    from mesa_mobility.experiments.design.sensitivity import SaltelliSamples as SaltelliSamples
    from mesa_mobility.experiments.driver import Progress as Progress
    from mesa_mobility.experiments.driver import run_experiment as run_experiment
    from mesa_mobility.experiments.experiment import Experiment as Experiment
    from mesa_mobility.experiments.intervals import Estimate as Estimate
    from mesa_mobility.experiments.intervals import mean_interval as mean_interval
    from mesa_mobility.experiments.intervals import quantile_interval as quantile_interval
    from mesa_mobility.experiments.report_options import ReportOptions as ReportOptions
    from mesa_mobility.experiments.reporting.report import write_report as write_report
    from mesa_mobility.experiments.sensitivity import morris_screening as morris_screening
    from mesa_mobility.experiments.sensitivity import sobol_indices as sobol_indices
    from mesa_mobility.experiments.store import Store as Store
    from mesa_mobility.experiments.store import open_store as open_store
    from mesa_mobility.experiments.variance import VarianceComponent as VarianceComponent
    from mesa_mobility.experiments.variance import variance_components as variance_components

__getattr__, __dir__ = names_of(__name__, __file__)
