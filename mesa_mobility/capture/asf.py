"""Reading ASF files: the skeleton that AMC files move.

Format: Acclaim Skeleton File Definition V1.10, with the notes of ACCLAIMdef (Vicon) on what the
``order`` and ``axis`` lines mean: rotations are listed in the order in which they apply about fixed
axes.

A bone of an ASF becomes the joint at its start, so that ``lfemur`` is the hip, ``ltibia`` the knee,
``lfoot`` the ankle and ``ltoes`` the base of the toes.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from mesa_mobility.capture.skeleton import END, Skeleton, check_joints
from mesa_mobility.capture.text import check_unit, numbers, quote, read_bytes, text_lines
from mesa_mobility.errors import CaptureError

ROOT = "root"
ROTATIONS = ("rx", "ry", "rz")
TRANSLATIONS = ("tx", "ty", "tz")

Row = tuple[str, list[str]]
"""Where a line stands (file and line number, for errors) and its words."""

_AS_SPACE = str.maketrans(",()", "   ")


@dataclass
class Bone:
    """A bone as the file has it; the root is one of length zero.

    Attributes:
        where: file and line where the bone begins.
        direction: (3,) unit vector from start to end in file axes.
        length: file units.
        axis: rotation of the bone's own axes against the file's.
        dof: channels that the AMC file has for it, in order: "rx", "ry", "rz" (and "tx", "ty",
            "tz" for the root).
    """

    where: str
    direction: NDArray[np.float64] = field(default_factory=lambda: np.zeros(3))
    length: float = 0.0
    axis: Rotation = field(default_factory=Rotation.identity)
    dof: tuple[str, ...] = ()


@dataclass(frozen=True)
class AsfSkeleton:
    """Skeleton and channels of an ASF file.

    Attributes:
        skeleton: joints at the starts of bones, then the free ends of leaf bones.
        bones: by name, in the order of the skeleton's joints, the root first.
        degrees: whether angles are in degrees.
    """

    skeleton: Skeleton
    bones: dict[str, Bone]
    degrees: bool


def read_asf(path: str | Path, *, unit_to_m: float) -> AsfSkeleton:
    """Read an ASF file.

    Args:
        path: the file.
        unit_to_m: metres in one unit of the file; the file's own ``length`` multiplier is not
            used.

    Raises:
        CaptureError: the file is missing, truncated, no ASF, or has bones that are not connected.
    """
    path = Path(path)
    check_unit(unit_to_m, str(path))
    sections = _sections(text_lines(read_bytes(path), path), str(path))
    root = _root(sections["root"], str(path))
    degrees = _degrees(sections.get("units", []))
    bones = {ROOT: root, **_bones(sections["bonedata"], str(path), degrees)}
    parents = _hierarchy(sections["hierarchy"], bones, str(path))
    return _skeleton(bones, parents, degrees, unit_to_m)


def _sections(lines: list[str], where: str) -> dict[str, list[Row]]:
    sections: dict[str, list[Row]] = {}
    rows: list[Row] | None = None
    for line, raw in enumerate(lines, start=1):
        words = raw.partition("#")[0].translate(_AS_SPACE).split()
        if not words:
            continue
        if words[0].startswith(":"):
            rows = sections.setdefault(words[0][1:].lower(), [])
        elif rows is None:
            raise CaptureError(
                f"{where}, line {line}: {quote(raw.strip())}, expected an ASF keyword"
            )
        else:
            rows.append((f"{where}, line {line}", words))
    for needed in ("root", "bonedata", "hierarchy"):
        if needed not in sections:
            raise CaptureError(f"{where}: no section :{needed} (truncated, or no ASF?)")
    return sections


def _degrees(rows: list[Row]) -> bool:
    for at, words in rows:
        if words[0].lower() == "angle":
            if [word.lower() for word in words[1:]] not in (["deg"], ["rad"]):
                raise CaptureError(f"{at}: angle {quote(' '.join(words[1:]))}, expected deg or rad")
            return words[1].lower() == "deg"
    return True


def _root(rows: list[Row], where: str) -> Bone:
    bone = Bone(where)
    for at, (key, *values) in rows:
        if key.lower() == "order":
            bone.where = at
            bone.dof = _channels(values, at, (*TRANSLATIONS, *ROTATIONS))
        elif key.lower() in ("position", "orientation") and any(numbers(values, 3, at)):
            # Programs disagree about which axes a preset root counts in (ACCLAIMdef).
            raise CaptureError(f"{at}: root {key} {' '.join(values)}, expected 0 0 0")
    if not bone.dof:
        raise CaptureError(f"{where}: section :root has no order, expected TX TY TZ RX RY RZ")
    return bone


def _channels(values: list[str], at: str, known: tuple[str, ...]) -> tuple[str, ...]:
    channels = tuple(value.lower() for value in values)
    for channel in channels:
        if channel not in known or channels.count(channel) > 1:
            raise CaptureError(
                f"{at}: channel {quote(channel)}, expected each of {', '.join(known)} at most once"
            )
    return channels


def _bones(rows: list[Row], where: str, degrees: bool) -> dict[str, Bone]:
    bones: dict[str, Bone] = {}
    block: dict[str, tuple[str, list[str]]] | None = None
    begun = where
    for at, (key, *values) in rows:
        key = key.lower()
        if key == "begin":
            if block is not None:
                raise CaptureError(f"{at}: 'begin' inside of a bone, expected 'end' first")
            block, begun = {}, at
        elif block is None:
            raise CaptureError(f"{at}: {quote(key)}, expected 'begin' of a bone")
        elif key == "end":
            name, bone = _bone(block, begun, degrees)
            if name in bones or name == ROOT:
                raise CaptureError(f"{begun}: bone {quote(name)} occurs twice")
            bones[name] = bone
            check_joints(len(bones), at)
            block = None
        else:
            block[key] = (at, values)
    if block is not None:
        raise CaptureError(f"{begun}: bone without 'end' (truncated?)")
    if not bones:
        raise CaptureError(f"{where}: section :bonedata has no bones")
    return bones


def _bone(block: dict[str, tuple[str, list[str]]], begun: str, degrees: bool) -> tuple[str, Bone]:
    for needed in ("name", "direction", "length", "axis"):
        if needed not in block:
            raise CaptureError(f"{begun}: bone without {needed}")
    at, values = block["name"]
    if len(values) != 1:
        raise CaptureError(f"{at}: {quote(' '.join(values))}, expected the name of a bone")
    bone = Bone(begun)
    direction_at, direction = block["direction"]
    vector = np.array(numbers(direction, 3, direction_at))
    length_at, length = block["length"]
    bone.length = numbers(length, 1, length_at)[0]
    size = float(np.linalg.norm(vector))
    if bone.length < 0 or (size == 0 and bone.length > 0):
        raise CaptureError(f"{begun}: bone {values[0]} has no length in any direction")
    bone.direction = vector / size if size > 0 else vector
    axis_at, axis = block["axis"]
    order = axis[-1].lower() if axis else ""
    if sorted(order) != ["x", "y", "z"]:
        raise CaptureError(f"{axis_at}: axis order {quote(order)}, expected XYZ or another order")
    # Lower-case letters: about fixed axes, in this order.
    bone.axis = Rotation.from_euler(order, numbers(axis[:-1], 3, axis_at), degrees=degrees)
    if "dof" in block:
        at, channels = block["dof"]
        bone.dof = _channels(channels, at, ROTATIONS)
    return values[0], bone


def _hierarchy(rows: list[Row], bones: dict[str, Bone], where: str) -> dict[str, str]:
    """Parent of every bone but the root."""
    parents: dict[str, str] = {}
    ended = False
    for at, words in rows:
        if words[0].lower() in ("begin", "end"):
            ended = words[0].lower() == "end"
            continue
        parent, *children = words
        for name in words:
            if name not in bones:
                raise CaptureError(f"{at}: bone {quote(name)} is not in :bonedata")
        for child in children:
            if child == ROOT or child in parents:
                raise CaptureError(f"{at}: bone {quote(child)} has a second parent {quote(parent)}")
            parents[child] = parent
    if not ended:
        raise CaptureError(f"{where}: section :hierarchy has no 'end' (truncated?)")
    return parents


def _skeleton(
    bones: dict[str, Bone], parents: dict[str, str], degrees: bool, unit_to_m: float
) -> AsfSkeleton:
    order = [ROOT]
    for name in order:  # grows while it is walked: parents come before their children
        order += [child for child in bones if parents.get(child) == name]
    for name, bone in bones.items():
        if name not in order:
            raise CaptureError(f"{bone.where}: bone {quote(name)} does not hang from the root")
    leaves = [name for name in order if name != ROOT and name not in parents.values()]
    index = {name: j for j, name in enumerate(order)}
    above = [parents[name] for name in order[1:]] + leaves
    skeleton = Skeleton(
        names=(*order, *(name + END for name in leaves)),
        parents=np.array([-1, *(index[name] for name in above)]),
        offsets=np.array(
            [[0.0, 0.0, 0.0]]
            + [list(bones[name].direction * bones[name].length * unit_to_m) for name in above]
        ),
    )
    return AsfSkeleton(skeleton, {name: bones[name] for name in order}, degrees)
