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
    from mesa_mobility.mobility.held_out import coverage
    from mesa_mobility.mobility.map import MobilityMap
    from mesa_mobility.mobility.mapfile import shipped_map_path
    from mesa_mobility.mobility.paths import ReachableOptions, reachable_options
    from mesa_mobility.mobility.poses import POSE_JOINTS, PoseTable, pose_table

_MODULES = {
    "POSE_JOINTS": "poses",
    "Clusters": "clusters",
    "MobilityMap": "map",
    "MotionGraph": "graph",
    "PoseTable": "poses",
    "ReachableOptions": "paths",
    "ShortestPaths": "apsp",
    "build_map": "build",
    "cluster_poses": "clusters",
    "coverage": "held_out",
    "motion_graph": "graph",
    "pose_table": "poses",
    "reachable_options": "paths",
    "shipped_map_path": "mapfile",
    "shortest_paths": "apsp",
}

__all__ = [
    "POSE_JOINTS",
    "Clusters",
    "MobilityMap",
    "MotionGraph",
    "PoseTable",
    "ReachableOptions",
    "ShortestPaths",
    "build_map",
    "cluster_poses",
    "coverage",
    "motion_graph",
    "pose_table",
    "reachable_options",
    "shipped_map_path",
    "shortest_paths",
]

__getattr__, __dir__ = names_of(__name__, _MODULES)
