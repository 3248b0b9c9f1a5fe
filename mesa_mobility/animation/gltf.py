"""A run as glTF 2.0: people as skinned, animated figures between the walls of the plan.

All people share one mesh. Each has a skeleton of its own, whose joints are animated at 30 frames a
second with quaternions of 16 bits.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from mesa_mobility.animation.figure import human_figure, rest_positions
from mesa_mobility.animation.people import Walker
from mesa_mobility.bodies.motion import FRAME_RATE
from mesa_mobility.bodies.skeleton import JOINTS, OFFSETS, PARENTS, TURNING
from mesa_mobility.errors import ResultsError
from mesa_mobility.files.atomic import replacing

if TYPE_CHECKING:
    from mesa_mobility.floorplan import FloorPlan

COLOURS = ("#3f6ea8", "#b65a43", "#5b8f5a", "#8c6bb1", "#c59a3d", "#4f9d9d", "#7d7d7d", "#a8577e")
"""Of the people, in turn."""

FLOOR, WALL = "#e6e6e2", "#8b8b88"

WALL_HEIGHT = 1.2
"""Metres: low enough to look over."""

MARGIN = 0.5
"""Metres by which the floor reaches beyond the walls."""

_UP = Rotation.from_euler("x", -90, degrees=True).as_quat().tolist()
"""From z up to glTF's y up."""

_FLOAT, _SHORT, _USHORT, _UBYTE = 5126, 5122, 5123, 5121


