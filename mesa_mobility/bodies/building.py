"""Make the pose bank of a map from the recordings that the map was built from."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.bodies.bank import PoseBank
from mesa_mobility.bodies.bank_data import HEIGHT_STEP, QUATERNION_STEP, STRIDE_STEP
from mesa_mobility.bodies.retargeting import retarget
from mesa_mobility.bodies.retracing import Retraced, retrace
from mesa_mobility.bodies.rotations import quaternions
from mesa_mobility.bodies.skeleton import JOINTS, STATURE
from mesa_mobility.capture import Recording
from mesa_mobility.capture.transforms import MIRRORED, mirror
from mesa_mobility.mobility import MobilityMap
from mesa_mobility.mobility.clusters import STANDING
from mesa_mobility.mobility.provenance import acknowledgements, provenance

Progress = Callable[[str, int, int], None]


def build_bank(
    map_: MobilityMap, recordings: Sequence[Recording], progress: Progress | None = None
) -> PoseBank:
    """The pose bank of a map.

    Args:
        map_: the map.
        recordings: those that it was built from, prepared in the same way and order.
        progress: called as ``progress(stage, done, total)``.

    Raises:
        MapError: the recordings do not give the map's options.
        CaptureError: a recording without known legs.
    """
    retraced = retrace(map_, recordings, progress)
    numbers = np.empty(len(retraced.poses), dtype=np.int64)
    kept: list[Recording] = []
    rows_of: dict[str, int] = {}
    facings, total = [], 0
    first = retraced.poses.first
    for clip, recording in enumerate(recordings):
        own = slice(int(first[clip]), int(first[clip + 1]))
        name = recording.name.removesuffix(MIRRORED)
        mirrored = recording.name != name
        if name not in rows_of:
            facing = retraced.poses.facing[own]
            kept.append(_original(recording))
            facings.append(-facing if mirrored else facing)
            rows_of[name] = total
            total += recording.frames
        rows = rows_of[name] + np.arange(recording.frames)
        numbers[own] = 2 * rows + mirrored
    clips = []
    for done, (recording, facing) in enumerate(zip(kept, facings, strict=True), start=1):
        clips.append(retarget(recording, facing))
        if progress is not None:
            progress("poses on the neutral skeleton", done, len(kept))
    turns = np.concatenate([clip.rotations for clip in clips])
    heights = np.concatenate([clip.heights for clip in clips])
    contacts = np.concatenate([clip.contacts for clip in clips])
    typical = _typical(map_, retraced, numbers)
    frames, poses, counts = _stretches(map_, retraced.chains, numbers, typical)
    return PoseBank(
        rotations=_quantised(quaternions(turns)),
        heights=np.rint(heights / HEIGHT_STEP).astype(np.int16),
        contacts=(contacts @ (1 << np.arange(4))).astype(np.uint8),
        clips=np.concatenate([[0], np.cumsum([len(clip.heights) for clip in clips])]),
        offsets=np.concatenate([[0], np.cumsum(counts)]).astype(np.int64),
        frames=frames.astype(np.int16),
        poses=poses.astype(np.int32),
        strides=np.rint(retraced.strides / STRIDE_STEP).astype(np.uint8),
        cluster_poses=typical.astype(np.int32),
        metadata=_metadata(map_, recordings, kept),
    )


def _original(recording: Recording) -> Recording:
    """The recording, or where it is a mirror image, what it is the image of."""
    name = recording.name.removesuffix(MIRRORED)
    return recording if recording.name == name else replace(mirror(recording), name=name)


def _quantised(found: NDArray[np.float64]) -> NDArray[np.int16]:
    """Quaternions of which each is near the one before, since q and -q are the same rotation."""
    along = np.einsum("njk,njk->nj", found[1:], found[:-1])
    sign = np.cumprod(np.where(along < 0.0, -1.0, 1.0), axis=0)
    found = np.concatenate([found[:1], found[1:] * sign[..., None]])
    return np.rint(found / QUATERNION_STEP).astype(np.int16)


def _typical(
    map_: MobilityMap, retraced: Retraced, numbers: NDArray[np.int64]
) -> NDArray[np.int64]:
    """(k,) number of the pose nearest to the centre of each cluster."""
    features, labels = retraced.poses.features, retraced.labels
    typical = np.empty(map_.n_clusters, dtype=np.int64)
    for cluster in range(map_.n_clusters):
        rows = np.flatnonzero(labels == cluster)
        if not len(rows):  # the standing cluster of another map
            rows = np.arange(len(features))
        distance = np.linalg.norm(features[rows] - map_.centres[cluster], axis=1)
        typical[cluster] = numbers[rows[np.argmin(distance)]]
    return typical


def _stretches(
    map_: MobilityMap,
    chains: NDArray[np.int32],
    numbers: NDArray[np.int64],
    typical: NDArray[np.int64],
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Frames and poses of all stretches, and how many each option has."""
    used = chains[:, :, 1] >= 0
    # An option without poses of its own, such as the stand, is shown by its cluster's typical pose.
    without = ~used.any(axis=1)
    cluster = np.repeat(np.arange(map_.n_clusters), np.diff(map_.offsets))
    frames = np.where(used, chains[:, :, 0], 0)
    poses = np.where(used, numbers[np.maximum(chains[:, :, 1], 0)], 0)
    used[without, 0] = True
    poses[without, 0] = typical[cluster[without]]
    return frames[used].astype(np.int64), poses[used], used.sum(axis=1)


def _metadata(
    map_: MobilityMap, recordings: Sequence[Recording], kept: Sequence[Recording]
) -> dict[str, Any]:
    return {
        "pedestrian_type": map_.pedestrian_type,
        "map_digest": map_.digest,
        "standing": int(STANDING),
        "scale": float(map_.metadata.get("derived", {}).get("length_factor", 1.0)),
        "skeleton": {"joints": list(JOINTS), "stature_m": STATURE},
        "clips": provenance(kept),
        "acknowledgements": acknowledgements(recordings),
    }
