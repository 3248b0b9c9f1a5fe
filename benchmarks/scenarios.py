"""The scenarios that are timed: floors and people, the same for every simulator."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from shapely import Polygon, box, union_all

from mesa_mobility.distributions import TruncatedNormal

Line = tuple[tuple[float, float], tuple[float, float]]


@dataclass(frozen=True)
class Scenario:
    """One crowd on one floor.

    Attributes:
        floor: where people walk, metres.
        exits: by name, the line that people leave by and the area just inside of it.
        doors: lines to be crossed on the way.
        places: (n, 2) metres.
        speeds: (n,) preferred, m/s.
        exit_of: (n,) name of the exit each heads for, or None for the nearest.
        seconds: how long it runs; None until the floor is empty.
    """

    floor: Polygon
    exits: dict[str, tuple[Line, Polygon]]
    doors: dict[str, Line]
    places: NDArray[np.float64]
    speeds: NDArray[np.float64]
    exit_of: list[str | None]
    seconds: float | None


def walkers(n: int, rng: np.random.Generator) -> NDArray[np.float64]:
    """(n,) preferred speeds: 1.34 +- 0.26 m/s within 0.6 and 2.0."""
    return TruncatedNormal(1.34, 0.26, 0.6, 2.0).draw(n, rng)


def shaken(
    n: int, x0: float, y0: float, x1: float, y1: float, rng: np.random.Generator
) -> NDArray[np.float64]:
    """(n, 2) places on a square lattice over a rectangle, shaken by a quarter of its spacing."""
    across = max(1, round(np.sqrt(n * (x1 - x0) / (y1 - y0))))
    up = int(np.ceil(n / across))
    dx, dy = (x1 - x0) / across, (y1 - y0) / up
    row, column = np.divmod(rng.permutation(across * up)[:n], across)
    lattice = np.column_stack([x0 + (column + 0.5) * dx, y0 + (row + 0.5) * dy])
    return lattice + rng.uniform(-0.25, 0.25, (n, 2)) * (dx, dy)


def open_walk(people: int, density: float = 0.5, seconds: float = 10.0) -> Scenario:
    """Half walk +x and half -x on an empty rectangle, twice as long as wide."""
    rng = np.random.default_rng(1)
    width = float(np.sqrt(people / density / 2.0))
    length = 2.0 * width
    floor = box(0.0, 0.0, length, width)
    exits = {
        "east": (((length, 0.0), (length, width)), box(length - 0.5, 0.0, length, width)),
        "west": (((0.0, 0.0), (0.0, width)), box(0.0, 0.0, 0.5, width)),
    }
    places = shaken(people, 1.0, 0.5, length - 1.0, width - 0.5, rng)
    towards = [("east", "west")[k] for k in rng.permutation(np.arange(people) % 2)]
    return Scenario(floor, exits, {}, places, walkers(people, rng), list(towards), seconds)


def room(people: int = 750) -> Scenario:
    """30 m x 25 m, two doors of 1.2 m in a long wall, to a corridor with an exit at each end."""
    rng = np.random.default_rng(1)
    centres = (10.0, 20.0)
    doors = [box(x - 0.6, 25.0, x + 0.6, 25.2) for x in centres]
    floor = union_all([box(0.0, 0.0, 30.0, 25.0), *doors, box(0.0, 25.2, 30.0, 28.2)])
    exits = {
        "west": (((0.0, 25.2), (0.0, 28.2)), box(0.0, 25.2, 0.5, 28.2)),
        "east": (((30.0, 25.2), (30.0, 28.2)), box(29.5, 25.2, 30.0, 28.2)),
    }
    lines = {f"door {x:g}": ((x - 0.6, 25.1), (x + 0.6, 25.1)) for x in centres}
    places = shaken(people, 0.5, 0.5, 29.5, 24.5, rng)
    return Scenario(floor, exits, lines, places, walkers(people, rng), [None] * people, None)


def bottleneck(people: int = 150, width: float = 1.0) -> Scenario:
    """10 m x 8 m with one door."""
    rng = np.random.default_rng(1)
    a, b = 5.0 - width / 2, 5.0 + width / 2
    floor = union_all([box(0.0, 0.0, 10.0, 8.0), box(a, 8.0, b, 9.0)])
    exits = {"door": (((a, 9.0), (b, 9.0)), box(a, 8.5, b, 9.0))}
    places = shaken(people, 0.4, 0.4, 9.6, 7.6, rng)
    lines = {"doorway": ((a, 8.1), (b, 8.1))}
    return Scenario(floor, exits, lines, places, walkers(people, rng), [None] * people, None)


SCENARIOS: dict[str, Callable[[], Scenario]] = {
    "open-1000": lambda: open_walk(1_000),
    "open-10000": lambda: open_walk(10_000),
    "open-100000": lambda: open_walk(100_000),
    "room": room,
    "bottleneck": bottleneck,
}
"""What the benchmarks know by name."""
