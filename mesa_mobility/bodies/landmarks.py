"""Find the joints of the upper body in a recording's skeleton, by their names."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.capture import Recording
from mesa_mobility.capture.legs import leg_joints
from mesa_mobility.capture.skeleton import END

_TRUNK = {
    "chest": ("thorax", "Spine2", "Spine1", "Spine", "Chest", "T8"),
    "neck": ("lowerneck", "Neck"),
    "head": ("head", "Head"),
    "crown": ("head" + END, "Head" + END, "HeadTop_End", "HeadEnd"),
}
_ARMS = {
    "shoulder": ("{l}humerus", "{Left}Arm", "{Left}UpperArm", "UpperArm_{L}", "{Left}Shoulder"),
    "elbow": ("{l}radius", "{Left}ForeArm", "{Left}LowerArm", "LowerArm_{L}", "{Left}Elbow"),
    "wrist": ("{l}wrist", "{Left}Hand", "Hand_{L}", "{Left}Wrist"),
}
_SAME_PLACE = 0.01
"""Metres within which two joints count as one."""


def landmarks(recording: Recording) -> dict[str, NDArray[np.float64]]:
    """Positions of the neutral skeleton's joints in a recording.

    Args:
        recording: with legs that are known by name.

    Returns:
        For each joint found, (frames, 3) positions in the world, metres. All of the legs are there;
        joints of the upper body may be missing.

    Raises:
        CaptureError: legs that are not found.
    """
    positions = recording.positions()
    plain = {name.rpartition(":")[2]: j for j, name in enumerate(recording.skeleton.names)}
    found: dict[str, NDArray[np.float64]] = {}
    legs = leg_joints(recording.skeleton)
    for side, leg in (("left", legs.left), ("right", legs.right)):
        for joint, number in zip(("hip", "knee", "ankle", "toe"), leg, strict=True):
            found[f"{side}_{joint}"] = positions[:, number]
        for joint, names in _ARMS.items():
            for name in names:
                spelt = name.format(l=side[0], L=side[0].upper(), Left=side.capitalize())
                if spelt in plain:
                    found[f"{side}_{joint}"] = positions[:, plain[spelt]]
                    break
    for joint in ("neck", "head", "crown", "chest"):
        for name in _TRUNK[joint]:
            if name not in plain:
                continue
            place = positions[:, plain[name]]
            # Some files end the trunk where the neck begins.
            if joint == "chest" and _same(place, found.get("neck")):
                continue
            found[joint] = place
            break
    return found


def _same(place: NDArray[np.float64], other: NDArray[np.float64] | None) -> bool:
    return other is not None and bool(np.linalg.norm(place[0] - other[0]) < _SAME_PLACE)
