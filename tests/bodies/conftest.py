"""Pose banks small enough to work out by hand."""

from __future__ import annotations

import numpy as np
import pytest

from mesa_mobility.bodies import PoseBank
from mesa_mobility.bodies.skeleton import JOINT, TURN_OF, TURNING


def quarter_turns(joint: str, degrees: list[float]) -> np.ndarray:
    """(n, 17, 4) quaternions in file units: a joint turned forward by these angles."""
    quaternions = np.zeros((len(degrees), len(TURNING), 4))
    quaternions[..., 3] = 1.0
    half = np.deg2rad(degrees) / 2
    quaternions[:, TURN_OF[JOINT[joint]], 1] = np.sin(half)
    quaternions[:, TURN_OF[JOINT[joint]], 3] = np.cos(half)
    return np.rint(quaternions * 32767).astype(np.int16)


def make_bank(degrees=(0.0, 10.0, 20.0, 30.0), *, first=2, **changes) -> PoseBank:
    """Two clips in which the left elbow bends; option 0 stands, option 1 changes clips."""
    degrees = list(degrees)
    fields = {
        "rotations": quarter_turns("left_elbow", degrees),
        "heights": np.full(len(degrees), 9350, dtype=np.int16),
        "contacts": np.full(len(degrees), 0b0011, dtype=np.uint8),
        "clips": np.array([0, first, len(degrees)]),
        "offsets": np.array([0, 1, 3]),
        "frames": np.array([0, 0, 1], dtype=np.int16),
        "poses": np.array([0, 0, 2 * first], dtype=np.int32),
        "strides": np.array([100, 100], dtype=np.uint8),
        "cluster_poses": np.array([0, 2 * first], dtype=np.int32),
        "metadata": {
            "map_digest": "abc",
            "pedestrian_type": "test",
            "clips": [{"clip": "one"}, {"clip": "two"}],
        },
    }
    return PoseBank(**{**fields, **changes})


@pytest.fixture
def bank() -> PoseBank:
    return make_bank()
