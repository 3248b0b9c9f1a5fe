"""Stairs and ramps between the storeys of a building model, with floor before their ends."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import Polygon
from shapely.geometry.base import BaseGeometry

from mesa_mobility.floorplan.formats.assembling.boxes import box_around
from mesa_mobility.floorplan.formats.ifc.drafts import Draft
from mesa_mobility.floorplan.formats.ifc.flights import way_of
from mesa_mobility.floorplan.formats.ifc.records import Element, Model
from mesa_mobility.floorplan.formats.ifc.way import End, Way
from mesa_mobility.floorplan.formats.storeys import Link

NEAR = 0.6
"""Metres by which stairs may end above or below a floor to which they lead."""

BEFORE = 0.55
"""Metres of floor that are needed before either end of stairs."""

INTO = 0.01
"""Metres by which that floor reaches below the stairs."""

MORE = 0.002
"""Metres by which that floor is larger than needed, so that nothing is missing by rounding."""

CLEAR = 1e-3
"""Metres between the ends of stairs and what is in the way before them."""

LEAST_PART = 1e-6
"""Square metres of floor that may be missing."""

LEAST_WIDTH = 0.6
"""Metres; narrower stairs are left out."""

AROUND = 0.4
"""Metres beside and beyond stairs that are taken from the floor."""


@dataclass(frozen=True)
class Join:
    """Stairs or a ramp between two storeys: the link, the floor before its ends by the number of
    the level, and what it takes of both floors."""

    link: Link
    before: dict[int, Polygon]
    taken: BaseGeometry
    guessed: str = ""


def joins_of(model: Model, drafts: Sequence[Draft], notes: list[str]) -> list[Join]:
    """The stairs and ramps between storeys, each with a name of its own.

    Args:
        model: the building.
        drafts: its storeys from the lowest. Floor is put before ends of stairs where none is.
        notes: takes what was guessed and left out.
    """
    joins: list[Join] = []
    for element in model.of("stairs", "ramp"):
        what = f"{element.kind} {_name_of(element)}"
        found = False
        for lower, upper in pairwise(drafts):
            if not _between(element, lower, upper):
                continue
            name = _free(_name_of(element), joins, upper)
            found = True
            join = (
                _stairs(element, lower, upper, name)
                if element.kind == "stairs"
                else _ramp(element, lower, upper, name)
            )
            if isinstance(join, Join):
                joins.append(join)
                if join.guessed:
                    notes.append(f"{element.kind} {name} are taken as {join.guessed}")
            else:
                notes.append(f"left out {what}: {join}")
        if not found:
            notes.append(
                f"left out {what}: it leads from {element.bottom:.2f} to {element.top:.2f} m, and "
                "no two floors are there"
            )
    return joins


def _between(element: Element, lower: Draft, upper: Draft) -> bool:
    bottom, top = element.bottom, element.top
    if element.steps:
        bottom = min(each.height for each in element.steps)
        top = max(each.height for each in element.steps)
    return bottom < lower.elevation + NEAR and top > upper.elevation - NEAR


def _name_of(element: Element) -> str:
    parts = element.name.split(":")
    return parts[-1] if len(parts) > 1 else element.name or str(element.key)


def _free(name: str, joins: Sequence[Join], upper: Draft) -> str:
    """A name that no other stairs have."""
    taken = [each.link.name for each in joins]
    if name in taken:
        name = f"{name} to {upper.number}"
    number, found = 1, name
    while found in taken:
        number += 1
        found = f"{name} ({number})"
    return found


def _stairs(element: Element, lower: Draft, upper: Draft, name: str) -> Join | str:
    """The stairs between two storeys, or what is wrong with them."""
    way = way_of(element.steps, lower.elevation, upper.elevation, element.risers)
    if way is None:
        return "its steps cannot be made out"
    narrower = _with_floor(way, lower, upper)
    if isinstance(narrower, str):
        return narrower
    way = narrower
    before = {
        draft.number: _strip(end, way.width)
        for draft, end in zip((upper, lower), way.ends(), strict=True)
    }
    corners = [*way.head, *(shapely.get_coordinates(each) for each in before.values())]
    taken = shapely.union_all([shapely.MultiPoint(np.vstack(corners)), element.area])
    link = Link("stairs", name, _line(way.head), (upper.number, lower.number), way.given)
    return Join(link, before, taken.convex_hull.buffer(AROUND), way.guessed)


def _with_floor(way: Way, lower: Draft, upper: Draft) -> Way | str:
    """The stairs, as wide as the floor before both their ends, or what is wrong with them.

    Floor is put where holes of slabs, or missing rooms, leave none.
    """
    upper_free, lower_free = (
        _blocked(draft, end, way.width)
        for draft, end in zip((upper, lower), way.ends(), strict=True)
    )
    if max(sum(upper_free), sum(lower_free)) == 0.0:
        return way
    narrow = way.width - max(sum(upper_free), sum(lower_free))
    if narrow >= LEAST_WIDTH:
        narrower = way.narrowed(upper_free, lower_free)
        narrow = narrower.width
        if narrow >= LEAST_WIDTH:
            ends = zip((upper, lower), narrower.ends(), strict=True)
            left = max(sum(_blocked(draft, end, narrow)) for draft, end in ends)
            if left < 2 * CLEAR:
                return narrower
            narrow -= left
    return f"only {max(narrow, 0.0):.2f} m of floor are before both its ends"


def _blocked(draft: Draft, end: End, width: float) -> tuple[float, float]:
    """Metres on the left and the right of an end before which there is no floor.

    Floor is put there first, where no wall stands.
    """
    before = _strip(end, width)
    draft.passages.append(before.buffer(MORE, join_style="mitre").difference(draft.walls))
    sides = [0.0, 0.0]
    for part in shapely.get_parts(before.difference(draft.floor())):
        if part.area > LEAST_PART:
            at = (shapely.get_coordinates(part) - end.middle) @ end.across
            # It is at one side, as a rule.
            k, much = (1, width / 2 - at.min()) if at.mean() > 0 else (0, width / 2 + at.max())
            sides[k] = max(sides[k], float(much) + CLEAR)
    return sides[0], sides[1]


def _strip(end: End, width: float) -> Polygon:
    """The floor before an end of stairs."""
    half, near, far = width / 2 * end.across, -INTO * end.away, BEFORE * end.away
    left, right = end.middle - half, end.middle + half
    return Polygon([left + near, right + near, right + far, left + far])


def _ramp(element: Element, lower: Draft, upper: Draft, name: str) -> Join | str:
    """A straight ramp along the longer side of its area; it is highest where the upper floor is
    nearer."""
    if element.area.is_empty:
        return "it has no body"
    box = box_around(element.area)
    if box is None:
        return "it has no width"
    corners = np.roll(box.corners, -int(box.lengths[0] > box.lengths[1]), axis=0)
    ends = [corners[:2], corners[2:]]
    away = [shapely.LineString(each).distance(upper.open) for each in ends]
    head = ends[int(np.argmin(away))]
    (bx, by), (ix, iy) = head[1] - head[0], corners.mean(axis=0) - head.mean(axis=0)
    if bx * iy - by * ix < 0:
        head = head[::-1]
    whole = Way(head, 2, float(box.lengths.max()), guessed="straight")
    ramp = _with_floor(whole, lower, upper)
    if isinstance(ramp, str):
        return ramp
    before = {
        draft.number: _strip(end, ramp.width)
        for draft, end in zip((upper, lower), ramp.ends(), strict=True)
    }
    given: dict[str, object] = {"length": ramp.tread}
    link = Link("ramp", name, _line(ramp.head), (upper.number, lower.number), given)
    return Join(link, before, element.area.buffer(AROUND), ramp.guessed)


def _line(head: NDArray[np.float64]) -> tuple[tuple[float, float], tuple[float, float]]:
    (ax, ay), (bx, by) = np.round(head, 4).tolist()
    return (ax, ay), (bx, by)