def write_glb(
    people: Iterable[Walker],
    plan: FloorPlan,
    path: str | os.PathLike[str],
    *,
    progress: Callable[[int], None] | None = None,
) -> None:
    """Write a binary glTF file: metres, y up, one animation.

    Args:
        people: those shown; the animation begins with the first of their frames.
        plan: floor and walls.
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
    meshes, bind = _add_figure(gltf, file, store)
    shown = list(people)
    first = min(walker.first for walker in shown)
    last = max(walker.first + len(walker.motion) for walker in shown)
    times = store.view(np.arange(last - first + 1, dtype=np.float32) / FRAME_RATE)
    animation = gltf.Animation(name="walk", samplers=[], channels=[])
    for done, walker in enumerate(shown, start=1):
        joints = _add_skeleton(gltf, file, store, walker, world)
        file.skins.append(gltf.Skin(inverseBindMatrices=bind, joints=joints, skeleton=joints[0]))
        figure = gltf.Node(
            name=f"person {walker.person}",
            mesh=meshes[walker.person % len(meshes)],
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
        vertices, "VEC3", _FLOAT, target=_ARRAY,
        min=vertices.min(axis=0).tolist(), max=vertices.max(axis=0).tolist(),
    )  # fmt: skip
    attributes = gltf.Attributes(
        POSITION=places, NORMAL=store.accessor(normals, "VEC3", _FLOAT, target=_ARRAY)
    )
    flat = triangles.astype(np.uint16).reshape(-1)
    return attributes, store.accessor(flat, "SCALAR", _USHORT, target=_INDEX)


def _material(gltf: Any, file: Any, colour: str, *, both_sides: bool = False) -> int:
    channels = [int(colour[k : k + 2], 16) / 255.0 for k in (1, 3, 5)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]
    file.materials.append(
        gltf.Material(
            pbrMetallicRoughness=gltf.PbrMetallicRoughness(
                baseColorFactor=[*(round(c, 5) for c in linear), 1.0],
                metallicFactor=0.0,
                roughnessFactor=0.9,
            ),
            doubleSided=both_sides,
        )
    )
    return len(file.materials) - 1


def _add_figure(gltf: Any, file: Any, store: _Store) -> tuple[list[int], int]:
    """The shared mesh in each colour, and the accessor of the inverse bind matrices."""
    figure = human_figure()
    attributes, indices = _mesh(store, gltf, figure.vertices, figure.normals, figure.triangles)
    attributes.JOINTS_0 = store.accessor(figure.joints, "VEC4", _UBYTE, target=_ARRAY)
    attributes.WEIGHTS_0 = store.accessor(figure.weights, "VEC4", _FLOAT, target=_ARRAY)
    meshes = []
    for colour in COLOURS:
        part = gltf.Primitive(
            attributes=attributes, indices=indices, material=_material(gltf, file, colour)
        )
        file.meshes.append(gltf.Mesh(name="person", primitives=[part]))
        meshes.append(len(file.meshes) - 1)
    bind = np.tile(np.eye(4, dtype=np.float32), (len(JOINTS), 1, 1))
    bind[:, 3, :3] = -rest_positions()  # matrices are stored column by column
    return meshes, store.accessor(bind, "MAT4", _FLOAT)


def _add_plan(gltf: Any, file: Any, store: _Store, plan: FloorPlan, world: int) -> None:
    x0, y0, x1, y1 = plan.bounds
    x0, y0, x1, y1 = x0 - MARGIN, y0 - MARGIN, x1 + MARGIN, y1 + MARGIN
    floor = np.array([[x0, y0, 0], [x1, y0, 0], [x1, y1, 0], [x0, y1, 0]], dtype=np.float32)
    up = np.tile(np.array([0, 0, 1], dtype=np.float32), (4, 1))
    surfaces = [("floor", floor, up, np.array([[0, 1, 2], [0, 2, 3]]), FLOOR)]
    walls = np.asarray(plan.walls, dtype=np.float64)
    # Indices have 16 bits: 65,535 is not allowed.
    for start in range(0, len(walls), 16_000):
        surfaces.append(("walls", *_upright(walls[start : start + 16_000]), WALL))
    for name, vertices, normals, triangles, colour in surfaces:
        attributes, indices = _mesh(store, gltf, vertices, normals, triangles)
        material = _material(gltf, file, colour, both_sides=name == "walls")
        part = gltf.Primitive(attributes=attributes, indices=indices, material=material)
        file.meshes.append(gltf.Mesh(name=name, primitives=[part]))
        node = store.node(gltf.Node(name=name, mesh=len(file.meshes) - 1))
        file.nodes[world].children.append(node)


def _upright(
    walls: NDArray[np.float64],
) -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.int64]]:
    """Vertices, normals and triangles of (m, 4) walls as upright rectangles."""
    corners = np.zeros((len(walls), 4, 3))
    corners[:, [0, 3], :2] = walls[:, None, :2]
    corners[:, [1, 2], :2] = walls[:, None, 2:]
    corners[:, 2:, 2] = WALL_HEIGHT
    along = walls[:, 2:] - walls[:, :2]
    length = np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-9)
    normal = np.column_stack([-along[:, 1], along[:, 0], np.zeros(len(walls))]) / length
    square = np.array([[0, 1, 2], [0, 2, 3]])
    triangles = (4 * np.arange(len(walls))[:, None, None] + square).reshape(-1, 3)
    return (
        corners.reshape(-1, 3).astype(np.float32),
        np.repeat(normal, 4, axis=0).astype(np.float32),
        triangles,
    )


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
    """Channels of one person: pelvis, joints, and when it is there."""
    n = len(walker.motion)
    begin = walker.first - first
    span = [begin / FRAME_RATE, (begin + n - 1) / FRAME_RATE]
    stamps = store.accessor(
        np.empty(n), "SCALAR", _FLOAT, view=times, byteOffset=4 * begin,
        min=[float(np.float32(span[0]))], max=[float(np.float32(span[1]))],
    )  # fmt: skip

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
    turns = walker.motion.local()
    for k, joint in enumerate(TURNING.tolist()):
        found = Rotation.from_matrix(turns[:, k]).as_quat()
        # The nearer of q and -q: viewers turn the shorter way.
        sign = np.cumprod(np.where(np.einsum("ij,ij->i", found[1:], found[:-1]) < 0.0, -1.0, 1.0))
        found[1:] *= sign[:, None]
        whole = np.rint(found * 32767).astype(np.int16)
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
    """A person has its size while it is there, and none before and after."""
    full = [walker.motion.scale] * 3
    keys = [(0, [0.0] * 3)] if there[0] > 0 else []
    keys += [(there[0], full), (there[1], [0.0] * 3)]
    when = np.array([frame / FRAME_RATE for frame, _ in keys], dtype=np.float32)
    stamps = store.accessor(when, "SCALAR", _FLOAT, min=[float(when[0])], max=[float(when[-1])])
    sizes = np.array([size for _, size in keys], dtype=np.float32)
    channel(pelvis, "scale", store.accessor(sizes, "VEC3", _FLOAT), stamps, "STEP")
