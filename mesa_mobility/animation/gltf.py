"""A run as glTF 2.0: people as skinned, animated figures between the walls of the plan.

People share one mesh, those with a stick or a wheelchair another; their clothes are its materials.
Each has a skeleton of its own, whose joints are animated with quaternions of 16 bits. Frames are
left out where what viewers mix between the others is near enough (see ``keys.py``).
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from mesa_mobility.animation.figures.aids import aid_of, figure_with
from mesa_mobility.animation.figures.clothes import LOOKS, PARTS, look_of
from mesa_mobility.animation.figures.figure import Figure, rest_positions
from mesa_mobility.animation.gltf_store import Store
from mesa_mobility.animation.keys import key_frames
from mesa_mobility.animation.people import Walker, walkers
from mesa_mobility.animation.scenery import linear, surfaces
from mesa_mobility.bodies.motion import FRAME_RATE
from mesa_mobility.bodies.skeleton import JOINTS, OFFSETS, PARENTS, TURNING
from mesa_mobility.errors import ResultsError
from mesa_mobility.files.atomic import replacing
from mesa_mobility.results.formats.output_format import OutputFormat

if TYPE_CHECKING:
    from mesa_mobility.buildings import Building
    from mesa_mobility.floorplan import FloorPlan
    from mesa_mobility.results.excerpts import Excerpt

_UP = Rotation.from_euler("x", -90, degrees=True).as_quat().tolist()
"""From z up to glTF's y up."""

_FLOAT, _SHORT, _USHORT, _UBYTE = 5126, 5122, 5123, 5121
_ARRAY, _INDEX = 34962, 34963

OFF = 0.005
"""Metres by which the far end of what a joint carries, and a pelvis, may be off."""


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


_TOLERANCES = OFF / _reaches()[TURNING]
"""(17,) radians by which joints may be off."""


class Glb(OutputFormat):
    """Figures in glTF, for Blender and the web. Needs the extra `animation`."""

    name = "glb"
    suffixes = (".glb",)
    storeys = True

    def write(self, excerpt: Excerpt, path: Path) -> None:
        """See ``write_glb``."""
        people = walkers(excerpt.trajectories, excerpt.selection, excerpt.bank, excerpt.building)
        write_glb(people, excerpt.plan, path, progress=excerpt.person_done)


def write_glb(
    people: Iterable[Walker],
    plan: FloorPlan | Building,
    path: str | os.PathLike[str],
    *,
    progress: Callable[[int], None] | None = None,
) -> None:
    """Write a binary glTF file: metres, y up, one animation.

    Args:
        people: those shown; the animation begins with the first of their frames.
        plan: floor and walls, or a building.
        path: the file.
        progress: called with the number of people done.

    Raises:
        ResultsError: the file cannot be written, or pygltflib is not installed.
    """
    try:
        import pygltflib as gltf
    except ImportError as error:
        raise ResultsError(
            "glTF files need pygltflib: pip install 'mesa-mobility[animation]'"
        ) from error
    file = gltf.GLTF2(asset=gltf.Asset(version="2.0", generator="mesa-mobility"))
    store = Store(gltf, file)
    world = store.node(gltf.Node(name="world", rotation=_UP, children=[]))
    top = [world]
    _add_plan(gltf, file, store, plan, world)
    shown = list(people)
    aids = sorted({aid_of(walker.type_name) for walker in shown})
    meshes, bind = _add_figures(gltf, file, store, aids)
    first = min(walker.first for walker in shown)
    animation = gltf.Animation(name="walk", samplers=[], channels=[])
    for done, walker in enumerate(shown, start=1):
        joints = _add_skeleton(gltf, file, store, walker, world)
        file.skins.append(gltf.Skin(inverseBindMatrices=bind, joints=joints, skeleton=joints[0]))
        figure = gltf.Node(
            name=f"person {walker.person}",
            mesh=meshes[aid_of(walker.type_name)][walker.person % LOOKS],
            skin=len(file.skins) - 1,
        )
        top.append(store.node(figure))
        _animate(gltf, file, store, animation, walker, joints, first)
        if progress is not None:
            progress(done)
    file.animations.append(animation)
    file.scenes.append(gltf.Scene(nodes=top))
    file.scene = 0
    store.finish()
    content = b"".join(file.save_to_bytes())
    with replacing(path, ResultsError) as temporary:
        temporary.write_bytes(content)


