"""Densities: people over area, and Voronoi, from the part of the floor nearest to each person."""

from __future__ import annotations

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.spatial import Voronoi
from shapely.geometry.base import BaseGeometry

from mesa_mobility.errors import ResultsError
from mesa_mobility.results.measures.occupancy import frames_at
from mesa_mobility.results.tracks import Tracks

FloatArray = NDArray[np.float64]


def density(trajectories: Tracks, area: shapely.Polygon, every: float = 1.0) -> list[list[float]]:
    """People in an area divided by its size, as [[t, people / m2], ...].

    The classic density N / A; see `voronoi_density` for one without its jumps.

    Args:
        trajectories: the run.
        area: measuring polygon, metres.
        every: seconds between the entries.

    Raises:
        ResultsError: an area without size.
    """
    if not area.area > 0:
        raise ResultsError("the measuring area of a density has no size")
    shapely.prepare(area)
    offsets = trajectories.frame_offsets
    result: list[list[float]] = []
    for tick, frame in frames_at(trajectories, every):
        rows = slice(offsets[frame], offsets[frame + 1])
        inside = shapely.contains_xy(area, trajectories.x[rows], trajectories.y[rows])
        result.append([tick, float(np.count_nonzero(inside) / area.area)])
    return result


def voronoi_cells(
    points: FloatArray, floor: BaseGeometry, of: NDArray[np.bool_] | None = None
) -> NDArray[np.object_]:
    """The part of the floor that is nearer to each person than to anybody else.

    Cells end at walls. If walls cut a cell into pieces, only the piece with the person counts.
    (Steffen and Seyfried 2010, Physica A 389: 1902, with PedPy's cut at the walls.)

    Args:
        points: (n, 2) metres, on the floor, all different.
        floor: walkable area (`FloorPlan.free`).
        of: (n,) people whose cells are wanted; by default everybody.

    Returns:
        (k,) polygons, one for each person in ``of``.
    """
    asked = np.arange(len(points)) if of is None else np.flatnonzero(of)
    if len(asked) == 0:
        return np.empty(0, dtype=object)
    x0, y0, x1, y1 = floor.bounds
    middle, far = np.array([(x0 + x1) / 2, (y0 + y1) / 2]), 10.0 * max(x1 - x0, y1 - y0, 1.0)
    # With four people far outside, every cell of those inside is bounded.
    outside = middle + far * np.array([[-1, 0], [1, 0], [0, -1], [0, 1]])
    diagram = Voronoi(np.concatenate([points, outside]))
    regions = [diagram.regions[diagram.point_region[k]] for k in asked]
    corners = np.concatenate([diagram.vertices[region] for region in regions])
    ring = np.repeat(np.arange(len(asked)), [len(region) for region in regions])
    cells = shapely.polygons(shapely.linearrings(_closed(corners, ring), indices=_closed_of(ring)))
    shapely.prepare(floor)
    for k in np.flatnonzero(~shapely.contains_properly(floor, cells)):
        pieces = shapely.get_parts(shapely.intersection(cells[k], floor))
        here = shapely.points(points[asked[k]])
        cells[k] = pieces[np.argmin(shapely.distance(pieces, here))]
    return cells


def individual_densities(
    points: FloatArray, floor: BaseGeometry, of: NDArray[np.bool_] | None = None
) -> FloatArray:
    """Individual densities: 1 / area of each person's cell, persons per square metre.

    Arguments and order as for :func:`voronoi_cells`.
    """
    densities: FloatArray = 1.0 / shapely.area(voronoi_cells(points, floor, of))
    return densities


def voronoi_density(
    trajectories: Tracks,
    area: shapely.Polygon,
    floor: BaseGeometry,
    every: float = 1.0,
) -> list[list[float]]:
    """Mean over an area of the density 1 / A_i of the cells in it, as [[t, people / m2], ...].

    Everybody counts with the share of their cell that lies in the area (Steffen and Seyfried 2010,
    equation 6). So the density does not jump when a person enters, as N / A does.

    Args:
        trajectories: the run.
        area: measuring polygon, metres.
        floor: walkable area (`FloorPlan.free`); people beside it are left out.
        every: seconds between the entries.

    Raises:
        ResultsError: an area without floor in it, or `every` shorter than a frame.
    """
    measured = shapely.intersection(area, floor)
    if not measured.area > 0:
        raise ResultsError("the measuring area of a density has no floor in it")
    offsets = trajectories.frame_offsets
    result: list[list[float]] = []
    for time, frame in frames_at(trajectories, every):
        rows = slice(offsets[frame], offsets[frame + 1])
        points = np.column_stack([trajectories.x[rows], trajectories.y[rows]])
        points = points[shapely.intersects_xy(floor, points[:, 0], points[:, 1])]
        cells = voronoi_cells(points, floor)
        shares = shapely.area(shapely.intersection(cells, measured)) / shapely.area(cells)
        result.append([time, float(shares.sum() / measured.area)])
    return result


def _closed(corners: FloatArray, ring: NDArray[np.int64]) -> FloatArray:
    """Corners of all rings with each ring's first one again at its end."""
    last = np.append(np.flatnonzero(np.diff(ring)), len(ring) - 1)
    first = np.append(0, last[:-1] + 1)
    return np.insert(corners, last + 1, corners[first], axis=0)


def _closed_of(ring: NDArray[np.int64]) -> NDArray[np.int64]:
    last = np.append(np.flatnonzero(np.diff(ring)), len(ring) - 1)
    return np.insert(ring, last + 1, ring[last])
