"""Reading BVH files: any joint count, any channels in any order.

The reader is the project's own.  ``pybvh`` (0.9) was tried first; it refuses position channels
on joints below the root, which every file of the Bandai-Namco data set has, and gives the rows of
the motion no line numbers in its errors.

A position channel takes the place of the joint's OFFSET along its axis and is not added to it:
the root's OFFSET repeats where the person stood when the file was made.  Rotation channels apply in
the order in which they are listed, about the axes that the ones before have turned.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from mesa_mobility.capture.bvh_hierarchy import BvhJoint, read_hierarchy
from mesa_mobility.capture.motion import FRAME_TIME_S, frame_rate_of, root_to_world, to_world
from mesa_mobility.capture.recording import Recording, check_size
from mesa_mobility.capture.skeleton import Skeleton
from mesa_mobility.capture.text import (
    check_unit,
    number,
    quote,
    read_bytes,
    stem,
    table,
    text_lines,
    whole_number,
)
from mesa_mobility.errors import CaptureError

STRETCH_TOLERANCE_M = 0.005
"""Largest change of a joint's distance to its parent before bones count as stretching."""


def read_bvh(path: str | Path, *, unit_to_m: float) -> Recording:
    """Read a y-up BVH file (``.bvh``, or ``.bvh.xz`` compressed).

    Args:
        path: the file.
        unit_to_m: metres in one unit of the file.

    Returns:
        The recording at its native frame rate, in the z-up world.  Unnamed ends of leaves are
        joints named after the leaf (``Head.end``).

    Raises:
        CaptureError: the file is missing, truncated, no BVH, has numbers that are not finite or
            rows of the wrong length, or has bones that change their length.
    """
    path = Path(path)
    return parse_bvh(read_bytes(path), path, unit_to_m=unit_to_m)


def parse_bvh(data: bytes, path: Path, *, unit_to_m: float) -> Recording:
    """Read the content of a BVH file; ``path`` gives the name and stands in errors."""
    check_unit(unit_to_m, str(path))
    lines = enumerate(text_lines(data, path), start=1)
    joints = read_hierarchy(lines, str(path))
    frame_time, motion = _read_motion(lines, joints, str(path))
    columns = np.cumsum([0, *(len(joint.channels or ()) for joint in joints)])
    channels = [motion[:, a:b] for a, b in pairwise(columns)]
    translations = np.stack(
        [_translation(j, c) for j, c in zip(joints, channels, strict=True)], axis=1
    )
    rotations = np.stack([_rotation(j, c) for j, c in zip(joints, channels, strict=True)], axis=1)
    return _recording(joints, translations * unit_to_m, rotations, frame_rate_of(frame_time), path)


def _read_motion(
    lines: Iterator[tuple[int, str]], joints: list[BvhJoint], where: str
) -> tuple[float, NDArray[np.float64]]:
    """Frame time in seconds and the (F, C) channel values."""
    width = sum(len(joint.channels or ()) for joint in joints)
    if width == 0:
        raise CaptureError(f"{where}: no joint has channels, expected at least one")
    line, text = _header(lines, "Frames:", where)
    frames = whole_number(text, f"{where}, line {line}, Frames")
    if frames < 1:
        raise CaptureError(f"{where}, line {line}: {frames} frames, expected at least one")
    check_size(frames, len(joints), f"{where}, line {line}")
    line, text = _header(lines, "Frame Time:", where)
    frame_time = number(text, f"{where}, line {line}, Frame Time")
    shortest, longest = FRAME_TIME_S
    if not shortest <= frame_time <= longest:
        raise CaptureError(
            f"{where}, line {line}: frame time {frame_time:g} s, "
            f"expected {shortest:g} to {longest:g} s"
        )
    rows = [(line, text) for line, text in lines if text and not text.isspace()]
    if len(rows) > frames:
        raise CaptureError(
            f"{where}, line {rows[frames][0]}: {len(rows)} rows of motion, expected {frames}"
        )
    if len(rows) < frames:
        raise CaptureError(
            f"{where}: ends at line {rows[-1][0] if rows else line} after {len(rows)} rows of "
            f"motion, expected {frames} (truncated?)"
        )
    return frame_time, table(rows, width, where)


def _header(lines: Iterator[tuple[int, str]], label: str, where: str) -> tuple[int, str]:
    for line, text in lines:
        if text.isspace() or not text:
            continue
        head, colon, rest = text.partition(":")
        if " ".join(head.split()).lower() + colon != label.lower():
            raise CaptureError(f"{where}, line {line}: {quote(text.strip())}, expected {label}")
        return line, rest.strip()
    raise CaptureError(f"{where}: ends before {label} (truncated?)")


def _translation(joint: BvhJoint, values: NDArray[np.float64]) -> NDArray[np.float64]:
    """(F, 3) position against the parent, file units."""
    result = np.tile(np.asarray(joint.offset, dtype=np.float64), (len(values), 1))
    for column, (axis, kind) in enumerate(joint.channels or ()):
        if kind == "position":
            result[:, "XYZ".index(axis)] = values[:, column]
    return result


def _rotation(joint: BvhJoint, values: NDArray[np.float64]) -> NDArray[np.float64]:
    """(F, 4) rotation against the parent."""
    turns = [(i, axis) for i, (axis, kind) in enumerate(joint.channels or ()) if kind == "rotation"]
    if not turns:
        return np.tile([0.0, 0.0, 0.0, 1.0], (len(values), 1))
    order = "".join(axis for _, axis in turns)
    angles = values[:, [column for column, _ in turns]]
    return Rotation.from_euler(order, angles, degrees=True).as_quat()


def _recording(
    joints: list[BvhJoint],
    translations: NDArray[np.float64],
    rotations: NDArray[np.float64],
    frame_rate: float,
    path: Path,
) -> Recording:
    """Take one moving joint as the root; every other must keep its distance to its parent."""
    offsets = np.median(translations, axis=0)
    drift = np.linalg.norm(translations - offsets, axis=2).max(axis=0)
    parents = np.array([joint.parent for joint in joints])
    # Some programs put a "world" joint above the hips: the root is the last joint of the chain
    # that moves.
    root = max((j for j in _chain(parents) if drift[j] > STRETCH_TOLERANCE_M), default=0)
    position, turn = translations[:, 0], Rotation.from_quat(rotations[:, 0])
    for j in range(1, root + 1):
        position = position + turn.apply(translations[:, j])
        turn = turn * Rotation.from_quat(rotations[:, j])
    for j in range(root + 1, len(joints)):
        if drift[j] > STRETCH_TOLERANCE_M:
            raise CaptureError(
                f"{path}, line {joints[j].line}: joint {quote(joints[j].name)} moves "
                f"{drift[j]:.3f} m against its parent, expected bones of constant length"
            )
    quats = rotations[:, root:].copy()
    quats[:, 0] = root_to_world(turn.as_quat())
    skeleton = Skeleton(
        names=tuple(joint.name for joint in joints[root:]),
        parents=np.maximum(parents[root:] - root, -1),
        offsets=offsets[root:],
    )
    return Recording(stem(path), skeleton, frame_rate, to_world(position), quats)


def _chain(parents: NDArray[np.int64]) -> range:
    """Joints from the root to the first that has more or fewer than one child."""
    children = np.bincount(parents[1:], minlength=len(parents))
    return range(int(np.argmax(children != 1)) + 1)
