"""Stairs and lifts of an indoor map, which says where they are and little more."""

from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from mesa_mobility.floorplan.formats.assembling.boxes import box_around
from mesa_mobility.floorplan.formats.indoor.shapes import (
    DOORWAY,
    LIFT,
    PASSAGE,
    ROOM,
    STAIRS,
    STEPS,
    Shape,
)
from mesa_mobility.floorplan.formats.storeys import Link

RISER = 0.17
"""Height of a riser, metres, where stairs do not say how many they have."""

TREADS = 0.20, 0.60
"""Least and greatest depth of a tread, metres."""

BEFORE = 0.8
"""Metres of floor before each end of stairs that are drawn as a room."""

BESIDE = 0.1
"""Metres from the wall of a room to the stairs in it."""

LEAST_WIDTH = 0.6
"""Metres; narrower stairs are left out."""

LEAST_SHARED = 0.3
"""Share of the smaller one that two drawings of the same stairs have in common."""

REACH = 0.4
"""Metres within which a door or a room is beside stairs or a lift."""

LEAST_LIFT = 0.95
"""Metres; smaller shafts hold no car."""


def links_of(
    shapes: Sequence[Shape], numbers: Mapping[str, int], height: float, notes: list[str]
) -> list[Link]:
    """The stairs and lifts that join the levels.

    Args:
        shapes: all features, in metres.
        numbers: of the levels by their names, from the lowest.
        height: metres from one level to the next.
        notes: takes what was guessed and left out.
    """
    links: list[Link] = []
    for lower, upper in pairwise(numbers):
        rise = (numbers[upper] - numbers[lower]) * height
        ends = numbers[upper], numbers[lower]
        for number, (area, title) in enumerate(_pairs(shapes, STAIRS, lower, upper), start=1):
            name = _free(title or f"stairs {number}", ends, links)
            doors = [_beside(shapes, area, level) for level in (upper, lower)]
            link = _in_room(area, doors, rise, ends, name)
            if isinstance(link, Link):
                links.append(link)
            else:
                notes.append(f"left out {name}: {link}")
        for shape in shapes:
            if shape.kind == STEPS and {lower, upper} <= set(shape.levels):
                links.append(_along(shape, rise, ends, _free(shape.name or "steps", ends, links)))
    return links + _lifts(shapes, numbers, links, notes)


def _pairs(
    shapes: Sequence[Shape], kind: str, lower: str, upper: str
) -> list[tuple[BaseGeometry, str]]:
    """The parts that areas of a kind on two levels have in common, with the names of these."""
    below, above = (
        [each for each in shapes if each.kind == kind and level in each.levels]
        for level in (lower, upper)
    )
    if not below or not above:
        return []
    tree = shapely.STRtree([each.geometry for each in above])
    found, used = [], set[int]()
    for one in below:
        for k in tree.query(one.geometry, predicate="intersects").tolist():
            other = above[k]
            shared = one.geometry.intersection(other.geometry)
            least = min(one.geometry.area, other.geometry.area)
            if k not in used and shared.area >= LEAST_SHARED * least > 0:
                used.add(k)
                found.append((shared, one.name or other.name))
                break
    return found


def _free(name: str, ends: tuple[int, int], links: Sequence[Link]) -> str:
    """A name that no other link has."""
    taken = {each.name for each in links}
    found, number = (f"{name} to {ends[0]}" if name in taken else name), 1
    while found in taken:
        number += 1
        found = f"{name} to {ends[0]} ({number})"
    return found


def _beside(shapes: Sequence[Shape], area: BaseGeometry, level: str) -> NDArray[np.float64] | None:
    """(2,) the middle of the doors, or otherwise of the rooms, beside an area on a level."""
    near = area.buffer(REACH)
    for kinds in ((DOORWAY,), (PASSAGE, ROOM)):
        spots = [
            each.geometry.intersection(near).centroid
            for each in shapes
            if each.kind in kinds
            and (not each.levels or level in each.levels)
            and each.geometry.intersects(near)
        ]
        spots = [each for each in spots if not each.is_empty]
        if spots:
            middle: NDArray[np.float64] = shapely.get_coordinates(spots).mean(axis=0)
            return middle
    return None


