"""Subtractive clustering of poses, with a single cluster for all standing poses.

Subtractive clustering (Chiu 1994; used by Kim et al. 2003, the paper's reference
[5]): each pose has a potential, the sum of Gaussians of its distance to all
others; the highest becomes a centre, its neighbourhood is subtracted, and so
on.  Chiu's stop ratio would stop below 30 clusters here, because standing poses
dwarf all other potentials, so we stop at a requested number.

Standing poses share one cluster.  Split up, each part would hold the few
options that its own poses happened to lead to, and a stander would be trapped.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numba import prange
from numpy.typing import NDArray

from mesa_mobility.compiled.decorators import kept
from mesa_mobility.errors import MapError
from mesa_mobility.mobility.graph import MotionGraph, squared_distances

STANDING = 0
"""Number of the standing cluster."""

POSES_PER_CLUSTER = 150
"""Poses for each cluster where no number of clusters is asked for.

Clusters of a few poses share no options; of many, they join poses that look different.
"""

ACCEPTANCE_RADIUS = 0.4
"""r_a of subtractive clustering, as a multiple of the poses' root mean square spread."""

SQUASH_RATIO = 1.5
"""r_b / r_a."""


@dataclass(frozen=True)
class Clusters:
    """Clusters of the poses that survived in the motion graph.

    Attributes:
        labels: (n,) int32; cluster of each pose, -1 where the pose is not in the graph.
        centres: (k, 36) float32; features of the centre of each cluster, the pose chosen
            by subtractive clustering. Cluster 0 is the standing one: its centre is the mean
            of its poses, or zero if nobody stands.
        mean_joints: (k, 9, 3) float32; mean pose, metres in the pelvis frame.
        sizes: (k,) int64; poses in each cluster, at least 1 but for the standing one.
        mean_speeds: (k,) float64; mean root speed, m/s.
        stopped_by: which rule ended the search for centres.
    """

    labels: NDArray[np.int32]
    centres: NDArray[np.float32]
    mean_joints: NDArray[np.float32]
    sizes: NDArray[np.int64]
    mean_speeds: NDArray[np.float64]
    stopped_by: str

    def __len__(self) -> int:
        return len(self.sizes)


def cluster_poses(
    graph: MotionGraph,
    clusters: int | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Clusters:
    """Cluster the poses of a motion graph.

    Args:
        graph: the motion graph; only poses in its component take part.
        clusters: number of clusters wanted, the standing one included; by default one for
            ``POSES_PER_CLUSTER`` poses.
        progress: called as ``progress(done, total)``.

    Raises:
        MapError: ``clusters`` below two, or no moving poses.
    """
    if clusters is None:
        clusters = max(int(graph.kept.sum()) // POSES_PER_CLUSTER, 2)
    if clusters < 2:
        raise MapError(f"clusters: got {clusters}, expected at least 2 (one for standing)")
    poses = graph.poses
    standing = graph.kept & poses.is_standing()
    moving = np.flatnonzero(graph.kept & ~standing)
    if not len(moving):
        anywhere = int((~poses.is_standing()).sum())
        found = f"; {anywhere} others are not connected with these" if anywhere else ""
        raise MapError(
            f"no moving poses among the {int(graph.kept.sum())} that lead to each other and back"
            f"{found}: expected recordings of people who walk"
        )
    wanted = min(clusters - 1, len(moving))
    features = poses.features[moving]
    columns = np.ascontiguousarray(features.T)
    spread = float(np.sqrt(np.mean(np.sum((features - features.mean(axis=0)) ** 2, axis=1))))
    radius = ACCEPTANCE_RADIUS * spread

    potential = _potentials(columns, np.float32(4.0 / radius**2))
    squash = np.float32(4.0 / (SQUASH_RATIO * radius) ** 2)
    chosen: list[int] = []
    for done in range(wanted):
        best = int(np.argmax(potential))
        chosen.append(best)
        _subtract(columns, best, squash, potential)
        potential[best] = -np.inf
        if progress is not None and (done % 16 == 15 or done == wanted - 1):
            progress(done + 1, wanted)

    labels = np.full(len(poses), -1, dtype=np.int32)
    labels[standing] = STANDING
    nearest = nearest_centre(features, features[chosen])
    used, compact = np.unique(nearest, return_inverse=True)  # identical centres leave one empty
    labels[moving] = 1 + compact
    centre = poses.features[standing].sum(axis=0, keepdims=True) / max(standing.sum(), 1)
    centres = np.concatenate([centre, features[np.array(chosen)[used]]])
    inside = np.flatnonzero(labels >= 0)
    k = 1 + len(used)
    sizes = np.bincount(labels[inside], minlength=k)
    several = np.maximum(sizes, 1)
    joints = np.zeros((k, *poses.joints.shape[1:]))
    np.add.at(joints, labels[inside], poses.joints[inside])
    speeds = np.bincount(labels[inside], weights=poses.speed[inside], minlength=k)
    stopped = f"reached the requested number of clusters ({clusters})"
    if wanted < clusters - 1:
        stopped = f"every moving pose became a centre ({wanted})"
    return Clusters(
        labels=labels,
        centres=centres.astype(np.float32),
        mean_joints=(joints / several[:, None, None]).astype(np.float32),
        sizes=sizes,
        mean_speeds=speeds / several,
        stopped_by=stopped,
    )


def nearest_centre(
    features: NDArray[np.float32], centres: NDArray[np.float32]
) -> NDArray[np.int32]:
    """Index of the nearest of ``centres`` (k, 36) for each row of ``features`` (n, 36)."""
    return _nearest(np.ascontiguousarray(features), np.ascontiguousarray(centres.T))


@kept(parallel=True)
def _nearest(features: NDArray[np.float32], columns: NDArray[np.float32]) -> NDArray[np.int32]:
    k = columns.shape[1]
    nearest = np.empty(len(features), np.int32)
    for i in prange(len(features)):
        d2 = np.empty(k, np.float32)
        squared_distances(features[i], columns, 0, k, d2)
        nearest[i] = np.argmin(d2)
    return nearest


@kept(parallel=True)
def _potentials(columns: NDArray[np.float32], alpha: np.float32) -> NDArray[np.float64]:
    """Sum over all poses of exp(-alpha d^2); terms below exp(-16), 1e-7, are left out."""
    n = columns.shape[1]
    potential = np.empty(n)
    for i in prange(n):
        d2 = np.empty(512, np.float32)
        total = 0.0
        for start in range(0, n, 512):
            width = min(512, n - start)
            squared_distances(columns[:, i], columns, start, width, d2)
            for q in range(width):
                exponent = alpha * d2[q]
                if exponent < 16.0:
                    total += np.exp(-exponent)
        potential[i] = total
    return potential


@kept(parallel=True)
def _subtract(
    columns: NDArray[np.float32], centre: int, beta: np.float32, potential: NDArray[np.float64]
) -> None:
    n = columns.shape[1]
    peak = potential[centre]
    for block in prange((n + 511) // 512):
        d2 = np.empty(512, np.float32)
        start = block * 512
        width = min(512, n - start)
        squared_distances(columns[:, centre], columns, start, width, d2)
        for q in range(width):
            exponent = beta * d2[q]
            if exponent < 16.0:
                potential[start + q] -= peak * np.exp(-exponent)
