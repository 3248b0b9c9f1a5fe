"""Floor plans drawn in CAD: a DXF whose layers say what is drawn on them."""

import os
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import Polygon

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.formats.content import Content, content_of
from mesa_mobility.floorplan.formats.drawing import Curve, Drawing
from mesa_mobility.floorplan.formats.plan_format import PlanFormat

KINDS = ("walkable", "obstacle", "gate", "exit")
"""What a layer can hold."""

JOINED = 0.001
"""Metres between the ends of two lines that meet."""

_LAYER = re.compile(rf"({'|'.join(KINDS)})(?:[ _-]+(.+))?", re.IGNORECASE)


class Dxf(PlanFormat):
    """CAD drawing in DXF whose layers say what is drawn on them. Needs the extra `cad`."""

    name = "dxf"
    suffixes = (".dxf",)

    def read(
        self,
        path: Path,
        *,
        layers: Mapping[str, str] | None = None,
        unit: str | None = None,
    ) -> Content:
        """See ``FloorPlan.from_dxf``."""
        return read(path, layers, unit)


def read(
    path: "str | os.PathLike[str]",
    layers: Mapping[str, str] | None = None,
    unit: str | None = None,
) -> Content:
    """Read a floor plan from a DXF; see ``FloorPlan.from_dxf``."""
    drawing = Drawing(path, unit)
    kinds = _kinds(drawing.layers, layers, str(path))
    curves = drawing.curves(kinds)
    return content_of(_features(curves, kinds, str(path)), str(path))


def _kinds(
    drawn: Sequence[str], given: Mapping[str, str] | None, where: str
) -> dict[str, tuple[str, str]]:
    """Kind and name of the parts on each layer that has some."""
    kinds = {}
    for layer in drawn:
        says = layer if given is None else given.get(layer, "")
        found = _LAYER.fullmatch(says.strip())
        if found is not None:
            kinds[layer] = (found[1].lower(), (found[2] or "").strip())
        elif given is not None and says:
            raise FloorPlanError(
                f"layer {layer}: got {says!r}, expected one of {', '.join(KINDS)}, and a name"
            )
    missing = [layer for layer in given or () if layer not in drawn]
    if missing or not any(kind == "walkable" for kind, _ in kinds.values()):
        what = f"layer {missing[0]}" if missing else "layer of kind walkable"
        names = ", ".join(drawn[:10]) or "none"
        more = f" and {len(drawn) - 10} more" if len(drawn) > 10 else ""
        raise FloorPlanError(f"{where}: has no {what}; it has drawings on {names}{more}")
    return kinds


def _features(
    curves: Sequence[Curve], kinds: Mapping[str, tuple[str, str]], where: str
) -> Iterator[tuple[dict[str, Any], str]]:
    for layer, (kind, name) in kinds.items():
        own = [curve for curve in curves if curve.layer == layer]
        if kind in ("gate", "exit"):
            for number, curve in enumerate(own, start=1):
                title = name or kind
                title = f"{title} {number}" if len(own) > 1 else title
                line = shapely.LineString(curve.points)
                yield _feature(kind, title, line), f"{where}: {curve.what}"
        elif kind == "obstacle":
            for area in _areas(own, layer, where):
                yield _feature(kind, name, area), f"{where}: layer {layer}"
    floors = [layer for layer, (kind, _) in kinds.items() if kind == "walkable"]
    areas = [
        area
        for layer in floors
        for area in _areas([curve for curve in curves if curve.layer == layer], layer, where)
    ]
    floor = areas[0] if len(areas) == 1 else shapely.union_all(areas)
    names = [kinds[layer][1] for layer in floors if kinds[layer][1]]
    yield _feature("walkable", names[0] if names else "", floor), f"{where}: layer {floors[0]}"


def _feature(kind: str, name: str, geometry: Any) -> dict[str, Any]:
    return {
        "properties": {"kind": kind, "name": name},
        "geometry": shapely.geometry.mapping(geometry),
    }


def _areas(curves: Sequence[Curve], layer: str, where: str) -> list[Polygon]:
    """The areas that curves enclose: a ring in another one is a hole, one in that an island."""
    rings = []
    for points in _rings(curves, layer, where):
        ring = Polygon(points)
        if not ring.is_valid:
            reason = shapely.is_valid_reason(ring)
            raise FloorPlanError(f"{where}: layer {layer}: an outline is not valid: {reason}")
        rings.append(ring)
    tree = shapely.STRtree(rings)
    outer, inner = tree.query(rings, predicate="contains")
    other = outer != inner
    outer, inner = outer[other], inner[other]
    depth = np.bincount(inner, minlength=len(rings))
    areas = []
    for k in np.flatnonzero(depth % 2 == 0).tolist():
        holes = [rings[h] for h in inner[outer == k].tolist() if depth[h] == depth[k] + 1]
        areas.append(rings[k] if not holes else _without(rings[k], holes))
    return areas


def _without(ring: Polygon, holes: Sequence[Polygon]) -> Any:
    """A ring with holes; where holes touch it or each other, what is left."""
    whole = Polygon(ring.exterior, [hole.exterior for hole in holes])
    return whole if whole.is_valid else ring.difference(shapely.union_all(list(holes)))


def _rings(curves: Sequence[Curve], layer: str, where: str) -> list[NDArray[np.float64]]:
    """Closed outlines, those of single lines joined where these meet."""
    rings, open_lines = [], []
    for curve in curves:
        first, last = curve.points[0], curve.points[-1]
        if len(curve.points) > 3 and np.hypot(*(first - last)) <= JOINED:
            rings.append(np.concatenate([curve.points[:-1], curve.points[:1]]))
        else:
            open_lines.append(curve.points)
    joined = shapely.line_merge(shapely.MultiLineString(_snapped(open_lines)))
    for line in shapely.get_parts(joined):
        points = shapely.get_coordinates(line)
        if len(points) < 4 or (points[0] != points[-1]).any():
            x, y = points[-1]
            raise FloorPlanError(
                f"{where}: layer {layer}: an outline is open at ({x:.3f}, {y:.3f}) m, expected "
                "closed ones"
            )
        rings.append(points)
    return rings


def _snapped(lines: list[NDArray[np.float64]]) -> list[NDArray[np.float64]]:
    """Lines whose ends are the same where they nearly are."""
    if not lines:
        return []
    ends = np.array([end for line in lines for end in (line[0], line[-1])])
    tree = shapely.STRtree(shapely.points(ends))
    near = tree.query(shapely.points(ends), predicate="dwithin", distance=JOINED)
    first = np.full(len(ends), len(ends))
    np.minimum.at(first, near[0], near[1])
    moved = ends[first].reshape(-1, 2, 2)
    return [
        np.concatenate([m[:1], line[1:-1], m[1:]]) for m, line in zip(moved, lines, strict=True)
    ]
