"""A run as glTF 2.0: people as skinned, animated figures between the walls of the plan.

People share one mesh, those with a stick or a wheelchair another. Each has a skeleton of its own,
whose joints are animated at 30 frames a second with quaternions of 16 bits.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from mesa_mobility.animation.aids import aid_of, figure_with
from mesa_mobility.animation.figure import rest_positions
from mesa_mobility.animation.people import Walker, walkers
from mesa_mobility.animation.scenery import COLOURS, linear, surfaces
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
    store = _Store(gltf, file)
    world = store.node(gltf.Node(name="world", rotation=_UP, children=[]))
    top = [world]
    _add_plan(gltf, file, store, plan, world)
    shown = list(people)
    aids = sorted({aid_of(walker.type_name) for walker in shown})
    meshes, bind = _add_figures(gltf, file, store, aids)
    first = min(walker.first for walker in shown)
    last = max(walker.first + len(walker.motion) for walker in shown)
    times = store.view(np.arange(last - first + 1, dtype=np.float32) / FRAME_RATE)
    animation = gltf.Animation(name="walk", samplers=[], channels=[])
    for done, walker in enumerate(shown, start=1):
        joints = _add_skeleton(gltf, file, store, walker, world)
        file.skins.append(gltf.Skin(inverseBindMatrices=bind, joints=joints, skeleton=joints[0]))
        figure = gltf.Node(
            name=f"person {walker.person}",
            mesh=meshes[aid_of(walker.type_name)][walker.person % len(COLOURS)],
            skin=len(file.skins) - 1,
        )
        top.append(store.node(figure))
        _animate(gltf, store, animation, walker, joints, times, first)
        if progress is not None:
            progress(done)
    file.animations.append(animation)
    file.scenes.append(gltf.Scene(nodes=top))
    file.scene = 0
    store.finish()
    content = b"".join(file.save_to_bytes())
    with replacing(path, ResultsError) as temporary:
        temporary.write_bytes(content)


class _Store:
    """Arrays of a glTF file in one buffer."""

    def __init__(self, gltf: Any, file: Any) -> None:
        self._gltf, self._file = gltf, file
        self._parts: list[bytes] = []
        self._length = 0

    def node(self, node: Any) -> int:
        """Add a node; its number."""
        self._file.nodes.append(node)
        return len(self._file.nodes) - 1

    def view(self, array: NDArray[Any], target: int | None = None) -> int:
        """Add an array; the number of its view."""
        data = np.ascontiguousarray(array).tobytes()
        self._file.bufferViews.append(
            self._gltf.BufferView(
                buffer=0, byteOffset=self._length, byteLength=len(data), target=target
            )
        )
        data += bytes(-len(data) % 4)
        self._parts.append(data)
        self._length += len(data)
        return len(self._file.bufferViews) - 1

    def accessor(
        self,
        array: NDArray[Any],
        kind: str,
        component: int,
        *,
        target: int | None = None,
        view: int | None = None,
        **more: Any,
    ) -> int:
        """Add an accessor of an array, which is added too unless its view is given."""
        self._file.accessors.append(
            self._gltf.Accessor(
                bufferView=self.view(array, target) if view is None else view,
                componentType=component,
                count=len(array),
                type=kind,
                **more,
            )
        )
        return len(self._file.accessors) - 1

    def finish(self) -> None:
        """Put all arrays into the file."""
        self._file.buffers.append(self._gltf.Buffer(byteLength=self._length))
        self._file.set_binary_blob(b"".join(self._parts))


_ARRAY, _INDEX = 34962, 34963


def _mesh(
    store: _Store,
    gltf: Any,
    vertices: NDArray[np.float32],
    normals: NDArray[np.float32],
    triangles: NDArray[np.integer],
) -> tuple[Any, int]:
    """Attributes and indices of a mesh."""
    places = store.accessor(
        vertices,
        "VEC3",
        _FLOAT,
        target=_ARRAY,
        min=vertices.min(axis=0).tolist(),
        max=vertices.max(axis=0).tolist(),
    )
    attributes = gltf.Attributes(
        POSITION=places, NORMAL=store.accessor(normals, "VEC3", _FLOAT, target=_ARRAY)
    )
    flat = triangles.astype(np.uint16).reshape(-1)
    return attributes, store.accessor(flat, "SCALAR", _USHORT, target=_INDEX)


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
    gltf: Any, file: Any, store: _Store, aids: list[str]
) -> tuple[dict[str, list[int]], int]:
    """The mesh for each aid in each colour, and the accessor of the inverse bind matrices."""
    meshes: dict[str, list[int]] = {aid: [] for aid in aids}
    materials = [_material(gltf, file, colour) for colour in COLOURS]
    for aid in aids:
        figure = figure_with(aid)
        attributes, indices = _mesh(store, gltf, figure.vertices, figure.normals, figure.triangles)
        attributes.JOINTS_0 = store.accessor(figure.joints, "VEC4", _UBYTE, target=_ARRAY)
        attributes.WEIGHTS_0 = store.accessor(figure.weights, "VEC4", _FLOAT, target=_ARRAY)
        for material in materials:
            part = gltf.Primitive(attributes=attributes, indices=indices, material=material)
            file.meshes.append(gltf.Mesh(name="person", primitives=[part]))
            meshes[aid].append(len(file.meshes) - 1)
    bind = np.tile(np.eye(4, dtype=np.float32), (len(JOINTS), 1, 1))
    bind[:, 3, :3] = -rest_positions()  # matrices are stored column by column
    return meshes, store.accessor(bind, "MAT4", _FLOAT)


def _add_plan(gltf: Any, file: Any, store: _Store, plan: FloorPlan | Building, world: int) -> None:
    # Indices have 16 bits, and 65,535 is not allowed.
    for name, vertices, normals, triangles, colour, both_sides, opacity in surfaces(plan, 65_535):
        attributes, indices = _mesh(store, gltf, vertices, normals, triangles)
        material = _material(gltf, file, colour, both_sides=both_sides, opacity=opacity)
        part = gltf.Primitive(attributes=attributes, indices=indices, material=material)
        file.meshes.append(gltf.Mesh(name=name, primitives=[part]))
        node = store.node(gltf.Node(name=name, mesh=len(file.meshes) - 1))
        file.nodes[world].children.append(node)


def _add_skeleton(gltf: Any, file: Any, store: _Store, walker: Walker, world: int) -> list[int]:
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
    store: _Store,
    animation: Any,
    walker: Walker,
    joints: list[int],
    times: int,
    first: int,
) -> None:
    """Channels of one person: pelvis, joints, and when they are there."""
    n = len(walker.motion)
    begin = walker.first - first
    span = [begin / FRAME_RATE, (begin + n - 1) / FRAME_RATE]
    stamps = store.accessor(
        np.empty(n),
        "SCALAR",
        _FLOAT,
        view=times,
        byteOffset=4 * begin,
        min=[float(np.float32(span[0]))],
        max=[float(np.float32(span[1]))],
    )

    def channel(node: int, what: str, output: int, when: int = stamps, how: str = "LINEAR") -> None:
        animation.samplers.append(
            gltf.AnimationSampler(input=when, output=output, interpolation=how)
        )
        animation.channels.append(
            gltf.AnimationChannel(
                sampler=len(animation.samplers) - 1,
                target=gltf.AnimationChannelTarget(node=node, path=what),
            )
        )

    channel(
        joints[0], "translation", store.accessor(walker.pelvis.astype(np.float32), "VEC3", _FLOAT)
    )
    turns = walker.turns()
    for k, joint in enumerate(TURNING.tolist()):
        whole = np.rint(turns[:, k] * 32767).astype(np.int16)
        channel(joints[joint], "rotation", store.accessor(whole, "VEC4", _SHORT, normalized=True))
    _show(gltf, store, channel, walker, joints[0], (begin, begin + n))


def _show(
    gltf: Any,
    store: _Store,
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
    stamps = store.accessor(when, "SCALAR", _FLOAT, min=[float(when[0])], max=[float(when[-1])])
    sizes = np.array([size for _, size in keys], dtype=np.float32)
    channel(pelvis, "scale", store.accessor(sizes, "VEC3", _FLOAT), stamps, "STEP")
