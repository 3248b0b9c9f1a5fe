"""Pose tables and maps small enough to work out by hand."""

from __future__ import annotations

import numpy as np
import pytest

from mesa_mobility.mobility import MobilityMap, PoseTable


def make_poses(features, clip_lengths, *, step=None, speed=None):
    """A pose table from features (n, 36) and the lengths of its clips."""
    features = np.asarray(features, dtype=np.float32)
    n = len(features)
    assert sum(clip_lengths) == n
    first = np.concatenate([[0], np.cumsum(clip_lengths)])
    steps = np.tile([0.04, 0.0, 0.0], (n, 1)) if step is None else np.asarray(step, dtype=float)
    return PoseTable(
        features=features,
        joints=np.zeros((n, 9, 3), dtype=np.float32),
        step=steps,
        position=np.zeros((n, 2)),
        facing=np.zeros(n),
        speed=np.full(n, 1.2) if speed is None else np.asarray(speed, dtype=float),
        turn_rate=np.zeros(n),
        clip=np.repeat(np.arange(len(clip_lengths), dtype=np.int32), clip_lengths),
        first=first,
        clip_names=tuple(f"clip{k}" for k in range(len(clip_lengths))),
    )


def random_poses(rng, clips=4, length=60, wobble=0.02):
    """Clips that repeat one noisy cycle of poses, as walking does; the first stands at first."""
    phase = np.arange(length) * 2 * np.pi / 20
    cycle = np.column_stack([np.cos((k + 1) * phase + k) for k in range(36)])
    features = np.concatenate([cycle + rng.normal(0, wobble, cycle.shape) for _ in range(clips)])
    speed = np.full(clips * length, 1.2)
    speed[:20] = 0.0
    step = np.column_stack(
        [
            rng.normal(0.04, 0.005, clips * length),
            rng.normal(0, 0.005, clips * length),
            rng.normal(0, 0.02, clips * length),
        ]
    )
    step[np.arange(1, clips + 1) * length - 1] = 0.0
    return make_poses(features, [length] * clips, step=step, speed=speed)


@pytest.fixture
def small_map() -> MobilityMap:
    """Two clusters, three options: a stand of 12 frames, a step of 12 and a walk of 24."""
    stand = np.zeros((4, 3))
    step = np.column_stack([np.arange(1, 5) * 0.1, np.zeros(4), np.zeros(4)])
    walk = np.column_stack([np.arange(1, 9) * 0.15, np.arange(1, 9) * 0.01, np.arange(1, 9) * 0.02])
    return MobilityMap(
        offsets=np.array([0, 2, 3]),
        durations=np.array([12, 12, 24], dtype=np.int16),
        costs=np.array([0.0, 0.5, 1.25], dtype=np.float32),
        path_offsets=np.array([0, 4, 8, 16]),
        paths=np.concatenate([stand, step, walk]).astype(np.float32),
        path_clusters=np.array([0] * 4 + [1] * 4 + [1] * 7 + [0], dtype=np.uint16),
        mean_poses=np.zeros((2, 9, 3), dtype=np.float32),
        centres=np.zeros((2, 36), dtype=np.float32),
        sizes=np.array([10, 20]),
        mean_speeds=np.array([0.0, 1.2], dtype=np.float32),
        metadata={"pedestrian_type": "test", "body": {"core_radius_m": 0.15}},
    )
