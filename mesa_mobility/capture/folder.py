"""Clips without a manifest: a folder of recordings, or a single one."""

from __future__ import annotations

import hashlib
import os
from itertools import islice
from pathlib import Path

from mesa_mobility.capture.amc import FRAME_RATE
from mesa_mobility.capture.legs import leg_length
from mesa_mobility.capture.manifest import UNKNOWN_TYPE, Clip, Manifest, read_manifest
from mesa_mobility.capture.reading import SUFFIXES, is_recording, parse_recording
from mesa_mobility.capture.skeleton import Skeleton
from mesa_mobility.capture.text import read_bytes, stem
from mesa_mobility.errors import CaptureError

MANIFEST = "manifest.tsv"
"""Name of the manifest of a folder that has one."""

UNITS_M = (1.0, 0.01, 0.0254, 0.0564444, 0.001)
"""Units in use: metre, centimetre, inch, CMU's 0.0254 / 0.45 m, millimetre."""

MOST_FOLDERS = 1000
"""Subfolders searched, at most, for recordings when the given folder has none."""

LEG_LENGTH_M = (0.6, 1.1)
"""Thigh and shank of an adult.  No two of the units put one skeleton within this range."""


def find_clips(path: str | Path) -> Manifest:
    """The clips of a manifest file, of a folder with or without one, or of a single recording.

    Raises:
        CaptureError: as :func:`read_manifest` and :func:`read_folder` do.
    """
    path = Path(path)
    if path.is_dir():
        manifest = path / MANIFEST
        return read_manifest(manifest) if manifest.is_file() else read_folder(path)
    if is_recording(path):
        return Manifest(path, (_clip(path),))
    return read_manifest(path)


def read_folder(path: str | Path) -> Manifest:
    """The recordings of a folder, by name: every ``.bvh``, ``.bvh.xz`` and ``.amc`` in it.

    Without a manifest, all frames are used, the type is unknown,
    the unit is the one in :data:`UNITS_M` that gives legs a plausible length, and AMC files
    have 120 frames a second.  :func:`load_clips` splits recordings at jumps, movements that no
    human can make, such as that from a T-pose in the first frame to the first step.  It leaves
    out parts that are too short, and so the T-pose.

    Raises:
        CaptureError: the folder cannot be read or holds no recordings, or one of them cannot be
            used, has no known legs, or legs of no plausible length.
    """
    path = Path(path)
    try:
        files = sorted(file for file in path.iterdir() if is_recording(file))
    except OSError as error:
        raise CaptureError(f"{path}: cannot be read ({error.strerror or error})") from None
    if not files:
        raise CaptureError(
            f"{path}: no recordings, expected files named {', '.join(SUFFIXES)}{_below(path)}"
        )
    return Manifest(path, tuple(_clip(file) for file in files))


def _below(path: Path) -> str:
    """Subfolders that have recordings, named in the error about a folder without any."""
    found = [
        str(Path(folder).relative_to(path))
        for folder, _, files in islice(os.walk(path), 1, MOST_FOLDERS)
        if any(is_recording(Path(file)) for file in files)
    ]
    if not found:
        return ""
    named = ", ".join(sorted(found)[:3]) + (", ..." if len(found) > 3 else "")
    return f" in the folder itself; there are some below it in {named}: give one of these"


def _clip(path: Path) -> Clip:
    data = read_bytes(path)
    # In the smallest unit no bone seems to stretch, whatever the true one is.
    smallest = min(UNITS_M)
    recording = parse_recording(data, path, unit_to_m=smallest, frame_rate=FRAME_RATE)
    return Clip(
        file=path.name,
        type=UNKNOWN_TYPE,
        session=path.resolve().parent.name,
        subject="",
        clip=stem(path),
        description="",
        tags=(),
        native_fps=recording.frame_rate,
        use_from=0,
        use_to=recording.frames,
        unit_to_m=_unit(recording.skeleton, smallest, path),
        licence="",
        source_repo="",
        source_commit="",
        source_path="",
        sha256=hashlib.sha256(data).hexdigest(),
        path=path,
        where=str(path),
    )


def _unit(skeleton: Skeleton, read_with: float, path: Path) -> float:
    try:
        length = leg_length(skeleton) / read_with
    except CaptureError as error:
        raise CaptureError(f"{path}: {error}") from None
    low, high = LEG_LENGTH_M
    for unit in UNITS_M:
        if low <= length * unit <= high:
            return unit
    raise CaptureError(
        f"{path}: legs {length:g} units long, expected {low:g} to {high:g} m in one of the units "
        f"{', '.join(f'{unit:g}' for unit in UNITS_M)} m; a manifest can say another"
    )
