"""People's motion by those frames alone that viewers need."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.animation.figures.figure import rest_positions
from mesa_mobility.animation.keys import key_frames
from mesa_mobility.animation.people import Walker
from mesa_mobility.bodies.skeleton import JOINTS, PARENTS, TURNING

WITHIN = 0.005
"""Metres by which a pelvis of few people may be off, and by which each joint may move the far end
of what it carries."""

FEW = 100
"""People up to whom motion is as near as that; in a larger crowd everybody is seen from farther."""


def within_of(people: int) -> float:
    """How far off the motion of one of so many people may be, metres: 25 mm of 750 people."""
    return WITHIN * max(1.0, people / FEW) ** 0.8


def _reaches() -> NDArray[np.float64]:
    """(22,) metres from each joint to the farthest one that it carries."""
    places = rest_positions()
    found = np.zeros(len(JOINTS))
    for j in range(len(JOINTS)):
        carrier = j
        while carrier >= 0:
            away = float(np.linalg.norm(places[j] - places[carrier]))
            found[carrier] = max(found[carrier], away)
            carrier = int(PARENTS[carrier])
    return found


_REACHES = _reaches()[TURNING]


@dataclass(frozen=True)
class Keys:
    """Frames, from the person's first one on, and what is there in them.

    Attributes:
        frames: (k,) rising; one alone if nothing changes.
        values: (k, 3) metres, or (k, 4) quaternions of unit length.
    """

    frames: NDArray[np.int64]
    values: NDArray[np.float64]


@dataclass(frozen=True)
class Keyed:
    """The motion of one person.

    Attributes:
        person: number of the person.
        type_name: the person's pedestrian type.
        first: their first frame.
        count: number of frames in which they are there.
        scale: size of their body, 1 for that of the neutral skeleton.
        pelvis: its places.
        turns: of each of ``skeleton.TURNING`` against its parent.
    """

    person: int
    type_name: str
    first: int
    count: int
    scale: float
    pelvis: Keys
    turns: tuple[Keys, ...]


def keyed(walker: Walker, within: float) -> Keyed:
    """Leave out frames of somebody's motion that are near enough between others.

    Args:
        walker: the person.
        within: metres by which the pelvis may be off, and by which each joint alone may move the
            far end of what it carries.
    """
    (frames,) = key_frames(walker.pelvis[None], np.array([within]))
    turns = walker.turns().swapaxes(0, 1)
    kept = key_frames(turns, within / _REACHES, turns=True)
    return Keyed(
        walker.person,
        walker.type_name,
        walker.first,
        len(walker.motion),
        float(walker.motion.scale),
        Keys(frames, walker.pelvis[frames]),
        tuple(Keys(each, turn[each]) for each, turn in zip(kept, turns, strict=True)),
    )
