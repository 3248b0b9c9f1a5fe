"""Oddities of a floor plan for an evacuation: narrow doors, dead ends, traps and gaps."""

from collections.abc import Collection, Iterator
from typing import NamedTuple

import numpy as np
import shapely
from shapely import Polygon
from shapely.geometry.base import BaseGeometry

from mesa_mobility.floorplan.dead_ends import dead_ends_of, width_of
from mesa_mobility.floorplan.floor.floor import Floor
from mesa_mobility.floorplan.formats.assembling.edges import Edge
from mesa_mobility.floorplan.reachability import pieces_of

WHEELCHAIR = 0.8
"""Least clear width of a door in metres for people in wheelchairs (ISO 21542)."""

ADULT = 0.323
"""Width in metres of the narrowest gap that adults pass."""

GAP = 0.2
"""Metres; floor that is narrower is a gap in which nobody walks."""

LEAST_GAP = 0.3
"""Metres; shorter gaps are not named."""

CRACK = 0.05
"""Metres; walls and obstacles that are thinner may be faults of a drawing."""

LEAST_ROOM = 0.5
"""Square metres; smaller pieces of floor are not named."""

NARROWER = 0.1
"""Metres by which the floor before an exit may be narrower than the exit."""

MOST = 50
"""Places of each kind that are named."""


class Oddity(NamedTuple):
    """Something odd: which kind it is, a sentence, and its place (x, y) in metres."""

    kind: str
    text: str
    place: tuple[float, float]


def oddities_of(plan: Floor, no_doors: Collection[str] = ()) -> list[Oddity]:
    """The oddities of a floor plan for an evacuation, at most 50 places of each kind.

    The kinds are "narrow door", "exit wider than its floor", "no way out", "no way out for
    wheelchairs", "dead end" (see ``dead_ends_of``), "gap" and "thin wall".

    Args:
        plan: the floor plan. Gates and exits that are closed count as open.
        no_doors: names of exits that are no doors, such as ends of stairs.

    Examples:
        >>> from mesa_mobility import Exit, FloorPlan
        >>> from mesa_mobility.floorplan import oddities_of
        >>> plan = FloorPlan(
        ...     "POLYGON ((0 0, 6 0, 6 4, 0 4, 0 0))", exits=[Exit("door", (6, 1), (6, 1.7))]
        ... )
        >>> [each.kind for each in oddities_of(plan)]
        ['narrow door', 'no way out for wheelchairs']
    """
    free = shapely.union_all([plan.free])
    found: list[Oddity] = []
    for each in (
        _narrow_doors(plan, no_doors),
        _wide_exits(plan, free, no_doors),
        _traps(plan, free),
        _dead_ends(plan),
        _gaps(free),
        _thin_walls(free),
    ):
        own = list(each)
        found += own[:MOST]
    return found


def _narrow_doors(plan: Floor, no_doors: Collection[str]) -> Iterator[Oddity]:
    for opening in plan.openings():
        if opening.length < WHEELCHAIR - 1e-6 and opening.name not in no_doors:
            passed = "nobody passes" if opening.length < ADULT else "wheelchairs need"
            need = "" if opening.length < ADULT else f" {WHEELCHAIR:.2f} m"
            text = f"{opening.kind} {opening.name} is {opening.length:.2f} m wide: {passed}{need}"
            yield Oddity("narrow door", text, opening.midpoint)


def _wide_exits(plan: Floor, free: BaseGeometry, no_doors: Collection[str]) -> Iterator[Oddity]:
    """Exits with less floor before them than they are wide."""
    for each in (own for own in plan.exits if own.name not in no_doors):
        a, b = np.array(each.a), np.array(each.b)
        open_m = max(
            sum(part.length for part in edge.open_parts(free)) for edge in (Edge(a, b), Edge(b, a))
        )
        if open_m < each.length - NARROWER:
            text = f"exit {each.name} is {each.length:.2f} m wide, the floor before it {open_m:.2f}"
            yield Oddity("exit wider than its floor", text + " m", each.midpoint)


def _traps(plan: Floor, free: BaseGeometry) -> Iterator[Oddity]:
    """Pieces of floor from which adults, or people in wheelchairs, come to no exit."""
    if not plan.exits:
        return
    lost: list[Polygon] = []
    for kind, width, who in (
        ("no way out", ADULT, "an adult"),
        ("no way out for wheelchairs", WHEELCHAIR, "a wheelchair"),
    ):
        half = width / 2 - 1e-3
        _, cut_off = pieces_of(plan, free, half, plan.exits, Polygon())
        for piece in sorted(_polygons(cut_off), key=lambda each: -each.area):
            room = piece.buffer(half).intersection(free)
            known = any(room.intersection(each).area > room.area / 2 for each in lost)
            if room.area >= LEAST_ROOM and not known:
                lost.append(room)
                text = f"{room.area:.1f} m² from which {who} comes to no exit"
                yield Oddity(kind, text, _spot(piece))


def _dead_ends(plan: Floor) -> Iterator[Oddity]:
    for each in dead_ends_of(plan):
        text = f"a corridor {each.width:.1f} m wide leads nowhere for {each.length:.1f} m"
        yield Oddity("dead end", text, each.place)


def _gaps(free: BaseGeometry) -> Iterator[Oddity]:
    """Floor in which nobody can stand or walk."""
    half = GAP / 2
    kept = free.buffer(-half, join_style="mitre").buffer(half + 1e-4, join_style="mitre")
    for part in sorted(_polygons(free.difference(kept)), key=lambda each: -each.area):
        length = max(np.ptp(shapely.get_coordinates(part), axis=0))
        if length >= LEAST_GAP and part.area > 1e-3:
            text = (
                f"a gap {width_of(part):.2f} m wide and {length:.1f} m long, too narrow to walk in"
            )
            yield Oddity("gap", text, _spot(part))


def _thin_walls(free: BaseGeometry) -> Iterator[Oddity]:
    """Strips between floor that are too thin for a wall."""
    half = CRACK / 2
    closed = free.buffer(half, join_style="mitre").buffer(-half - 1e-4, join_style="mitre")
    for part in sorted(_polygons(closed.difference(free)), key=lambda each: -each.area):
        length = max(np.ptp(shapely.get_coordinates(part), axis=0))
        if length >= LEAST_GAP and width_of(part) > 1e-3:
            text = f"floor is parted by {width_of(part):.3f} m for {length:.1f} m"
            yield Oddity("thin wall", text, _spot(part))


def _spot(part: Polygon) -> tuple[float, float]:
    spot = part.representative_point()
    return float(spot.x), float(spot.y)


def _polygons(area: BaseGeometry) -> list[Polygon]:
    parts = shapely.get_parts(area)
    return [part for part in parts if isinstance(part, Polygon) and not part.is_empty]
