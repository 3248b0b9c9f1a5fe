"""Random places at which people can stand."""

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray
from shapely.geometry.base import BaseGeometry

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.floor.boundaries import opening_segments
from mesa_mobility.floorplan.floor.checks import read_area
from mesa_mobility.floorplan.floor.floor import Floor
from mesa_mobility.floorplan.poisson_disk import lattice, throw
from mesa_mobility.floorplan.reachability import with_way_out
from mesa_mobility.floorplan.walls.sight import Sight, sight_of
from mesa_mobility.floorplan.walls.smooth_floor import smooth_floor
from mesa_mobility.floorplan.walls.wall_distances import wall_distances

PASSING = 0.1615
"""Half the width in metres of the narrowest gap that routes of an adult lead through."""


def random_points(
    plan: Floor,
    n: int,
    rng: np.random.Generator,
    *,
    within: BaseGeometry | str | None = None,
    spacing: float,
    clearance: float,
    avoid: ArrayLike = (),
) -> NDArray[np.float64]:
    """(n, 2) random points in metres with room for people to stand.

    Every point is at least `clearance` from walls and exits, on no copied part of a seam's strip,
    and at least `spacing` from the other points and from the (k, 2) points of `avoid`. It has a way
    to an exit, were all doors open, through gaps of at least 0.323 m, which adults pass; if there
    is no such place, none needs to have one. The points are the same for the same state of `rng`.
    Points thrown one by one (random sequential placement) are tried first, then a jittered
    hexagonal lattice.

    Args:
        plan: the floor plan.
        n: how many.
        rng: where they come from.
        within: the area in which they lie, a polygon or several (shapely or WKT), metres; by
            default the whole floor.
        spacing: least distance of the points to each other, metres.
        clearance: least distance to walls and exits, metres.
        avoid: (k, 2) further points from which they keep the spacing, metres.

    Raises:
        FloorPlanError: there is room for fewer than n points; the message says for how many. Or
            `within` is no valid area.
    """
    if n < 0 or not (np.isfinite([spacing, clearance]).all() and spacing > 0 and clearance >= 0):
        raise FloorPlanError(
            "random points need n >= 0, spacing > 0 and clearance >= 0, "
            f"found {n}, {spacing} and {clearance}"
        )
    taken = np.asarray(avoid, dtype=np.float64).reshape(-1, 2)
    if n == 0:
        return np.empty((0, 2))
    area = None if within is None else read_area(within, "within")
    region = _standing_region(plan, area, clearance)
    # Open exits are not walls, but nobody should start in one.
    edge = np.concatenate([plan.walls, opening_segments(plan.open_exits())])
    sight = sight_of(edge, (), clearance)

    def fits(points: NDArray[np.float64]) -> NDArray[np.bool_]:
        return _fits(region, sight, clearance, points)

    # Discs of half the spacing around more points would not fit, however they lay. Round corners of
    # a polygon lack less than a hundredth of that area.
    most = int(4.04 * region.buffer(spacing / 2.0).area / (np.pi * spacing**2))
    if n > most:
        raise FloorPlanError(
            f"the floor plan leaves room for {most} of {n} people, {spacing} m apart and "
            f"{clearance} m from walls, at most"
        )
    found = np.empty((0, 2))
    if region.area > 0:
        tried = min(n, _most(region, spacing))
        found = throw(region, fits, tried, rng, spacing, taken)
        if len(found) < tried:
            found = max(found, lattice(region, fits, tried, rng, spacing, taken), key=len)
    if len(found) < n:
        raise FloorPlanError(
            f"the floor plan leaves room for {len(found)} of {n} people, "
            f"{spacing} m apart and {clearance} m from walls"
        )
    return found


def _most(region: BaseGeometry, spacing: float) -> int:
    """Upper bound of the points that a region can hold, since discs around them do not overlap.

    Looking for room for millions would take minutes and gigabytes.
    """
    xmin, ymin, xmax, ymax = region.bounds
    # The disc around a point at the region's edge lies half outside.
    area = (xmax - xmin + spacing) * (ymax - ymin + spacing)
    return int(area / (np.pi * (spacing / 2) ** 2)) + 1


def _standing_region(plan: Floor, within: BaseGeometry | None, clearance: float) -> BaseGeometry:
    # A smooth floor shrinks faster; `_fits` looks at the walls themselves.
    region = smooth_floor(plan).floor.buffer(-clearance, quad_segs=32)
    # In one piece of at least this clearance every place has a way out, or none has.
    whole = clearance >= PASSING and region.geom_type == "Polygon"
    if within is not None:
        region = region.intersection(within)
    if plan.seams:
        region = region.difference(plan.copied)
    if not whole:
        region = with_way_out(plan, region, PASSING)
    parts = [part for part in shapely.get_parts(region) if part.geom_type == "Polygon"]
    region = shapely.MultiPolygon(parts)
    shapely.prepare(region)
    return region


def _fits(
    region: BaseGeometry, sight: Sight, clearance: float, points: NDArray[np.float64]
) -> NDArray[np.bool_]:
    fits = shapely.contains_xy(region, points[:, 0], points[:, 1])
    # Round corners of the shrunken region are polygons: only the walls themselves are exact.
    # Where nothing is nearer the distance found is the bound itself.
    fits[fits] = wall_distances(sight, points[fits], clearance) >= clearance
    return fits
