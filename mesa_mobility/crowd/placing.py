"""Putting people on the floor."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesa_mobility.crowd.state import NO_OPTION, Crowd
from mesa_mobility.errors import ModelError
from mesa_mobility.floorplan import FloorPlan


@dataclass(frozen=True)
class Newcomer:
    """What new people have in common: index of their type, core radius in metres, number of the
    cluster in which they stand, number of their destination."""

    kind: int
    core: float
    standing: int
    destination: int


def check_places(positions: ArrayLike, plan: FloorPlan) -> NDArray[np.float64]:
    """(n, 2) places as an array.

    Raises:
        ModelError: another shape, or off the floor.
    """
    points = np.asarray(positions, dtype=np.float64)
    if points.size == 0:
        points = points.reshape(0, 2)
    if points.ndim != 2 or points.shape[1] != 2:
        raise ModelError(f"positions: shape {points.shape}, expected (n, 2)")
    off = ~plan.contains(points)
    if off.any():
        k = int(np.argmax(off))
        raise ModelError(f"pedestrian {k} at {points[k].tolist()}: expected a place on the floor")
    return points


def check_column(name: str, values: ArrayLike, n: int) -> NDArray[np.float64]:
    """(n,) numbers; a single one stands for all.

    Raises:
        ModelError: another length, or not finite.
    """
    column = np.asarray(values, dtype=np.float64)
    if column.shape not in ((n,), ()) or not np.isfinite(column).all():
        raise ModelError(f"{name}: shape {column.shape}, expected {n} finite numbers")
    return np.broadcast_to(column, (n,))


def place(
    state: Crowd,
    rows: NDArray[np.int64],
    points: NDArray[np.float64],
    speeds: NDArray[np.float64],
    frame: int,
    new: Newcomer,
) -> None:
    """Fill the rows of people who appear at ``points``, standing; their headings come later."""
    state.x[rows], state.y[rows] = points.T
    state.preferred[rows] = speeds
    state.core[rows], state.kind[rows] = new.core, new.kind
    state.destination[rows], state.cluster[rows] = new.destination, new.standing
    state.vx[rows] = state.vy[rows] = 0.0
    state.option[rows], state.gone[rows] = NO_OPTION, -1
    state.start[rows] = state.end[rows] = frame
    state.spacing[rows] = state.knots[rows] = 1
    state.path[rows, :2, 0] = points
    state.box[rows] = np.column_stack([points, points])
    state.sweep[rows, :2], state.sweep[rows, 2] = points, 0.0
    state.stride[rows] = 0.0
    state.active[rows] = True


def face(state: Crowd, rows: NDArray[np.int64], headings: NDArray[np.float64]) -> None:
    """Turn people who have just been placed."""
    state.heading[rows] = headings
    state.path[rows, 2, 0] = headings
