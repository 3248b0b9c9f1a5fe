"""Where people can stand: random places for a crowd, and whether they can get out."""

from typing import TYPE_CHECKING

import numpy as np
import shapely
from numba import njit
from numpy.typing import ArrayLike, NDArray
from shapely import LineString, Polygon
from shapely.geometry.base import BaseGeometry

from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.edges import opening_segments
from mesa_mobility.floorplan.kernels import point_segment_distance2
from mesa_mobility.floorplan.walls import CellTable, WallIndex

if TYPE_CHECKING:
    from mesa_mobility.floorplan.plan import FloorPlan

_THROWS = 200
"""Points thrown per person wanted before random placement counts as full."""

_LATTICES = 24
"""Hexagonal lattices (of different direction and offset) tried in the fallback."""


def check_reachable(plan: "FloorPlan", points: ArrayLike, clearance: float) -> None:
    """See `FloorPlan.check_reachable`."""
    xy = np.asarray(points, dtype=np.float64).reshape(-1, 2)
    if not np.isfinite(xy).all():
        raise FloorPlanError("points to check must be finite")
    # Open exits are lengthened outwards into short corridors, so that shrinking the area by
    # the body leaves a piece touching the exit's line only where the body fits through it.
    doorways = [e.line.buffer(2 * clearance, cap_style="flat") for e in plan.open_exits()]
    outside = shapely.union_all(doorways).difference(plan.walkable)
    room = shapely.union_all([plan.free, outside]).buffer(-clearance, quad_segs=32)
    closed = [g.line.buffer(clearance) for g in plan.closed_gates()]
    room = room.difference(shapely.union_all(closed))
    pieces = [
        piece
        for piece in shapely.get_parts(room)
        if any(piece.intersects(e.line) for e in plan.open_exits())
    ]
    ways_out = shapely.union_all(pieces)
    # A person nearer to a wall than the clearance counts as standing at the nearest place that is not.
    away = shapely.distance(ways_out, shapely.points(xy)) if pieces else np.full(len(xy), np.inf)
    lost = ~((away <= clearance + 1e-6) & plan.contains(xy))
    if lost.any():
        x, y = xy[np.flatnonzero(lost)[0]]
        raise FloorPlanError(
            f"{int(lost.sum())} of {len(xy)} people cannot reach an exit, "
            f"the first stands at ({x:.2f}, {y:.2f}); gaps under {2 * clearance:.2f} m do not count"
        )


def random_points(
    plan: "FloorPlan",
    n: int,
    rng: np.random.Generator,
    *,
    within: Polygon | None,
    spacing: float,
    clearance: float,
    avoid: ArrayLike,
) -> NDArray[np.float64]:
    """See `FloorPlan.random_points`."""
    if n < 0 or not (np.isfinite([spacing, clearance]).all() and spacing > 0 and clearance >= 0):
        raise FloorPlanError(
            f"random points need n >= 0, spacing > 0 and clearance >= 0, "
            f"found {n}, {spacing} and {clearance}"
        )
    taken = np.asarray(avoid, dtype=np.float64).reshape(-1, 2)
    if n == 0:
        return np.empty((0, 2))
    region = _standing_region(plan, within, clearance)
    best = np.empty((0, 2))
    if not region.is_empty:
        fits = _Fits(plan, region, clearance)
        best = _throw(fits, n, rng, spacing, taken)
        if len(best) < n:
            lattice = _lattice(fits, n, rng, spacing, taken)
            best = max(best, lattice, key=len)
    if len(best) < n:
        raise FloorPlanError(
            f"the floor plan leaves room for {len(best)} of {n} people, "
            f"{spacing} m apart and {clearance} m from walls"
        )
    return best


def _standing_region(plan: "FloorPlan", within: Polygon | None, clearance: float) -> BaseGeometry:
    region = plan.free.buffer(-clearance, quad_segs=32)
    region = region.difference(shapely.union_all([g.line for g in plan.closed_gates()]).buffer(clearance))
    return region if within is None else region.intersection(within)


