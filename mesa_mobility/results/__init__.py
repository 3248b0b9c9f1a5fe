"""Trajectories, measures, pictures and exports."""

from mesa_mobility.results.export import to_pedpy, write_juelich_text, write_jupedsim_sqlite
from mesa_mobility.results.files import check_writable
from mesa_mobility.results.gait import Sway, lateral_sway
from mesa_mobility.results.measures import (
    Crossings,
    crossings,
    density,
    departures,
    direction_changes,
    egress_time,
    flow,
    mean_speed,
    occupancy,
    speeds,
)
from mesa_mobility.results.parquet import read_parquet, write_parquet
from mesa_mobility.results.plots import plot_occupancy, plot_snapshots, plot_trajectories
from mesa_mobility.results.run import write_run
from mesa_mobility.results.safety import Overlap, SafetyReport, WallCrossing, check_safety
from mesa_mobility.results.trajectories import Trajectories

__all__ = [
    "Crossings",
    "Overlap",
    "SafetyReport",
    "Sway",
    "Trajectories",
    "WallCrossing",
    "check_safety",
    "check_writable",
    "crossings",
    "density",
    "departures",
    "direction_changes",
    "egress_time",
    "flow",
    "lateral_sway",
    "mean_speed",
    "occupancy",
    "plot_occupancy",
    "plot_snapshots",
    "plot_trajectories",
    "read_parquet",
    "speeds",
    "to_pedpy",
    "write_juelich_text",
    "write_jupedsim_sqlite",
    "write_parquet",
    "write_run",
]
