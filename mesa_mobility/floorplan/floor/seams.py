"""Seams: lines at which people change from one sheet of a floor plan to another.

A building is drawn as several sheets side by side in one plane. The strip around a seam, such as a
flight of stairs, is drawn on both sheets that it joins. On each of them, the half beyond the line
is a copy: people who enter it continue on the other sheet.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray
from shapely import Polygon
from shapely.geometry.base import BaseGeometry

from mesa_mobility._numbers import is_number
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.floor.belts import Belt
from mesa_mobility.floorplan.floor.openings import Gate

LEAST_DEPTH = 0.2
"""Least metres of a strip to either side of its line."""

BEFORE, AFTER = "before", "after"
"""Gates of a seam, halfway from its line to the ends of its strip: on the side of the first sheet,
and on that of the second."""

_COPY = " (copy)"


class Link(NamedTuple):
    """A part of routes that leads from one sheet to another.

    Attributes:
        leaving: name of the gate by which people leave the one.
        arriving: name of the gate by which they come to the other.
        out: (2,) direction in which they cross the former.
        on: (2,) direction in which they cross the latter.
        shift: (2,) metres from a place in the former to the same in the latter.
        length: metres as which it counts.
    """

    leaving: str
    arriving: str
    out: NDArray[np.float64]
    on: NDArray[np.float64]
    shift: NDArray[np.float64]
    length: float


@dataclass(frozen=True)
class Seam:
    """A strip of floor that two sheets share, and the line in it at which people change sheets.

    Whoever crosses the line with `a` on their left comes from the first sheet to the second. The
    strip is a rectangle as wide as the line, drawn on both sheets, with walls along its sides. Its
    part before the line belongs to the first sheet and is a copy on the second, its part behind the
    line belongs to the second and is a copy on the first.

    Args:
        name: the names of its four gates begin with it.
        a: end of the line on the first sheet, (x, y) in metres.
        b: the other end.
        shift: (dx, dy) in metres from a place on the first sheet to the same on the second.
        depth: metres of the strip to either side of the line.
        extra: metres by which routes across the seam count as longer than they are drawn, for a
            strip on which people walk more slowly.
        stepless: whether people who use no stairs walk over it, too.
        belt: what carries people over it, who then cross it in that direction alone.
        before: metres at either end of the strip that are floor before and behind the steps.

    Raises:
        FloorPlanError: what `Gate` refuses, a shift of other than two numbers, a depth of less than
            0.2 m, an extra length below 0, or steps that do not reach the line.
    """

    name: str
    a: tuple[float, float]
    b: tuple[float, float]
    shift: tuple[float, float]
    depth: float
    extra: float = 0.0
    stepless: bool = False
    belt: Belt | None = None
    before: float = 0.0

    def __post_init__(self) -> None:
        line = Gate(self.name, self.a, self.b)
        object.__setattr__(self, "a", line.a)
        object.__setattr__(self, "b", line.b)
        shift = tuple(self.shift)
        if len(shift) != 2 or not all(is_number(each) for each in shift):
            raise FloorPlanError(
                f"seam {self.name!r}: shift must be two numbers, found {self.shift!r:.60}"
            )
        object.__setattr__(self, "shift", (float(shift[0]), float(shift[1])))
        if not is_number(self.depth) or not LEAST_DEPTH <= self.depth < math.inf:
            raise FloorPlanError(
                f"seam {self.name!r}: depth must be at least {LEAST_DEPTH} m, found {self.depth!r}"
            )
        if not is_number(self.extra) or not 0.0 <= self.extra < math.inf:
            raise FloorPlanError(
                f"seam {self.name!r}: extra must be metres, 0 or more, found {self.extra!r}"
            )
        if not is_number(self.before) or not 0.0 <= self.before < self.depth:
            raise FloorPlanError(
                f"seam {self.name!r}: before must be metres, 0 or more and less than the depth, "
                f"found {self.before!r}"
            )

    @property
    def width(self) -> float:
        """Width of the strip, metres."""
        return math.hypot(self.b[0] - self.a[0], self.b[1] - self.a[1])

    @property
    def centre(self) -> tuple[float, float]:
        """The middle of the line on the first sheet, (x, y) in metres."""
        return (self.a[0] + self.b[0]) / 2.0, (self.a[1] + self.b[1]) / 2.0

    @property
    def joint(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """The middle of the line on the first sheet and on the second, (x, y) in metres."""
        (x, y), (dx, dy) = self.centre, self.shift
        return (x, y), (x + dx, y + dy)

    @property
    def direction(self) -> tuple[float, float]:
        """The unit vector in which people cross from the first sheet to the second."""
        return -(self.b[1] - self.a[1]) / self.width, (self.b[0] - self.a[0]) / self.width

    def past(self, points: ArrayLike, second: bool = False) -> NDArray[np.float64]:
        """(n,) metres by which (n, 2) points are past the line; below 0 before it.

        Args:
            points: metres.
            second: whether they are on the second sheet.
        """
        xy = np.asarray(points, dtype=np.float64).reshape(-1, 2) - self._origin(second)
        along: NDArray[np.float64] = xy @ np.array(self.direction)
        return along

    def on_strip(self, points: ArrayLike, second: bool = False) -> NDArray[np.bool_]:
        """(n,) whether (n, 2) points are on the strip, its edge included; see `past`."""
        xy = np.asarray(points, dtype=np.float64).reshape(-1, 2) - self._origin(second)
        ux, uy = self.direction
        aside = np.abs(xy[:, 1] * ux - xy[:, 0] * uy)
        return (np.abs(xy @ np.array([ux, uy])) <= self.depth) & (aside <= self.width / 2.0)

    def part(self, first: float, last: float, second: bool = False) -> Polygon:
        """The part of the strip from `first` to `last` metres past the line.

        Args:
            first: metres; below 0 before the line.
            last: metres.
            second: whether to give it as drawn on the second sheet.
        """
        step = np.array(self.direction)
        offset = np.array(self.shift) if second else np.zeros(2)
        a, b = np.array(self.a) + offset, np.array(self.b) + offset
        return Polygon([a + first * step, b + first * step, b + last * step, a + last * step])

    @property
    def copies(self) -> tuple[Polygon, Polygon]:
        """The copied parts of the strip, on the first sheet and on the second."""
        return self.part(0.0, self.depth), self.part(-self.depth, 0.0, second=True)

    @property
    def gates(self) -> tuple[Gate, ...]:
        """Two gates across the strip, each as drawn on both sheets, between which routes lead from
        sheet to sheet."""
        return (
            self._gate(BEFORE, -self.depth / 2.0, False, ""),
            self._gate(AFTER, self.depth / 2.0, False, _COPY),
            self._gate(BEFORE, -self.depth / 2.0, True, _COPY),
            self._gate(AFTER, self.depth / 2.0, True, ""),
        )

    @property
    def ends(self) -> tuple[Gate, Gate]:
        """The gate before the line on the first sheet, and that after it on the second."""
        gates = self.gates
        return gates[0], gates[3]

    @property
    def copied_gates(self) -> dict[str, Gate]:
        """The copy of each of the two gates, on the other sheet, by the name of the gate."""
        gates = self.gates
        return {gates[0].name: gates[2], gates[3].name: gates[1]}

    @property
    def steps(self) -> NDArray[np.float64]:
        """(k, 4) x1, y1, x2, y2 in metres of the edges at which the steps begin, on the first sheet
        and on the second; none without steps."""
        if self.stepless:
            return np.empty((0, 4))
        far = self.depth - self.before
        ends = (self.part(-far, -far), self.part(far, far, second=True))
        return np.array([shapely.get_coordinates(end)[:2].ravel() for end in ends])

    def on_steps(self, points: ArrayLike, second: bool = False) -> NDArray[np.bool_]:
        """(n,) whether (n, 2) points are on steps, their edges excluded; see `past`."""
        off = np.abs(self.past(points, second)) < self.depth - self.before
        return self.on_strip(points, second) & off & (not self.stepless)

    @property
    def links(self) -> list[Link]:
        """How routes lead from sheet to sheet: both ways, or as a belt moves."""
        forward, shift = np.array(self.direction), np.array(self.shift)
        before, after = f"{self.name} {BEFORE}", f"{self.name} {AFTER}"
        on = Link(after + _COPY, after, forward, forward, shift, self.extra)
        back = Link(before + _COPY, before, -forward, -forward, -shift, self.extra)
        if self.belt is None:
            return [on, back]
        return [on if self.belt.way > 0 else back]

    def _gate(self, name: str, past: float, second: bool, copy: str) -> Gate:
        a, b = shapely.get_coordinates(self.part(past, past, second).exterior)[:2].tolist()
        return Gate(f"{self.name} {name}{copy}", tuple(a), tuple(b))

    def _origin(self, second: bool) -> NDArray[np.float64]:
        return np.array(self.centre) + (self.shift if second else (0.0, 0.0))


def to_own_sheets(points: NDArray[np.float64], seams: Sequence[Seam]) -> NDArray[np.float64]:
    """(n, 2) metres from places to the same on the sheets to which they belong.

    They are 0 for all (n, 2) points that are not on the copied part of a strip.
    """
    shifts = np.zeros((len(points), 2))
    for seam in seams:
        for second, sign in ((False, 1.0), (True, -1.0)):
            copied = seam.on_strip(points, second) & (sign * seam.past(points, second) > 0.0)
            shifts[copied] = sign * np.array(seam.shift)
    return shifts


def check_seams(walkable: BaseGeometry, seams: Sequence[Seam]) -> None:
    """Strips must lie on the walkable area on both sheets; FloorPlanError otherwise."""
    room = walkable.buffer(1e-6)
    shapely.prepare(room)
    for seam in seams:
        if not isinstance(seam, Seam):
            raise FloorPlanError(f"seams must be Seam objects, found {type(seam).__name__}")
        for second in (False, True):
            strip = seam.part(-seam.depth, seam.depth, second)
            if not room.covers(strip):
                outside = strip.difference(room)
                spot = outside.representative_point()
                raise FloorPlanError(
                    f"seam {seam.name!r}: {outside.area:.2f} m² of its strip, around "
                    f"({spot.x:.2f}, {spot.y:.2f}), are not on the walkable area"
                )


def joined(
    pieces: NDArray[np.object_],
    joints: Sequence[tuple[tuple[float, float], tuple[float, float]]],
    found: NDArray[np.bool_],
) -> None:
    """Mark the pieces of floor that are joined with those that are marked.

    Args:
        pieces: (n,) polygons.
        joints: pairs of places, (x, y) in metres, that are joined.
        found: (n,) whether each is marked; is written.
    """
    ends = [[shapely.intersects(pieces, shapely.Point(each)) for each in joint] for joint in joints]
    for _ in range(len(pieces)):
        known = found.copy()
        for one, other in ends:
            if found[one].any() or found[other].any():
                found |= one | other
        if (known == found).all():
            return
