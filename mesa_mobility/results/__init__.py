"""Trajectories, measures, pictures and exports.

A run needs few of them, so the names are imported when they are first used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from mesa_mobility._lazy import names_of

if TYPE_CHECKING:
    from mesa_mobility.floorplan import Room as Room
    from mesa_mobility.results.engineering.clearing import clearing as clearing
    from mesa_mobility.results.engineering.clearing import time_to_share as time_to_share
    from mesa_mobility.results.engineering.doors import clogging as clogging
    from mesa_mobility.results.engineering.doors import crossings_of_doors as crossings_of_doors
    from mesa_mobility.results.engineering.doors import doors as doors
    from mesa_mobility.results.engineering.doors import n_t as n_t
    from mesa_mobility.results.engineering.files import write_results as write_results
    from mesa_mobility.results.engineering.grids import Grid as Grid
    from mesa_mobility.results.engineering.maps import FloorMaps as FloorMaps
    from mesa_mobility.results.engineering.maps import maps as maps
    from mesa_mobility.results.engineering.maps import maps_by_type as maps_by_type
    from mesa_mobility.results.engineering.measured import Measured as Measured
    from mesa_mobility.results.engineering.measured import measure as measure
    from mesa_mobility.results.engineering.pictures import plot_map as plot_map
    from mesa_mobility.results.engineering.queues import queue_lengths as queue_lengths
    from mesa_mobility.results.engineering.queues import queues as queues
    from mesa_mobility.results.engineering.queues import waiting_times as waiting_times
    from mesa_mobility.results.engineering.rooms import read_rooms as read_rooms
    from mesa_mobility.results.engineering.rooms import room_figures as room_figures
    from mesa_mobility.results.engineering.rooms import room_times as room_times
    from mesa_mobility.results.engineering.rooms import rooms_of as rooms_of
    from mesa_mobility.results.engineering.service import level_of_service as level_of_service
    from mesa_mobility.results.engineering.service import service_limits as service_limits
    from mesa_mobility.results.excerpts import Excerpt as Excerpt
    from mesa_mobility.results.excerpts import Selection as Selection
    from mesa_mobility.results.files import check_writable as check_writable
    from mesa_mobility.results.formats.export import to_pedpy as to_pedpy
    from mesa_mobility.results.formats.juelich import write_juelich_text as write_juelich_text
    from mesa_mobility.results.formats.jupedsim import (
        write_jupedsim_sqlite as write_jupedsim_sqlite,
    )
    from mesa_mobility.results.formats.output_format import OutputFormat as OutputFormat
    from mesa_mobility.results.formats.parquet import write_parquet as write_parquet
    from mesa_mobility.results.measures.by_type import by_type as by_type
    from mesa_mobility.results.measures.by_type import occupancy_by_type as occupancy_by_type
    from mesa_mobility.results.measures.by_type import tables_by_type as tables_by_type
    from mesa_mobility.results.measures.climbs import Climbs as Climbs
    from mesa_mobility.results.measures.climbs import by_stairs as by_stairs
    from mesa_mobility.results.measures.climbs import climbs as climbs
    from mesa_mobility.results.measures.climbs import occupancy_by_stairs as occupancy_by_stairs
    from mesa_mobility.results.measures.crossings import Crossings as Crossings
    from mesa_mobility.results.measures.crossings import crossings as crossings
    from mesa_mobility.results.measures.crossings import flow as flow
    from mesa_mobility.results.measures.crossings import flow_over_time as flow_over_time
    from mesa_mobility.results.measures.crossings import passages as passages
    from mesa_mobility.results.measures.crossings import passed_by as passed_by
    from mesa_mobility.results.measures.density import density as density
    from mesa_mobility.results.measures.density import individual_densities as individual_densities
    from mesa_mobility.results.measures.density import voronoi_cells as voronoi_cells
    from mesa_mobility.results.measures.density import voronoi_density as voronoi_density
    from mesa_mobility.results.measures.gait import Sway as Sway
    from mesa_mobility.results.measures.gait import lateral_sway as lateral_sway
    from mesa_mobility.results.measures.lifts import Rides as Rides
    from mesa_mobility.results.measures.lifts import by_lift as by_lift
    from mesa_mobility.results.measures.lifts import occupancy_by_lift as occupancy_by_lift
    from mesa_mobility.results.measures.lifts import rides as rides
    from mesa_mobility.results.measures.occupancy import departures as departures
    from mesa_mobility.results.measures.occupancy import egress_time as egress_time
    from mesa_mobility.results.measures.occupancy import occupancy as occupancy
    from mesa_mobility.results.measures.sites import Site as Site
    from mesa_mobility.results.measures.speeds import SpeedsAlong as SpeedsAlong
    from mesa_mobility.results.measures.speeds import direction_changes as direction_changes
    from mesa_mobility.results.measures.speeds import mean_speed as mean_speed
    from mesa_mobility.results.measures.speeds import speeds as speeds
    from mesa_mobility.results.measures.speeds import speeds_along as speeds_along
    from mesa_mobility.results.measures.storeys import by_level as by_level
    from mesa_mobility.results.measures.storeys import leaving_times as leaving_times
    from mesa_mobility.results.measures.storeys import occupancy_by_level as occupancy_by_level
    from mesa_mobility.results.overlaps import Overlap as Overlap
    from mesa_mobility.results.plots import plot_occupancy as plot_occupancy
    from mesa_mobility.results.plots import plot_snapshots as plot_snapshots
    from mesa_mobility.results.plots import plot_trajectories as plot_trajectories
    from mesa_mobility.results.run import write_run as write_run
    from mesa_mobility.results.safety import SafetyReport as SafetyReport
    from mesa_mobility.results.safety import WallCrossing as WallCrossing
    from mesa_mobility.results.safety import check_safety as check_safety
    from mesa_mobility.results.trajectories import Trajectories as Trajectories
    from mesa_mobility.results.trajectories import read_parquet as read_parquet

__getattr__, __dir__ = names_of(__name__, __file__)