def _attributes(
    gltf: Any, store: Store, vertices: NDArray[np.float32], normals: NDArray[np.float32]
) -> Any:
    places = store.accessor(
        vertices,
        "VEC3",
        _FLOAT,
        target=_ARRAY,
        min=vertices.min(axis=0).tolist(),
        max=vertices.max(axis=0).tolist(),
    )
    facing = store.accessor(normals, "VEC3", _FLOAT, target=_ARRAY)
    return gltf.Attributes(POSITION=places, NORMAL=facing)


def _indices(store: Store, triangles: NDArray[np.integer]) -> int:
    flat = triangles.astype(np.uint16).reshape(-1)
    return store.accessor(flat, "SCALAR", _USHORT, target=_INDEX)


def _material(
    gltf: Any, file: Any, colour: str, *, both_sides: bool = False, opacity: float = 1.0
) -> int:
    file.materials.append(
        gltf.Material(
            pbrMetallicRoughness=gltf.PbrMetallicRoughness(
                baseColorFactor=[*linear(colour), opacity],
                metallicFactor=0.0,
                roughnessFactor=0.9,
            ),
            doubleSided=both_sides,
            alphaMode="OPAQUE" if opacity == 1.0 else "BLEND",
        )
    )
    return len(file.materials) - 1


def _add_figures(
    gltf: Any, file: Any, store: Store, aids: list[str]
) -> tuple[dict[str, list[int]], int]:
    """The meshes for each aid, one for each look, and the accessor of inverse bind matrices."""
    meshes: dict[str, list[int]] = {aid: [] for aid in aids}
    materials: dict[str, int] = {}
    for aid in aids:
        attributes, parts = _add_figure(gltf, store, figure_with(aid))
        for number in range(LOOKS):
            look, primitives = look_of(number), []
            for part, indices in parts.items():
                if look[part] not in materials:
                    materials[look[part]] = _material(gltf, file, look[part])
                primitives.append(
                    gltf.Primitive(
                        attributes=attributes, indices=indices, material=materials[look[part]]
                    )
                )
            file.meshes.append(gltf.Mesh(name="person", primitives=primitives))
            meshes[aid].append(len(file.meshes) - 1)
    bind = np.tile(np.eye(4, dtype=np.float32), (len(JOINTS), 1, 1))
    bind[:, 3, :3] = -rest_positions()  # matrices are stored column by column
    return meshes, store.accessor(bind, "MAT4", _FLOAT)


def _add_figure(gltf: Any, store: Store, figure: Figure) -> tuple[Any, dict[str, int]]:
    """Attributes of a figure, and the accessor of the triangles of each of its parts."""
    attributes = _attributes(gltf, store, figure.vertices, figure.normals)
    attributes.JOINTS_0 = store.accessor(figure.joints, "VEC4", _UBYTE, target=_ARRAY)
    attributes.WEIGHTS_0 = store.accessor(figure.weights, "VEC4", _FLOAT, target=_ARRAY)
    of = figure.parts[figure.triangles[:, 0]]
    parts = {PARTS[k]: _indices(store, figure.triangles[of == k]) for k in np.unique(of).tolist()}
    return attributes, parts


def _add_plan(gltf: Any, file: Any, store: Store, plan: FloorPlan | Building, world: int) -> None:
    # Indices have 16 bits, and 65,535 is not allowed.
    for name, vertices, normals, triangles, colour, both_sides, opacity in surfaces(plan, 65_535):
        attributes, indices = (
            _attributes(gltf, store, vertices, normals),
            _indices(store, triangles),
        )
        material = _material(gltf, file, colour, both_sides=both_sides, opacity=opacity)
        part = gltf.Primitive(attributes=attributes, indices=indices, material=material)
        file.meshes.append(gltf.Mesh(name=name, primitives=[part]))
        node = store.node(gltf.Node(name=name, mesh=len(file.meshes) - 1))
        file.nodes[world].children.append(node)


