"""The nodes of routes: corners, gates and exits."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from mesa_mobility.floorplan.floor.boundaries import rings, turns
from mesa_mobility.floorplan.floor.checks import EDGE_TOLERANCE
from mesa_mobility.floorplan.floor.floor import Floor
from mesa_mobility.floorplan.floor.openings import Exit, Opening
from mesa_mobility.floorplan.walls.narrow_gaps import walls_near
from mesa_mobility.floorplan.walls.sight import Sight
from mesa_mobility.floorplan.walls.smooth_floor import smooth_floor
from mesa_mobility.floorplan.walls.wall_distances import wall_distances

CORNER, GATE, EXIT = 0, 1, 2
"""Kinds of nodes."""

# Nodes stand the clearance from walls, in narrow passages at least this share of it. Views
# between nodes need a little less, and views of nodes by people less again: so a person near
# a node has in view what the node has, and need not hit it to see how the route goes on. With
# much less (0.65), straight ways cut corners by more than wide bodies can: people in wheelchairs
# got stuck at jambs.
NODE_SHARE = 0.85
EDGE_SHARE = 0.8
VIEW_SHARE = 0.78

# Shares of the clearance to try, widest first.
_SHARES = (1.0, 0.92, NODE_SHARE)

# Curved walls are thinned to corners with this share of the clearance between wall and chord.
_SIMPLIFY = 0.1

# Beyond a right angle and a bit, one corner far ahead of a sharp tip is replaced by two beside it.
_SHARP = np.deg2rad(100.0)

# Widest gap, in clearances, in which a corner beside one wall can be too near to the other.
_NARROW = 2.5

# Spacing of nodes along a gate or exit (metres), and their greatest number.
_POINT_SPACING = 0.5
_POINTS_PER_OPENING = 41


@dataclass(frozen=True)
class Nodes:
    """The nodes of a route graph.

    Attributes:
        kind: (n,) CORNER, GATE or EXIT.
        xy: (n, 2) metres.
        opening: (n,) number of the gate or exit in `FloorPlan.openings()`, -1 for corners.
        only: (n,) number of the exit that a route bends here for and for nothing else, at the end
            of a wall beside it; -1 for nodes that any route may pass.
        normal: (n, 2) unit direction in which the gate or exit is crossed, 0 for corners. Every
            point of a gate is two nodes, one for either direction.
    """

    kind: NDArray[np.int64]
    xy: NDArray[np.float64]
    opening: NDArray[np.int64]
    only: NDArray[np.int64]
    normal: NDArray[np.float64]


def find_nodes(plan: Floor, sight: Sight, clearance: float) -> Nodes:
    """The nodes of a plan for bodies that keep `clearance` metres from walls."""
    corners, only = _corners(plan, sight, clearance)
    keys = np.column_stack([corners.round(3), only])
    first = np.unique(keys, axis=0, return_index=True)[1]
    corners, only = corners[first], only[first]
    kinds = [np.zeros(len(corners), np.int64)]
    points, normals = [corners], [np.zeros((len(corners), 2))]
    numbers = [np.full(len(corners), -1, dtype=np.int64)]
    # An exit may lie a little outside the edge of the area.
    room = plan.free.buffer(2 * EDGE_TOLERANCE)
    shapely.prepare(room)
    for number, opening in enumerate(plan.openings()):
        if not plan.is_open(opening.name):
            continue
        places = _places(plan, room, opening, clearance)
        directions = [outward(plan, opening)] if isinstance(opening, Exit) else _both_ways(opening)
        for direction in directions:
            kinds.append(
                np.full(len(places), EXIT if isinstance(opening, Exit) else GATE, dtype=np.int64)
            )
            points.append(places)
            normals.append(np.tile(direction, (len(places), 1)))
            numbers.append(np.full(len(places), number, dtype=np.int64))
    kind = np.concatenate(kinds)
    return Nodes(
        kind,
        np.ascontiguousarray(np.concatenate(points)),
        np.concatenate(numbers),
        np.concatenate([only, np.full(len(kind) - len(only), -1, dtype=np.int64)]),
        np.ascontiguousarray(np.concatenate(normals)),
    )


def with_points(nodes: Nodes, points: Sequence[tuple[float, float]]) -> Nodes:
    """The nodes, and one like a corner at each of these points, metres."""
    if not points:
        return nodes
    n = len(points)
    return Nodes(
        np.concatenate([nodes.kind, np.full(n, CORNER, dtype=np.int64)]),
        np.ascontiguousarray(np.concatenate([nodes.xy, np.array(points, dtype=np.float64)])),
        np.concatenate([nodes.opening, np.full(n, -1, dtype=np.int64)]),
        np.concatenate([nodes.only, np.full(n, -1, dtype=np.int64)]),
        np.ascontiguousarray(np.concatenate([nodes.normal, np.zeros((n, 2))])),
    )


def outward(plan: Floor, opening: Exit) -> NDArray[np.float64]:
    """(2,) unit normal of an exit, away from the free area."""
    normal = _both_ways(opening)[0]
    along = np.linspace(0.05, 0.95, 10)[:, None]
    places = np.array(opening.a) + along * (np.array(opening.b) - np.array(opening.a))
    # Two centimetres: farther than an exit may lie from the edge.
    ahead, behind = (
        shapely.intersects_xy(plan.walkable, *(places + side * 0.02 * normal).T) for side in (1, -1)
    )
    return -normal if ahead.sum() > behind.sum() else normal


def _both_ways(opening: Opening) -> list[NDArray[np.float64]]:
    along = (np.array(opening.b) - np.array(opening.a)) / opening.length
    normal = np.array([-along[1], along[0]])
    return [normal, -normal]


def _places(
    plan: Floor, room: BaseGeometry, opening: Opening, clearance: float
) -> NDArray[np.float64]:
    """Points along the parts of a gate or exit that are clear of walls, and in the `room`."""
    near = shapely.union_all(walls_near(plan, opening.line, clearance))
    places = [np.empty((0, 2))]
    for share in _SHARES:
        # Round ends are polygons inside the circle; the margin keeps the rest clear.
        clear = opening.line.difference(near.buffer(1.001 * share * clearance, quad_segs=32))
        for part in shapely.get_parts(clear.intersection(room)):
            count = 1 + int(np.ceil(part.length / _POINT_SPACING)) if part.length > 0.05 else 1
            share_along = np.linspace(0, 1, min(count, _POINTS_PER_OPENING)) if count > 1 else [0.5]
            points = shapely.line_interpolate_point(part, share_along, normalized=True)
            places.append(shapely.get_coordinates(points))
        if len(places) > 1:
            break
    return np.concatenate(places)


def _passable(sight: Sight, places: NDArray[np.float64], clearance: float) -> NDArray[np.bool_]:
    # The bound itself counts, whatever the last bit.
    return wall_distances(sight, places, clearance) > NODE_SHARE * clearance - 1e-9


def _corners(
    plan: Floor, sight: Sight, clearance: float
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """The (n, 2) corners of routes, and for each the only exit that it leads to, or -1."""
    bases, offsets = _gate_ends(plan, clearance)
    beside = []
    for ring in rings(smooth_floor(plan).floor.simplify(_SIMPLIFY * clearance)):
        for vertex, own, edges in _reflex(ring, clearance):
            bases += [vertex] * len(own)
            offsets += own
            beside += [np.stack([vertex, vertex + offset]) for offset in edges]
    only = [-1] * len(bases)
    for number, base, offset in _exit_ends(plan, clearance):
        bases.append(base)
        offsets.append(offset)
        only.append(number)
    base = np.array(bases, dtype=np.float64).reshape(-1, 2)
    offset = np.array(offsets, dtype=np.float64).reshape(-1, 2)
    waiting = np.arange(len(base))
    found, leads = [], []
    # In a narrow passage a corner is put nearer to its wall.
    for share in _SHARES:
        places = base[waiting] + share * offset[waiting]
        good = plan.contains(places) & _passable(sight, places, clearance)
        found.append(places[good])
        leads.append(np.array(only, dtype=np.int64)[waiting[good]])
        waiting = waiting[~good]
    # Where even that is too near to another wall, the route bends in the middle of the gap, and
    # beside the vertex before and after it.
    failed = {tuple(each) for each in base[waiting].tolist()}
    more = [place for vertex, place in beside if tuple(vertex.tolist()) in failed]
    last = np.array(more, dtype=np.float64).reshape(-1, 2)
    last = np.concatenate([last, _middles(plan, base[waiting], clearance)])
    last = last[plan.contains(last) & _passable(sight, last, clearance)]
    return (
        np.concatenate([*found, last]),
        np.concatenate([*leads, np.full(len(last), -1, dtype=np.int64)]),
    )


def _middles(plan: Floor, bases: NDArray[np.float64], clearance: float) -> NDArray[np.float64]:
    """The middles of the gaps between some vertices and the walls near them."""
    found = [np.empty((0, 2))]
    for base in shapely.points(bases):
        across = shapely.shortest_line(base, walls_near(plan, base, _NARROW * clearance))
        middles = shapely.line_interpolate_point(across, 0.5, normalized=True)
        found.append(shapely.get_coordinates(middles))
    return np.concatenate(found)


def _reflex(
    ring: NDArray[np.float64], clearance: float
) -> list[tuple[NDArray[np.float64], list[NDArray[np.float64]], list[NDArray[np.float64]]]]:
    """The vertices of a ring that routes bend around.

    Each comes with offsets to where a body passes it, one or, at a sharp tip, two, and with the two
    offsets at right angles to the edges that meet there.
    """
    arriving = ring - np.roll(ring, 1, axis=0)
    arriving /= np.hypot(*arriving.T)[:, None]
    leaving = np.roll(arriving, -1, axis=0)
    turn = turns(ring)
    result = []
    for i in np.flatnonzero(turn < -1e-6):
        angle = -turn[i]
        edges = [clearance * np.array([-y, x]) for x, y in (arriving[i], leaving[i])]
        if angle <= _SHARP:
            own = [(edges[0] + edges[1]) / (2 * np.cos(angle / 2) ** 2)]
        else:
            outwards = (arriving[i] - leaving[i]) / np.hypot(*(arriving[i] - leaving[i]))
            own = _cap(outwards, np.pi - angle, clearance)
        result.append((ring[i], own, edges))
    return result


def _cap(
    outwards: NDArray[np.float64], solid: float, clearance: float
) -> list[NDArray[np.float64]]:
    """Two corners beside a tip of the given solid angle, as on a square cap around it."""
    beside = clearance * (1 - np.sin(solid / 2)) / np.cos(solid / 2)
    across = np.array([-outwards[1], outwards[0]])
    return [clearance * outwards + beside * across, clearance * outwards - beside * across]


def _exit_ends(
    plan: Floor, clearance: float
) -> Iterator[tuple[int, NDArray[np.float64], NDArray[np.float64]]]:
    """The ends of walls at open exits: number of the exit, end, and offset of the corner."""
    for number, opening in enumerate(plan.openings()):
        if isinstance(opening, Exit) and plan.is_open(opening.name):
            a, b = np.array(opening.a), np.array(opening.b)
            along = (b - a) / opening.length * min(clearance, opening.length / 2)
            inward = -clearance * outward(plan, opening)
            yield number, a, inward + along
            yield number, b, inward - along


def _gate_ends(
    plan: Floor, clearance: float
) -> tuple[list[NDArray[np.float64]], list[NDArray[np.float64]]]:
    """The ends of closed gates that are no vertices of the free area, and offsets of corners."""
    bases, offsets = [], []
    edge = plan.free.boundary
    for gate in plan.closed_gates():
        a, b = np.array(gate.a), np.array(gate.b)
        for end, other in ((a, b), (b, a)):
            if edge.distance(shapely.Point(end)) > 0:
                for offset in _cap((end - other) / gate.length, 0.0, clearance):
                    bases.append(end)
                    offsets.append(offset)
    return bases, offsets
