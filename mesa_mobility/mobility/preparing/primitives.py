"""Motion primitives of a differential drive: the options of somebody on wheels, who has no gait.

The state is the speed, in bins. In an option the speed changes evenly from one bin to another, and
the rate of turn is one of a few in each part of it, all within the limits of the drive: motion
primitives of a state lattice (Pivtoraiko, Knepper and Kelly 2009). The wheels do not slip: each
step leads along the heading, and there is no step to the side. From rest it turns on the spot.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.mobility.clusters import STANDING
from mesa_mobility.mobility.edits import SAMPLE_EVERY
from mesa_mobility.mobility.map import MobilityMap
from mesa_mobility.mobility.poses import FRAME_RATE
from mesa_mobility.mobility.standing.ways_back import check_ways_back
from mesa_mobility.mobility.storing.assembly import STAND_FRAMES
from mesa_mobility.mobility.storing.steps import quantise_costs, quantise_paths
from mesa_mobility.mobility.thinning import DURATIONS, EDIT_CELL

SPEED_BIN = 0.1
"""Difference of two neighbouring speeds, m/s."""

REVERSE = -0.2
"""The one speed backwards, m/s: to back off from a wall where there is no room to turn."""

PARTS = {12: 1, 24: 2, 45: 3}
"""Parts of an option of so many frames, each with a rate of turn of its own."""

TURNS = (0.0, 0.15, -0.15, 0.4, -0.4, 1.0, -1.0)
"""Rates of turn, as shares of the greatest that the speed allows."""

_SEATED = [
    [0.0, 0.0, 0.5],
    *(
        [x, y, z]
        for y in (0.1, -0.1)
        for x, z in ((0.0, 0.5), (0.42, 0.5), (0.48, 0.12), (0.62, 0.08))
    ),
]
"""Joints of somebody who sits, metres, as ``POSE_JOINTS`` lists them."""


@dataclass(frozen=True)
class DifferentialDrive:
    """What somebody on wheels can do.

    Attributes:
        fastest: speed, m/s.
        acceleration: at most, m/s^2.
        braking: deceleration at most, m/s^2.
        turn_rate: at most, rad/s; on the spot as well.
        lateral_acceleration: at most, m/s^2; at a higher speed, turns are therefore wider.
    """

    fastest: float
    acceleration: float
    braking: float
    turn_rate: float
    lateral_acceleration: float

    def speeds(self) -> NDArray[np.float64]:
        """Speed of each cluster, m/s: standing, backwards, and forwards from slow to fast."""
        forwards = SPEED_BIN * np.arange(1, round(self.fastest / SPEED_BIN) + 1)
        return np.concatenate([[0.0, REVERSE], forwards])

    def reachable(self, speed: float, seconds: float) -> NDArray[np.int64]:
        """Clusters whose speed, m/s, can be reached from ``speed`` within these ``seconds``."""
        change = self.speeds() - speed
        # Slowing down backwards is an acceleration forwards; both are small.
        within = (change <= self.acceleration * seconds + 1e-9) & (
            change >= -self.braking * seconds - 1e-9
        )
        return np.flatnonzero(within)

    def turn_rate_at(self, speeds: NDArray[np.float64]) -> NDArray[np.float64]:
        """Greatest rate of turn at each speed, rad/s."""
        fast = np.maximum(np.abs(speeds), 1e-9)
        return np.minimum(self.turn_rate, self.lateral_acceleration / fast)


def map_of_primitives(
    drive: DifferentialDrive, type_name: str, metadata: dict[str, Any]
) -> MobilityMap:
    """The mobility map of a drive; clusters are speeds.

    Args:
        drive: its limits.
        type_name: name of the pedestrian type.
        metadata: further entries for the map's metadata.

    Raises:
        MapError: people of the map would be trapped.
    """
    speeds = drive.speeds()
    counts: list[int] = []
    durations: list[int] = []
    costs: list[float] = []
    paths: list[NDArray[np.float64]] = []
    path_clusters: list[NDArray[np.int64]] = []
    for cluster in range(len(speeds)):
        first = len(durations)
        if cluster == STANDING:
            durations.append(STAND_FRAMES)
            costs.append(0.0)
            paths.append(np.zeros((STAND_FRAMES // SAMPLE_EVERY, 3)))
            path_clusters.append(np.full(STAND_FRAMES // SAMPLE_EVERY, STANDING))
        for frames in DURATIONS:
            effort, ways, passed = _options(drive, float(speeds[cluster]), frames)
            durations += [frames] * len(effort)
            costs += effort.tolist()
            paths += list(ways)
            path_clusters += list(passed)
        counts.append(len(durations) - first)
    samples = np.array(durations) // SAMPLE_EVERY
    seated = np.array(_SEATED, dtype=np.float32)
    built = MobilityMap(
        offsets=np.concatenate([[0], np.cumsum(counts)]).astype(np.int64),
        durations=np.array(durations, dtype=np.int16),
        costs=quantise_costs(np.array(costs)),
        path_offsets=np.concatenate([[0], np.cumsum(samples)]).astype(np.int64),
        paths=quantise_paths(np.concatenate(paths)),
        path_clusters=np.concatenate(path_clusters).astype(np.uint16),
        mean_poses=np.repeat(seated[None], len(speeds), axis=0),
        centres=np.repeat(_features(seated)[None], len(speeds), axis=0),
        sizes=np.ones(len(speeds), dtype=np.int64),
        mean_speeds=np.abs(speeds).astype(np.float32),
        metadata={
            "pedestrian_type": type_name,
            "frame_rate_hz": FRAME_RATE,
            "build": {
                "speeds_m_s": np.round(speeds, 3).tolist(),
                "turn_rates": list(TURNS),
                "durations_frames": list(DURATIONS),
                "cell": [round(float(size), 6) for size in EDIT_CELL],
            },
            "provenance": [],
            "acknowledgements": [],
            **metadata,
        },
    )
    check_ways_back(built)
    return built


def _options(
    drive: DifferentialDrive, speed: float, frames: int
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.int64]]:
    """Costs, paths and clusters of the options of one speed and duration, thinned."""
    ends = drive.reachable(speed, frames / FRAME_RATE)
    shares = np.array(list(product(TURNS, repeat=PARTS[frames])))
    end = np.repeat(ends, len(shares))
    share = np.tile(np.repeat(shares, frames // PARTS[frames], axis=1), (len(ends), 1))
    to = drive.speeds()[end]
    # In the middle of each frame.
    middle = (np.arange(frames) + 0.5) / frames
    at = speed + (to[:, None] - speed) * middle
    rate = share * drive.turn_rate_at(at)
    heading = np.cumsum(rate, axis=1) / FRAME_RATE
    along = heading - 0.5 * rate / FRAME_RATE
    path = np.stack(
        [
            np.cumsum(at * np.cos(along), axis=1) / FRAME_RATE,
            np.cumsum(at * np.sin(along), axis=1) / FRAME_RATE,
            heading,
        ],
        axis=2,
    )[:, SAMPLE_EVERY - 1 :: SAMPLE_EVERY]
    reached = np.arange(SAMPLE_EVERY, frames + 1, SAMPLE_EVERY) / frames
    passed = speed + (to[:, None] - speed) * reached
    clusters = np.abs(passed[..., None] - drive.speeds()).argmin(axis=2)
    effort = np.abs(to - speed) / drive.acceleration + np.abs(rate).sum(axis=1) / (
        FRAME_RATE * drive.turn_rate
    )
    # Changes of the rate of turn cost too: of two ways to the same place, the steadier.
    effort += 0.1 * np.abs(np.diff(share, axis=1)).sum(axis=1)
    kept = _cheapest(np.column_stack([end, np.floor(path[:, -1] / EDIT_CELL + 0.5)]), effort)
    return effort[kept], path[kept], clusters[kept]


def _cheapest(keys: NDArray[np.float64], costs: NDArray[np.float64]) -> NDArray[np.int64]:
    """Rows of the cheapest option of each key, the first among equals."""
    order = np.lexsort((np.arange(len(keys)), np.round(costs, 6), *keys.T[::-1]))
    first = np.append(True, (np.diff(keys[order], axis=0) != 0).any(axis=1))
    return order[first]


def _features(joints: NDArray[np.float32]) -> NDArray[np.float32]:
    """The 36 features of a pose that does not change: directions of its segments."""
    pairs = ((1, 2), (2, 3), (3, 4), (5, 6), (6, 7), (7, 8))
    segments = np.array([joints[b] - joints[a] for a, b in pairs])
    directions = segments / np.linalg.norm(segments, axis=1, keepdims=True)
    return np.concatenate([directions.reshape(-1), np.zeros(18)]).astype(np.float32)
