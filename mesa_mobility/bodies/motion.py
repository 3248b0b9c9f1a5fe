"""A person's body in motion: joint positions and orientations along their track."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial.transform import Rotation

from mesa_mobility.bodies.bank import PoseBank
from mesa_mobility.bodies.feet import LEGS, bend, plant, settle
from mesa_mobility.bodies.rotations import about_z, from_vectors, matrices, rotation_vectors
from mesa_mobility.bodies.sequence import Movements, blended, pose_sequence
from mesa_mobility.bodies.skeleton import (
    ANKLE_HEIGHT,
    JOINTS,
    OFFSETS,
    forward_kinematics,
    local_rotations,
)
from mesa_mobility.errors import ResultsError

if TYPE_CHECKING:
    from mesa_mobility.buildings import Footing

FRAME_RATE = 30.0

LIVELY_TURN = 1.0
"""Turn on the spot, rad/s, from which on feet are lifted as recorded although they do not step."""


@dataclass(frozen=True, eq=False)
class BodyMotion:
    """One person's body in some frames.

    Attributes:
        frames: (n,) float64; frames, whole or between two.
        positions: (n, 22, 3) float64; joints (``skeleton.JOINTS``) in the world, metres, z up.
        rotations: (n, 22, 4) float64; orientations of the joints in the world as quaternions (x, y,
            z, w): how the neutral skeleton's axes are turned. Joints without children have their
            parents'.
        bearing: (n, 4) bool; whether left ankle and toe, right ankle and toe bear on the floor.
        scale: size of the body, as a multiple of the neutral skeleton's.
    """

    frames: NDArray[np.float64]
    positions: NDArray[np.float64]
    rotations: NDArray[np.float64]
    bearing: NDArray[np.bool_]
    scale: float = 1.0

    def __len__(self) -> int:
        return len(self.frames)

    def local(self) -> NDArray[np.float64]:
        """(n, 17, 3, 3) turns of ``skeleton.TURNING`` against their parents."""
        return local_rotations(matrices(self.rotations))

    def at(self, frames: ArrayLike) -> BodyMotion:
        """The body at other times, between those that are known.

        Args:
            frames: (k,) frames, whole or between two.

        Raises:
            ResultsError: a time before the first or after the last frame.
        """
        wanted = np.atleast_1d(np.asarray(frames, dtype=np.float64))
        first, last = self.frames[0], self.frames[-1]
        if len(wanted) and not (first <= wanted.min() and wanted.max() <= last):
            raise ResultsError(
                f"frames {wanted.min():g} to {wanted.max():g}: the person is there from frame "
                f"{first:g} to {last:g}"
            )
        before = np.clip(np.searchsorted(self.frames, wanted, side="right") - 1, 0, len(self) - 1)
        after = np.minimum(before + 1, len(self) - 1)
        span = np.where(after > before, self.frames[after] - self.frames[before], 1.0)
        share = (wanted - self.frames[before]) / span
        start, end = (
            Rotation.from_quat(self.rotations[each].reshape(-1, 4)) for each in (before, after)
        )
        part = np.repeat(share, len(JOINTS))[:, None] * (start.inv() * end).as_rotvec()
        turned = (start * Rotation.from_rotvec(part)).as_quat()
        between = share[:, None, None]
        return BodyMotion(
            frames=wanted,
            positions=(1.0 - between) * self.positions[before] + between * self.positions[after],
            rotations=turned.reshape(len(wanted), len(JOINTS), 4),
            bearing=self.bearing[before],
            scale=self.scale,
        )


def body_motion(
    bank: PoseBank,
    movements: Movements,
    frames: NDArray[np.int64],
    track: NDArray[np.float64],
    *,
    planted: bool = True,
    elevation: NDArray[np.float64] | None = None,
    footing: Footing | None = None,
) -> BodyMotion:
    """One person's body in successive frames.

    Args:
        bank: poses of the person's type.
        movements: what the person does.
        frames: (n,) successive frames at 30 Hz.
        track: (n, 3) the person's x, y (metres) and heading (radians) in them.
        planted: whether feet are held where they bear on the floor.
        elevation: (n,) elevation of the person's place, metres; 0 by default.
        footing: stairs on whose treads feet are put; by default the floor beneath feet has the
            elevation of the person's place.
    """
    floor = None if elevation is None else _Floor(track[:, :2], elevation, bank.scale, footing)
    track = np.asarray(track, dtype=np.float64) / [bank.scale, bank.scale, 1.0]
    sequence = pose_sequence(bank, frames, movements)
    turns, heights = blended(bank, sequence)
    positions, oriented = forward_kinematics(turns)
    bearing = bank.bearing(sequence.numbers)
    if planted:
        lively = settle(_liveliness(sequence.strides, track[:, 2]))
        _shorten(positions, oriented, settle(sequence.strides), lively, heights)
    facing = about_z(track[:, 2])
    positions = np.einsum("nij,nkj->nki", facing, positions)
    oriented = np.einsum("nij,nkjl->nkil", facing, oriented)
    positions += np.column_stack([track[:, :2], heights])[:, None]
    if floor is not None:
        positions[:, :, 2] += floor.carried()[:, None]
    if planted:
        bearing = plant(positions, oriented, bearing, floor)
    quaternions = Rotation.from_matrix(oriented.reshape(-1, 3, 3)).as_quat()
    return BodyMotion(
        frames=frames.astype(np.float64),
        positions=positions * bank.scale,
        rotations=quaternions.reshape(len(frames), len(JOINTS), 4),
        bearing=bearing,
        scale=bank.scale,
    )


class _Floor:
    """The floor of a building under one person, in units of the person's size."""

    def __init__(
        self,
        xy: NDArray[np.float64],
        elevation: NDArray[np.float64],
        scale: float,
        footing: Footing | None,
    ) -> None:
        self._places = np.column_stack([xy, elevation])
        self._scale, self._footing = scale, footing

    def carried(self) -> NDArray[np.float64]:
        places, footing = self._places, self._footing
        return (places[:, 2] if footing is None else footing.carried(places)) / self._scale

    def __call__(
        self, points: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        if self._footing is None:
            level = self.carried()
            return level, level
        treads, edges = self._footing.beneath(self._places, points * self._scale)
        return treads / self._scale, edges / self._scale


def _liveliness(strides: NDArray[np.float64], heading: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n,) share of the recorded lift of the feet: all of it in whole steps and quick turns."""
    turning = np.abs(np.gradient(heading)) * FRAME_RATE if len(heading) > 1 else np.zeros(1)
    return np.clip(np.maximum(strides, turning / LIVELY_TURN), 0.0, 1.0)


def _shorten(
    positions: NDArray[np.float64],
    oriented: NDArray[np.float64],
    strides: NDArray[np.float64],
    lively: NDArray[np.float64],
    heights: NDArray[np.float64],
) -> None:
    """Draw feet in under the body, by the share to which steps are shortened, and lift them less.

    Positions are relative to the pelvis, seen from where the person faces. Where the body covers a
    share of the recorded way over a foot that stands still, the foot is nearer to it by that share.
    """
    changed = np.flatnonzero((strides != 1.0) | (lively != 1.0))
    if not len(changed):
        return
    where, foot = positions[changed], oriented[changed]
    for hip, knee, ankle, toe in LEGS:
        target = where[:, ankle].copy()
        target[:, 0] *= strides[changed]
        floor = ANKLE_HEIGHT - heights[changed]
        target[:, 2] = floor + lively[changed] * (target[:, 2] - floor)
        flat = about_z(np.arctan2(foot[:, ankle, 1, 0], foot[:, ankle, 0, 0]))
        tilt = rotation_vectors(np.swapaxes(flat, -1, -2) @ foot[:, ankle])
        foot[:, ankle] = flat @ from_vectors(lively[changed, None] * tilt)
        bend(where, foot, (hip, knee, ankle), target)
        where[:, toe] = where[:, ankle] + foot[:, ankle] @ OFFSETS[toe]
    positions[changed], oriented[changed] = where, foot
