"""Points at least a distance apart: thrown one by one, or on a jittered lattice."""

from collections.abc import Callable

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from mesa_mobility.compiled.decorators import kept

Fits = Callable[[NDArray[np.float64]], NDArray[np.bool_]]
"""Maps (n, 2) points in metres to (n,) whether each is allowed."""

# Points thrown for each point wanted before random placement counts as full.
_THROWS = 200

# Number of hexagonal lattices, of random direction and offset, that are tried.
_LATTICES = 24

_HALVINGS = 12


def throw(
    region: BaseGeometry,
    fits: Fits,
    n: int,
    rng: np.random.Generator,
    spacing: float,
    avoid: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Up to n points of a region, thrown one by one and kept where there is room.

    Random sequential placement: it fills up at 0.547 of the area in discs, or
    0.70 / spacing² points per square metre (Feder 1980).
    """
    cells, side = _cells(region)
    placed = np.empty((0, 2))
    left = _THROWS * n
    while left > 0 and len(placed) < n:
        batch = min(left, max(4 * n, 256))
        left -= batch
        thrown = cells[rng.integers(len(cells), size=batch)] + side * rng.random((batch, 2))
        placed = _add(placed, thrown[fits(thrown)], avoid, spacing)[:n]
    return placed


def lattice(
    region: BaseGeometry,
    fits: Fits,
    n: int,
    rng: np.random.Generator,
    spacing: float,
    avoid: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Up to n points: n sites of the widest hexagonal lattice that has as many, jittered.

    A lattice holds up to 1.15 / spacing² points per square metre. Its sites move at
    random by less than half of what their distance exceeds `spacing`.
    """
    best = np.empty((0, 2))
    for _ in range(_LATTICES):
        angle, shift = rng.uniform(0, np.pi / 3), rng.random(2)
        width, too_wide = spacing, 2 * spacing
        points = _places(region, fits, width, angle, shift, spacing, avoid)
        if len(points) < n:
            best = max(best, points, key=len)
            continue
        for _ in range(_HALVINGS):
            middle = (width + too_wide) / 2
            trial = _places(region, fits, middle, angle, shift, spacing, avoid)
            if len(trial) >= n:
                width, points = middle, trial
            else:
                too_wide = middle
        chosen = points[np.sort(rng.permutation(len(points))[:n])]
        return _shake(chosen, fits, rng, (width - spacing) / 2, spacing, avoid)
    return best


def _cells(region: BaseGeometry) -> tuple[NDArray[np.float64], float]:
    """Lower left corners of squares that cover the region, so that few throws miss a thin one."""
    xmin, ymin, xmax, ymax = region.bounds
    side = max(0.5, (xmax - xmin) / 200, (ymax - ymin) / 200)
    x, y = np.meshgrid(np.arange(xmin, xmax, side), np.arange(ymin, ymax, side))
    corners = np.stack([x.ravel(), y.ravel()], axis=1)
    return corners[shapely.intersects(region, shapely.box(*corners.T, *(corners + side).T))], side


def _places(
    region: BaseGeometry,
    fits: Fits,
    width: float,
    angle: float,
    shift: NDArray[np.float64],
    spacing: float,
    avoid: NDArray[np.float64],
) -> NDArray[np.float64]:
    """The points of a hexagonal lattice that are allowed."""
    xmin, ymin, xmax, ymax = region.bounds
    height = width * np.sqrt(0.75)
    radius = np.hypot(xmax - xmin, ymax - ymin) / 2 + width
    columns, rows = int(np.ceil(radius / width)), int(np.ceil(radius / height))
    i, j = np.meshgrid(
        np.arange(-columns, columns + 1, dtype=np.int64), np.arange(-rows, rows + 1, dtype=np.int64)
    )
    x = ((i + 0.5 * (j % 2) + shift[0]) * width).ravel()
    y = ((j + shift[1]) * height).ravel()
    cos, sin = np.cos(angle), np.sin(angle)
    centre = [(xmin + xmax) / 2, (ymin + ymax) / 2]
    points = np.stack([cos * x - sin * y, sin * x + cos * y], axis=1) + centre
    return points[fits(points) & _away(points, avoid, spacing)]


def _shake(
    points: NDArray[np.float64],
    fits: Fits,
    rng: np.random.Generator,
    radius: float,
    spacing: float,
    avoid: NDArray[np.float64],
) -> NDArray[np.float64]:
    # A hair less than half the spare distance, so that rounding cannot bring two too close.
    reach = 0.999 * radius * np.sqrt(rng.random(len(points)))
    angle = rng.uniform(0, 2 * np.pi, len(points))
    moved = points + reach[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    good = fits(moved) & _away(moved, avoid, spacing)
    return np.where(good[:, None], moved, points)


def _away(
    points: NDArray[np.float64], avoid: NDArray[np.float64], spacing: float
) -> NDArray[np.bool_]:
    """A mask of the points far enough from those to avoid; distances among them do not count."""
    away = np.ones(len(points), dtype=np.bool_)
    for place in avoid:
        away &= np.hypot(*(points - place).T) >= spacing
    return away


def have_room(points: NDArray[np.float64], spacing: float) -> NDArray[np.bool_]:
    """(n,) which points are kept, in order, if each is `spacing` metres from those before."""
    if len(points) == 0:
        return np.ones(0, dtype=np.bool_)
    cells = np.floor((points - points.min(axis=0)) / spacing).astype(np.int64)
    return _with_room(points, cells, 0, spacing)


def _add(
    placed: NDArray[np.float64],
    thrown: NDArray[np.float64],
    avoid: NDArray[np.float64],
    spacing: float,
) -> NDArray[np.float64]:
    """`placed`, and those of `thrown` that have room, one after the other."""
    fixed = len(avoid) + len(placed)
    points = np.concatenate([avoid, placed, thrown])
    if len(points) == 0:
        return points
    cells = np.floor((points - points.min(axis=0)) / spacing).astype(np.int64)
    kept = _with_room(points, cells, fixed, spacing)
    kept[: len(avoid)] = False
    return points[kept]


@kept(nogil=True)
def _with_room(
    points: NDArray[np.float64], cells: NDArray[np.int64], fixed: int, spacing: float
) -> NDArray[np.bool_]:
    """A mask of the points kept: the first `fixed`, then those `spacing` from all before them."""
    stays = np.zeros(len(points), dtype=np.bool_)
    # A hash table of chains: `last` point of each bucket, `earlier` point of each point.
    # Cells that share a bucket only make its chain longer.
    mask = 1
    while mask < len(points):
        mask = 2 * mask + 1
    last = np.full(mask + 1, -1, dtype=np.int64)
    earlier = np.full(len(points), -1, dtype=np.int64)
    for i in range(len(points)):
        room = True
        if i >= fixed:
            for k in range(9):
                near = _bucket(cells[i, 0] + k % 3 - 1, cells[i, 1] + k // 3 - 1, mask)
                j = last[near]
                while j >= 0 and room:
                    dx = points[i, 0] - points[j, 0]
                    dy = points[i, 1] - points[j, 1]
                    room = dx * dx + dy * dy >= spacing * spacing
                    j = earlier[j]
        if room:
            bucket = _bucket(cells[i, 0], cells[i, 1], mask)
            earlier[i] = last[bucket]
            last[bucket] = i
            stays[i] = True
    return stays


@kept()
def _bucket(column: int, row: int, mask: int) -> int:
    return (column * 73856093 ^ row * 19349663) & mask
