"""Cut, resample, scale and mirror recordings."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.spatial.transform import Rotation

from mesa_mobility.capture.legs import counterparts
from mesa_mobility.capture.motion import MIRROR_IN_FILE, MIRROR_IN_WORLD
from mesa_mobility.capture.recording import Recording, check_size
from mesa_mobility.capture.skeleton import Skeleton
from mesa_mobility.errors import CaptureError

MIRRORED = "~mirror"
"""Suffix of the name of a mirrored recording."""

RATIO_TOLERANCE = 1e-6
"""Relative error within which a ratio of frame rates counts as whole."""


def trim(recording: Recording, use_from: int, use_to: int) -> Recording:
    """Frames ``use_from`` up to, but not including, ``use_to``.

    Raises:
        CaptureError: the range is empty or reaches beyond the recording.
    """
    if not 0 <= use_from < use_to <= recording.frames:
        raise CaptureError(
            f"{recording.name}: frames {use_from}:{use_to}, expected a range within "
            f"0:{recording.frames}"
        )
    return replace(
        recording,
        root_position=recording.root_position[use_from:use_to],
        rotations=recording.rotations[use_from:use_to],
    )


def resample(recording: Recording, frame_rate: float = 30.0) -> Recording:
    """Change the frame rate, in Hz; the first frame stays.

    Where the old rate is a whole multiple of the new one, frames are picked unchanged.
    Otherwise positions are interpolated linearly and rotations along the great arc (slerp), up to
    the last frame, never beyond it.

    Raises:
        CaptureError: the frame rate is not positive, or gives too many frames.
    """
    if not (np.isfinite(frame_rate) and frame_rate > 0):
        raise CaptureError(f"{recording.name}: resampling to {frame_rate} Hz, expected more than 0")
    ratio = recording.frame_rate / frame_rate
    step = round(ratio)
    if step >= 1 and abs(ratio - step) <= RATIO_TOLERANCE * step:
        return replace(
            recording,
            frame_rate=frame_rate,
            root_position=recording.root_position[::step],
            rotations=recording.rotations[::step],
        )
    last = recording.frames - 1
    joints = len(recording.skeleton)
    check_size(int(last / ratio) + 1, joints, recording.name)
    # Times of the new frames, in units of old frames.
    times = np.arange(int(last / ratio + RATIO_TOLERANCE) + 1) * ratio
    before = np.minimum(times.astype(np.int64), last)
    after = np.minimum(before + 1, last)
    share = np.clip(times - before, 0.0, 1.0)[:, None]
    start = Rotation.from_quat(recording.rotations[before].reshape(-1, 4))
    stop = Rotation.from_quat(recording.rotations[after].reshape(-1, 4))
    part = np.repeat(share, joints, axis=0) * (start.inv() * stop).as_rotvec()
    rotations = (start * Rotation.from_rotvec(part)).as_quat()
    position = recording.root_position
    return replace(
        recording,
        frame_rate=frame_rate,
        root_position=(1 - share) * position[before] + share * position[after],
        rotations=rotations.reshape(len(times), joints, 4),
    )


def scale(recording: Recording, length: float = 1.0, time: float = 1.0) -> Recording:
    """The movement of a recording as of a smaller or larger body, and slower or quicker.

    Lengths of the skeleton and of the root's path are multiplied by ``length``, times by ``time``;
    joint angles and the frame rate stay.  ``time = sqrt(length)`` keeps the Froude number.

    Raises:
        CaptureError: a factor that is not positive, or one that gives too many frames.
    """
    for what, factor in (("length", length), ("time", time)):
        if not (np.isfinite(factor) and factor > 0):
            raise CaptureError(f"{recording.name}: {what} times {factor}, expected more than 0")
    skeleton = replace(recording.skeleton, offsets=recording.skeleton.offsets * length)
    slower = replace(
        recording,
        skeleton=skeleton,
        frame_rate=recording.frame_rate / time,
        root_position=recording.root_position * length,
    )
    return resample(slower, recording.frame_rate)


def mirror(recording: Recording) -> Recording:
    """Reflect a recording left to right, about the plane y = 0 of the world.

    Joint positions are the reflections (x, -y, z) of the original's with the joints of the left
    and the right exchanged: the mirrored ``LeftFoot`` is where the reflected ``RightFoot`` was.

    Raises:
        CaptureError: the skeleton's left and right differ in structure.
    """
    skeleton = recording.skeleton
    try:
        other = counterparts(skeleton)
    except CaptureError as error:
        raise CaptureError(f"{recording.name}: {error}") from None
    rotations = recording.rotations[:, other]
    # F R F with F = diag(-1, 1, 1) keeps the turn about the file's X and reverses the others.
    mirrored = rotations * [1.0, -1.0, -1.0, 1.0]
    root = Rotation.from_quat(rotations[:, 0]).as_matrix()
    mirrored[:, 0] = Rotation.from_matrix(MIRROR_IN_WORLD @ root @ MIRROR_IN_FILE).as_quat()
    return Recording(
        name=recording.name + MIRRORED,
        skeleton=Skeleton(
            names=skeleton.names,
            parents=skeleton.parents,
            offsets=skeleton.offsets[other] @ MIRROR_IN_FILE,
        ),
        frame_rate=recording.frame_rate,
        root_position=recording.root_position @ MIRROR_IN_WORLD,
        rotations=mirrored,
        clip=recording.clip,
    )