def _in_room(
    area: BaseGeometry,
    doors: Sequence[NDArray[np.float64] | None],
    rise: float,
    ends: tuple[int, int],
    name: str,
) -> Link | str:
    """Stairs in a room: straight where it is left at opposite ends, otherwise two flights side by
    side; or what is wrong with them.

    Args:
        area: of the room.
        doors: places where it is left on the upper and the lower level.
        rise: metres.
        ends: numbers of the levels.
        name: of the stairs.
    """
    if doors[0] is None or doors[1] is None:
        return "nothing leads to it on one of its levels"
    box = box_around(area)
    if box is None or box.lengths.min() < LEAST_WIDTH:
        return "its area is too small"
    axis = int(np.argmax(box.lengths))
    along, length, breadth = box.along[axis], box.lengths[axis], box.lengths[1 - axis]
    middle = box.centre
    top, bottom = ((each - middle) @ along for each in doors if each is not None)
    up = along if top >= 0 else -along
    aside = np.array([-up[1], up[0]])  # the right of somebody who walks down
    risers = max(round(rise / RISER), 4)
    if top * bottom < 0 or breadth < 2 * LEAST_WIDTH + 3 * BESIDE:
        width = breadth - 2 * BESIDE
        tread = (length - 2 * BEFORE) / (risers - 1)
        if tread < TREADS[0]:
            return f"{length:.2f} m are too short for stairs {rise:g} m high"
        tread = min(tread, TREADS[1])
        head, given = middle + (risers - 1) * tread / 2 * up, {}
    else:
        width = (breadth - 3 * BESIDE) / 2
        landing = max(min(width, 1.5), LEAST_WIDTH)
        upper = risers // 2
        tread = min((length - BEFORE - landing - BESIDE) / (risers - upper - 1), 0.3)
        if tread < TREADS[0]:
            return f"{length:.2f} m are too short for two flights {rise:g} m high"
        head = middle + (length / 2 - BEFORE) * up + (width + BESIDE) / 2 * aside
        given = {"type": "dog_leg", "turn": "left", "well": BESIDE, "landing": landing}
    line = np.round([head - width / 2 * aside, head + width / 2 * aside], 4).tolist()
    given = {"risers": risers, "tread": round(float(tread), 4), **given}
    return Link("stairs", name, (tuple(line[0]), tuple(line[1])), ends, given)


def _along(shape: Shape, rise: float, ends: tuple[int, int], name: str) -> Link:
    """Straight stairs along a line."""
    xy = shapely.get_coordinates(shape.geometry)
    bottom, top = (xy[0], xy[-1]) if shape.up else (xy[-1], xy[0])
    length = max(float(np.hypot(*(top - bottom))), 1e-6)
    up = (top - bottom) / length
    aside = np.array([-up[1], up[0]]) * shape.width / 2
    risers = shape.steps if shape.steps >= 4 else max(round(rise / RISER), 4)
    line = np.round([top - aside, top + aside], 4).tolist()
    given = {"risers": risers, "tread": round(length / (risers - 1), 4)}
    return Link("stairs", name, (tuple(line[0]), tuple(line[1])), ends, given)


def _lifts(
    shapes: Sequence[Shape], numbers: Mapping[str, int], links: Sequence[Link], notes: list[str]
) -> list[Link]:
    """Lifts: shafts that lie above each other on several levels."""
    found: list[Link] = []
    left = [each for each in shapes if each.kind == LIFT]
    while left:
        first = left.pop(0)
        own = [first]
        for each in list(left):
            shared = each.geometry.intersection(first.geometry).area
            if shared >= LEAST_SHARED * min(each.geometry.area, first.geometry.area) > 0:
                own.append(each)
                left.remove(each)
        levels = [name for name in numbers if any(name in each.levels for each in own)]
        name = _free(first.name or "lift", (len(found), 0), [*links, *found])
        if len(levels) < 2:
            notes.append(f"left out {name}: it is on one level alone")
            continue
        door = _beside(shapes, first.geometry, levels[0])
        link = _lift(first.geometry, door, tuple(numbers[each] for each in levels), name)
        if isinstance(link, Link):
            found.append(link)
        else:
            notes.append(f"left out {name}: {link}")
    return found


def _lift(
    area: BaseGeometry, door: NDArray[np.float64] | None, levels: tuple[int, ...], name: str
) -> Link | str:
    """A lift whose door is in the side of its shaft that is nearest to a door or a room."""
    if door is None:
        return "nothing leads to it"
    box = box_around(area)
    if box is None or box.lengths.min() < LEAST_LIFT:
        return "its shaft is too small"
    sides = np.roll(box.corners, -1, axis=0) - box.corners
    middles = box.corners + sides / 2
    k = int(np.argmin(np.hypot(*(middles - door).T)))
    width, depth = float(box.lengths[k % 2]), float(box.lengths[(k + 1) % 2])
    car = min(width - 2 * BESIDE, 3.0)
    half = min(car, 0.9) / 2 * sides[k] / width
    # The floor of the shaft is on the left of its sides.
    line = np.round([middles[k] - half, middles[k] + half], 4).tolist()
    given = {"width": round(car, 3), "depth": round(min(depth - 2 * BESIDE, 3.0), 3)}
    return Link("lift", name, (tuple(line[0]), tuple(line[1])), levels, given)