def _add_skeleton(gltf: Any, file: Any, store: Store, walker: Walker, world: int) -> list[int]:
    """Nodes of a person's joints, the pelvis below the world; their numbers."""
    start = len(file.nodes)
    joints = [start + j for j in range(len(JOINTS))]
    for j, name in enumerate(JOINTS):
        children = [start + int(child) for child in np.flatnonzero(j == PARENTS)]
        place = walker.pelvis[0] if j == 0 else OFFSETS[j]
        store.node(
            gltf.Node(
                name=f"{walker.person}.{name}",
                translation=[float(value) for value in place],
                scale=[walker.motion.scale] * 3 if j == 0 else None,
                children=children,
            )
        )
    file.nodes[world].children.append(joints[0])
    return joints


def _animate(
    gltf: Any,
    file: Any,
    store: Store,
    animation: Any,
    walker: Walker,
    joints: list[int],
    first: int,
) -> None:
    """Channels of one person: pelvis, joints, and when they are there."""
    n = len(walker.motion)
    begin = walker.first - first

    def channel(node: int, what: str, output: int, when: int, how: str = "LINEAR") -> None:
        animation.samplers.append(
            gltf.AnimationSampler(input=when, output=output, interpolation=how)
        )
        animation.channels.append(
            gltf.AnimationChannel(
                sampler=len(animation.samplers) - 1,
                target=gltf.AnimationChannelTarget(node=node, path=what),
            )
        )

    def stamps(frames: NDArray[np.int64]) -> int:
        when = ((begin + frames) / FRAME_RATE).astype(np.float32)
        ends = {"min": [float(when[0])], "max": [float(when[-1])]}
        return store.keys(when, "SCALAR", _FLOAT, **ends)

    pelvis = walker.pelvis
    (frames,) = key_frames(pelvis[None], np.array([OFF]))
    if len(frames) > 1:
        places = pelvis[frames].astype(np.float32)
        channel(joints[0], "translation", store.keys(places, "VEC3", _FLOAT), stamps(frames))
    turns = walker.turns().swapaxes(0, 1)
    kept = key_frames(turns, _TOLERANCES, turns=True)
    for turn, frames, joint in zip(turns, kept, TURNING.tolist(), strict=True):
        whole = np.rint(turn[frames] * 32767).astype(np.int16)
        if len(frames) == 1:
            file.nodes[joints[joint]].rotation = _of_length_one(turn[0])
            continue
        output = store.keys(whole, "VEC4", _SHORT, normalized=True)
        channel(joints[joint], "rotation", output, stamps(frames))
    _show(store, channel, walker, joints[0], (begin, begin + n))


def _of_length_one(turn: NDArray[np.float64]) -> list[float]:
    return (turn / np.linalg.norm(turn)).tolist()  # type: ignore[no-any-return]


def _show(
    store: Store,
    channel: Callable[..., None],
    walker: Walker,
    pelvis: int,
    there: tuple[int, int],
) -> None:
    """A person has their size while they are there, and size 0 before and after."""
    full = [walker.motion.scale] * 3
    keys = [(0, [0.0] * 3)] if there[0] > 0 else []
    keys += [(there[0], full), (there[1], [0.0] * 3)]
    when = np.array([frame / FRAME_RATE for frame, _ in keys], dtype=np.float32)
    stamps = store.keys(when, "SCALAR", _FLOAT, min=[float(when[0])], max=[float(when[-1])])
    sizes = np.array([size for _, size in keys], dtype=np.float32)
    channel(pelvis, "scale", store.keys(sizes, "VEC3", _FLOAT), stamps, "STEP")
