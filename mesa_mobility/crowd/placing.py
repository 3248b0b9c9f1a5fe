"""Putting people on the floor."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesa_mobility.crowd.state import NO_CORNER, NO_OPTION, Crowd
from mesa_mobility.distributions import Distribution
from mesa_mobility.errors import ModelError
from mesa_mobility.floorplan import FloorPlan


@dataclass(frozen=True)
class Newcomer:
    """What new people have in common: index of their type, core radius in metres, number of the
    cluster in which they stand, numbers of their destination, and of their journey and group, 0 for
    none."""

    kind: int
    core: float
    standing: int
    destination: int
    journey: int
    group: int


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
    try:
        column = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise ModelError(f"{name}: got {values!r}, expected {n} finite numbers") from None
    if column.shape not in ((n,), ()) or not np.isfinite(column).all():
        raise ModelError(f"{name}: shape {column.shape}, expected {n} finite numbers")
    return np.broadcast_to(column, (n,))


def draw_column(
    name: str, values: ArrayLike | Distribution, n: int, rng: np.random.Generator
) -> NDArray[np.float64]:
    """(n,) numbers, drawn if a distribution is given.

    Raises:
        ModelError: another length, or not finite.
    """
    drawn = values.draw(n, rng) if isinstance(values, Distribution) else values
    return check_column(name, drawn, n)


def place(
    state: Crowd,
    rows: NDArray[np.int64],
    points: NDArray[np.float64],
    speeds: NDArray[np.float64],
    frame: int,
    sets_off: NDArray[np.int64],
    new: Newcomer,
) -> None:
    """Fill the rows of people who appear at ``points``, standing; their headings come later.

    Until the frame in which somebody ``sets_off`` its movement is one of standing there.
    """
    state.x[rows], state.y[rows] = points.T
    state.preferred[rows] = speeds
    state.core[rows], state.kind[rows] = new.core, new.kind
    state.destination[rows], state.cluster[rows] = new.destination, new.standing
    state.vx[rows] = state.vy[rows] = 0.0
    state.option[rows], state.gone[rows] = NO_OPTION, -1
    state.start[rows], state.end[rows] = frame, sets_off
    waits = sets_off > frame
    state.spacing[rows] = np.where(waits, sets_off - frame, 1)
    state.knots[rows] = 1 + waits
    state.from_x[rows], state.from_y[rows] = state.to_x[rows], state.to_y[rows] = points.T
    state.box[rows] = np.column_stack([points, points])
    state.stride[rows] = 0.0
    state.active[rows] = True
    agenda = state.agenda
    agenda["speed"][rows] = speeds
    agenda["journey"][rows], agenda["crossed"][rows] = new.journey, 0
    agenda["checked"][rows] = frame - 1
    agenda["nearest"][rows] = np.inf
    agenda["corner"][rows] = NO_CORNER
    agenda["group"][rows] = new.group
    agenda["sets_off"][rows] = agenda["waits_until"][rows] = sets_off


def face(state: Crowd, rows: NDArray[np.int64], headings: NDArray[np.float64]) -> None:
    """Turn people who have just been placed."""
    state.heading[rows] = state.from_heading[rows] = state.to_heading[rows] = headings
