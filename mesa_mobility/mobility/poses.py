"""Poses of the lower body, one for each frame of a recording.

A pose is one frame of a recording at 30 Hz.  Two poses are compared by the unit
directions of thigh, shank and foot of both legs, seen in the frame of the
pelvis, and by how fast these directions change.  Segment directions compare
across skeletons of any size and joint count, and the upper body is ignored, as
in section 5 of the paper.  Root position and yaw are left out of the
comparison; they are kept apart as the motion that a pose contributes to a path.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.errors import CaptureError, MapError

if TYPE_CHECKING:
    from mesa_mobility.capture import Recording

FRAME_RATE = 30.0
"""Frames a second of every pose table (45 frames = 1.5 s, as in the paper)."""

VELOCITY_WEIGHT = 3.0
"""Weight of a change of direction per frame against a direction."""

FACING_SMOOTHING = 0.30
"""Standard deviation, in seconds, of the Gaussian that turns pelvis heading into facing.

The hip line swings a few degrees with every step.  That swing belongs to the
gait, not to where the person is facing, and would otherwise turn whole paths.
"""

SPEED_SMOOTHING = 0.10
"""Standard deviation, in seconds, of the Gaussian used for root speed and turn rate."""

MOTION_STEP = 2e-5
"""Motion from one pose to the next is rounded to so many metres and radians, as files keep it."""

STANDING_SPEED, STANDING_TURN_RATE = 0.10, 0.35
"""A person slower than both counts as standing; m/s and rad/s."""

POSE_JOINTS = (
    "pelvis",
    "left_hip",
    "left_knee",
    "left_ankle",
    "left_toe",
    "right_hip",
    "right_knee",
    "right_ankle",
    "right_toe",
)
"""Joints of a stored pose, in order."""


@dataclass(frozen=True)
class PoseTable:
    """All poses of a set of recordings, one row a frame.

    Attributes:
        features: (n, 36) float32; 18 components of unit segment directions and
            their 18 changes per frame, weighted.
        joints: (n, 9, 3) float32; joint positions in metres in the pelvis frame
            (x forwards, y to the left, z up, origin on the floor below the pelvis).
        step: (n, 3) float64; motion to the next frame of the clip in the facing
            frame of this one: dx, dy in metres, dheading in radians.  Zero on
            the last frame of a clip.
        position: (n, 2) float64; root position in the recording's own ground plane, metres.
        facing: (n,) float64; unwrapped facing in the recording's own frame, radians.
        speed: (n,) float64; root speed, m/s.
        turn_rate: (n,) float64; absolute rate of turn, rad/s.
        clip: (n,) int32; index into ``clip_names``.
        first: (c + 1,) int64; rows of clip k are ``first[k]:first[k + 1]``.
        clip_names: names of the clips.
    """

    features: NDArray[np.float32]
    joints: NDArray[np.float32]
    step: NDArray[np.float64]
    position: NDArray[np.float64]
    facing: NDArray[np.float64]
    speed: NDArray[np.float64]
    turn_rate: NDArray[np.float64]
    clip: NDArray[np.int32]
    first: NDArray[np.int64]
    clip_names: tuple[str, ...]

    def __len__(self) -> int:
        return len(self.clip)

    def is_standing(
        self, max_speed: float = STANDING_SPEED, max_turn_rate: float = STANDING_TURN_RATE
    ) -> NDArray[np.bool_]:
        """Poses of a person who stands: slower than both limits (m/s, rad/s)."""
        return (self.speed < max_speed) & (self.turn_rate < max_turn_rate)


def pose_table(
    recordings: Sequence[Recording],
    progress: Callable[[int, int], None] | None = None,
) -> PoseTable:
    """Compute the pose table of recordings at 30 Hz.

    Args:
        recordings: clips of at least two frames each.
        progress: called as ``progress(done, total)`` after each clip.

    Raises:
        MapError: no recording, or one that is not at 30 Hz.
        CaptureError: a skeleton whose legs cannot be found, or a clip that jumps.
    """
    if not recordings:
        raise MapError("no recordings: at least one clip of 45 frames is needed for a mobility map")
    parts = []
    for done, recording in enumerate(recordings, start=1):
        if abs(recording.frame_rate - FRAME_RATE) > 1e-6:
            raise MapError(
                f"{recording.name}: frame rate {recording.frame_rate:g}, expected {FRAME_RATE:g} Hz"
            )
        parts.append(_clip_poses(recording))
        if progress is not None:
            progress(done, len(recordings))
    counts = np.array([len(p[0]) for p in parts])
    columns = [np.concatenate(column) for column in zip(*parts, strict=True)]
    features, joints, step, position, facing, speed, turn_rate = columns
    return PoseTable(
        features=features.astype(np.float32),
        joints=joints.astype(np.float32),
        step=step,
        position=position,
        facing=facing,
        speed=speed,
        turn_rate=turn_rate,
        clip=np.repeat(np.arange(len(parts), dtype=np.int32), counts),
        first=np.concatenate([[0], np.cumsum(counts)]).astype(np.int64),
        clip_names=tuple(recording.name for recording in recordings),
    )


def _clip_poses(recording: Recording) -> tuple[NDArray[np.float64], ...]:
    # Imported here, since reading a map imports this module but does not need them.
    from scipy.ndimage import gaussian_filter1d

    from mesa_mobility.capture import find_jumps, leg_joints

    legs = leg_joints(recording.skeleton)
    world = recording.positions()
    chain = world[:, [*legs.left, *legs.right]]
    jumps = find_jumps(chain)
    if jumps.reason:
        raise CaptureError(f"{recording.name}: jumps at frame {jumps.frames[0]}, {jumps.reason}")
    pelvis_heading = _hip_heading(chain[:, 0], chain[:, 4])
    root = 0.5 * (chain[:, 0, :2] + chain[:, 4, :2])
    facing = gaussian_filter1d(pelvis_heading, FACING_SMOOTHING * FRAME_RATE, mode="nearest")

    pelvis = 0.5 * (chain[:, 0] + chain[:, 4])
    joints = np.concatenate([pelvis[:, None], chain], axis=1)
    joints = joints - np.concatenate([root, np.zeros((len(root), 1))], axis=1)[:, None]
    joints[..., :2] = _rotate(joints[..., :2], -pelvis_heading[:, None])

    segments = np.stack(
        [joints[:, b] - joints[:, a] for a, b in ((1, 2), (2, 3), (3, 4), (5, 6), (6, 7), (7, 8))],
        axis=1,
    )
    length = np.linalg.norm(segments, axis=-1, keepdims=True)
    directions = (segments / np.maximum(length, 1e-9)).reshape(len(root), 18)
    change = np.gradient(directions, axis=0)
    features = np.concatenate([directions, VELOCITY_WEIGHT * change], axis=1)

    step = np.zeros((len(root), 3))
    step[:-1, :2] = _rotate(np.diff(root, axis=0), -facing[:-1])
    step[:-1, 2] = np.diff(facing)
    step = np.rint(step / MOTION_STEP) * MOTION_STEP

    velocity = np.gradient(root, axis=0) * FRAME_RATE
    smooth = SPEED_SMOOTHING * FRAME_RATE
    speed = np.linalg.norm(gaussian_filter1d(velocity, smooth, axis=0, mode="nearest"), axis=1)
    turn_rate = np.abs(gaussian_filter1d(np.gradient(facing) * FRAME_RATE, smooth, mode="nearest"))
    return features, joints, step, root, facing, speed, turn_rate


def _hip_heading(
    left_hip: NDArray[np.float64], right_hip: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Unwrapped direction in which the pelvis faces: the hip line turned by -90 degrees."""
    across = left_hip[:, :2] - right_hip[:, :2]
    return np.unwrap(np.arctan2(-across[:, 0], across[:, 1]))


def _rotate(vectors: NDArray[np.float64], angle: NDArray[np.float64]) -> NDArray[np.float64]:
    c, s = np.cos(angle), np.sin(angle)
    x, y = vectors[..., 0], vectors[..., 1]
    return np.stack([c * x - s * y, s * x + c * y], axis=-1)
