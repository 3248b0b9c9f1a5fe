"""Whether a body of some width can reach an open exit."""

from collections.abc import Sequence

import numpy as np
import shapely
from numpy.typing import ArrayLike
from shapely.geometry.base import BaseGeometry

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.floor.floor import Floor
from mesa_mobility.floorplan.floor.openings import Exit
from mesa_mobility.floorplan.floor.seams import joined
from mesa_mobility.floorplan.walls.smooth_floor import CLOSER, smooth_floor


def check_reachable(plan: Floor, points: ArrayLike, clearance: float) -> None:
    """Raise FloorPlanError if a body of radius `clearance` metres cannot reach an open exit.

    `points` is (n, 2) in metres.
    """
    xy = np.asarray(points, dtype=np.float64).reshape(-1, 2)
    if not np.isfinite(xy).all():
        raise FloorPlanError("points to check must be finite")
    closed = shapely.union_all([gate.line for gate in plan.closed_gates()]).buffer(clearance)
    # A body nearer to a wall than the clearance counts as at the nearest place that keeps it.
    # That place is never behind the wall, where such places are farther away.
    leads_out, _ = pieces_of(plan, plan.free, clearance, plan.open_exits(), closed)
    away = shapely.distance(leads_out, shapely.points(xy))
    lost = ~(plan.contains(xy) & (away <= clearance + 1e-6))
    if lost.any():
        x, y = xy[np.flatnonzero(lost)[0]]
        raise FloorPlanError(
            f"{int(lost.sum())} of {len(xy)} people cannot reach an open exit through gaps of "
            f"{2 * clearance:.2f} m; the first stands at ({x:.2f}, {y:.2f})"
        )


def with_way_out(plan: Floor, region: BaseGeometry, radius: float) -> BaseGeometry:
    """The part of a region from which bodies could reach an exit if all exits and gates were open.

    If no part of the region has a way out, or the plan has no exit, this is the whole region.

    Args:
        plan: the floor plan.
        region: possible places of the centres of bodies.
        radius: half the width of the narrowest gap that the bodies pass, metres.
    """
    if not plan.exits:
        return region
    smooth = smooth_floor(plan)
    # A smooth wall may lie a little before the real one, and close no gap by that.
    passing = radius if smooth.is_exact else max(radius - CLOSER, 0.0)
    _, cut_off = pieces_of(plan, smooth.floor, passing, plan.exits, shapely.Polygon())
    if cut_off.is_empty:
        return region
    # Nearer to a wall than the radius a body counts as at the nearest place that keeps it.
    kept = region.difference(cut_off.buffer(radius, quad_segs=32))
    return region if kept.is_empty else kept


def pieces_of(
    plan: Floor,
    floor: BaseGeometry,
    clearance: float,
    exits: Sequence[Exit],
    closed: BaseGeometry,
) -> tuple[BaseGeometry, BaseGeometry]:
    """Places at which the centre of a body can be: with a way to one of the exits, and without."""
    # The exits are lengthened outwards into short corridors, so that shrinking the area by
    # the body leaves a piece touching the exit's line only where the body fits through it.
    doorways = [e.line.buffer(2 * clearance, cap_style="flat") for e in exits]
    outside = shapely.union_all(doorways).difference(plan.walkable)
    room = shapely.union_all([floor, outside]).buffer(-clearance, quad_segs=32)
    pieces = shapely.get_parts(room.difference(closed))
    lines = shapely.union_all([e.line for e in exits])
    leads_out = shapely.intersects(pieces, lines)
    joined(pieces, plan.joints, leads_out)
    # What lies in such a corridor is no place to be.
    cut_off = [piece for piece in pieces[~leads_out] if piece.intersects(floor)]
    return shapely.union_all(pieces[leads_out]), shapely.union_all(cut_off)
