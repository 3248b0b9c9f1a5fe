"""Put recordings onto the neutral skeleton: its bones point where the recorded ones do.

Directions of bones compare across skeletons of any size and joint count. A bone that a recording
lacks keeps its direction in its parent's axes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.bodies.landmarks import landmarks
from mesa_mobility.bodies.rotations import about_z, axes, shortest_turn, unit
from mesa_mobility.bodies.skeleton import (
    ANKLE_HEIGHT,
    JOINT,
    LEG_LENGTH,
    OFFSETS,
    PARENTS,
    TOE_HEIGHT,
    TURN_OF,
    TURNING,
)
from mesa_mobility.capture import Recording
from mesa_mobility.capture.legs import leg_length

FEET = ("left_ankle", "left_toe", "right_ankle", "right_toe")
"""The joints of which is known whether they bear on the floor."""

STILL_SPEED = 0.30
"""Metres a second below which a joint of a foot bears on the floor, if it is low ..."""

STILL_HEIGHT = 0.05
"""... by which it may be above where it is lowest in the clip, metres."""

STILL_SHARE = 0.15
"""On stairs a joint of a foot bears if it is slower than this share of its greatest speed: recorded
steps are repeated at other cadences."""

LOWEST = 5
"""Percentile of a joint's heights in a clip that counts as lowest."""


@dataclass(frozen=True)
class RetargetedClip:
    """A recording on the neutral skeleton, seen from where the person faces.

    Attributes:
        rotations: (n, 17, 3, 3) turns of ``TURNING`` against their parents, the pelvis's against
            the direction in which the person faces.
        heights: (n,) of the pelvis above the floor, metres.
        contacts: (n, 4) bool; whether each of ``FEET`` bears on the floor.
    """

    rotations: NDArray[np.float64]
    heights: NDArray[np.float64]
    contacts: NDArray[np.bool_]


def retarget(recording: Recording, facing: NDArray[np.float64]) -> RetargetedClip:
    """Put a recording onto the neutral skeleton.

    Args:
        recording: at 30 Hz.
        facing: (n,) radians; where the person faces in the recording's own frame.

    Raises:
        CaptureError: legs that are not found.
    """
    found = landmarks(recording)
    contacts = _contacts(found, recording)
    away = about_z(-facing)
    seen = {name: np.einsum("nij,nj->ni", away, place) for name, place in found.items()}
    return RetargetedClip(
        rotations=_rotations(seen),
        heights=_heights(found, recording, contacts),
        contacts=contacts,
    )


def bone_directions(
    found: dict[str, NDArray[np.float64]],
) -> dict[str, NDArray[np.float64]]:
    """(n, 3) unit directions of the recorded bones, by the joint in which each ends."""
    found = {**found, "pelvis": 0.5 * (found["left_hip"] + found["right_hip"])}
    ends = {
        "chest": "pelvis",
        "neck": "chest",
        "head": "neck",
        "crown": "head",
    }
    for side in ("left", "right"):
        ends |= {
            f"{side}_shoulder": "neck",
            f"{side}_elbow": f"{side}_shoulder",
            f"{side}_wrist": f"{side}_elbow",
            f"{side}_knee": f"{side}_hip",
            f"{side}_ankle": f"{side}_knee",
            f"{side}_toe": f"{side}_ankle",
        }
    return {
        end: unit(found[end] - found[start])
        for end, start in ends.items()
        if end in found and start in found
    }


def _rotations(seen: dict[str, NDArray[np.float64]]) -> NDArray[np.float64]:
    across = seen["left_hip"] - seen["right_hip"]
    n = len(across)
    up = np.broadcast_to([0.0, 0.0, 1.0], (n, 3))
    directions = bone_directions(seen)
    turned = np.tile(np.eye(3), (n, len(TURNING), 1, 1))
    oriented = {JOINT["pelvis"]: axes(across, up, first="y")}
    turned[:, 0] = oriented[JOINT["pelvis"]]
    ends = {int(PARENTS[end]): end for end in range(len(PARENTS) - 1, 0, -1)}
    ends[JOINT["chest"]] = JOINT["neck"]
    names = {number: name for name, number in JOINT.items()}
    for j in TURNING[1:].tolist():
        parent = oriented[int(PARENTS[j])]
        end = ends[j]
        direction = directions.get(names[end])
        if direction is None:
            oriented[j] = parent
            continue
        if j == JOINT["chest"] and "left_shoulder" in seen and "right_shoulder" in seen:
            shoulders = seen["left_shoulder"] - seen["right_shoulder"]
            oriented[j] = axes(shoulders, direction, first="z")
            turned[:, TURN_OF[j]] = np.swapaxes(parent, -1, -2) @ oriented[j]
            continue
        local = np.einsum("nji,nj->ni", parent, direction)
        if names[j].endswith("collar"):
            # Where a neck begins differs between skeletons. What compares is how shoulders move.
            usual = unit(local.mean(axis=0))
            local = np.einsum("ij,nj->ni", shortest_turn(usual, unit(OFFSETS[end])), local)
        turned[:, TURN_OF[j]] = shortest_turn(unit(OFFSETS[end]), local)
        oriented[j] = parent @ turned[:, TURN_OF[j]]
    return turned


def _heights(
    found: dict[str, NDArray[np.float64]], recording: Recording, contacts: NDArray[np.bool_]
) -> NDArray[np.float64]:
    """Heights of the pelvis of a body with the neutral legs, whose soles touch the same floor.

    On stairs the floor is the slope through the middles of the feet that bear.
    """
    pelvis = 0.5 * (found["left_hip"][:, 2] + found["right_hip"][:, 2])
    soles = []
    for column, (name, height) in enumerate(zip(FEET, (ANKLE_HEIGHT, TOE_HEIGHT) * 2, strict=True)):
        place = found[name]
        if not recording.slope:
            soles.append(np.percentile(place[:, 2], LOWEST) - height)
        elif height == TOE_HEIGHT and contacts[:, column].any():
            middle = 0.5 * (place[:, 0] + found[FEET[column - 1]][:, 0])
            above = place[:, 2] - recording.slope * (middle - recording.root_position[:, 0])
            soles.append(np.median(above[contacts[:, column]]) - height)
    floor = float(np.mean(soles))
    ratio = LEG_LENGTH / leg_length(recording.skeleton)
    return (pelvis - floor - ANKLE_HEIGHT) * ratio + ANKLE_HEIGHT


def _contacts(found: dict[str, NDArray[np.float64]], recording: Recording) -> NDArray[np.bool_]:
    """(n, 4) whether joints of feet bear on the floor or, on stairs, on a tread."""
    columns = []
    rises = recording.slope * recording.root_position[:, 0]
    for name in FEET:
        place = found[name] + rises[:, None] * [0.0, 0.0, 1.0]
        speed = np.linalg.norm(np.gradient(place, axis=0), axis=1) * recording.frame_rate
        if recording.slope:
            columns.append(_steady(speed < STILL_SHARE * speed.max()))
            continue
        low = place[:, 2] < np.percentile(place[:, 2], LOWEST) + STILL_HEIGHT
        columns.append(_steady((speed < STILL_SPEED) & low))
    return np.column_stack(columns)


def _steady(contact: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Contacts without gaps of one frame, and without those of one frame."""
    padded = np.pad(contact, 1, mode="edge")
    filled = contact | (padded[:-2] & padded[2:])
    padded = np.pad(filled, 1, mode="edge")
    return filled & (padded[:-2] | padded[2:])
