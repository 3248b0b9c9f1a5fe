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
from mesa_mobility.floorplan.floor.openings import Gate
from mesa_mobility.floorplan.formats.assembling.drawn import Drawn, assembled
from mesa_mobility.floorplan.formats.assembling.exit_areas import WayOut
from mesa_mobility.floorplan.formats.assembling.parts import Area, polygons_of
from mesa_mobility.floorplan.formats.content import Content, content_of
from mesa_mobility.floorplan.formats.drawing import Curve, Drawing
from mesa_mobility.floorplan.formats.layers import guessed
from mesa_mobility.floorplan.formats.plan_format import PlanFormat

KINDS = ("walkable", "obstacle", "wall", "gate", "exit")
"""Contents of a layer."""

JOINED = 0.001
"""Metres between the ends of two lines that meet."""

SMALLEST = 1e-4
"""Square metres; smaller outlines are dots of a drawing's author."""

THIN = 0.05
"""Metres from a line of a wall to its surface."""

WIDEST_DOOR = 1.5
"""Metres; wider gaps between walls are no doors of the outer wall."""

LEAST_FLOOR = 0.5
"""Metres; a floor that is smaller is drawn in metres, whatever the drawing says."""

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
    where = str(path)
    own = any(
        (found := _LAYER.fullmatch(each)) and found[1].lower() == "walkable"
        for each in drawing.layers
    )
    guesses = guessed(drawing.layers) if layers is None and not own else {}
    if any(kind in ("walkable", "wall") for kind, _ in guesses.values()):
        return read_drawn(drawing, guesses, unit is None, where)
    kinds = _kinds(drawing.layers, layers, where)
    if layers is not None:
        return read_drawn(drawing, kinds, False, where)
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


def read_drawn(
    drawing: Drawing, kinds: Mapping[str, tuple[str, str]], any_unit: bool, where: str
) -> Content:
    """The floor plan of a drawing whose layers are named otherwise, or were named by the user.

    Args:
        drawing: the file.
        kinds: kind and name of what is on each layer.
        any_unit: whether the drawing's unit may be wrong.
        where: name of the file in messages.

    Raises:
        FloorPlanError: there is no floor, or something cannot be read.
    """
    notes = [f"layer {layer} holds {kind}" for layer, (kind, _) in kinds.items()]
    others = [layer for layer in drawing.layers if layer not in kinds]
    if others:
        notes.append(f"left out the layers {', '.join(others[:10])}; --layer LAYER=KIND says more")
    curves = drawing.curves(kinds, lenient=True)
    if any_unit and drawing.unit != "m" and curves:
        size = np.ptp(np.concatenate([each.points for each in curves]), axis=0).max()
        if size < LEAST_FLOOR:
            notes.append(f"{size:.3g} m wide in {drawing.unit}: taken as metres; --unit says more")
            drawing.unit = "m"
            curves = drawing.curves(kinds, lenient=True)
    drawn = Drawn(notes=notes)
    walls: list[Any] = []
    for layer, (kind, name) in kinds.items():
        own = [curve for curve in curves if curve.layer == layer]
        if kind in ("walkable", "obstacle"):
            areas = _areas(own, layer, where, notes)
            if kind == "walkable":
                drawn.areas += [
                    each for area in areas for each in polygons_of(area, f"layer {layer}", notes)
                ]
                drawn.name = drawn.name or name
            else:
                drawn.obstacles += areas
        elif kind == "wall":
            walls += _walls(own)
        else:
            for number, curve in enumerate(own, start=1):
                title = name or kind
                title = f"{title} {number}" if len(own) > 1 else title
                shape = _shape(curve)
                if kind == "exit" and shape.length > 0:
                    drawn.ways_out.append(WayOut(title, shape))
                elif kind == "gate" and curve.points[0].tolist() != curve.points[-1].tolist():
                    a, b = curve.points[0].tolist(), curve.points[-1].tolist()
                    drawn.gates.append(Gate(title, (a[0], a[1]), (b[0], b[1])))
    if walls:
        solid = shapely.union_all(walls)
        drawn.obstacles += [
            each.polygon for each in polygons_of(solid, "walls", notes) if each.polygon.area > 0
        ]
        if not drawn.areas:
            half = WIDEST_DOOR / 2
            closed = solid.buffer(half, join_style="mitre")
            hulls = [Polygon(part.exterior) for part in shapely.get_parts(closed)]
            inner = shapely.union_all(hulls).buffer(-half - THIN / 2, join_style="mitre")
            drawn.areas = [Area(each.polygon, "floor") for each in polygons_of(inner, "", notes)]
            notes.append("no layer holds the floor: it is what the outermost walls enclose")
    return assembled(drawn, where)


def _shape(curve: Curve) -> Any:
    """An area where a curve is closed, else a line."""
    if len(curve.points) > 3 and np.hypot(*(curve.points[0] - curve.points[-1])) <= JOINED:
        area = Polygon(curve.points)
        return area if area.is_valid else shapely.make_valid(area)
    return shapely.LineString(curve.points)


def _walls(curves: Sequence[Curve]) -> list[Any]:
    """Areas that closed curves enclose, and strips along lines. A closed curve that encloses others
    is a line."""
    shapes = [_shape(curve) for curve in curves]
    tree = shapely.STRtree(shapes)
    found = []
    for k, shape in enumerate(shapes):
        inside = [j for j in tree.query(shape, predicate="contains").tolist() if j != k]
        if shape.area > 0 and not inside:
            found.append(shape)
        else:
            line = shape.boundary if shape.area > 0 else shape
            found.append(line.buffer(THIN, cap_style="square", join_style="mitre"))
    return found


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


def _areas(
    curves: Sequence[Curve], layer: str, where: str, notes: list[str] | None = None
) -> list[Polygon]:
    """The areas that curves enclose: a ring in another one is a hole, one in that an island.

    Without ``notes``, open and invalid outlines are refused. With them, they are left out or
    mended, and named there.
    """
    rings = []
    for points in _rings(curves, layer, where, notes):
        ring = Polygon(points)
        if notes is not None:
            parts = polygons_of(ring, f"layer {layer}: an outline", notes)
            rings += [each.polygon for each in parts if each.polygon.area > SMALLEST]
            continue
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


def _rings(
    curves: Sequence[Curve], layer: str, where: str, notes: list[str] | None
) -> list[NDArray[np.float64]]:
    """Closed outlines, those of single lines joined where these meet."""
    stray = 0
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
            if notes is not None:
                stray += 1
                if stray == 1:
                    notes.append(
                        f"layer {layer}: left out a stray line that ends at ({x:.3f}, {y:.3f}) m"
                    )
                continue
            raise FloorPlanError(
                f"{where}: layer {layer}: an outline is open at ({x:.3f}, {y:.3f}) m, expected "
                "closed ones"
            )
        rings.append(points)
    if notes is not None and stray > 1:
        notes.append(f"layer {layer}: left out {stray - 1} further stray lines")
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
