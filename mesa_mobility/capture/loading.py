"""From a manifest to recordings that a mobility map can be built from."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from mesa_mobility.capture.legs import leg_joints
from mesa_mobility.capture.manifest import UNKNOWN_TYPE, Clip, Manifest
from mesa_mobility.capture.reading import parse_recording
from mesa_mobility.capture.recording import Recording
from mesa_mobility.capture.transforms import mirror, resample, trim
from mesa_mobility.errors import CaptureError

MINIMUM_FRAMES = 45
"""Poses that a clip must have: the length of a movement option, 1.5 s."""

Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class LoadedClips:
    """What :func:`load_clips` gives.

    Attributes:
        recordings: in the order of the manifest, each followed by its mirror image if wanted.
        skipped: (name, reason) of the clips that were too short.
    """

    recordings: list[Recording]
    skipped: list[tuple[str, str]]


def load_clips(
    manifest: Manifest,
    *,
    pedestrian_type: str | None = None,
    frame_rate: float = 30.0,
    mirrored: bool = True,
    minimum_frames: int = MINIMUM_FRAMES,
    progress: Progress | None = None,
) -> LoadedClips:
    """Read the clips of a manifest, cut to their usable frames and resampled.

    Args:
        manifest: from :func:`read_manifest`, :func:`read_folder` or :func:`find_clips`.
        pedestrian_type: only clips of this type and those of a folder without a manifest,
            whose type is not known; None for all.
        frame_rate: Hz.
        mirrored: follow each recording with its mirror image.
        minimum_frames: clips with fewer frames, after resampling, are skipped.
        progress: called as ``progress(done, total)`` after each clip.

    Raises:
        CaptureError: there is no clip of the type, a file cannot be used, has another sha256 or
            frame rate than the manifest says, ends before ``use_to``, or has no known legs.
    """
    clips = [
        clip
        for clip in manifest
        if pedestrian_type is None or clip.type in (pedestrian_type, UNKNOWN_TYPE)
    ]
    if not clips:
        known = ", ".join(sorted({clip.type for clip in manifest}))
        raise CaptureError(
            f"{manifest.path}: no clips of type {pedestrian_type!r}, expected one of {known}"
        )
    recordings: list[Recording] = []
    skipped: list[tuple[str, str]] = []
    for done, clip in enumerate(clips, start=1):
        recording = resample(_read_clip(clip), frame_rate)
        if recording.frames < minimum_frames:
            reason = f"{recording.frames} frames at {frame_rate:g} Hz, {minimum_frames} needed"
            skipped.append((clip.clip, reason))
        else:
            recordings.append(recording)
            if mirrored:
                recordings.append(mirror(recording))
        if progress is not None:
            progress(done, len(clips))
    return LoadedClips(recordings, skipped)


def _read_clip(clip: Clip) -> Recording:
    recording = parse_recording(
        clip.read(), clip.path, unit_to_m=clip.unit_to_m, frame_rate=clip.native_fps
    )
    if abs(recording.frame_rate - clip.native_fps) > 0.01 * clip.native_fps:
        raise CaptureError(
            f"{clip.where}: native_fps {clip.native_fps:g}, but {clip.file} has "
            f"{recording.frame_rate:g} frames a second"
        )
    if clip.use_to > recording.frames:
        raise CaptureError(
            f"{clip.where}: use_to {clip.use_to}, but {clip.file} has {recording.frames} frames"
        )
    try:
        leg_joints(recording.skeleton)
    except CaptureError as error:
        raise CaptureError(f"{clip.where}: {clip.file}: {error}") from None
    return replace(trim(recording, clip.use_from, clip.use_to), name=clip.clip, clip=clip)
