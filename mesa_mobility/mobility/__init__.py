"""Pose features, motion graph, clusters, movement options and the map file."""

from mesa_mobility.mobility.apsp import ShortestPaths, shortest_paths
from mesa_mobility.mobility.build import build_map
from mesa_mobility.mobility.clusters import Clusters, cluster_poses
from mesa_mobility.mobility.coverage import coverage
from mesa_mobility.mobility.graph import MotionGraph, motion_graph
from mesa_mobility.mobility.map import MobilityMap
from mesa_mobility.mobility.mapfile import shipped_map_path
from mesa_mobility.mobility.paths import ReachableOptions, reachable_options
from mesa_mobility.mobility.poses import POSE_JOINTS, PoseTable, pose_table

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
