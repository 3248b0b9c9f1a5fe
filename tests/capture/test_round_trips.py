"""Recordings written out as text and read again, against kinematics worked out here."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mesa_mobility.capture import read_amc
from mesa_mobility.capture.bvh import parse_bvh

UNIT = 0.01
Matrix = np.ndarray


def turn(axis: str, angle: float) -> Matrix:
    """Rotation by an angle in degrees about a coordinate axis, as textbooks have it."""
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    return {
        "X": np.array([[1, 0, 0], [0, c, -s], [0, s, c]]),
        "Y": np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]),
        "Z": np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]),
    }[axis]


def in_world(point: Matrix) -> Matrix:
    return np.array([point[2], point[0], point[1]]) * UNIT


lengths = st.floats(-100, 100)
angles = st.floats(-720, 720)
vectors = st.tuples(lengths, lengths, lengths)
orders = st.permutations("XYZ").map("".join)


@dataclass
class Joint:
    name: str
    parent: int
    offset: tuple[float, float, float]
    channels: list[tuple[str, str]]


@st.composite
def trees(draw: st.DrawFn) -> tuple[list[Joint], list[list[list[float]]]]:
    """Joints with any number of rotation channels in any order, and frames of their values."""
    count = draw(st.integers(1, 7))
    joints = []
    for j in range(count):
        parent = draw(st.integers(0, j - 1)) if j else -1
        rotations = draw(st.permutations([(axis, "rotation") for axis in "XYZ"]))
        channels = rotations[: draw(st.integers(0, 3))]
        if j == 0:
            channels = draw(st.permutations([*channels, *((axis, "position") for axis in "XYZ")]))
        joints.append(Joint(f"j{j}", parent, draw(vectors), channels))
    frames = draw(st.integers(1, 3))
    values = [
        [[draw(angles if k == "rotation" else lengths) for _, k in j.channels] for j in joints]
        for _ in range(frames)
    ]
    return joints, values


def bvh_text(joints: list[Joint], values: list, ends: bool, newline: str) -> str:
    """The file, and the joints in its order: depth first."""
    order: list[int] = []

    def block(j: int) -> str:
        order.append(j)
        joint = joints[j]
        offset = " ".join(map(repr, joint.offset))
        channels = " ".join(axis + kind for axis, kind in joint.channels)
        inside = "".join(block(i) for i, child in enumerate(joints) if child.parent == j)
        if ends and not inside:
            inside = "End Site\n{\nOFFSET 0 1 0\n}\n"
        return (
            f"{'JOINT' if j else 'ROOT'} {joint.name}\n{{\nOFFSET {offset}\n"
            f"CHANNELS {len(joint.channels)} {channels}\n{inside}}}\n"
        )

    hierarchy = block(0)
    rows = [" ".join(repr(v) for j in order for v in frame[j]) for frame in values]
    text = f"HIERARCHY\n{hierarchy}MOTION\nFrames: {len(values)}\nFrame Time: 0.02\n"
    return (text + "\n".join(rows) + "\n").replace("\n", newline)


@settings(deadline=None, max_examples=100)
@given(trees(), st.booleans(), st.sampled_from(["\n", "\r\n"]))
def test_bvh_text_gives_back_every_joint_where_matrices_put_it(tree, ends, newline):
    joints, values = tree
    text = bvh_text(joints, values, ends, newline)
    recording = parse_bvh(text.encode(), Path("tree.bvh"), unit_to_m=UNIT)
    found = recording.positions()
    assert recording.frames == len(values)
    assert recording.frame_rate == 50.0
    assert {name for name in recording.skeleton.names if "end" not in name} == {
        joint.name for joint in joints
    }
    for f, frame in enumerate(values):
        places: list[tuple[Matrix, Matrix]] = []
        for joint, numbers in zip(joints, frame, strict=True):
            rotation = np.eye(3)
            position = np.array(joint.offset)
            for (axis, kind), value in zip(joint.channels, numbers, strict=True):
                if kind == "rotation":
                    rotation = rotation @ turn(axis, value)
                else:
                    position["XYZ".index(axis)] = value
            if joint.parent >= 0:
                origin, frame_of_parent = places[joint.parent]
                position = origin + frame_of_parent @ position
                rotation = frame_of_parent @ rotation
            places.append((position, rotation))
            at = found[f, recording.skeleton.index(joint.name)]
            np.testing.assert_allclose(at, in_world(position), atol=1e-11)


@dataclass
class Bone:
    name: str
    parent: int
    direction: tuple[float, float, float]
    length: float
    axis_order: str
    axis: tuple[float, float, float]
    dof: str


@st.composite
def rigs(draw: st.DrawFn) -> tuple[str, list[Bone], list[list[list[float]]]]:
    """Order of the root's channels, bones (parent -1 is the root), and frames of values."""
    order = draw(st.permutations(["TX", "TY", "TZ", "RX", "RY", "RZ"]))
    bones = []
    for j in range(draw(st.integers(1, 6))):
        direction = draw(vectors.filter(lambda v: np.linalg.norm(v) > 1e-3))
        dof = draw(orders)[: draw(st.integers(0, 3))]
        bones.append(
            Bone(
                f"b{j}",
                draw(st.integers(-1, j - 1)),
                direction,
                draw(st.floats(0, 50)),
                draw(orders),
                draw(st.tuples(angles, angles, angles)),
                dof,
            )
        )
    frames = draw(st.integers(1, 3))
    values = [
        [[draw(angles) for _ in channels] for channels in [order, *(bone.dof for bone in bones)]]
        for _ in range(frames)
    ]
    return order, bones, values