class _Fits:
    """Tells which points are in a region and clear of every wall."""

    def __init__(self, plan: "FloorPlan", region: BaseGeometry, clearance: float) -> None:
        parts = [p for p in shapely.get_parts(region) if p.area > 0]
        self.region: BaseGeometry = shapely.MultiPolygon(parts)
        self.clearance = clearance
        shapely.prepare(self.region)
        walls = WallIndex(np.concatenate([plan.walls, opening_segments(plan.open_exits())]))
        self._walls = walls.segments
        self._table = walls.cell_table(max(1.0, _extent(plan.bounds) / 500), clearance)

    def __call__(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        inside = points[shapely.contains_xy(self.region, points[:, 0], points[:, 1])]
        # Round corners of the shrunken region are polygons: only the walls themselves are exact.
        return inside[_clear(inside, self._walls, self._table, self.clearance)]


def _extent(bounds: tuple[float, float, float, float]) -> float:
    return max(bounds[2] - bounds[0], bounds[3] - bounds[1])


@njit(cache=True)
def _clear(
    points: NDArray[np.float64], walls: NDArray[np.float64], table: CellTable, clearance: float
):
    clear = np.ones(len(points), dtype=np.bool_)
    for i in range(len(points)):
        x, y = points[i]
        column = int(np.floor((x - table.x0) / table.cell_size))
        row = int(np.floor((y - table.y0) / table.cell_size))
        if not (0 <= column < table.nx and 0 <= row < table.ny):
            continue
        cell = row * table.nx + column
        for k in range(table.offsets[cell], table.offsets[cell + 1]):
            ax, ay, bx, by = walls[table.indices[k]]
            if point_segment_distance2(x, y, ax, ay, bx, by) < clearance * clearance:
                clear[i] = False
                break
    return clear


def _throw(
    fits: _Fits, n: int, rng: np.random.Generator, spacing: float, taken: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Random sequential placement: throw points at the region, keep those with room."""
    cells = _cells(fits.region)
    side = cells[0, 2] - cells[0, 0]
    placed = np.empty((0, 2))
    left = _THROWS * n
    while left > 0 and len(placed) < n:
        batch = min(left, max(4 * n, 256))
        left -= batch
        corner = cells[rng.integers(len(cells), size=batch), :2]
        thrown = fits(corner + side * rng.random((batch, 2)))
        placed = _keep_apart(placed, thrown, taken, spacing, n)
    return placed


def _cells(region: BaseGeometry) -> NDArray[np.float64]:
    """(k, 4) boxes of one size that cover the region, so that few throws miss a thin one."""
    xmin, ymin, xmax, ymax = region.bounds
    side = max(0.5, _extent(region.bounds) / 200)
    x, y = np.meshgrid(np.arange(xmin, xmax, side), np.arange(ymin, ymax, side))
    boxes = np.stack([x.ravel(), y.ravel(), x.ravel() + side, y.ravel() + side], axis=1)
    return boxes[shapely.intersects(region, shapely.box(*boxes.T))]


def _lattice(
    fits: _Fits, n: int, rng: np.random.Generator, spacing: float, taken: NDArray[np.float64]
) -> NDArray[np.float64]:
    """The widest hexagonal lattice with n places, each shaken by half the spare distance."""
    best = np.empty((0, 2))
    for _ in range(_LATTICES):
        angle, shift = rng.uniform(0, np.pi / 3), rng.random(2)

        def places(width: float, angle: float = angle, shift: NDArray[np.float64] = shift) -> NDArray[np.float64]:
            points = fits(_hexagonal(fits.region.bounds, width, angle, shift))
            return points[_far_from(points, taken, spacing)]

        narrow, wide = spacing, 2 * spacing
        points = places(narrow)
        if len(points) < n:
            filled = _keep_apart(points, fits(rng.permutation(_hexagonal(fits.region.bounds, spacing / 3, angle, shift))), taken, spacing, n)
            best = max(best, filled, key=len)
            if len(best) >= n:
                break
            continue
        for _ in range(12):
            middle = (narrow + wide) / 2
            trial = places(middle)
            if len(trial) >= n:
                narrow, points = middle, trial
            else:
                wide = middle
        chosen = points[np.sort(rng.permutation(len(points))[:n])]
        return _shake(fits, chosen, rng, (narrow - spacing) / 2, taken, spacing)
    return best


def _shake(
    fits: _Fits,
    points: NDArray[np.float64],
    rng: np.random.Generator,
    radius: float,
    taken: NDArray[np.float64],
    spacing: float,
) -> NDArray[np.float64]:
    # A hair less than half the spare distance, so that rounding cannot bring two too close.
    reach = 0.999 * radius * np.sqrt(rng.random(len(points)))
    angle = rng.uniform(0, 2 * np.pi, len(points))
    moved = points + reach[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    for i, place in enumerate(moved):
        if len(fits(place[None])) and _far_from(place[None], taken, spacing)[0]:
            points[i] = place
    return points


def _hexagonal(
    bounds: tuple[float, float, float, float], width: float, angle: float, shift: NDArray[np.float64]
) -> NDArray[np.float64]:
    centre = np.array([bounds[0] + bounds[2], bounds[1] + bounds[3]]) / 2
    radius = np.hypot(bounds[2] - bounds[0], bounds[3] - bounds[1]) / 2 + width
    rows = np.arange(-np.ceil(radius / (width * np.sqrt(0.75))), np.ceil(radius / (width * np.sqrt(0.75))) + 1)
    columns = np.arange(-np.ceil(radius / width), np.ceil(radius / width) + 1)
    i, j = np.meshgrid(columns, rows)
    x = (i + 0.5 * (j % 2) + shift[0]) * width
    y = (j + shift[1]) * width * np.sqrt(0.75)
    cos, sin = np.cos(angle), np.sin(angle)
    return np.stack([(cos * x - sin * y).ravel(), (sin * x + cos * y).ravel()], axis=1) + centre


def _far_from(points: NDArray[np.float64], taken: NDArray[np.float64], spacing: float) -> NDArray[np.bool_]:
    if len(taken) == 0 or len(points) == 0:
        return np.ones(len(points), dtype=bool)
    from scipy.spatial import KDTree

    return KDTree(taken).query(points)[0] >= spacing


def _keep_apart(
    placed: NDArray[np.float64],
    thrown: NDArray[np.float64],
    taken: NDArray[np.float64],
    spacing: float,
    n: int,
) -> NDArray[np.float64]:
    """`placed` and, one after the other, those of `thrown` with room, up to n points."""
    thrown = thrown[_far_from(thrown, taken, spacing)]
    both = np.concatenate([placed, thrown])
    if len(both) == 0:
        return both
    origin = both.min(axis=0)
    cells = np.floor((both - origin) / spacing).astype(np.int64)
    kept = _sequential(both, cells, len(placed), spacing, n)
    return both[kept]


@njit(cache=True)
def _sequential(points, cells, fixed, spacing, n):
    # A cell as wide as the spacing holds at most four kept points, hence a dict of chains.
    kept = np.zeros(len(points), dtype=np.bool_)
    head = dict()
    chain = np.full(len(points), -1, dtype=np.int64)
    width = cells[:, 0].max() + 3
    count = 0
    for i in range(len(points)):
        if count == n:
            break
        free = True
        if i >= fixed:
            for dy in range(-1, 2):
                for dx in range(-1, 2):
                    key = (cells[i, 1] + dy + 1) * width + cells[i, 0] + dx + 1
                    if key in head:
                        j = head[key]
                        while j >= 0:
                            ex = points[i, 0] - points[j, 0]
                            ey = points[i, 1] - points[j, 1]
                            if ex * ex + ey * ey < spacing * spacing:
                                free = False
                            j = chain[j]
        if free:
            key = (cells[i, 1] + 1) * width + cells[i, 0] + 1
            if key in head:
                chain[i] = head[key]
            head[key] = i
            kept[i] = True
            count += 1
    return kept
