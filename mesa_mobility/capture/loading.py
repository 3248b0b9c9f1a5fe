"""From a manifest to recordings that a mobility map can be built from."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

from mesa_mobility.capture.amc import FRAME_RATE, parse_amc
from mesa_mobility.capture.bvh import parse_bvh
from mesa_mobility.capture.manifest import Clip, Manifest
from mesa_mobility.capture.recording import Recording
from mesa_mobility.capture.text import read_bytes
from mesa_mobility.capture.transforms import mirror, resample, trim
from mesa_mobility.errors import CaptureError

MINIMUM_FRAMES = 46
"""Poses of a clip that is of use: a movement option of 45 frames has 46."""

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


def read_recording(
    path: str | Path, *, unit_to_m: float, frame_rate: float = FRAME_RATE
) -> Recording:
    """Read a ``.bvh``, ``.bvh.xz`` or ``.amc`` file, told by its name.

    Args:
        path: the file.
        unit_to_m: metres in one unit of the file.
        frame_rate: frames a second of an AMC file, which does not tell.

    Raises:
        CaptureError: the name ends otherwise, or the file cannot be used.
    """
    path = Path(path)
    return _parse(read_bytes(path), path, unit_to_m, frame_rate)


def _parse(data: bytes, path: Path, unit_to_m: float, frame_rate: float) -> Recording:
    suffix = "".join(path.suffixes[-2:]).lower()
    if suffix.endswith((".bvh", ".bvh.xz")):
        return parse_bvh(data, path, unit_to_m=unit_to_m)
    if suffix.endswith(".amc"):
        return parse_amc(data, path, unit_to_m=unit_to_m, frame_rate=frame_rate)
    raise CaptureError(f"{path}: unknown kind of file, expected .bvh, .bvh.xz or .amc")


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
        manifest: from :func:`read_manifest` or :func:`read_folder`.
        pedestrian_type: only clips of this type; None for all.
        frame_rate: Hz.
        mirrored: follow each recording with its mirror image.
        minimum_frames: clips with fewer frames, after resampling, are skipped.
        progress: called as ``progress(done, total)`` after each clip.

    Raises:
        CaptureError: there is no clip of the type, a file cannot be used, has another sha256 or
            frame rate than the manifest says, or ends before ``use_to``.
    """
    clips = [c for c in manifest if pedestrian_type is None or c.type == pedestrian_type]
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
    recording = _parse(clip.read(), clip.path, clip.unit_to_m, clip.native_fps)
    if abs(recording.frame_rate - clip.native_fps) > 0.01 * clip.native_fps:
        raise CaptureError(
            f"{clip.where}: native_fps {clip.native_fps:g}, but {clip.file} has "
            f"{recording.frame_rate:g} frames a second"
        )
    if clip.use_to > recording.frames:
        raise CaptureError(
            f"{clip.where}: use_to {clip.use_to}, but {clip.file} has {recording.frames} frames"
        )
    return replace(trim(recording, clip.use_from, clip.use_to), name=clip.clip, clip=clip)
