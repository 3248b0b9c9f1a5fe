"""Random floor plans: halls, rooms, corridors, stars and traps, walked through one way or both."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely
from shapely import LineString, Polygon, affinity, box, union_all

from mesa_mobility import Exit, FloorPlan, Gate
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.verification.runs import CLEARANCE, SPACING, Run, crowd_model, evacuate

LIMIT_S = 600.0
WALL = 0.2
NARROWEST, WIDEST = 0.5, 2.0
"""Widths of doors, metres."""

# Two bodies and their distance: a narrower door is not used both ways.
NARROWEST_BOTH_WAYS = 1.2

_TRIES = 100


@dataclass(frozen=True)
class Drawn:
    """A floor plan and the areas in which people start.

    Attributes:
        plan: the floor plan.
        starts: areas in which people start, with the exits that they may leave by (None: all).
    """

    plan: FloorPlan
    starts: tuple[tuple[Polygon, tuple[str, ...] | None], ...]


def random_plan(seed: int, *, shape: str, both_ways: bool, people: int = 30) -> dict[str, Any]:
    """People leave a random plan.

    Args:
        seed: of the plan and of the run.
        shape: one of ``SHAPES``.
        both_ways: whether half of them walk in the opposite direction.
        people: their number, reduced if there is no room.
    """
    return random_run(seed, shape=shape, both_ways=both_ways, people=people).figures()


def random_run(seed: int, *, shape: str, both_ways: bool, people: int) -> Run:
    """The run of `random_plan`."""
    rng = np.random.default_rng(seed)
    drawn = draw_plan(rng, shape, both_ways=both_ways)
    model = crowd_model(drawn.plan, rng)
    share = people // len(drawn.starts)
    for area, exits in drawn.starts:
        # A quarter of the capacity of a lattice, which random places always reach.
        fit = min(share, int(0.25 * drawn.plan.free.intersection(area).area / SPACING**2))
        places = drawn.plan.random_points(
            max(fit, 1),
            model.rng,
            within=area,
            spacing=SPACING,
            clearance=CLEARANCE,
            avoid=model.population.bodies()[1],
        )
        model.add_pedestrians(places, exits=exits)
    return evacuate(model, LIMIT_S)


def draw_plan(rng: np.random.Generator, shape: str, *, both_ways: bool) -> Drawn:
    """A random plan of one of ``SHAPES``, with a way out from everywhere."""
    for _ in range(_TRIES):
        try:
            return SHAPES[shape](rng, both_ways)
        except FloorPlanError:  # obstacles that close a way: draw others
            continue
    raise FloorPlanError(f"{shape}: no plan in {_TRIES} tries")


def _width(rng: np.random.Generator, both_ways: bool) -> float:
    return float(rng.uniform(NARROWEST_BOTH_WAYS if both_ways else NARROWEST, WIDEST))


def _door(rng: np.random.Generator, length: float, both_ways: bool) -> tuple[float, float]:
    """Two ends of a door in a wall from 0 to ``length``."""
    width = _width(rng, both_ways)
    low = float(rng.uniform(0.3, length - width - 0.3))
    return low, low + width


def _ends(
    rng: np.random.Generator, length: float, height: float, both_ways: bool
) -> tuple[list[Exit], list[tuple[str, ...] | None]]:
    """Exits of a room, one on the right, and one on the left if people go both ways; and the exits
    of people who start on the left and on the right."""
    low, high = _door(rng, height, both_ways)
    exits = [Exit("east", (length, low), (length, high))]
    if not both_ways:
        return exits, [None]
    low, high = _door(rng, height, both_ways)
    return [*exits, Exit("west", (0.0, low), (0.0, high))], [("east",), ("west",)]


def _checked(plan: FloorPlan, starts: list[Polygon]) -> None:
    """Raise FloorPlanError unless everybody can get out and there is room to start."""
    points = plan.random_points(60, np.random.default_rng(0), spacing=0.01, clearance=CLEARANCE)
    plan.check_reachable(points, CLEARANCE)
    for start in starts:
        if plan.free.buffer(-CLEARANCE).intersection(start).area < 1.0:
            raise FloorPlanError("no room to start")


def _made(
    floor: Polygon,
    exits: list[Exit],
    starts: list[Polygon],
    may: list[tuple[str, ...] | None],
    gates: list[Gate] | None = None,
    obstacles: list[Polygon] | None = None,
) -> Drawn:
    plan = FloorPlan(floor, exits=exits, gates=gates or [], obstacles=obstacles or [])
    _checked(plan, starts)
    return Drawn(plan, tuple(zip(starts, may, strict=True)))


def _thing(rng: np.random.Generator, length: float, height: float) -> Polygon:
    """A pillar, a table or a piece of wall somewhere in a hall."""
    x, y = rng.uniform(1.0, length - 1.0), rng.uniform(0.5, height - 0.5)
    kind = int(rng.integers(3))
    if kind == 0:
        return shapely.Point(x, y).buffer(float(rng.uniform(0.15, 0.6)), quad_segs=3)
    if kind == 1:
        size = rng.uniform(0.5, 2.0), rng.uniform(0.4, 1.0)
    else:
        size = rng.uniform(1.0, 3.0), 0.1
    piece = box(x - size[0] / 2, y - size[1] / 2, x + size[0] / 2, y + size[1] / 2)
    return affinity.rotate(piece, float(rng.uniform(0, 180)))


def _hall(rng: np.random.Generator, both_ways: bool) -> Drawn:
    length, height = rng.uniform(9.0, 14.0), rng.uniform(6.0, 10.0)
    exits, may = _ends(rng, length, height, both_ways)
    things = [_thing(rng, length, height) for _ in range(int(rng.integers(1, 7)))]
    starts = [box(0, 0, length / 3, height), box(2 * length / 3, 0, length, height)]
    return _made(box(0, 0, length, height), exits, starts[: len(may)], may, obstacles=things)


def _rooms(rng: np.random.Generator, both_ways: bool) -> Drawn:
    """Rooms in a row."""
    height = float(rng.uniform(4.0, 6.0))
    parts, gates, x = [], list[Gate](), 0.0
    count = int(rng.integers(2, 5))
    edges = []
    for k in range(count):
        wide = float(rng.uniform(3.0, 5.0))
        parts.append(box(x, 0.0, x + wide, height))
        edges.append((x, x + wide))
        x += wide
        if k < count - 1:
            low, high = _door(rng, height, both_ways)
            parts.append(box(x, low, x + WALL, high))
            gates.append(Gate(f"door {k}", (x + WALL / 2, low), (x + WALL / 2, high)))
            x += WALL
    exits, may = _ends(rng, x, height, both_ways)
    starts = [box(low, 0, high, height) for low, high in (edges[0], edges[-1])]
    return _made(union_all(parts), exits, starts[: len(may)], may, gates)


def _corridor(rng: np.random.Generator, both_ways: bool) -> Drawn:
    """A corridor with bends, no less wide than a door."""
    width = _width(rng, both_ways) + 0.5
    points, heading = [np.zeros(2)], 0.0
    for k in range(int(rng.integers(2, 5))):
        turn = float(rng.choice([-90.0, -60.0, -30.0, 30.0, 60.0, 90.0])) if k else 0.0
        heading = float(np.clip(heading + turn, -90.0, 90.0))
        step = np.array([np.cos(np.radians(heading)), np.sin(np.radians(heading))])
        points.append(points[-1] + float(rng.uniform(4.0, 6.0)) * step)
    line = LineString(points)
    floor = line.buffer(width / 2, cap_style="flat", join_style="mitre")
    if floor.geom_type != "Polygon" or floor.interiors:
        raise FloorPlanError("the corridor crosses itself")
    exits, starts = [], []
    for name, here, there in (("east", points[-1], points[-2]), ("west", points[0], points[1])):
        along = (there - here) / np.hypot(*(there - here))
        across = np.array([-along[1], along[0]])
        share = width / 2 - (0.0 if both_ways else float(rng.uniform(0.0, width / 2 - 0.3)))
        exits.append(Exit(name, tuple(here + share * across), tuple(here - share * across)))
        first = LineString([here, here + 3.0 * along])
        starts.append(first.buffer(width / 2, cap_style="flat"))
    if both_ways:
        return _made(floor, exits, starts[::-1], [("east",), ("west",)])
    return _made(floor, exits[:1], starts[1:], [None])


def _star(rng: np.random.Generator, both_ways: bool) -> Drawn:
    """Corridors that meet in the middle; one or two of them lead out."""
    arms = int(rng.integers(3, 7))
    turns = np.linspace(0, 360, arms, endpoint=False) + rng.uniform(0, 30)
    parts, ends = [shapely.Point(0, 0).buffer(float(rng.uniform(2.0, 3.5)), quad_segs=4)], []
    for turn in turns:
        length, width = float(rng.uniform(5.0, 8.0)), _width(rng, both_ways) + 0.2
        arm = affinity.rotate(box(0, -width / 2, length, width / 2), turn, origin=(0, 0))
        tip = affinity.rotate(box(length - 2.5, -width / 2, length, width / 2), turn, origin=(0, 0))
        line = affinity.rotate(
            LineString([(length, -width / 2), (length, width / 2)]), turn, origin=(0, 0)
        )
        parts.append(arm)
        ends.append((tip, [tuple(place) for place in line.coords]))
    out = [Exit("east", *ends[0][1]), Exit("west", *ends[1][1])]
    floor = union_all(parts)
    if both_ways:
        return _made(floor, out, [ends[1][0], ends[0][0]], [("east",), ("west",)])
    return _made(floor, out[:1], [tip for tip, _ in ends[1:]], [None] * (arms - 1))


def _trap(rng: np.random.Generator, both_ways: bool) -> Drawn:
    """A hall with U-shaped walls, open towards the people who approach."""
    length, height = rng.uniform(10.0, 13.0), rng.uniform(7.0, 9.0)
    exits, may = _ends(rng, length, height, both_ways)
    traps = []
    for _ in range(int(rng.integers(1, 3))):
        wide, deep = rng.uniform(1.5, 3.5), rng.uniform(1.0, 2.5)
        x, y = rng.uniform(4.0, length - 3.0), rng.uniform(2.2, height - 2.2)
        shell = box(x - deep, y - wide / 2, x, y + wide / 2)
        hollow = box(x - deep - 0.1, y - wide / 2 + WALL, x - WALL, y + wide / 2 - WALL)
        trap = shell.difference(hollow)
        traps.append(affinity.scale(trap, -1.0) if both_ways and rng.random() < 0.5 else trap)
    starts = [box(0, 0, length / 2, height), box(length / 2, 0, length, height)]
    if not both_ways:
        starts = [box(0, 0, 0.7 * length, height)]
    return _made(box(0, 0, length, height), exits, starts, may, obstacles=traps)


SHAPES = {"hall": _hall, "rooms": _rooms, "corridor": _corridor, "star": _star, "trap": _trap}
"""Kinds of random plans, by name."""
