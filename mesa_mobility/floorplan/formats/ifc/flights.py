"""Stairs from the level faces of their body: straight ones, with landings, and those that turn."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from mesa_mobility.floorplan.formats.assembling.boxes import box_around
from mesa_mobility.floorplan.formats.ifc.records import Step
from mesa_mobility.floorplan.formats.ifc.way import LEFT, ON, RIGHT, Way

SAME = 0.02
"""Metres between the heights of faces of one step."""

LEAST_TREAD = 0.03
"""Square metres; smaller faces are no steps."""

STRAIGHT = 0.2
"""Metres by which the middles of the steps of a straight flight lie off its line."""

RISERS = 0.10, 0.22
"""Least and greatest height of a riser, metres."""

TREADS = 0.20, 0.60
"""Least and greatest depth of a tread, metres."""

EVEN = 0.005
"""Metres by which treads of one depth differ."""

LEAST_LANDING = 0.6
"""Least depth of a landing, metres."""

USUAL_RISER = 0.175
"""Metres, where stairs do not say how many risers they have."""

WELL = 0.1
"""Least metres between the flights of stairs that turn."""

LANDING = 1.8
"""How much larger than a usual step a landing is, at least."""

LEAST_RISERS = 3
"""Risers of one of several flights."""

RIGHT_ANGLE = 0.05
"""The most that the cosine of a right angle is off 0."""

ASTRAY = 0.15, 0.5
"""Metres by which the lower end of several flights lies off that of the file: where this is said,
and where they are not taken."""


def way_of(steps: Sequence[Step], bottom: float, top: float, given: int | None) -> Way | None:
    """Stairs from one floor up to the next.

    Args:
        steps: the level faces of their body.
        bottom: height of the lower floor, metres.
        top: height of the upper floor, metres.
        given: number of risers, if known.

    Returns:
        the stairs; None where faces are too few to tell.
    """
    risers = _risers(steps, bottom, top, given)
    own = _merged([each for each in steps if bottom + SAME < each.height < top - SAME])
    if len(own) < 3 or risers is None:
        return None
    several = _several(own, bottom, top, risers)
    if several is not None:
        return several
    spots = _middles(own)
    whole = shapely.union_all([each.area for each in own])
    way = spots[-1] - spots[0]
    up = way / max(float(np.hypot(*way)), 1e-9)
    aside = (spots - spots[0]) @ np.array([-up[1], up[0]])
    if np.hypot(*way) > 0.5 and np.ptp(aside) < STRAIGHT:
        return _straight(own, whole, up, risers)
    return _turning(own, spots, whole, risers)


def _risers(steps: Sequence[Step], bottom: float, top: float, given: int | None) -> int | None:
    rise = top - bottom
    heights = np.unique([each.height for each in steps if each.area.area >= LEAST_TREAD])
    gaps = np.diff(heights[(heights > bottom - SAME) & (heights < top + SAME)])
    gaps = gaps[gaps > RISERS[0] - SAME]
    measured = round(rise / float(np.median(gaps))) if len(gaps) else 0
    for count in (given or 0, measured, round(rise / USUAL_RISER)):
        if count >= 4 and RISERS[0] <= rise / count <= RISERS[1]:
            return count
    return None


def _merged(steps: Sequence[Step]) -> list[Step]:
    """Steps from the lowest, the faces of one height together, without small ones."""
    found: list[Step] = []
    for each in sorted(steps, key=lambda step: step.height):
        if found and each.height - found[-1].height <= SAME:
            area = shapely.union_all([found[-1].area, each.area])
            found[-1] = Step(found[-1].height, area)
        else:
            found.append(each)
    sizes = [each.area.area for each in found]
    least = max(LEAST_TREAD, 0.3 * float(np.median(sizes))) if sizes else 0.0
    return [each for each in found if each.area.area >= least]


def _extent(area: BaseGeometry, direction: NDArray[np.float64]) -> tuple[float, float]:
    at = shapely.get_coordinates(area) @ direction
    return float(at.min()), float(at.max())


def _width(steps: Sequence[Step], aside: NDArray[np.float64]) -> float:
    return float(np.median([np.ptp(_extent(each.area, aside)) for each in steps]))


def _middles(steps: Sequence[Step]) -> NDArray[np.float64]:
    """(n, 2) the middle of each step."""
    return np.array([shapely.get_coordinates(each.area.centroid)[0] for each in steps])


def _head_of(steps: Sequence[Step], up: NDArray[np.float64]) -> NDArray[np.float64]:
    """The upper edge of a straight flight."""
    aside = np.array([-up[1], up[0]])
    edge = max(_extent(each.area, up)[1] for each in steps)
    middle = float(np.mean([np.mean(_extent(each.area, aside)) for each in steps]))
    return _head(up, edge, middle, _width(steps, aside))


def _head(up: NDArray[np.float64], edge: float, middle: float, width: float) -> NDArray[np.float64]:
    """The upper edge: ``edge`` metres along ``up``, around ``middle`` metres aside of it."""
    right_down = np.array([-up[1], up[0]])  # the right of somebody who walks down
    centre = edge * up + middle * right_down
    return np.array([centre - width / 2 * right_down, centre + width / 2 * right_down])


def _straight(
    steps: Sequence[Step], whole: BaseGeometry, up: NDArray[np.float64], risers: int
) -> Way:
    up = _squared(whole, up)
    low, high = _extent(whole, up)
    tread, guessed = _tread([(high - low) / (risers - 1)])
    return Way(_head_of(steps, up), risers, tread, guessed=guessed)


def _several(steps: Sequence[Step], bottom: float, top: float, risers: int) -> Way | None:
    """Flights with landings between, on which the way goes on or turns by a right angle; None for
    other stairs."""
    usual = float(np.median([each.area.area for each in steps]))
    at = [k for k, each in enumerate(steps) if each.area.area > LANDING * usual]
    runs = [steps[a + 1 : b] for a, b in pairwise([-1, *at, len(steps)])]
    if not at or min(len(run) for run in runs) < LEAST_RISERS - 1:
        return None
    heights = np.array([bottom, *(steps[k].height for k in at), top])
    exact = np.diff(heights) / ((top - bottom) / risers)
    counts = [round(each) for each in exact.tolist()]
    if sum(counts) != risers or min(counts) < LEAST_RISERS or np.ptp(exact - counts) > 0.5:
        return None
    if not all(len(run) < 3 or _in_line(_middles(run)) for run in runs):
        return None
    areas = [shapely.union_all([each.area for each in run]) for run in runs]
    ups = [_squared(area, _run(_middles(run), 1)) for area, run in zip(areas, runs, strict=True)]
    turns = [_turn(-above, -below) for below, above in pairwise(ups)]
    if not all(turns):
        return None
    ends = [_extent(area, up) for area, up in zip(areas, ups, strict=True)]
    tread, guessed = _tread(
        [(high - low) / (count - 1) for (low, high), count in zip(ends, counts, strict=True)]
    )
    deep = [ends[k + 1][0] - ends[k][1] for k, turn in enumerate(turns) if turn == ON]
    way = Way(
        _head_of(runs[-1], ups[-1]),
        risers,
        tread,
        landing=float(np.mean(deep)) if deep else None,
        flights=tuple(counts[::-1]),
        turns=tuple(turns[::-1]),
        guessed=guessed,
    )
    foot = _head_of(runs[0], ups[0]).mean(axis=0) - (ends[0][1] - ends[0][0]) * ups[0]
    astray = float(np.hypot(*(way.ends()[1].middle - foot)))
    if astray > ASTRAY[1] or (deep and min(deep) < LEAST_LANDING):
        return None
    if astray > ASTRAY[0]:
        way = replace(way, guessed=f"flights whose lower end is {astray:.1f} m off")
    return way


def _turn(first: NDArray[np.float64], second: NDArray[np.float64]) -> str:
    """The way on from one direction to another; nothing where it is at no right angle."""
    (ax, ay), (bx, by) = first, second
    cosine, sine = ax * bx + ay * by, ax * by - ay * bx
    if abs(cosine) < RIGHT_ANGLE:
        return LEFT if sine > 0 else RIGHT
    return ON if cosine > 1 - RIGHT_ANGLE else ""


def _tread(measured: Sequence[float]) -> tuple[float, str]:
    """One depth of a tread for those measured in several flights, and a note if it is none."""
    tread = float(np.clip(np.median(measured), *TREADS))
    even = max(abs(each - tread) for each in measured) < EVEN
    return tread, "" if even else f"treads of {tread:.2f} m"


def _squared(whole: BaseGeometry, up: NDArray[np.float64]) -> NDArray[np.float64]:
    """The side of the smallest rectangle around stairs that is nearest to their direction."""
    box = box_around(whole)
    if box is None:
        return up
    sides = np.concatenate([box.along, -box.along])
    best: NDArray[np.float64] = sides[int(np.argmax(sides @ up))]
    return best if best @ up > 0.98 else up


def _turning(
    steps: Sequence[Step], spots: NDArray[np.float64], whole: BaseGeometry, risers: int
) -> Way:
    """Two flights side by side for stairs that turn, in place and as wide as can be."""
    first, last = _run(spots, 1), _run(spots, -1)
    half = len(spots) // 2
    back = bool(first @ last < -0.9) and _in_line(spots[:half]) and _in_line(spots[-half:])
    if back:
        up = _squared(whole, last)
    else:
        centre = shapely.get_coordinates(whole.centroid)[0]
        ends = (spots[0] + spots[-1]) / 2 - centre
        up = ends / max(float(np.hypot(*ends)), 1e-9)
    aside = np.array([-up[1], up[0]])
    side = float(np.sign((spots[-1] - spots[0]) @ aside)) or 1.0
    near, far = _extent(whole, aside)
    across = far - near
    width = _width(steps[-3:], aside) if back else across
    width = min(width, (across - WELL) / 2)
    middle = (far - width / 2) if side > 0 else (near + width / 2)
    low, high = _extent(whole, up)
    count = risers // 2
    landing = max(width, LEAST_LANDING) if not back else _landing(steps, up, width)
    tread = float(np.clip((high - low - landing) / max(risers - count - 1, 1), *TREADS))
    if not back:
        said = "two flights side by side"
    elif abs(risers - 2 * count) or not _even(spots, last):
        said = "two flights of half the risers each"
    else:
        said = ""
    return Way(
        _head(up, high, middle, width),
        risers,
        tread,
        # The lower flight is on the other side; the left of who walks down is at -aside.
        turn=LEFT if side > 0 else RIGHT,
        well=max(across - 2 * width, WELL),
        landing=landing,
        guessed=said,
    )


def _in_line(spots: NDArray[np.float64]) -> bool:
    """Whether all but one of the middles of steps are on a line: one may be a landing's."""
    if len(spots) < 3:
        return False
    ways = np.diff(spots, axis=0)
    ways = ways / np.maximum(np.hypot(*ways.T), 1e-9)[:, None]
    return bool(((ways @ np.median(ways, axis=0)) > 0.95).sum() >= len(ways) - 1)


def _run(spots: NDArray[np.float64], sign: int) -> NDArray[np.float64]:
    """(2,) the upward direction of the first steps, or with ``sign`` -1 of the last."""
    ordered = spots if sign > 0 else spots[::-1]
    ahead = sign * (ordered[min(2, len(spots) - 1)] - ordered[0])
    found: NDArray[np.float64] = ahead / max(float(np.hypot(*ahead)), 1e-9)
    return found


def _landing(steps: Sequence[Step], up: NDArray[np.float64], width: float) -> float:
    """Depth of the largest step, if it is a landing."""
    largest = max(steps, key=lambda each: each.area.area)
    depth = float(np.ptp(_extent(largest.area, up)))
    return depth if depth >= LEAST_LANDING else max(width, LEAST_LANDING)


def _even(spots: NDArray[np.float64], last: NDArray[np.float64]) -> bool:
    """Whether as many steps lead one way as the other."""
    ways = np.diff(spots, axis=0) @ last
    return abs(int((ways > 0.1).sum()) - int((ways < -0.1).sum())) <= 1
