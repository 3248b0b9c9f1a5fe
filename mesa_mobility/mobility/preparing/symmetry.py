"""Whether a gait is alike on both sides, so that mirror images of it show the same person.

A limp is not: its mirror image limps on the other leg. In a symmetric gait most poses look like
some pose of the mirror images, a step of the other leg. In an asymmetric one they do not.
"""

from __future__ import annotations

import numpy as np

from mesa_mobility.mobility.graph import THRESHOLD
from mesa_mobility.mobility.poses import PoseTable

SYMMETRIC = 0.3
"""Least share of moving poses with a look-alike in the mirror images of a symmetric gait."""


def mirrored_share(poses: PoseTable, mirrored: PoseTable) -> float:
    """Share of the moving poses that look like a pose of the mirror images.

    Args:
        poses: of the recordings.
        mirrored: of their mirror images.

    Returns:
        Between 0 and 1; 1 if nobody moves.
    """
    from scipy.spatial import cKDTree

    moving = poses.features[~poses.is_standing()]
    if not len(moving):
        return 1.0
    nearest = cKDTree(mirrored.features).query(moving, distance_upper_bound=THRESHOLD)[0]
    return float(np.isfinite(nearest).mean())
