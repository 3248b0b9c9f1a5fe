"""Find the leg joints, and pairs of left and right joints, by their names."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.capture.skeleton import END, Skeleton
from mesa_mobility.errors import CaptureError

Names = tuple[str, str, str, tuple[str, ...]]

CONVENTIONS: tuple[tuple[str, Names, Names], ...] = (
    (
        "CMU and ACCAD BVH, Mixamo",
        ("LeftUpLeg", "LeftLeg", "LeftFoot", ("LeftToeBase", "LeftToe")),
        ("RightUpLeg", "RightLeg", "RightFoot", ("RightToeBase", "RightToe")),
    ),
    (
        "CMU ASF",
        ("lfemur", "ltibia", "lfoot", ("ltoes",)),
        ("rfemur", "rtibia", "rfoot", ("rtoes",)),
    ),
    (
        "Bandai-Namco",
        ("UpperLeg_L", "LowerLeg_L", "Foot_L", ("Toes_L",)),
        ("UpperLeg_R", "LowerLeg_R", "Foot_R", ("Toes_R",)),
    ),
    (
        "joints named after the joint",
        ("LeftHip", "LeftKnee", "LeftAnkle", ("LeftToe", "LeftToeBase", "LeftAnkle" + END)),
        ("RightHip", "RightKnee", "RightAnkle", ("RightToe", "RightToeBase", "RightAnkle" + END)),
    ),
    (
        "Xsens",
        ("LeftUpperLeg", "LeftLowerLeg", "LeftFoot", ("LeftToe", "LeftToeBase")),
        ("RightUpperLeg", "RightLowerLeg", "RightFoot", ("RightToe", "RightToeBase")),
    ),
)
"""Joint names by convention: (hip, knee, ankle, toe or its alternatives), left and right."""


TOES = ("toe", "toes", "toebase", "forefoot", "ball")
"""Names of the joint below the ankle in use elsewhere, without their side, in small letters."""


@dataclass(frozen=True)
class LegJoints:
    """Indices of (hip, knee, ankle, toe base) among the joints of a skeleton."""

    left: tuple[int, int, int, int]
    right: tuple[int, int, int, int]


def leg_joints(skeleton: Skeleton) -> LegJoints:
    """Find the legs of a skeleton by the names of its joints.

    Supports the names in CMU (BVH and ASF), ACCAD, Bandai-Namco, Mixamo and Xsens files. A prefix
    before a colon, as in ``mixamorig:LeftLeg``, is ignored. The joint below the ankle may also have
    one of the names of :data:`TOES`, if it is the only one there that has.

    Raises:
        CaptureError: the names belong to no known convention, or the joints found do not hang
            one from the other.
    """
    plain = {_plain(name): j for j, name in enumerate(skeleton.names)}
    for _, left, right in CONVENTIONS:
        legs = [_leg(names, plain, skeleton) for names in (left, right)]
        if legs[0] is not None and legs[1] is not None:
            for leg in (legs[0], legs[1]):
                _require_chain(skeleton, leg)
            return LegJoints(legs[0], legs[1])
    raise CaptureError(_no_legs(plain, skeleton))


def _leg(
    names: Names, plain: dict[str, int], skeleton: Skeleton
) -> tuple[int, int, int, int] | None:
    hip, knee, ankle, toes = names
    if not {hip, knee, ankle} <= plain.keys():
        return None
    named = [plain[name] for name in toes if name in plain]
    below = [j for j in _children(skeleton, plain[ankle]) if _bare(skeleton.names[j]) in TOES]
    if not named and len(below) != 1:
        return None
    return plain[hip], plain[knee], plain[ankle], (named or below)[0]


def _no_legs(plain: dict[str, int], skeleton: Skeleton) -> str:
    """What was found of the convention that comes nearest, and what was looked for."""
    label, *sides = max(
        CONVENTIONS, key=lambda each: sum(name in plain for side in each[1:] for name in side[:3])
    )
    found = [name for *names, _ in sides for name in names if name in plain]
    if found:
        missing = [name for *names, _ in sides for name in names if name not in plain]
        for *_, ankle, toes in sides:
            if ankle in plain and not any(name in plain for name in toes):
                there = [skeleton.names[j] for j in _children(skeleton, plain[ankle])]
                missing.append(
                    f"one of {', '.join(toes)}, or a single joint below {ankle} that is called "
                    f"{', '.join(TOES)} (there: {', '.join(there) or 'none'})"
                )
        return f"no legs: found {', '.join(found)} ({label}), but not {'; nor '.join(missing)}"
    expected = "; ".join(
        f"{', '.join(left[:3])}, {left[3][0]} and the same of the right ({name})"
        for name, left, _ in CONVENTIONS
    )
    names = ", ".join(skeleton.names)
    names = names if len(names) <= 500 else names[:497] + "..."
    return f"no legs among the joints {names}: expected {expected}"


def _children(skeleton: Skeleton, joint: int) -> list[int]:
    return np.flatnonzero(skeleton.parents == joint).tolist()


def _bare(name: str) -> str:
    """A name in small letters, without its side and what is no letter."""
    word = re.sub(r"(?i)left|right|(?<![a-z])[lr](?![a-z])|[^a-z]", "", _plain(name)).lower()
    return word[1:] if word[:1] in ("l", "r") and word[1:] in TOES else word


def _require_chain(skeleton: Skeleton, leg: Iterable[int]) -> None:
    hip, *below = leg
    for joint in below:
        j = joint
        while j > hip:
            j = int(skeleton.parents[j])
        if j != hip:
            raise CaptureError(
                f"joint {skeleton.names[joint]!r} does not hang from {skeleton.names[hip]!r}: "
                "expected hip, knee, ankle and toe in one chain"
            )
        hip = joint


def leg_length(skeleton: Skeleton) -> float:
    """Length of thigh and shank together, the mean of both legs, in the unit of the offsets.

    Raises:
        CaptureError: no legs are known by name.
    """
    legs = leg_joints(skeleton)
    length = 0.0
    for hip, _, ankle, _ in (legs.left, legs.right):
        joint = ankle
        while joint != hip:
            length += float(np.linalg.norm(skeleton.offsets[joint]))
            joint = int(skeleton.parents[joint])
    return length / 2


def counterparts(skeleton: Skeleton) -> NDArray[np.int64]:
    """(J,) index of each joint's counterpart on the other side; the joint itself if it has none.

    Sides are marked by ``Left``/``Right`` anywhere in a name, ``_L``/``_R`` or ``.L``/``.R`` at its
    end, or ``l``/``r`` (``L``/``R``) at its beginning, where both names occur.

    Raises:
        CaptureError: two joints are counterparts but their parents are not, so that left and
            right cannot be exchanged.
    """
    index = {name: j for j, name in enumerate(skeleton.names)}
    other = np.arange(len(skeleton))
    for name, j in index.items():
        for candidate in _other_side(name):
            if candidate in index:
                other[j] = index[candidate]
                break
    other = np.where(other[other] == np.arange(len(other)), other, np.arange(len(other)))
    parents = skeleton.parents
    for j in range(1, len(skeleton)):
        if parents[other[j]] != other[parents[j]]:
            raise CaptureError(
                f"joints {skeleton.names[j]!r} and {skeleton.names[other[j]]!r} hang from "
                f"{skeleton.names[parents[j]]!r} and {skeleton.names[parents[other[j]]]!r}: "
                "expected the same structure left and right"
            )
    return other


def _other_side(name: str) -> list[str]:
    prefix, colon, bare = name.rpartition(":")
    bare, end, number = bare.partition(END)
    names = []
    for here, there in (("Left", "Right"), ("left", "right"), ("LEFT", "RIGHT")):
        for a, b in ((here, there), (there, here)):
            if a in bare:
                names.append(bare.replace(a, b))
    swap = {"L": "R", "R": "L", "l": "r", "r": "l"}
    if len(bare) > 2 and bare[-2] in "_." and bare[-1] in swap:
        names.append(bare[:-1] + swap[bare[-1]])
    if len(bare) > 1 and bare[0] in swap:
        names.append(swap[bare[0]] + bare[1:])
    return [prefix + colon + candidate + end + number for candidate in names]


def _plain(name: str) -> str:
    return name.rpartition(":")[2]
