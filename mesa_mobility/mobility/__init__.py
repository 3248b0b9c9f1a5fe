"""Pose features, motion graph, clusters, movement options and the map file.

Reading a map needs none of what builds one, so the names are imported when
they are first used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from mesa_mobility._lazy import names_of

if TYPE_CHECKING:
    from mesa_mobility.mobility.build import build_families as build_families
    from mesa_mobility.mobility.build import build_map as build_map
    from mesa_mobility.mobility.build import map_of_families as map_of_families
    from mesa_mobility.mobility.clusters import Clusters as Clusters
    from mesa_mobility.mobility.clusters import cluster_poses as cluster_poses
    from mesa_mobility.mobility.graph import MotionGraph as MotionGraph
    from mesa_mobility.mobility.graph import ShortestPaths as ShortestPaths
    from mesa_mobility.mobility.graph import motion_graph as motion_graph
    from mesa_mobility.mobility.graph import shortest_paths as shortest_paths
    from mesa_mobility.mobility.judging.abilities import abilities_of as abilities_of
    from mesa_mobility.mobility.judging.held_out import coverage as coverage
    from mesa_mobility.mobility.judging.left_out import (
        left_out_one_at_a_time as left_out_one_at_a_time,
    )
    from mesa_mobility.mobility.judging.left_out import sample_left_out as sample_left_out
    from mesa_mobility.mobility.map import MobilityMap as MobilityMap
    from mesa_mobility.mobility.mapfile import shipped_map_path as shipped_map_path
    from mesa_mobility.mobility.paths import ReachableOptions as ReachableOptions
    from mesa_mobility.mobility.paths import reachable_options as reachable_options
    from mesa_mobility.mobility.poses import POSE_JOINTS as POSE_JOINTS
    from mesa_mobility.mobility.poses import PoseTable as PoseTable
    from mesa_mobility.mobility.poses import pose_table as pose_table
    from mesa_mobility.mobility.preparing.again import recordings_behind as recordings_behind
    from mesa_mobility.mobility.preparing.bootstrap import draw_clips as draw_clips
    from mesa_mobility.mobility.preparing.clips import PreparedRecordings as PreparedRecordings
    from mesa_mobility.mobility.preparing.clips import prepare_recordings as prepare_recordings
    from mesa_mobility.mobility.preparing.derived import DerivedType as DerivedType
    from mesa_mobility.mobility.preparing.derived import derived_type as derived_type
    from mesa_mobility.mobility.preparing.wheelchairs import WHEELCHAIRS as WHEELCHAIRS
    from mesa_mobility.mobility.preparing.wheelchairs import Wheelchair as Wheelchair
    from mesa_mobility.mobility.storing.families import OptionFamilies as OptionFamilies

__getattr__, __dir__ = names_of(__name__, __file__)
