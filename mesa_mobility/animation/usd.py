"""A run as OpenUSD: people as skinned, animated figures (UsdSkel) between the walls of the plan.

People share one mesh and one skeleton by reference, those with a stick or a wheelchair another;
each has an animation of its own.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.animation.figures.aids import aid_of, figure_with
from mesa_mobility.animation.figures.clothes import LOOKS, PARTS, look_of
from mesa_mobility.animation.figures.figure import rest_positions
from mesa_mobility.animation.meshes import FLOOR, WALL
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

_AROUND_JOINTS = 0.35
"""Metres by which a body reaches beyond its joints at most."""


class OpenUsd(OutputFormat):
    """Figures in OpenUSD (UsdSkel); `.usda` is text. Needs the extra `usd`."""

    name = "usd"
    suffixes = (".usd", ".usda", ".usdc")
    storeys = True

    def write(self, excerpt: Excerpt, path: Path) -> None:
        """See ``write_usd``."""
        people = walkers(excerpt.trajectories, excerpt.selection, excerpt.bank, excerpt.building)
        write_usd(people, excerpt.plan, path, progress=excerpt.person_done)


def write_usd(
    people: Iterable[Walker],
    plan: FloorPlan | Building,
    path: str | os.PathLike[str],
    *,
    progress: Callable[[int], None] | None = None,
) -> None:
    """Write an OpenUSD file: metres, z up, 30 time codes a second, which count the run's frames.

    Person 5 is ``/world/person_5``, visible while they are there.

    Args:
        people: those shown.
        plan: floor and walls, or a building.
        path: the file; its suffix is one of ``OpenUsd.suffixes``.
        progress: called with the number of people done.

    Raises:
        ResultsError: another suffix, the file cannot be written, or usd-core is not installed.
    """
    if Path(path).suffix not in OpenUsd.suffixes:
        raise ResultsError(f"{path}: expected a name that ends with {', '.join(OpenUsd.suffixes)}")
    try:
        from pxr import Tf, Usd, UsdGeom
    except ImportError as error:
        raise ResultsError(
            "OpenUSD files need usd-core: pip install 'mesa-mobility[usd]'"
        ) from error
    stage = Usd.Stage.CreateInMemory(f"run{Path(path).suffix}")
    UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.z)
    stage.SetTimeCodesPerSecond(FRAME_RATE)
    stage.SetFramesPerSecond(FRAME_RATE)
    stage.SetDefaultPrim(UsdGeom.Xform.Define(stage, "/world").GetPrim())
    stage.DefinePrim("/world/materials", "Scope")
    materials = {colour: _material(stage, colour) for colour in (FLOOR, WALL)}
    materials |= {
        colour: _material(stage, colour)
        for number in range(LOOKS)
        for colour in look_of(number).values()
    }
    _add_plan(stage, plan, materials)
    figures: dict[str, str] = {}
    first, last = np.inf, -np.inf
    for done, walker in enumerate(people, start=1):
        aid = aid_of(walker.type_name)
        if aid not in figures:
            figures[aid] = _add_figure(stage, aid)
        _add_person(stage, walker, figures[aid], materials)
        first = min(first, walker.first)
        last = max(last, walker.first + len(walker.motion) - 1)
        if progress is not None:
            progress(done)
    stage.SetStartTimeCode(first)
    stage.SetEndTimeCode(last)
    with replacing(path, ResultsError) as temporary:
        temporary.touch()  # USD would make folders that are not there
        try:
            stage.GetRootLayer().Export(str(temporary))
        except Tf.ErrorException as error:
            raise OSError(f"{error}") from error


def _material(stage: Any, look: str, opacity: float = 1.0) -> Any:
    """A matt material; its look begins with its colour as hexadecimal digits."""
    from pxr import Sdf, UsdShade

    material = UsdShade.Material.Define(stage, f"/world/materials/colour_{look[1:]}")
    shader = UsdShade.Shader.Define(stage, material.GetPath().AppendChild("surface"))
    shader.CreateIdAttr("UsdPreviewSurface")
    shader.CreateInput("diffuseColor", Sdf.ValueTypeNames.Color3f).Set(tuple(linear(look)))
    shader.CreateInput("roughness", Sdf.ValueTypeNames.Float).Set(0.9)
    if opacity < 1.0:
        shader.CreateInput("opacity", Sdf.ValueTypeNames.Float).Set(opacity)
    material.CreateSurfaceOutput().ConnectToSource(shader.ConnectableAPI(), "surface")
    return material


def _mesh(
    stage: Any,
    path: str,
    vertices: NDArray[np.float32],
    normals: NDArray[np.float32],
    triangles: NDArray[np.integer],
) -> Any:
    from pxr import UsdGeom, Vt

    mesh = UsdGeom.Mesh.Define(stage, path)
    mesh.CreatePointsAttr(_vectors(vertices))
    mesh.CreateNormalsAttr(_vectors(normals))
    mesh.SetNormalsInterpolation(UsdGeom.Tokens.vertex)
    mesh.CreateFaceVertexCountsAttr(Vt.IntArray(len(triangles), 3))
    mesh.CreateFaceVertexIndicesAttr(
        Vt.IntArray.FromNumpy(np.ascontiguousarray(triangles, dtype=np.int32).reshape(-1))
    )
    mesh.CreateSubdivisionSchemeAttr(UsdGeom.Tokens.none)
    mesh.CreateExtentAttr(_vectors(np.stack([vertices.min(axis=0), vertices.max(axis=0)])))
    return mesh


def _add_plan(stage: Any, plan: FloorPlan | Building, materials: dict[str, Any]) -> None:
    for name, vertices, normals, triangles, colour, both_sides, opacity in surfaces(plan):
        mesh = _mesh(stage, f"/world/{name}", vertices, normals, triangles)
        mesh.CreateDoubleSidedAttr(both_sides)
        look = f"{colour}_through" if opacity < 1.0 else colour
        if look not in materials:
            materials[look] = _material(stage, look, opacity)
        _bind(mesh, materials[look])


def _bind(mesh: Any, material: Any) -> None:
    from pxr import UsdShade

    UsdShade.MaterialBindingAPI.Apply(mesh.GetPrim()).Bind(material)


def _names() -> list[str]:
    """Path of each joint below the pelvis, as skeletons name them."""
    names: list[str] = []
    for name, parent in zip(JOINTS, PARENTS.tolist(), strict=True):
        names.append(name if parent < 0 else f"{names[parent]}/{name}")
    return names


def _add_figure(stage: Any, aid: str) -> str:
    """The mesh bound to its skeleton, as a class that people refer to; its path."""
    from pxr import Sdf, UsdGeom, UsdShade, UsdSkel, Vt

    path = f"/figure_with_{aid}" if aid else "/figure"
    stage.CreateClassPrim(path)
    figure, names = figure_with(aid), _names()
    skeleton = UsdSkel.Skeleton.Define(stage, f"{path}/skeleton")
    skeleton.CreateJointsAttr(names)
    skeleton.CreateBindTransformsAttr(_translations(rest_positions()))
    skeleton.CreateRestTransformsAttr(_translations(OFFSETS))
    skeleton.CreatePurposeAttr(UsdGeom.Tokens.guide)
    mesh = _mesh(stage, f"{path}/body", figure.vertices, figure.normals, figure.triangles)
    binding = UsdSkel.BindingAPI.Apply(mesh.GetPrim())
    flat = np.ascontiguousarray(figure.joints, dtype=np.int32).reshape(-1)
    binding.CreateJointIndicesPrimvar(False, 4).Set(Vt.IntArray.FromNumpy(flat))
    weights = np.ascontiguousarray(figure.weights, dtype=np.float32).reshape(-1)
    binding.CreateJointWeightsPrimvar(False, 4).Set(Vt.FloatArray.FromNumpy(weights))
    binding.CreateGeomBindTransformAttr(_translations(np.zeros((1, 3)))[0])
    binding.CreateSkeletonRel().SetTargets([Sdf.Path(f"{path}/skeleton")])
    of = figure.parts[figure.triangles[:, 0]]
    for part in np.unique(of).tolist():
        faces = Vt.IntArray.FromNumpy(np.flatnonzero(of == part).astype(np.int32))
        UsdShade.MaterialBindingAPI(mesh).CreateMaterialBindSubset(PARTS[part], faces)
    return path


def _add_person(stage: Any, walker: Walker, figure: str, materials: Mapping[str, Any]) -> None:
    from pxr import Gf, Sdf, Usd, UsdGeom, UsdSkel, Vt

    place = f"/world/person_{walker.person}"
    root = UsdSkel.Root.Define(stage, place)
    root.GetPrim().GetReferences().AddInternalReference(figure)
    scale = walker.motion.scale
    if scale != 1.0:
        root.AddScaleOp().Set(Gf.Vec3f(scale))
    joints = walker.motion.positions / scale
    space = np.stack([joints.min(axis=(0, 1)) - _AROUND_JOINTS, joints.max(axis=(0, 1))])
    space[1] += _AROUND_JOINTS
    root.CreateExtentAttr(_vectors(space))
    for part, colour in look_of(walker.person).items():
        own = UsdGeom.Subset.Get(stage, f"{place}/body/{part}")
        if own:
            _bind(own, materials[colour])
    walk = UsdSkel.Animation.Define(stage, f"{place}/walk")
    skeleton = UsdSkel.BindingAPI.Apply(stage.GetPrimAtPath(f"{place}/skeleton"))
    skeleton.CreateAnimationSourceRel().SetTargets([walk.GetPath()])
    names = _names()
    walk.CreateJointsAttr([names[joint] for joint in TURNING])
    walk.CreateScalesAttr(Vt.Vec3hArray(len(TURNING), Gf.Vec3h(1.0)))
    turns = walker.turns().astype(np.float32)
    moved = np.tile(OFFSETS[TURNING].astype(np.float32), (len(turns), 1, 1))
    moved[:, 0] = joints[:, 0]
    rotations = walk.CreateRotationsAttr().GetPath()
    translations = walk.CreateTranslationsAttr().GetPath()
    visible = root.CreateVisibilityAttr()
    visible.Set(UsdGeom.Tokens.invisible, Usd.TimeCode(walker.first - 1))
    visible.Set(UsdGeom.Tokens.inherited, Usd.TimeCode(walker.first))
    visible.Set(UsdGeom.Tokens.invisible, Usd.TimeCode(walker.first + len(turns)))
    layer = stage.GetRootLayer()
    with Sdf.ChangeBlock():
        for frame, (turned, where) in enumerate(zip(turns, moved, strict=True), walker.first):
            layer.SetTimeSample(rotations, frame, Vt.QuatfArray.FromNumpy(turned))
            layer.SetTimeSample(translations, frame, Vt.Vec3fArray.FromNumpy(where))


def _vectors(values: NDArray[np.floating]) -> Any:
    from pxr import Vt

    return Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(values, dtype=np.float32))


def _translations(places: NDArray[np.float64]) -> Any:
    """Matrices that move to these (n, 3) places; their last row is the translation."""
    from pxr import Vt

    matrices = np.tile(np.eye(4), (len(places), 1, 1))
    matrices[:, 3, :3] = places
    return Vt.Matrix4dArray.FromNumpy(matrices)
