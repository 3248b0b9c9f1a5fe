"""Random buildings: levels that stairs, ramps, escalators and lifts join.

Each part is drawn at random and kept if `Building` takes it; refused draws are counted.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np
import shapely
from shapely import Polygon, box

from mesa_mobility import Building, Escalator, Exit, Level, Lift, Ramp, Refuge, Stairs
from mesa_mobility.errors import FloorPlanError

STOREYS, WAYS = (2, 8), (1, 4)
"""Fewest and most levels, and stairs and the like from one level to the next."""
LENGTHS, DEPTHS = (14.0, 30.0), (9.0, 16.0)
RISES, LOW_RISES = (2.7, 4.0), (1.6, 2.2)
"""Metres from level to level, and where ramps are to fit."""
TRIES = 60

Way = Stairs | Ramp | Escalator
Line = tuple[tuple[float, float], tuple[float, float]]


@dataclass
class Drawn:
    """A building as it grows.

    Attributes:
        rng: what draws it.
        levels: from the level with the exits outwards.
        ways: stairs, ramps and escalators.
        lifts: lifts.
        draws: parts that were tried.
        refused: those of them that the building refused.
    """

    rng: np.random.Generator
    levels: list[Level] = field(default_factory=list)
    ways: list[Way] = field(default_factory=list)
    lifts: list[Lift] = field(default_factory=list)
    draws: int = 0
    refused: int = 0

    @property
    def building(self) -> Building:
        """The building of these parts; raises FloorPlanError if it is none."""
        return Building(self.levels, self.ways, lifts=self.lifts)

    def keep(self, draw: Callable[[], Drawn], tries: int = TRIES) -> bool:
        """Take over the first of so many changed copies that is a building; whether one was."""
        for _ in range(tries):
            self.draws += 1
            try:
                drawn = draw()
                assert drawn.building.levels
            except FloorPlanError:
                self.refused += 1
                continue
            self.levels, self.ways, self.lifts = drawn.levels, drawn.ways, drawn.lifts
            return True
        return False

    def with_(
        self,
        *,
        levels: list[Level] | None = None,
        way: Way | None = None,
        lift: Lift | None = None,
    ) -> Drawn:
        """A copy with other levels, or with one part more."""
        return Drawn(
            self.rng,
            self.levels if levels is None else levels,
            [*self.ways, way] if way is not None else self.ways,
            [*self.lifts, lift] if lift is not None else self.lifts,
        )


def draw_building(rng: np.random.Generator) -> Drawn:
    """A random building. The level with the exits may have others below it."""
    while True:
        drawn = Drawn(rng)
        if _storeys(drawn):
            break
    for _ in range(int(rng.integers(0, 3))):
        if rng.random() < 0.5:
            drawn.keep(partial(_lifted, drawn), tries=10)
    for number in range(len(drawn.levels)):
        for _ in range(int(rng.integers(0, 4))):
            drawn.keep(partial(_blocked, drawn, number), tries=5)
        if rng.random() < 0.4:
            drawn.keep(partial(_sheltered, drawn, number), tries=10)
    return drawn


def _storeys(drawn: Drawn) -> bool:
    """Draw the levels and what joins them; whether all could be joined."""
    rng = drawn.rng
    count, low = int(rng.integers(STOREYS[0], STOREYS[1] + 1)), bool(rng.random() < 0.25)
    rise = float(rng.uniform(*(LOW_RISES if low else RISES)))
    length, depth = float(rng.uniform(*LENGTHS)), float(rng.uniform(*DEPTHS))
    least = int(rng.integers(-2, 1)) if count > 2 else 0
    outline = box(0.0, 0.0, length + 8.0 * low, depth)
    drawn.levels = [Level(0, outline, exits=_exits(rng, outline))]
    ways = int(rng.integers(WAYS[0], WAYS[1] + 1))
    kinds = ["straight", "dog_leg", "dog_leg", "escalator", *["ramp", "ramp"] * low]
    for number in [*range(1, count + least), *range(-1, least - 1, -1)]:
        level = Level(number, _outline(rng, outline), elevation=number * rise)
        before = number - int(np.sign(number))
        ends = max(number, before), min(number, before)
        grown = [*drawn.levels, level]
        for k in range(ways):
            draw = partial(_joined, drawn, grown, k, str(rng.choice(kinds)), ends, rise)
            added = drawn.keep(draw, tries=TRIES if k == 0 else 5)
            if not added and k == 0:
                return False
    return True


def _outline(rng: np.random.Generator, outline: Polygon) -> Polygon:
    """The outline of a level: the whole, or without a corner."""
    if rng.random() < 0.6:
        return outline
    _, _, length, depth = outline.bounds
    wide, deep = rng.uniform(0.1, 0.4, 2) * (length, depth)
    x, y = rng.choice((0.0, length - wide)), rng.choice((0.0, depth - deep))
    return outline.difference(box(x, y, x + wide, y + deep))


def _exits(rng: np.random.Generator, outline: Polygon) -> list[Exit]:
    _, _, length, depth = outline.bounds
    found = []
    for k, x in enumerate((0.0, length)[: int(rng.integers(1, 3))]):
        width = float(rng.uniform(1.0, 2.5))
        y = float(rng.uniform(0.3, depth - width - 0.3))
        found.append(Exit(f"exit {k}", (x, y), (x, y + width)))
    return found


def _line(rng: np.random.Generator, outline: Polygon, width: float, *, turned: bool) -> Line:
    """A line somewhere on the outline, along it or, at times, at any angle."""
    _, _, length, depth = outline.bounds
    angle = float(rng.integers(0, 4)) * math.pi / 2.0
    if turned and rng.random() < 0.2:
        angle = float(rng.uniform(0.0, 2.0 * math.pi))
    x, y = rng.uniform(0.0, length), rng.uniform(0.0, depth)
    return (
        (float(x), float(y)),
        (float(x + width * math.cos(angle)), float(y + width * math.sin(angle))),
    )


def _joined(
    drawn: Drawn, levels: list[Level], number: int, kind: str, ends: tuple[int, int], rise: float
) -> Drawn:
    """With these levels, and one way more between two of them, of a kind."""
    name = f"{kind} {number} from {ends[0]}"
    return drawn.with_(levels=levels, way=_way(drawn.rng, name, kind, ends, rise, levels[0].area))


def _way(
    rng: np.random.Generator,
    name: str,
    kind: str,
    ends: tuple[int, int],
    rise: float,
    outline: Polygon,
) -> Way:
    """Stairs, a ramp or an escalator of any size between two levels, anywhere."""
    if kind == "ramp":
        head = _line(rng, outline, float(rng.uniform(1.0, 2.4)), turned=True)
        return Ramp.straight(name, *ends, head, length=rise / float(rng.uniform(0.12, 0.25)))
    if kind == "escalator":
        angle, speed = rng.uniform(25.0, 35.0), float(rng.choice((0.0, 0.5, 0.65, 0.75)))
        return Escalator.straight(
            name,
            *ends,
            _line(rng, outline, float(rng.uniform(0.6, 1.1)), turned=True),
            length=rise / math.tan(math.radians(angle)),
            direction=str(rng.choice(("up", "down"))),
            speed=speed,
        )
    head = _line(rng, outline, float(rng.uniform(0.8, 2.0)), turned=True)
    risers = math.ceil(rise / float(rng.uniform(0.15, 0.20)))
    tread = float(rng.uniform(0.24, 0.34))
    if kind == "straight":
        return Stairs.straight(name, *ends, head, risers=risers, tread=tread)
    return Stairs.dog_leg(
        name,
        *ends,
        head,
        risers=risers,
        tread=tread,
        turn=str(rng.choice(("left", "right"))),
        well=float(rng.uniform(0.1, 0.5)),
    )


def _lifted(drawn: Drawn) -> Drawn:
    """With one lift more, between all levels or two of them."""
    rng, clear = drawn.rng, float(drawn.rng.uniform(0.8, 1.1))
    numbers = sorted(level.number for level in drawn.levels)
    if rng.random() < 0.3:
        numbers = sorted(rng.choice(numbers, size=2, replace=False).tolist())
    outline = drawn.levels[0].area
    lift = Lift(
        f"lift {len(drawn.lifts)}",
        numbers,
        _line(rng, outline, clear, turned=False),
        capacity=int(rng.integers(1, 9)),
        speed=float(rng.uniform(1.0, 2.5)),
        width=clear + float(rng.uniform(0.2, 0.5)),
        depth=float(rng.uniform(1.2, 2.2)),
        everybody=bool(rng.random() < 0.3),
    )
    return drawn.with_(lift=lift)


def _spot(drawn: Drawn, number: int) -> tuple[float, float]:
    left, low, right, high = drawn.levels[number].area.bounds
    return float(drawn.rng.uniform(left, right)), float(drawn.rng.uniform(low, high))


def _blocked(drawn: Drawn, number: int) -> Drawn:
    """With one obstacle more on a level: a column, a wall, or a round one."""
    rng, (x, y) = drawn.rng, _spot(drawn, number)
    kind = int(rng.integers(0, 3))
    if kind == 0:
        shape = box(x, y, x + rng.uniform(0.3, 1.5), y + rng.uniform(0.3, 1.5))
    elif kind == 1:
        wall = box(x, y, x + rng.uniform(2.0, 6.0), y + 0.15)
        shape = shapely.affinity.rotate(wall, float(rng.uniform(0.0, 180.0)))
    else:
        shape = shapely.Point(x, y).buffer(rng.uniform(0.2, 0.8), quad_segs=3)
    level = drawn.levels[number]
    levels = list(drawn.levels)
    levels[number] = replace(level, obstacles=[*level.obstacles, shape])
    return drawn.with_(levels=levels)


def _sheltered(drawn: Drawn, number: int) -> Drawn:
    """With a refuge on a level."""
    x, y = _spot(drawn, number)
    area = box(x, y, x + drawn.rng.uniform(1.5, 4.0), y + drawn.rng.uniform(1.5, 4.0))
    level = drawn.levels[number]
    levels = list(drawn.levels)
    levels[number] = replace(level, refuges=[Refuge(f"refuge {level.number}", area)])
    return drawn.with_(levels=levels)
