"""Figures of people and of what they hold or sit in, for the three-dimensional view.

Each is there with much detail, for people near the viewer, and with little, for those far away.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from mesa_mobility.animation.figures.aids import aid_figure
from mesa_mobility.animation.figures.figure import (
    FLAT,
    OPEN,
    POINT,
    Coarse,
    Figure,
    coarse_figure,
    human_figure,
    pawn,
    rest_positions,
)
from mesa_mobility.bodies.motion import BodyMotion
from mesa_mobility.bodies.rotations import matrices
from mesa_mobility.bodies.seated import seated_motion
from mesa_mobility.bodies.skeleton import JOINT

NEAR_AROUND = 8
"""Vertices round a limb of somebody near."""

_FAR: dict[str, Coarse] = {
    "hips": ((0, 2), 4, (FLAT, OPEN)),
    "torso": ((1, 5, 6), 4, (OPEN, FLAT)),
    "head": ((1, 4, 7), 4, (FLAT, FLAT)),
    "hair": ((0, 3, 5), 4, (FLAT, FLAT)),
    "leg": ((0, 4, 8), 4, (OPEN, OPEN)),
    "foot": ((0, 3), 4, (FLAT, FLAT)),
    "sleeve": ((2, 5), 4, (FLAT, OPEN)),
    "forearm": ((0, 3), 4, (OPEN, FLAT)),
    "hand": ((0, 2), 4, (OPEN, FLAT)),
}
_SMALL: dict[str, Coarse] = {
    "torso": ((1, 5, 6), 4, (OPEN, FLAT)),
    "head": ((1, 4), 4, (OPEN, OPEN)),
    "hair": ((0, 4), 4, (OPEN, FLAT)),
    "leg": ((0, 4, 8), 3, (OPEN, OPEN)),
    "foot": ((0, 3), 3, (FLAT, POINT)),
    "sleeve": ((2, 5), 3, (FLAT, OPEN)),
    "forearm": ((0, 3), 3, (OPEN, OPEN)),
    "hand": ((1, 2), 3, (OPEN, POINT)),
}
"""Parts of people who are far away, and of those who are few pixels high."""

_CARRIED = ("cane", "crutches", "walking_frame")
_BARS = {"near": 6, "far": 3}
"""Vertices round a bar of what is carried."""

_WHEELS = {"near": 12, "far": 6}
"""Vertices round a wheel, and each bar of a wheelchair."""


def jointed_figures() -> dict[str, Figure]:
    """People and what they hold, by name, in the pose of the neutral skeleton.

    The pelvis is at the origin. Names end with the level of detail: ``person_near``, ``cane_far``.
    ``person_small`` shows a person who is few pixels high.
    """
    found = {
        "person_near": human_figure(NEAR_AROUND),
        "person_far": coarse_figure(_FAR),
        "person_small": coarse_figure(_SMALL),
    }
    for level, around in _BARS.items():
        found |= {f"{aid}_{level}": aid_figure(aid, around) for aid in _CARRIED}
    return found


def rigid_figures() -> dict[str, Figure]:
    """Figures that move as a whole and stand on the floor at the origin, by name.

    Names that end with ``_near`` are of detailed figures, those with ``_far`` of coarse ones.
    ``seated_near`` and ``seated_far`` show a person who sits in a wheelchair, without the
    wheelchair. ``wheelchair_near`` and ``wheelchair_far`` show the wheelchair alone.
    ``person_pawn`` shows a person without limbs, ``person_speck`` one who is few pixels high.
    """
    people = {"near": human_figure(NEAR_AROUND), "far": coarse_figure(_FAR)}
    found = {"person_pawn": pawn(), "person_speck": pawn(small=True)}
    for level, person in people.items():
        found[f"seated_{level}"] = _seated(person)
        found[f"wheelchair_{level}"] = _seated(aid_figure("wheelchair", _WHEELS[level]))
    return found


def seated_head() -> list[float]:
    """Place of the head of somebody who sits in a wheelchair at the origin, metres."""
    head: list[float] = _sitting().positions[0, JOINT["head"]].tolist()
    return head


def _sitting() -> BodyMotion:
    return seated_motion(np.zeros(1, dtype=np.int64), np.zeros((1, 3)))


def _seated(figure: Figure) -> Figure:
    """A figure in the pose of somebody who sits in a wheelchair at the origin."""
    motion = _sitting()
    turns = matrices(motion.rotations[0])[figure.joints]
    away = figure.vertices[:, None] - rest_positions()[figure.joints]
    places = motion.positions[0][figure.joints] + np.einsum("vkij,vkj->vki", turns, away)
    facing = np.einsum("vkij,vj->vki", turns, figure.normals)
    shares = figure.weights[..., None]
    return replace(
        figure,
        vertices=(shares * places).sum(axis=1).astype(np.float32),
        normals=(shares * facing).sum(axis=1).astype(np.float32),
    )
