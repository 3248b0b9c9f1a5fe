"""Whether a body of some width can reach an open exit."""

from typing import TYPE_CHECKING

import numpy as np
import shapely
from numpy.typing import ArrayLike
from shapely.geometry.base import BaseGeometry

from mesa_mobility.errors import FloorPlanError

if TYPE_CHECKING:
    from mesa_mobility.floorplan.plan import FloorPlan


def check_reachable(plan: "FloorPlan", points: ArrayLike, clearance: float) -> None:
    """See `FloorPlan.check_reachable`."""
    xy = np.asarray(points, dtype=np.float64).reshape(-1, 2)
    if not np.isfinite(xy).all():
        raise FloorPlanError("points to check must be finite")
    # A body nearer to a wall than the clearance counts as at the nearest place that keeps it.
    # That place is never behind the wall, where such places are farther away.
    away = shapely.distance(_ways_out(plan, clearance), shapely.points(xy))
    lost = ~(plan.contains(xy) & (away <= clearance + 1e-6))
    if lost.any():
        x, y = xy[np.flatnonzero(lost)[0]]
        raise FloorPlanError(
            f"{int(lost.sum())} of {len(xy)} people cannot reach an open exit through gaps of "
            f"{2 * clearance:.2f} m; the first stands at ({x:.2f}, {y:.2f})"
        )


def _ways_out(plan: "FloorPlan", clearance: float) -> BaseGeometry:
    """Places from which the centre of a body can get to an open exit."""
    # Open exits are lengthened outwards into short corridors, so that shrinking the area by
    # the body leaves a piece touching the exit's line only where the body fits through it.
    doorways = [e.line.buffer(2 * clearance, cap_style="flat") for e in plan.open_exits()]
    outside = shapely.union_all(doorways).difference(plan.walkable)
    room = shapely.union_all([plan.free, outside]).buffer(-clearance, quad_segs=32)
    closed = shapely.union_all([gate.line for gate in plan.closed_gates()]).buffer(clearance)
    pieces = [
        piece
        for piece in shapely.get_parts(room.difference(closed))
        if any(piece.intersects(e.line) for e in plan.open_exits())
    ]
    return shapely.union_all(pieces)
