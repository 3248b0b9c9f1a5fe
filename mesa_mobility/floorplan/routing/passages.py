"""Passages too narrow for two people, such as doors and corridors, and their mouths."""

from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.errors import GEOSException
from shapely.geometry.base import BaseGeometry

from mesa_mobility.floorplan.floor.checks import one_line
from mesa_mobility.floorplan.floor.floor import Floor
from mesa_mobility.floorplan.walls.narrow_gaps import narrow_gaps
from mesa_mobility.floorplan.walls.smooth_floor import smooth_floor

FOR_TWO = 1.2
"""Metres that two people need to pass each other with room: each takes 0.6 m (Fruin, Pedestrian
Planning and Design, 1971)."""

# Distance from a gap at which the floor on either side of it is sampled, and depth of a gap without
# floor of its own, as between walls without thickness (metres).
_BESIDE = 0.01

# Distance from an exit at which the floor is looked for, metres: it may lie 1 cm off the edge.
_OFF_EXIT = 0.02

_DIGITS = 6


class Passages(NamedTuple):
    """The narrow passages of a floor plan, one after the other.

    Fields: ``mouths`` (m, 6) each mouth as a line from (x, y) to (x, y) and the unit vector into
    the passage; ``first_mouth`` (p + 1,) where the mouths of each passage start; ``outline`` (k, 2)
    the corners of the passages' floors and ``first_corner`` (p + 1,) where those of each start;
    ``boxes`` (p, 4) the bounding box of each passage, x0, y0, x1, y1.
    """

    mouths: NDArray[np.float64]
    first_mouth: NDArray[np.int64]
    outline: NDArray[np.float64]
    first_corner: NDArray[np.int64]
    boxes: NDArray[np.float64]


def narrow_passages(plan: Floor, width: float = FOR_TWO) -> Passages:
    """The passages narrower than ``width`` metres that lead from floor to floor.

    Dead ends, and passages that lead to an exit, have only one mouth and are left out: nobody comes
    towards those who enter them.
    """
    floors, mouths = _floors_and_mouths(plan, width)
    both = [(floor, own) for floor, own in zip(floors, mouths, strict=True) if len(own) > 1]
    outlines = [shapely.get_coordinates(floor.exterior) for floor, _ in both]
    return Passages(
        mouths=np.array([mouth for _, own in both for mouth in own]).reshape(-1, 6),
        first_mouth=np.cumsum([0] + [len(own) for _, own in both], dtype=np.int64),
        outline=np.concatenate([np.empty((0, 2)), *outlines]),
        first_corner=np.cumsum([0] + [len(outline) for outline in outlines], dtype=np.int64),
        boxes=np.array(
            [_box(outline, own) for outline, (_, own) in zip(outlines, both, strict=True)]
        ).reshape(-1, 4),
    )


def narrow_mouths(plan: Floor, width: float) -> NDArray[np.float64]:
    """(m, 6) the mouths of all passages narrower than ``width`` metres, and exits as narrow.

    Each is a line from (x, y) to (x, y), metres, and the unit vector into the passage, or out by
    the exit.
    """
    mouths = [mouth for own in _floors_and_mouths(plan, width)[1] for mouth in own]
    for exit_ in plan.open_exits():
        line = np.array([*exit_.a, *exit_.b])
        if exit_.length >= width:
            continue
        along = (line[2:] - line[:2]) / exit_.length
        normal, middle = np.array([-along[1], along[0]]), (line[:2] + line[2:]) / 2.0
        floor = plan.contains(middle + np.outer([-_OFF_EXIT, _OFF_EXIT], normal))
        if floor[0] != floor[1]:
            mouths.append(np.append(line, normal if floor[0] else -normal))
    return np.array(mouths).reshape(-1, 6)


def _floors_and_mouths(
    plan: Floor, width: float
) -> tuple[list[shapely.Polygon | shapely.LineString], list[list[NDArray[np.float64]]]]:
    """The floors of passages narrower than ``width`` metres, and the (6,) mouths of each."""
    gaps = _gaps(plan, width)
    with one_line("narrow passages"):
        narrow = _narrow_floor(plan, gaps, width)
    along = gaps[:, 2:] - gaps[:, :2]
    normals = np.column_stack([-along[:, 1], along[:, 0]]) / np.hypot(*along.T)[:, None]
    middles = (gaps[:, :2] + gaps[:, 2:]) / 2.0
    ahead, behind = (_holders(narrow, middles + s * _BESIDE * normals) for s in (1.0, -1.0))
    mouths: list[list[NDArray[np.float64]]] = [[] for _ in narrow]
    floors = list(narrow)
    for line, normal, one, other in zip(gaps, normals, ahead, behind, strict=True):
        if one < 0 and other < 0:
            floors.append(shapely.LineString(line.reshape(2, 2)).buffer(_BESIDE))
            mouths.append([np.append(line, normal), np.append(line, -normal)])
        elif one < 0:
            mouths[other].append(np.append(line, -normal))
        elif other < 0:
            mouths[one].append(np.append(line, normal))
    return floors, mouths


def _box(outline: NDArray[np.float64], mouths: list[NDArray[np.float64]]) -> NDArray[np.float64]:
    """(4,) bounding box of a passage's floor and its mouths."""
    corners = np.concatenate([outline, np.array(mouths)[:, :4].reshape(-1, 2)])
    return np.concatenate([corners.min(axis=0), corners.max(axis=0)])


def _gaps(plan: Floor, width: float) -> NDArray[np.float64]:
    """(k, 4) the gaps up to ``width`` metres wide, each once."""
    found = narrow_gaps(plan, width + 10.0**-_DIGITS).round(_DIGITS)
    turned = (found[:, 0] > found[:, 2]) | (
        (found[:, 0] == found[:, 2]) & (found[:, 1] > found[:, 3])
    )
    found[turned] = found[turned][:, [2, 3, 0, 1]]
    # Rounding may leave nothing of a gap between walls that touch.
    found = found[(found[:, :2] != found[:, 2:]).any(axis=1)]
    return np.unique(found, axis=0)


def _narrow_floor(plan: Floor, gaps: NDArray[np.float64], width: float) -> list[shapely.Polygon]:
    """The parts of the floor between gaps in which no disc of diameter ``width`` has room."""
    if len(gaps) == 0:
        return []
    lines = shapely.linestrings(gaps.reshape(-1, 2, 2))
    floor = smooth_floor(plan).floor
    cut = _noded([floor.boundary, *lines])
    pieces = shapely.get_parts(shapely.polygonize(shapely.get_parts(cut)))
    pieces = pieces[shapely.contains(floor, shapely.point_on_surface(pieces))]
    room = shapely.buffer(pieces, -width / 2.0 - 10.0**-_DIGITS)
    narrow = shapely.union_all(pieces[shapely.is_empty(room)])
    return [part for part in shapely.get_parts(narrow) if isinstance(part, shapely.Polygon)]


def _noded(lines: list[BaseGeometry]) -> BaseGeometry:
    """Lines cut where they cross."""
    try:
        return shapely.union_all(lines)
    except GEOSException:
        # Crossings of lines at the smallest angles cannot be put in order but on a grid.
        return shapely.union_all(lines, grid_size=10.0**-_DIGITS)


def _holders(floors: list[shapely.Polygon], places: NDArray[np.float64]) -> NDArray[np.int64]:
    """(n,) index of the floor on which each of (n, 2) points lies, -1 for none."""
    found = np.full(len(places), -1, dtype=np.int64)
    which, floor = shapely.STRtree(floors).query(shapely.points(places), predicate="within")
    found[which] = floor
    return found
