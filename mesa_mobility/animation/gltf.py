"""A run as glTF 2.0: people as skinned, animated figures between the walls of the plan.

People share one mesh, those with a stick or a wheelchair another; their clothes are its materials.
Each has a skeleton of its own, whose joints are animated with quaternions of 16 bits. Frames are
left out where what viewers mix between the others is near enough (see ``keyed.py``).
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
from mesa_mobility.animation.keyed import WITHIN, Keyed, Keys, keyed, within_of
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

_FLOAT, _SHORT, _BYTE, _USHORT, _UBYTE = 5126, 5122, 5120, 5123, 5121

_COARSE = 0.015
"""Metres from which on 8 bits a number are near enough: they turn by up to 0.9 degrees."""

_NEAR_ONE = 0.0075
"""By how much the length of a rounded quaternion may differ from 1."""

_ARRAY, _INDEX = 34962, 34963


class Glb(OutputFormat):
    """Figures in glTF, for Blender and the web. Needs the extra `animation`."""

    name = "glb"
    suffixes = (".glb",)
    storeys = True

    def write(self, excerpt: Excerpt, path: Path, *, within: float | None = None) -> None:
        """See ``write_glb``.

        Args:
            excerpt: what to write.
            path: the file.
            within: metres by which limbs may be off; by default 5 mm of up to 100 people, and more
                in a larger crowd: 25 mm of 750.
        """
        people = walkers(excerpt.trajectories, excerpt.selection, excerpt.bank, excerpt.building)
        within = within_of(len(excerpt.people)) if within is None else within
        write_glb(people, excerpt.plan, path, within=within, progress=excerpt.person_done)


def write_glb(
    people: Iterable[Walker],
    plan: FloorPlan | Building,
    path: str | os.PathLike[str],
    *,
    within: float = WITHIN,
    progress: Callable[[int], None] | None = None,
) -> None:
    """Write a binary glTF file: metres, y up, one animation.

    Args:
        people: those shown; the animation begins with the first of their frames.
        plan: floor and walls, or a building.
        path: the file.
        within: metres by which a pelvis may be off between the frames that are kept, and by which
            each joint alone may move the far end of what it carries; joints of a limb add up. From
            15 mm on turns have 8 bits, otherwise 16.
        progress: called with the number of people done.

    Raises:
        ResultsError: the file cannot be written, ``within`` is not positive, or pygltflib is not
            installed.
    """
    if not 0.0 < within < np.inf:
        raise ResultsError(f"glTF: within {within} m, expected more than 0")
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
    # Whole motions of hundreds of people would take gigabytes.
    shown = []
    for done, walker in enumerate(people, start=1):
        shown.append(keyed(walker, within))
        if progress is not None:
            progress(done)
    aids = sorted({aid_of(each.type_name) for each in shown})
    meshes, bind = _add_figures(gltf, file, store, aids)
    first = min(each.first for each in shown)
    animation = gltf.Animation(name="walk", samplers=[], channels=[])
    coded = _in_bytes if within >= _COARSE else _in_shorts
    for each in shown:
        joints = _add_skeleton(gltf, file, store, each, world)
        file.skins.append(gltf.Skin(inverseBindMatrices=bind, joints=joints, skeleton=joints[0]))
        figure = gltf.Node(
            name=f"person {each.person}",
            mesh=meshes[aid_of(each.type_name)][each.person % LOOKS],
            skin=len(file.skins) - 1,
        )
        top.append(store.node(figure))
        _animate(gltf, file, store, animation, each, joints, first, coded)
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


def _add_skeleton(gltf: Any, file: Any, store: Store, person: Keyed, world: int) -> list[int]:
    """Nodes of a person's joints, the pelvis below the world; their numbers."""
    start = len(file.nodes)
    joints = [start + j for j in range(len(JOINTS))]
    for j, name in enumerate(JOINTS):
        children = [start + int(child) for child in np.flatnonzero(j == PARENTS)]
        place = person.pelvis.values[0] if j == 0 else OFFSETS[j]
        store.node(
            gltf.Node(
                name=f"{person.person}.{name}",
                translation=[float(value) for value in place],
                scale=[person.scale] * 3 if j == 0 else None,
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
    person: Keyed,
    joints: list[int],
    first: int,
    coded: Callable[[NDArray[np.float64]], tuple[NDArray[Any], int]],
) -> None:
    """Channels of one person: pelvis, joints, and when they are there."""
    begin = person.first - first

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

    def stamps(keys: Keys) -> int:
        when = ((begin + keys.frames) / FRAME_RATE).astype(np.float32)
        ends = {"min": [float(when[0])], "max": [float(when[-1])]}
        return store.keys(when, "SCALAR", _FLOAT, **ends)

    if len(person.pelvis.frames) > 1:
        places = store.keys(person.pelvis.values.astype(np.float32), "VEC3", _FLOAT)
        channel(joints[0], "translation", places, stamps(person.pelvis))
    for keys, joint in zip(person.turns, TURNING.tolist(), strict=True):
        if len(keys.frames) == 1:
            turn = keys.values[0] / np.linalg.norm(keys.values[0])
            file.nodes[joints[joint]].rotation = turn.tolist()
            continue
        whole, component = coded(keys.values)
        output = store.keys(whole, "VEC4", component, normalized=True)
        channel(joints[joint], "rotation", output, stamps(keys))
    _show(store, channel, person, joints[0], begin)


def _in_shorts(turns: NDArray[np.float64]) -> tuple[NDArray[np.int16], int]:
    return np.rint(turns * 32767).astype(np.int16), _SHORT


def _in_bytes(turns: NDArray[np.float64]) -> tuple[NDArray[np.int8], int]:
    """Of a few roundings, for each turn the one of about length 1 that is turned the least."""
    sizes = np.array([1.0, 0.993, 0.996, 1.004, 1.007])[:, None, None]
    whole = np.clip(np.rint(turns * 127 * sizes), -127, 127)
    length = np.linalg.norm(whole, axis=2)
    along = np.abs(np.einsum("snk,nk->sn", whole, turns)) / length
    best = np.argmax(along - (np.abs(length / 127 - 1.0) > _NEAR_ONE), axis=0)
    return whole[best, np.arange(len(turns))].astype(np.int8), _BYTE


def _show(
    store: Store, channel: Callable[..., None], person: Keyed, pelvis: int, begin: int
) -> None:
    """A person has their size while they are there, and size 0 before and after."""
    full = [person.scale] * 3
    keys = [(0, [0.0] * 3)] if begin > 0 else []
    keys += [(begin, full), (begin + person.count, [0.0] * 3)]
    when = np.array([frame / FRAME_RATE for frame, _ in keys], dtype=np.float32)
    stamps = store.keys(when, "SCALAR", _FLOAT, min=[float(when[0])], max=[float(when[-1])])
    sizes = np.array([size for _, size in keys], dtype=np.float32)
    channel(pelvis, "scale", store.keys(sizes, "VEC3", _FLOAT), stamps, "STEP")