def asf_text(order: list[str], bones: list[Bone], radians: bool) -> str:
    def angle(value: float) -> str:
        return repr(float(np.radians(value))) if radians else repr(value)

    data = "".join(
        f"  begin\n    id {j + 1}\n    name {bone.name}\n"
        f"    direction {' '.join(map(repr, bone.direction))}\n    length {bone.length!r}\n"
        f"    axis {' '.join(map(angle, bone.axis))} {bone.axis_order}\n"
        + (f"    dof {' '.join('r' + axis.lower() for axis in bone.dof)}\n" if bone.dof else "")
        + "    limits (-inf inf)\n  end\n"
        for j, bone in enumerate(bones)
    )
    lines = []
    for parent in range(-1, len(bones)):
        children = [bone.name for bone in bones if bone.parent == parent]
        if children:
            name = "root" if parent < 0 else bones[parent].name
            lines.append(f"    {name} {' '.join(children)}\n")
    return (
        f"# made up\n:version 1.10\n:name test\n:units\n  length 0.45\n"
        f"  angle {'rad' if radians else 'deg'}\n:root\n  order {' '.join(order)}\n  axis XYZ\n"
        f"  position 0 0 0\n  orientation 0 0 0\n:bonedata\n{data}"
        f":hierarchy\n  begin\n{''.join(lines)}  end\n"
    )


def amc_text(order: list[str], bones: list[Bone], values: list, radians: bool) -> str:
    def number(value: float, is_angle: bool) -> str:
        return repr(float(np.radians(value))) if radians and is_angle else repr(value)

    text = "#!made up\n:FULLY-SPECIFIED\n" + (":RADIANS\n" if radians else ":DEGREES\n")
    for f, (root, *rest) in enumerate(values, start=1):
        moved = [number(v, c[0] == "R") for c, v in zip(order, root, strict=True)]
        text += f"{f}\nroot {' '.join(moved)}\n"
        # Files list the bones in an order of their own.
        for bone, numbers in reversed(list(zip(bones, rest, strict=True))):
            if bone.dof:
                text += f"{bone.name} {' '.join(number(v, True) for v in numbers)}\n"
    return text


def sequence(order: str, values: Sequence[float]) -> Matrix:
    """Rotations about fixed axes, the first one first."""
    rotation = np.eye(3)
    for axis, value in zip(order, values, strict=True):
        rotation = turn(axis, value) @ rotation
    return rotation


@pytest.mark.thorough
@settings(deadline=None, max_examples=100)
@given(rigs(), st.booleans())
def test_amc_text_gives_back_every_bone_where_matrices_put_it(tmp_path_factory, rig, radians):
    order, bones, values = rig
    folder = tmp_path_factory.mktemp("rig")
    (folder / "s.asf").write_text(asf_text(order, bones, radians))
    (folder / "s_01.amc").write_text(amc_text(order, bones, values, radians))
    recording = read_amc(folder / "s_01.amc", unit_to_m=UNIT, frame_rate=60.0)
    found = recording.positions()
    names = recording.skeleton.names
    assert recording.frames == len(values)
    assert recording.frame_rate == 60.0
    for f, (root, *rest) in enumerate(values):
        channels = dict(zip(order, root, strict=True))
        turns = [(c[1], v) for c, v in zip(order, root, strict=True) if c[0] == "R"]
        base = sequence("".join(axis for axis, _ in turns), [v for _, v in turns])
        start = np.array([channels["TX"], channels["TY"], channels["TZ"]])
        np.testing.assert_allclose(found[f, names.index("root")], in_world(start), atol=1e-10)
        ends: list[tuple[Matrix, Matrix]] = []
        for bone, numbers in zip(bones, rest, strict=True):
            begin, frame_of_parent = ends[bone.parent] if bone.parent >= 0 else (start, base)
            own = sequence(bone.axis_order, bone.axis)
            rotation = frame_of_parent @ own @ sequence(bone.dof, numbers) @ own.T
            direction = np.array(bone.direction) / np.linalg.norm(bone.direction)
            end = begin + rotation @ direction * bone.length
            ends.append((end, rotation))
            at = found[f, names.index(bone.name)]
            np.testing.assert_allclose(at, in_world(begin), atol=1e-10)
            if f"{bone.name}.end" in names:
                at = found[f, names.index(f"{bone.name}.end")]
                np.testing.assert_allclose(at, in_world(end), atol=1e-10)
    leaves = {b.name for j, b in enumerate(bones) if all(c.parent != j for c in bones)}
    assert {name.removesuffix(".end") for name in names if name.endswith(".end")} == leaves
