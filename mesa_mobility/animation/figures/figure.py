"""A simple figure around the neutral skeleton: one mesh of tubes, bound to its joints."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.animation.figures.clothes import PARTS
from mesa_mobility.bodies.skeleton import ANKLE_HEIGHT, HEEL_BACK, JOINT, OFFSETS, PARENTS

AROUND = 10
"""Vertices round a tube."""

MIDDLE, FLAT, OPEN, POINT = "middle", "flat", "open", "point"
"""How an end of a tube is closed: by triangles round its middle, by as few as it takes, not at all
since other parts hide it, or by a point in place of the last ring."""

Ring = tuple[tuple[float, float, float], float, float, dict[str, float]]
"""Centre in metres from a joint, radii along and across, and the joints that move it."""

Tube = tuple[list[Ring], int, str]
"""Rings, the axis along which they follow each other, and which of ``PARTS`` they are."""

Coarse = tuple[tuple[int, ...], int, tuple[str, str]]
"""Of a tube the rings that are left, vertices round it, and how its ends are closed."""

_Mesh = tuple[NDArray, NDArray, NDArray, NDArray, NDArray]


@dataclass(frozen=True)
class Figure:
    """A mesh, in the pose of the neutral skeleton, the pelvis at the origin.

    Attributes:
        vertices: (v, 3) float32 metres.
        normals: (v, 3) float32.
        triangles: (t, 3) int of vertices.
        joints: (v, 4) uint8; joints that move each vertex.
        weights: (v, 4) float32; their shares.
        parts: (v,) uint8; which of ``clothes.PARTS`` each vertex is; each triangle is of one part.
    """

    vertices: NDArray[np.float32]
    normals: NDArray[np.float32]
    triangles: NDArray[np.uint16]
    joints: NDArray[np.uint8]
    weights: NDArray[np.float32]
    parts: NDArray[np.uint8]


def rest_positions() -> NDArray[np.float64]:
    """(22, 3) joints of the neutral skeleton, the pelvis at the origin, metres."""
    places = np.zeros_like(OFFSETS)
    for j in range(1, len(OFFSETS)):
        places[j] = places[PARENTS[j]] + OFFSETS[j]
    return places


def human_figure(around: int = AROUND, more: Sequence[Tube] = ()) -> Figure:
    """The figure of an adult, and more parts that its joints carry."""
    return joined([*(tube for _, tube in _tubes()), *more], around)


def pawn(small: bool = False) -> Figure:
    """Somebody without limbs: shoulders and a head, feet at the origin.

    Args:
        small: for somebody who is few pixels high.
    """

    def rings(*each: tuple[float, float, float]) -> list[Ring]:
        return [((0.0, 0.0, z), deep, wide, {"pelvis": 1}) for z, deep, wide in each]

    legs = rings((0.0, 0.07, 0.13), (0.9, 0.10, 0.16))
    body = rings((0.86, 0.11, 0.17), (1.38, 0.12, 0.22), (1.5, 0.05, 0.06))
    head = rings((1.5, 0.04, 0.04), (1.63, 0.10, 0.08), (1.72, 0.06, 0.05))
    hair = rings((1.64, 0.09, 0.085), (1.72, 0.08, 0.07), (1.76, 0.03, 0.03))
    parts = ((legs, "trousers"), (body, "top"), (head, "skin"), (hair, "hair"))
    if small:
        return _together([(_tube(each[:2], 2, 4, (OPEN, FLAT)), part) for each, part in parts])
    return joined([(each, 2, part) for each, part in parts], 6)


def _tubes() -> list[tuple[str, Tube]]:
    tubes: list[tuple[str, Tube]] = [
        ("hips", (_hips(), 2, "trousers")),
        ("torso", (_torso(), 2, "top")),
        ("neck", (_neck(), 2, "skin")),
        ("head", (_head(), 2, "skin")),
        ("hair", (_hair(), 2, "hair")),
    ]
    for side in ("left", "right"):
        tubes += [
            ("leg", (_leg(side), 2, "trousers")),
            ("foot", (_foot(side), 0, "shoes")),
            ("sleeve", (_sleeve(side), 2, "top")),
            ("forearm", (_forearm(side), 2, "forearm")),
            ("hand", (_hand(side), 2, "skin")),
        ]
    return tubes


def joined(tubes: Sequence[Tube], around: int) -> Figure:
    """One mesh of tubes, each with so many vertices round it."""
    return _together([(_tube(rings, axis, around), part) for rings, axis, part in tubes])


def coarse_figure(coarse: Mapping[str, Coarse]) -> Figure:
    """The figure of an adult of the parts that are named, each as coarse as is said."""
    made = []
    for name, (rings, axis, part) in _tubes():
        if name in coarse:
            kept, around, ends = coarse[name]
            made.append((_tube([rings[k] for k in kept], axis, around, ends), part))
    return _together(made)


def _together(made: list[tuple[_Mesh, str]]) -> Figure:
    vertices, normals, triangles, joints, weights, parts, count = [], [], [], [], [], [], 0
    for (v, n, t, j, w), part in made:
        vertices.append(v)
        normals.append(n)
        triangles.append(t + count)
        joints.append(j)
        weights.append(w)
        parts.append(np.full(len(v), PARTS.index(part)))
        count += len(v)
    return Figure(
        np.concatenate(vertices).astype(np.float32),
        np.concatenate(normals).astype(np.float32),
        np.concatenate(triangles).astype(np.uint16),
        np.concatenate(joints).astype(np.uint8),
        np.concatenate(weights).astype(np.float32),
        np.concatenate(parts).astype(np.uint8),
    )


def _at(joint: str, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> tuple[float, float, float]:
    place = rest_positions()[JOINT[joint]] + [x, y, z]
    return float(place[0]), float(place[1]), float(place[2])


def _hips() -> list[Ring]:
    return [
        (_at("pelvis", z=-0.09), 0.075, 0.10, {"pelvis": 1}),
        (_at("pelvis", z=-0.02), 0.104, 0.163, {"pelvis": 1}),
        (_at("pelvis", z=0.08), 0.092, 0.145, {"pelvis": 0.6, "spine": 0.4}),
    ]


def _torso() -> list[Ring]:
    return [
        (_at("pelvis", z=-0.05), 0.106, 0.166, {"pelvis": 1}),
        (_at("pelvis", z=-0.02), 0.112, 0.170, {"pelvis": 1}),
        (_at("pelvis", z=0.10), 0.100, 0.150, {"pelvis": 0.6, "spine": 0.4}),
        (_at("pelvis", z=0.20), 0.094, 0.140, {"spine": 1}),
        (_at("chest"), 0.106, 0.157, {"spine": 0.5, "chest": 0.5}),
        (_at("chest", z=0.10), 0.112, 0.172, {"chest": 1}),
        (_at("neck", z=-0.05), 0.085, 0.165, {"chest": 1}),
        (_at("neck", z=-0.005), 0.062, 0.092, {"chest": 1}),
        (_at("neck", z=0.012), 0.056, 0.062, {"chest": 0.7, "neck": 0.3}),
    ]


def _neck() -> list[Ring]:
    return [
        (_at("neck", z=-0.01), 0.050, 0.052, {"chest": 0.6, "neck": 0.4}),
        (_at("neck", z=0.04), 0.050, 0.050, {"chest": 0.5, "neck": 0.5}),
        (_at("head"), 0.050, 0.050, {"neck": 1}),
    ]


def _head() -> list[Ring]:
    rings: list[Ring] = []
    for share in np.linspace(-1.0, 1.0, 9):
        wide = max(float(np.sqrt(1.0 - share * share)), 0.02)
        centre = _at("head", x=0.02, z=0.07 + 0.125 * float(share))
        rings.append((centre, 0.098 * wide, 0.076 * wide, {"head": 1}))
    return rings


def _hair() -> list[Ring]:
    """A cap a little wider than the head, set back so that the face is free."""
    rings: list[Ring] = []
    for share in np.linspace(-0.35, 1.0, 6):
        wide = max(float(np.sqrt(1.0 - share * share)), 0.02)
        back = 0.022 * (1.0 - float(share)) / 1.35
        centre = _at("head", x=0.02 - back, z=0.082 + 0.125 * float(share))
        rings.append((centre, 0.104 * wide, 0.083 * wide, {"head": 1}))
    return rings


def _leg(side: str) -> list[Ring]:
    hip, knee, ankle = (f"{side}_{joint}" for joint in ("hip", "knee", "ankle"))
    return [
        (_at(hip, z=0.02), 0.095, 0.085, {"pelvis": 0.6, hip: 0.4}),
        (_at(hip, z=-0.08), 0.092, 0.083, {hip: 1}),
        (_at(hip, z=-0.25), 0.075, 0.068, {hip: 1}),
        (_at(knee, z=0.05), 0.060, 0.056, {hip: 0.85, knee: 0.15}),
        (_at(knee), 0.058, 0.054, {hip: 0.5, knee: 0.5}),
        (_at(knee, z=-0.05), 0.056, 0.052, {hip: 0.15, knee: 0.85}),
        (_at(knee, x=-0.012, z=-0.15), 0.060, 0.052, {knee: 1}),
        (_at(knee, z=-0.32), 0.042, 0.038, {knee: 1}),
        (_at(ankle, z=0.02), 0.044, 0.040, {knee: 0.7, f"{side}_ankle": 0.3}),
    ]


def _foot(side: str) -> list[Ring]:
    ankle = f"{side}_ankle"
    rings: list[Ring] = []
    low = -ANKLE_HEIGHT
    for x, top in ((-HEEL_BACK, 0.055), (0.0, 0.085), (0.07, 0.065), (0.13, 0.045), (0.19, 0.030)):
        rings.append((_at(ankle, x=x, z=low + top / 2), top / 2, 0.040, {ankle: 1}))
    return rings


def _sleeve(side: str) -> list[Ring]:
    shoulder, elbow = f"{side}_shoulder", f"{side}_elbow"
    return [
        (_at(shoulder, z=0.035), 0.012, 0.012, {f"{side}_collar": 0.6, shoulder: 0.4}),
        (_at(shoulder, z=0.022), 0.038, 0.034, {f"{side}_collar": 0.5, shoulder: 0.5}),
        (_at(shoulder, z=-0.02), 0.054, 0.048, {f"{side}_collar": 0.3, shoulder: 0.7}),
        (_at(shoulder, z=-0.10), 0.049, 0.046, {shoulder: 1}),
        (_at(elbow, z=0.06), 0.043, 0.041, {shoulder: 0.9, elbow: 0.1}),
        (_at(elbow, z=0.03), 0.042, 0.040, {shoulder: 0.8, elbow: 0.2}),
    ]


def _forearm(side: str) -> list[Ring]:
    shoulder, elbow, wrist = (f"{side}_{joint}" for joint in ("shoulder", "elbow", "wrist"))
    return [
        (_at(elbow, z=0.05), 0.038, 0.036, {shoulder: 0.85, elbow: 0.15}),
        (_at(elbow), 0.038, 0.036, {shoulder: 0.5, elbow: 0.5}),
        (_at(elbow, z=-0.05), 0.039, 0.036, {elbow: 1}),
        (_at(wrist, z=0.01), 0.030, 0.026, {elbow: 1}),
    ]


def _hand(side: str) -> list[Ring]:
    elbow, wrist = f"{side}_elbow", f"{side}_wrist"
    return [
        (_at(wrist, z=0.02), 0.026, 0.022, {elbow: 1}),
        (_at(wrist, z=-0.06), 0.042, 0.022, {elbow: 1}),
        (_at(wrist, z=-0.17), 0.022, 0.012, {elbow: 1}),
    ]


def _tube(
    rings: list[Ring], axis: int, around: int, ends: tuple[str, str] = (MIDDLE, MIDDLE)
) -> _Mesh:
    """Vertices, normals, triangles, joints and weights of a tube along an axis."""
    angle = 2.0 * np.pi * np.arange(around) / around
    across = [each for each in range(3) if each != axis]
    if axis == 0:
        across.reverse()  # radii are given along z first, then y
    vertices, joints, weights = [], [], []
    middles = [rings[k] for k in (0, -1) if ends[k] in (MIDDLE, POINT)]
    whole = rings[:-1] if ends[1] == POINT else rings
    for count, each in [*((around, ring) for ring in whole), *((1, ring) for ring in middles)]:
        centre, along, aside, moved = each
        ring = np.tile(np.array(centre, dtype=np.float64), (count, 1))
        if count > 1:
            ring[:, across[0]] += along * np.cos(angle)
            ring[:, across[1]] += aside * np.sin(angle)
        vertices.append(ring)
        names, shares = list(moved), list(moved.values())
        joints.append(np.tile([JOINT[n] for n in names] + [0] * (4 - len(names)), (count, 1)))
        weights.append(np.tile(shares + [0.0] * (4 - len(shares)), (count, 1)))
    points = np.concatenate(vertices)
    triangles = np.array(_faces(len(whole), around, ends))
    corner = points[triangles]
    facing = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    outward = corner.mean(axis=1) - points.mean(axis=0)
    if np.einsum("ij,ij->", facing, outward) < 0.0:
        triangles, facing = triangles[:, ::-1], -facing
    normals = np.zeros_like(points)
    for k in range(3):
        np.add.at(normals, triangles[:, k], facing)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    return points, normals, triangles, np.concatenate(joints), np.concatenate(weights)


def _faces(rings: int, around: int, ends: tuple[str, str]) -> list[tuple[int, int, int]]:
    faces = []
    for ring in range(rings - 1):
        for a in range(around):
            b = (a + 1) % around
            low, high = ring * around, (ring + 1) * around
            faces += [(low + a, low + b, high + b), (low + a, high + b, high + a)]
    middle = rings * around
    around_ends = (range(around)[::-1], range((rings - 1) * around, rings * around))
    for end, own in zip(ends, around_ends, strict=True):
        if end == FLAT:
            faces += [(own[0], own[a], own[a + 1]) for a in range(1, around - 1)]
        elif end in (MIDDLE, POINT):
            faces += [(middle, own[a - 1], own[a]) for a in range(around)]
            middle += 1
    return faces
