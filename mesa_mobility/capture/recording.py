"""Recordings: a skeleton in motion, independent of the file format."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from mesa_mobility.capture.skeleton import Skeleton, read_only
from mesa_mobility.errors import CaptureError

if TYPE_CHECKING:
    from mesa_mobility.capture.manifest import Clip

UNIT_TOLERANCE = 1e-6
"""How far the length of a unit quaternion may be from 1."""

LARGEST_SIZE = 4_000_000
"""Frames times joints of one recording: an hour of 38 joints at 30 Hz."""


def check_size(frames: int, joints: int, where: str) -> None:
    """Refuse more frames of more joints than :data:`LARGEST_SIZE`.

    Raises:
        CaptureError: as said.
    """
    if frames * joints > LARGEST_SIZE:
        raise CaptureError(
            f"{where}: {frames} frames of {joints} joints, expected at most "
            f"{LARGEST_SIZE // joints} frames of so many joints"
        )


@dataclass(frozen=True, eq=False)
class Recording:
    """Every joint rotation and the root's path, at a constant frame rate.

    The world is z-up: the ground is the plane (x, y).

    Attributes:
        name: name of the clip.
        skeleton: the J joints.
        frame_rate: frames a second.
        root_position: (F, 3) float64; position of the root in the world, metres.
        rotations: (F, J, 4) float64; unit quaternions (x, y, z, w).  The root's turns file axes
            into the world; every other joint's is relative to its parent.
        clip: the row of the manifest that the recording came from, if any.
        slope: metres by which the ground rises for each metre along x, and which are taken out of
            the heights; 0 on a level floor.

    Raises:
        CaptureError: no frames, shapes that disagree, values that are not finite, quaternions that
            are not of unit length, or a frame rate that is not positive.
    """

    name: str
    skeleton: Skeleton
    frame_rate: float
    root_position: NDArray[np.float64]
    rotations: NDArray[np.float64]
    clip: Clip | None = None
    slope: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "frame_rate", float(self.frame_rate))
        object.__setattr__(self, "root_position", read_only(self.root_position, np.float64))
        object.__setattr__(self, "rotations", read_only(self.rotations, np.float64))
        if not (np.isfinite(self.frame_rate) and self.frame_rate > 0):
            raise CaptureError(
                f"{self.name}: frame rate {self.frame_rate}, expected more than 0 Hz"
            )
        frames, joints = len(self.root_position), len(self.skeleton)
        if frames == 0:
            raise CaptureError(f"{self.name}: no frames, expected at least one")
        if self.root_position.shape != (frames, 3) or self.rotations.shape != (frames, joints, 4):
            raise CaptureError(
                f"{self.name}: root positions have shape {self.root_position.shape} and rotations "
                f"{self.rotations.shape}, expected ({frames}, 3) and ({frames}, {joints}, 4)"
            )
        if not (np.isfinite(self.root_position).all() and np.isfinite(self.rotations).all()):
            raise CaptureError(f"{self.name}: positions or rotations that are not finite")
        if np.abs(np.linalg.norm(self.rotations, axis=2) - 1).max() > UNIT_TOLERANCE:
            raise CaptureError(f"{self.name}: rotations that are no unit quaternions")

    @property
    def frames(self) -> int:
        """Number of frames F."""
        return len(self.root_position)

    @property
    def duration(self) -> float:
        """Seconds from the first frame to the last: (F - 1) / frame rate."""
        return (self.frames - 1) / self.frame_rate

    def positions(self) -> NDArray[np.float64]:
        """Forward kinematics: (F, J, 3) positions of all joints in the world, metres."""
        frames, joints = self.rotations.shape[:2]
        local = Rotation.from_quat(self.rotations.reshape(-1, 4)).as_matrix()
        world = local.reshape(frames, joints, 3, 3)
        positions = np.empty((frames, joints, 3))
        positions[:, 0] = self.root_position
        for j in range(1, joints):
            parent = self.skeleton.parents[j]
            # Parents come first, so that the parent's rotation is already the accumulated one.
            positions[:, j] = positions[:, parent] + world[:, parent] @ self.skeleton.offsets[j]
            world[:, j] = world[:, parent] @ world[:, j]
        return positions
