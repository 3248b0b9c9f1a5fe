"""The recordings that a map of a type is built from: which clips, and whether they are mirrored."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from mesa_mobility.capture import LoadedClips, Manifest, Recording, load_clips, mirror
from mesa_mobility.mobility.graph import THRESHOLD
from mesa_mobility.mobility.poses import PoseTable, pose_table

STANDING_TYPE = "standing"
"""Type of a manifest's clips that are added if no clip of the type asked for shows standing."""

BOTH, ALONE = "both sides", "mirror images alone"
"""How a map's metadata calls recordings with their mirror images, and mirror images alone."""


@dataclass(frozen=True)
class PreparedRecordings:
    """Result of :func:`prepare_recordings`.

    Attributes:
        recordings: those that the map is built from: as recorded, each followed by its mirror
            image, or mirror images alone. Standing clips that were added come last.
        clips: the clips of the type, without mirror images and added standing clips, and which of
            them were skipped or split.
        remarks: what a reader should know, one line each: that clips are acted (tag "acted" in the
            manifest), that recordings are not mirrored because the gait differs between the sides,
            that standing clips were added.
        choices: the decisions as entries of a map's metadata: ``mirrored`` ("both sides", "as
            recorded" or "mirror images alone"); ``mirrored_share``, the share of moving poses
            that look like a mirrored pose, if that was measured to decide; ``acted_clips``, the
            number of acted recordings, and ``standing_clips``, the number of standing recordings
            that were added, if any.
    """

    recordings: list[Recording]
    clips: LoadedClips
    remarks: list[str] = field(default_factory=list)
    choices: dict[str, str | float] = field(default_factory=dict)


def prepare_recordings(
    manifest: Manifest,
    type_name: str,
    *,
    mirrored: bool | None = None,
    other_side: bool = False,
    progress: Callable[[int, int], None] | None = None,
) -> PreparedRecordings:
    """Load the clips of a type, with their mirror images if the gait is alike on both sides.

    If no clip shows anybody standing, the manifest's clips of type "standing" are added.

    Args:
        manifest: the clips.
        type_name: pedestrian type.
        mirrored: whether mirror images are added; None adds them if the gait is alike on both
            sides.
        other_side: use only mirror images. If the recorded people limp on the left, those of the
            map limp on the right.
        progress: called as ``progress(done, total)`` after each clip.

    Raises:
        CaptureError: as ``load_clips`` does.
    """
    loaded = load_clips(manifest, pedestrian_type=type_name, mirrored=False, progress=progress)
    prepared = PreparedRecordings([], loaded)
    acted = sum("acted" in r.clip.tags for r in loaded.recordings if r.clip is not None)
    if acted:
        prepared.choices["acted_clips"] = acted
        prepared.remarks.append(f"{acted} of {len(loaded.recordings)} clips are acted")
    poses = pose_table(loaded.recordings)
    images = [mirror(recording) for recording in loaded.recordings]
    if mirrored is None and not other_side:
        share = mirrored_share(poses, pose_table(images))
        mirrored = share >= SYMMETRIC
        prepared.choices["mirrored_share"] = round(share, 3)
        if not mirrored:
            prepared.remarks.append(
                f"not mirrored: {share:.0%} of the poses look like one of a mirror image, "
                f"a gait alike on both sides has {SYMMETRIC:.0%} or more"
            )
    if other_side:
        prepared.choices["mirrored"] = ALONE
        prepared.recordings.extend(images)
    elif mirrored:
        prepared.choices["mirrored"] = BOTH
        pairs = zip(loaded.recordings, images, strict=True)
        prepared.recordings.extend(each for pair in pairs for each in pair)
    else:
        prepared.choices["mirrored"] = "as recorded"
        prepared.recordings.extend(loaded.recordings)
    if not poses.is_standing().any() and any(clip.type == STANDING_TYPE for clip in manifest):
        added = load_clips(manifest, pedestrian_type=STANDING_TYPE)
        prepared.recordings.extend(added.recordings)
        prepared.choices["standing_clips"] = len(added.recordings)
        prepared.remarks.append(
            f"nobody stands in the clips of type {type_name!r}: "
            f"{len(added.recordings)} of type {STANDING_TYPE!r} added"
        )
    return prepared


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
