"""A map small enough to work out by hand."""

from __future__ import annotations

import numpy as np
import pytest

from mesa_mobility.mobility import MobilityMap


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
