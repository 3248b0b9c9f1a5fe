"""Load the clips of a manifest as recordings from which a map can be built."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from mesa_mobility.capture.jumps import FRAME_RATE, sound_parts
from mesa_mobility.capture.legs import leg_joints, leg_length
from mesa_mobility.capture.manifest import UNKNOWN_TYPE, Clip, Manifest
from mesa_mobility.capture.reading import parse_recording
from mesa_mobility.capture.recording import Recording
from mesa_mobility.capture.transforms import mirror, resample, trim
from mesa_mobility.errors import CaptureError

MINIMUM_FRAMES = 45
"""Poses that a clip must have: the length of a movement option, 1.5 s."""

LEG_LENGTH_M = (0.25, 1.3)
"""Leg length (thigh and shank) of the smallest and the tallest people who walk, metres."""

FOOT_LENGTH_M = 0.6
"""From hip to hip, or from ankle to toe, with room to spare."""

Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class LoadedClips:
    """Result of :func:`load_clips`.

    Attributes:
        recordings: in the order of the manifest, each followed by its mirror image if wanted.
            Parts of a clip that was split are named after it and their frames of the file, such as
            "walk[120:344]".
        skipped: (name, reason) of the clips without a part that is long enough.
        split: (name, reason) of the clips that jump; only the parts before, between
            and after the jumps are used.
    """

    recordings: list[Recording]
    skipped: list[tuple[str, str]]
    split: list[tuple[str, str]]


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

    A clip is split where its hips or legs jump; see :func:`find_jumps`.

    Args:
        manifest: from :func:`read_manifest`, :func:`read_folder` or :func:`find_clips`.
        pedestrian_type: only clips of this type and those of a folder without a manifest,
            whose type is not known; None for all.
        frame_rate: Hz.
        mirrored: follow each recording with its mirror image.
        minimum_frames: clips and parts with fewer frames, after resampling, are skipped.
        progress: called as ``progress(done, total)`` after each clip.

    Raises:
        CaptureError: there is no clip of the type, a file cannot be used, has another sha256 or
            frame rate than the manifest says, ends before ``use_to``, has no known legs or legs
            that no human has, or nothing of any clip is long enough.
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
    loaded = LoadedClips([], [], [])
    for done, clip in enumerate(clips, start=1):
        _load(clip, loaded, frame_rate, mirrored, minimum_frames)
        if progress is not None:
            progress(done, len(clips))
    if not loaded.recordings:
        name, reason = loaded.skipped[0]
        others = f" ({len(clips) - 1} others neither)" if len(clips) > 1 else ""
        raise CaptureError(f"{manifest.path}: {name} cannot be used{others}: {reason}")
    return loaded


def _load(
    clip: Clip, loaded: LoadedClips, frame_rate: float, mirrored: bool, minimum_frames: int
) -> None:
    """Add the usable parts of a clip to ``loaded``."""
    recording = _read_clip(clip)
    shortest = math.ceil(minimum_frames * FRAME_RATE / frame_rate)
    parts = sound_parts(recording, shortest)
    kept = 0
    for start, stop in parts.ranges:
        part = resample(trim(recording, start, stop), frame_rate)
        if part.frames < minimum_frames:
            continue
        if parts.jumps:
            used = f"[{clip.use_from + start}:{clip.use_from + stop}]"
            part = replace(part, name=clip.clip + used)
        kept += 1
        loaded.recordings.append(part)
        if mirrored:
            loaded.recordings.append(mirror(part))
    reason = ""
    if parts.jumps:
        others = f" and {len(parts.jumps) - 1} more" if len(parts.jumps) > 1 else ""
        first = clip.use_from + parts.jumps[0]
        reason = f"jumps at frame {first}{others} of {clip.file}, where {parts.reason}"
    if kept and reason:
        loaded.split.append((clip.clip, reason))
    elif not kept:
        frames = resample(recording, frame_rate).frames
        short = f"{frames} frames at {frame_rate:g} Hz, {minimum_frames} needed"
        loaded.skipped.append((clip.clip, reason or short))


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
    _check_legs(recording, clip)
    return replace(trim(recording, clip.use_from, clip.use_to), name=clip.clip, clip=clip)


def _check_legs(recording: Recording, clip: Clip) -> None:
    """Refuse legs, feet or hips of a size that no human has."""
    legs = leg_joints(recording.skeleton)
    at = trim(recording, 0, 1).positions()[0]
    pairs = [(legs.left[0], legs.right[0]), legs.left[2:], legs.right[2:]]
    widest = max(float(np.linalg.norm(at[a] - at[b])) for a, b in pairs)
    if widest > FOOT_LENGTH_M:
        raise CaptureError(
            f"{clip.where}: {clip.file} has hips or feet {widest:.3g} m long, "
            f"expected at most {FOOT_LENGTH_M:g} m"
        )
    length = leg_length(recording.skeleton)
    shortest, longest = LEG_LENGTH_M
    if not shortest <= length <= longest:
        raise CaptureError(
            f"{clip.where}: {clip.file} has legs of {length:.3g} m with unit_to_m "
            f"{clip.unit_to_m:g}, expected {shortest:g} to {longest:g} m"
        )
