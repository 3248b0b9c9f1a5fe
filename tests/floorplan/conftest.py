from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest
import shapely
from shapely import box

from mesa_mobility.floorplan import Exit, FloorPlan, Gate, Router


def room() -> FloorPlan:
    """10 m x 8 m, an exit of 1 m in the wall y = 0 from x = 4 to 5."""
    return FloorPlan(box(0, 0, 10, 8), exits=[Exit("south", (4, 0), (5, 0))], name="room")


def corridor() -> FloorPlan:
    """20 m x 4 m, an exit over the whole of each short side."""
    return FloorPlan(
        box(0, 0, 20, 4), exits=[Exit("west", (0, 0), (0, 4)), Exit("east", (20, 0), (20, 4))]
    )


def l_corridor() -> FloorPlan:
    """2 m wide: along y = 0 to x = 12, then up to the exit at y = 10; inner corner at (10, 2)."""
    walkable = "POLYGON((0 0, 12 0, 12 10, 10 10, 10 2, 0 2, 0 0))"
    return FloorPlan(walkable, exits=[Exit("top", (10, 10), (12, 10))], name="L corridor")


def u_corridor() -> FloorPlan:
    """Two legs, 2 m wide and 10 m long, joined below; a side exit in the inner wall of either."""
    walkable = "POLYGON((0 0, 6 0, 6 10, 4 10, 4 2, 2 2, 2 10, 0 10, 0 0))"
    return FloorPlan(
        walkable,
        exits=[
            Exit("left", (2, 5), (2, 6)),
            Exit("right", (4, 5), (4, 6)),
            Exit("top", (4, 10), (6, 10)),
        ],
    )


def two_rooms() -> FloorPlan:
    """Rooms of 6 m x 6 m, a wall of 0.2 m with a door (gate at x = 6.1), an exit in a far wall."""
    walkable = shapely.union_all(
        [box(0, 0, 6, 6), box(6, 1, 6.2, 2), box(6.2, 0, 12, 6), box(12, 4.5, 12.2, 5.3)]
    )
    return FloorPlan(
        walkable,
        gates=[Gate("door", (6.1, 1), (6.1, 2))],
        exits=[Exit("out", (12.2, 4.5), (12.2, 5.3))],
        name="two rooms",
    )


def two_rooms_turning_back() -> FloorPlan:
    """The exit lies right behind the wall with the door, so that the route turns sharply."""
    walkable = shapely.union_all([box(0, 0, 6, 6), box(6, 2, 6.2, 3), box(6.2, 0, 8, 6)])
    return FloorPlan(
        walkable,
        gates=[Gate("door", (6.1, 2), (6.1, 3))],
        exits=[Exit("out", (6.3, 0), (7.1, 0))],
        name="turning back",
    )


def hall() -> FloorPlan:
    """Twelve rows of seats in two blocks with aisles of 1.2 m, two exits."""
    rows = [
        box(a, 3 + 0.9 * row, b, 3.45 + 0.9 * row)
        for row in range(12)
        for a, b in ((1.2, 7), (8.2, 14))
    ]
    return FloorPlan(
        box(0, 0, 15.2, 15),
        exits=[Exit("front", (2, 0), (3.5, 0)), Exit("back", (15.2, 13.9), (15.2, 14.9))],
        obstacles=rows,
        name="hall",
    )


def bend() -> FloorPlan:
    """A corridor of 2 m along a sine curve, its round walls drawn as many short ones."""
    t = np.linspace(0, 1, 60)
    centre = np.stack([20 * t, 3 * np.sin(6 * t)], axis=1)
    walkable = shapely.LineString(centre).buffer(1.0, cap_style="flat")
    along = (centre[-1] - centre[-2]) / np.hypot(*(centre[-1] - centre[-2]))
    across = np.array([-along[1], along[0]])
    end = Exit("end", tuple(centre[-1] + across), tuple(centre[-1] - across))
    return FloorPlan(walkable, exits=[end], name="bend")


def places(plan: FloorPlan, step: float, clearance: float = 0.02) -> np.ndarray:
    """A grid of points over the whole free area, some of them right beside walls."""
    xmin, ymin, xmax, ymax = plan.bounds
    x, y = np.arange(xmin + step / 2, xmax, step), np.arange(ymin + step / 2, ymax, step)
    grid = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    return grid[shapely.contains_xy(plan.free.buffer(-clearance), *grid.T)]


@dataclass
class Walk:
    """Results of walkers: those left inside, steps through walls, lengths, gates crossed."""

    left: np.ndarray
    wall_crossings: int
    lengths: np.ndarray
    gates_crossed: np.ndarray


def walk(plan: FloorPlan, starts: np.ndarray, *, step: float = 0.1, steps: int = 1000) -> Walk:
    """Points that repeatedly step towards their target; checked with shapely alone."""
    router = Router(plan)
    here = np.array(starts)
    inside = np.ones(len(here), dtype=bool)
    lengths, crossed = np.zeros(len(here)), np.zeros(len(here), dtype=int)
    walls = shapely.STRtree(shapely.linestrings(plan.walls.reshape(-1, 2, 2)))
    crossings = 0
    for _ in range(steps):
        ids = np.flatnonzero(inside)
        if len(ids) == 0:
            break
        away = router.targets(here[ids], np.zeros(len(ids), int)).points - here[ids]
        length = np.hypot(*away.T)
        move = away * (np.minimum(step, length) / np.maximum(length, 1e-12))[:, None]
        there = here[ids] + move
        steps_taken = shapely.linestrings(np.stack([here[ids], there], axis=1))
        crossings += len(walls.query(steps_taken, predicate="crosses")[0])
        for gate in plan.gates:
            crossed[ids] += shapely.crosses(steps_taken, gate.line)
        for way_out in plan.open_exits():
            inside[ids[shapely.intersects(steps_taken, way_out.line)]] = False
        here[ids] = there
        lengths[ids] += np.hypot(*move.T)
    return Walk(starts[inside], crossings, lengths, crossed)


@pytest.fixture(scope="session")
def plans() -> dict[str, Callable[[], FloorPlan]]:
    makers = [
        room,
        corridor,
        l_corridor,
        u_corridor,
        two_rooms,
        two_rooms_turning_back,
        hall,
        bend,
    ]
    return {maker.__name__: maker for maker in makers}


@pytest.fixture(scope="session")
def places_in() -> Callable[..., np.ndarray]:
    return places


@pytest.fixture(scope="session")
def walkers() -> Callable[..., Walk]:
    return walk
