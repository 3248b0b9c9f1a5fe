"""The recorded poses that a person goes through, frame by frame, and how they are joined."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.bodies.bank import PoseBank
from mesa_mobility.bodies.bank_data import STRIDE_STEP
from mesa_mobility.bodies.rotations import from_vectors, rotation_vectors
from mesa_mobility.errors import ResultsError

BLEND_FRAMES = 6
"""Frames, 0.2 s, within which the difference at a join fades."""

_FADING = np.arange(BLEND_FRAMES) / BLEND_FRAMES
FADE: NDArray[np.float64] = 1.0 - _FADING * _FADING * (3.0 - 2.0 * _FADING)
"""(6,) share of the difference that is left in the frames from a join on."""

NEVER = np.iinfo(np.int64).max


class Movements(NamedTuple):
    """What one person does: their decisions in order of time.

    Attributes:
        starts: (d,) frames in which the movements begin.
        options: (d,) rows of the type's map, negative for the fallback.
        shares: (d,) the part of each option's length that the person walks, 0 to 1.
    """

    starts: NDArray[np.int64]
    options: NDArray[np.int64]
    shares: NDArray[np.float64]


class Sequence(NamedTuple):
    """The poses of one person in successive frames.

    Attributes:
        numbers: (n,) numbers of the bank's poses.
        joins: (j,) indices in ``numbers`` at which another stretch of a recording begins.
        before: (j,) number of the pose that would have come there without the join.
        strides: (n,) factor of the recorded strides.
        own: (n,) index of the decision that the person follows, -1 before the first.
    """

    numbers: NDArray[np.int64]
    joins: NDArray[np.int64]
    before: NDArray[np.int64]
    strides: NDArray[np.float64]
    own: NDArray[np.int64]


def pose_sequence(bank: PoseBank, frames: NDArray[np.int64], movements: Movements) -> Sequence:
    """The poses of a person in successive frames.

    Args:
        bank: poses of the person's type.
        frames: (n,) successive frames.
        movements: what the person does.
    """
    begins, poses, strides = _stretches(bank, movements)
    own = np.searchsorted(movements.starts, frames, side="right") - 1
    row = own + 1  # the first row is that of somebody who has not decided yet
    phase = frames - np.concatenate([[0], movements.starts])[row]
    phase[own < 0] = 0
    stretch = (phase[:, None] >= begins[row]).sum(axis=1) - 1
    into = phase - begins[row, stretch]
    still = ~_moving(movements)[row]
    numbers = bank.later(poses[row, stretch], np.where(still, 0, into))
    piece = row * begins.shape[1] + stretch
    following = bank.later(numbers[:-1], np.where(still[:-1], 0, 1))
    joins = 1 + np.flatnonzero((np.diff(piece) != 0) & (numbers[1:] != following))
    return Sequence(
        numbers=numbers,
        joins=joins,
        before=following[joins - 1],
        strides=strides[row],
        own=own,
    )


class Stretches(NamedTuple):
    """The stretches of recordings that one person goes through, in the order of time.

    Attributes:
        frames: (s,) frames in which the stretches begin.
        poses: (s,) number of the bank's pose with which each begins.
        moving: (s,) whether the later poses of the clip follow.
        strides: (s,) factor of the recorded strides.
        own: (s,) index of the decision that the person follows, -1 before the first.
    """

    frames: NDArray[np.int64]
    poses: NDArray[np.int64]
    moving: NDArray[np.bool_]
    strides: NDArray[np.float64]
    own: NDArray[np.int64]


def stretches(bank: PoseBank, movements: Movements, first: int) -> Stretches:
    """The stretches of a person who is there from frame ``first`` on.

    Args:
        bank: poses of the person's type.
        movements: what the person does.
        first: frame; the person stands until their first movement.
    """
    begins, poses, strides = _stretches(bank, movements)
    until = np.append(np.diff(movements.starts), NEVER)
    # The first row stands for the time before the first movement.
    used = begins < np.append(NEVER, until)[:, None]
    if len(movements.starts) and movements.starts[0] <= first:
        used[0] = False
    row, place = np.nonzero(used)
    start = np.append(first, movements.starts)[row] + begins[row, place]
    return Stretches(start, poses[row, place], _moving(movements)[row], strides[row], row - 1)


def stretch_of_each(
    bank: PoseBank, movements: Movements, phases: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.bool_], NDArray[np.float64]]:
    """The stretch that each of several people is in, who have one movement under way each.

    Args:
        bank: poses of their type.
        movements: one movement for each person.
        phases: (n,) frames since the movement began.

    Returns:
        (n,) frames since the stretch began, (n,) number of the pose then, (n,) whether the person
        moves, (n,) factor of the recorded strides.
    """
    begins, poses, strides = _stretches(bank, movements)
    begins, poses, strides = begins[1:], poses[1:], strides[1:]
    place = np.maximum((phases[:, None] >= begins).sum(axis=1) - 1, 0)
    row = np.arange(len(phases))
    into: NDArray[np.int64] = phases - begins[row, place]
    return into, poses[row, place], _moving(movements)[1:], strides


def _stretches(
    bank: PoseBank, movements: Movements
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]:
    """Frames and poses at which the stretches of each movement begin, and its strides.

    The first row is of somebody who stands.

    Raises:
        ResultsError: an option that the bank does not have.
    """
    standing = int(bank.cluster_poses[int(bank.metadata.get("standing", 0))])
    if movements.options.max(initial=-1) >= bank.n_options:
        raise ResultsError(
            f"decisions: option {movements.options.max()}, expected one of the {bank.n_options} of "
            f"the poses of {bank.pedestrian_type!r}"
        )
    moving = _moving(movements)
    rows = np.where(moving, np.concatenate([[0], movements.options]), 0)
    counts = np.where(moving, bank.offsets[rows + 1] - bank.offsets[rows], 1)
    places = np.arange(counts.max(initial=1))
    at = np.minimum(bank.offsets[rows][:, None] + places, len(bank.frames) - 1)
    present = (places < counts[:, None]) & moving[:, None]
    begins = np.where(present, bank.frames[at].astype(np.int64), NEVER)
    poses = np.where(present, bank.poses[at].astype(np.int64), standing)
    begins[~moving, 0] = 0
    strides = np.concatenate([[1.0], movements.shares]) * bank.strides[rows] * STRIDE_STEP
    return begins, poses, np.where(moving, strides, 1.0)


def _moving(movements: Movements) -> NDArray[np.bool_]:
    """(d + 1,) whether the person moves before their first decision, and after each decision.

    An option shortened to nothing stands and turns on the spot.
    """
    return np.concatenate([[False], (movements.options >= 0) & (movements.shares > 0.0)])


def blended(bank: PoseBank, sequence: Sequence) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Turns of the joints and heights of the pelvis, continuous where stretches are joined.

    The difference between what would have come and what comes is kept at a join, and fades within
    0.2 s.

    Returns:
        (n, 17, 3, 3) turns and (n,) metres, both of the neutral skeleton.
    """
    turns, heights = bank.turns(sequence.numbers), bank.pelvis_heights(sequence.numbers)
    joins = sequence.joins
    if not len(joins):
        return turns, heights
    here = turns[joins]
    apart = rotation_vectors(np.swapaxes(here, -1, -2) @ bank.turns(sequence.before))
    offsets = fading(joins, apart, len(turns))
    changed = np.flatnonzero(offsets.any(axis=(1, 2)))
    turns[changed] = turns[changed] @ from_vectors(offsets[changed])
    lifted = bank.pelvis_heights(sequence.before) - heights[joins]
    return turns, heights + fading(joins, lifted, len(turns))


def fading(
    places: NDArray[np.int64], differences: NDArray[np.float64], length: int
) -> NDArray[np.float64]:
    """(length, ...) sums of the (j, ...) differences, each of which begins at its place and fades.

    Places are distinct.
    """
    sums = np.zeros((length + BLEND_FRAMES, *differences.shape[1:]))
    for frame, share in enumerate(FADE):
        sums[places + frame] += share * differences
    return sums[:length]
