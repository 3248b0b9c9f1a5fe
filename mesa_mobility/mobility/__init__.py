"""Pose features, motion graph, clusters, movement options and the map file.

Reading a map needs none of what builds one, so the names are imported when
they are first used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from mesa_mobility._lazy import names_of

if TYPE_CHECKING:
    from mesa_mobility.mobility.apsp import ShortestPaths, shortest_paths
    from mesa_mobility.mobility.build import build_families, build_map, map_of_families
    from mesa_mobility.mobility.clusters import Clusters, cluster_poses
    from mesa_mobility.mobility.graph import MotionGraph, motion_graph
    from mesa_mobility.mobility.judging.abilities import abilities_of
    from mesa_mobility.mobility.judging.held_out import coverage
    from mesa_mobility.mobility.judging.left_out import (
        left_out_one_at_a_time,
        sample_left_out,
    )
    from mesa_mobility.mobility.map import MobilityMap
    from mesa_mobility.mobility.mapfile import shipped_map_path
    from mesa_mobility.mobility.paths import ReachableOptions, reachable_options
    from mesa_mobility.mobility.poses import POSE_JOINTS, PoseTable, pose_table
    from mesa_mobility.mobility.preparing.again import recordings_behind
    from mesa_mobility.mobility.preparing.bootstrap import draw_clips
    from mesa_mobility.mobility.preparing.clips import PreparedRecordings, prepare_recordings
    from mesa_mobility.mobility.preparing.derived import DerivedType, derived_type
    from mesa_mobility.mobility.preparing.wheelchairs import WHEELCHAIRS, Wheelchair
    from mesa_mobility.mobility.storing.families import OptionFamilies

_MODULES = {
    "POSE_JOINTS": "poses",
    "WHEELCHAIRS": "preparing.wheelchairs",
    "Clusters": "clusters",
    "DerivedType": "preparing.derived",
    "MobilityMap": "map",
    "MotionGraph": "graph",
    "OptionFamilies": "storing.families",
    "PoseTable": "poses",
    "PreparedRecordings": "preparing.clips",
    "ReachableOptions": "paths",
    "ShortestPaths": "apsp",
    "Wheelchair": "preparing.wheelchairs",
    "abilities_of": "judging.abilities",
    "build_families": "build",
    "build_map": "build",
    "cluster_poses": "clusters",
    "coverage": "judging.held_out",
    "derived_type": "preparing.derived",
    "draw_clips": "preparing.bootstrap",
    "left_out_one_at_a_time": "judging.left_out",
    "map_of_families": "build",
    "motion_graph": "graph",
    "pose_table": "poses",
    "prepare_recordings": "preparing.clips",
    "reachable_options": "paths",
    "recordings_behind": "preparing.again",
    "sample_left_out": "judging.left_out",
    "shipped_map_path": "mapfile",
    "shortest_paths": "apsp",
}

__all__ = [
    "POSE_JOINTS",
    "WHEELCHAIRS",
    "Clusters",
    "DerivedType",
    "MobilityMap",
    "MotionGraph",
    "OptionFamilies",
    "PoseTable",
    "PreparedRecordings",
    "ReachableOptions",
    "ShortestPaths",
    "Wheelchair",
    "abilities_of",
    "build_families",
    "build_map",
    "cluster_poses",
    "coverage",
    "derived_type",
    "draw_clips",
    "left_out_one_at_a_time",
    "map_of_families",
    "motion_graph",
    "pose_table",
    "prepare_recordings",
    "reachable_options",
    "recordings_behind",
    "sample_left_out",
    "shipped_map_path",
    "shortest_paths",
]

__getattr__, __dir__ = names_of(__name__, _MODULES)
