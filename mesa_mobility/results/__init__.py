"""Trajectories, measures, pictures and exports."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from mesa_mobility.results.excerpts import Excerpt, Selection
from mesa_mobility.results.files import check_writable
from mesa_mobility.results.formats.export import to_pedpy
from mesa_mobility.results.formats.juelich import write_juelich_text
from mesa_mobility.results.formats.jupedsim import write_jupedsim_sqlite
from mesa_mobility.results.formats.output_format import OutputFormat
from mesa_mobility.results.formats.parquet import write_parquet
from mesa_mobility.results.measures.by_type import by_type, occupancy_by_type
from mesa_mobility.results.measures.climbs import Climbs, by_stairs, climbs, occupancy_by_stairs
from mesa_mobility.results.measures.crossings import (
    Crossings,
    crossings,
    flow,
    flow_over_time,
    passages,
    passed_by,
)
from mesa_mobility.results.measures.density import (
    density,
    individual_densities,
    voronoi_cells,
    voronoi_density,
)
from mesa_mobility.results.measures.gait import Sway, lateral_sway
from mesa_mobility.results.measures.occupancy import departures, egress_time, occupancy
from mesa_mobility.results.measures.speeds import (
    SpeedsAlong,
    direction_changes,
    mean_speed,
    speeds,
    speeds_along,
)
from mesa_mobility.results.measures.storeys import by_level, leaving_times, occupancy_by_level
from mesa_mobility.results.overlaps import Overlap
from mesa_mobility.results.run import write_run
from mesa_mobility.results.safety import SafetyReport, WallCrossing, check_safety
from mesa_mobility.results.trajectories import Trajectories, read_parquet

if TYPE_CHECKING:
    from mesa_mobility.results.plots import plot_occupancy, plot_snapshots, plot_trajectories

__all__ = [
    "Climbs",
    "Crossings",
    "Excerpt",
    "OutputFormat",
    "Overlap",
    "SafetyReport",
    "Selection",
    "SpeedsAlong",
    "Sway",
    "Trajectories",
    "WallCrossing",
    "by_level",
    "by_stairs",
    "by_type",
    "check_safety",
    "check_writable",
    "climbs",
    "crossings",
    "density",
    "departures",
    "direction_changes",
    "egress_time",
    "flow",
    "flow_over_time",
    "individual_densities",
    "lateral_sway",
    "leaving_times",
    "mean_speed",
    "occupancy",
    "occupancy_by_level",
    "occupancy_by_stairs",
    "occupancy_by_type",
    "passages",
    "passed_by",
    "plot_occupancy",
    "plot_snapshots",
    "plot_trajectories",
    "read_parquet",
    "speeds",
    "speeds_along",
    "to_pedpy",
    "voronoi_cells",
    "voronoi_density",
    "write_juelich_text",
    "write_jupedsim_sqlite",
    "write_parquet",
    "write_run",
]


def __getattr__(name: str) -> Any:
    # Matplotlib takes half a second to load, so it is imported only when a picture is drawn.
    if name.startswith("plot_") and name in __all__:
        return getattr(import_module("mesa_mobility.results.plots"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
