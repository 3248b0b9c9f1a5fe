"""Pose features, motion graph, clusters, movement options and the map file.

Reading a map needs none of what builds one, so the names are imported when
they are first used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from mesa_mobility._lazy import names_of

if TYPE_CHECKING:
    from mesa_mobility.mobility.apsp import ShortestPaths, shortest_paths
    from mesa_mobility.mobility.build import build_map
    from mesa_mobility.mobility.clusters import Clusters, cluster_poses
    from mesa_mobility.mobility.graph import MotionGraph, motion_graph
    from mesa_mobility.mobility.judging.abilities import abilities_of
    from mesa_mobility.mobility.judging.held_out import coverage
    from mesa_mobility.mobility.judging.left_out import left_out_one_at_a_time
    from mesa_mobility.mobility.map import MobilityMap
    from mesa_mobility.mobility.mapfile import shipped_map_path
    from mesa_mobility.mobility.paths import ReachableOptions, reachable_options
    from mesa_mobility.mobility.poses import POSE_JOINTS, PoseTable, pose_table
    from mesa_mobility.mobility.preparing.bootstrap import draw_clips
    from mesa_mobility.mobility.preparing.clips import PreparedRecordings, prepare_recordings
    from mesa_mobility.mobility.preparing.derived import DerivedType, derived_type

_MODULES = {
    "POSE_JOINTS": "poses",
    "Clusters": "clusters",
    "DerivedType": "preparing.derived",
    "MobilityMap": "map",
    "MotionGraph": "graph",
    "PoseTable": "poses",
    "PreparedRecordings": "preparing.clips",
    "ReachableOptions": "paths",
    "ShortestPaths": "apsp",
    "abilities_of": "judging.abilities",
    "build_map": "build",
    "cluster_poses": "clusters",
    "coverage": "judging.held_out",
    "derived_type": "preparing.derived",
    "draw_clips": "preparing.bootstrap",
    "left_out_one_at_a_time": "judging.left_out",
    "motion_graph": "graph",
    "pose_table": "poses",
    "prepare_recordings": "preparing.clips",
    "reachable_options": "paths",
    "shipped_map_path": "mapfile",
    "shortest_paths": "apsp",
}

__all__ = [
    "POSE_JOINTS",
    "Clusters",
    "DerivedType",
    "MobilityMap",
    "MotionGraph",
    "PoseTable",
    "PreparedRecordings",
    "ReachableOptions",
    "ShortestPaths",
    "abilities_of",
    "build_map",
    "cluster_poses",
    "coverage",
    "derived_type",
    "draw_clips",
    "left_out_one_at_a_time",
    "motion_graph",
    "pose_table",
    "prepare_recordings",
    "reachable_options",
    "shipped_map_path",
    "shortest_paths",
]

__getattr__, __dir__ = names_of(__name__, _MODULES)
