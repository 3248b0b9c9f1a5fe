"""Stairs from the level faces of their body: straight ones, and those that turn."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from mesa_mobility.floorplan.formats.ifc.records import Step

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

USUAL_RISER = 0.175
"""Metres, where stairs do not say how many risers they have."""

WELL = 0.1
"""Least metres between the flights of stairs that turn."""


@dataclass(frozen=True)
class Way:
    """Stairs as a building takes them; metres.

    Attributes:
        head: (2, 2) the upper edge, its left end first as seen by somebody who walks down.
        risers: number of all risers.
        tread: depth of a tread.
        given: further properties of a feature of stairs, such as ``turn``.
        guessed: what is only like the stairs of the file, for a note; or nothing.
    """

    head: NDArray[np.float64]
    risers: int
    tread: float
    given: dict[str, object]
    guessed: str = ""

    @property
    def width(self) -> float:
        """Clear width, metres."""
        return float(np.hypot(*(self.head[1] - self.head[0])))

    @property
    def along(self) -> NDArray[np.float64]:
        """(2,) direction along the upper edge, to the right of somebody who walks down."""
        found: NDArray[np.float64] = (self.head[1] - self.head[0]) / self.width
        return found

    def ends(self) -> list[tuple[NDArray[np.float64], NDArray[np.float64]]]:
        """(2,) middles of the upper and the lower edge, each with the direction away from it."""
        along, middle = self.along, self.head.mean(axis=0)
        down = np.array([-along[1], along[0]])
        if self.given.get("type") != "dog_leg":
            return [(middle, -down), (middle + (self.risers - 1) * self.tread * down, down)]
        side = -1.0 if self.given["turn"] == "left" else 1.0
        aside = side * (float(self.given["well"]) + self.width)  # type: ignore[arg-type]
        # Of an odd number of risers the lower flight has one more.
        longer = self.risers % 2 * self.tread
        return [(middle, -down), (middle + aside * along - longer * down, -down)]

    def between(self, low: float, high: float) -> "Way":
        """The same as narrow as from ``low`` to ``high`` metres along the upper edge, measured from
        its middle."""
        middle, given = self.head.mean(axis=0), dict(self.given)
        if "well" in given:
            given["well"] = float(given["well"]) + self.width - (high - low)  # type: ignore[arg-type]
        head = np.array([middle + low * self.along, middle + high * self.along])
        return replace(self, head=head, given=given)


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
    spots = np.array([shapely.get_coordinates(each.area.centroid)[0] for each in own])
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


def _head(up: NDArray[np.float64], edge: float, middle: float, width: float) -> NDArray[np.float64]:
    """The upper edge: ``edge`` metres along ``up``, around ``middle`` metres aside of it."""
    right_down = np.array([-up[1], up[0]])  # the right of somebody who walks down
    centre = edge * up + middle * right_down
    return np.array([centre - width / 2 * right_down, centre + width / 2 * right_down])


def _straight(
    steps: Sequence[Step], whole: BaseGeometry, up: NDArray[np.float64], risers: int
) -> Way:
    up = _squared(whole, up)
    aside = np.array([-up[1], up[0]])
    width = _width(steps, aside)
    low, high = _extent(whole, up)
    middle = float(np.mean([np.mean(_extent(each.area, aside)) for each in steps]))
    tread = (high - low) / (risers - 1)
    clipped = float(np.clip(tread, *TREADS))
    guessed = "" if abs(clipped - tread) < 0.005 else f"treads of {clipped:.2f} m"
    return Way(_head(up, high, middle, width), risers, clipped, {}, guessed)


def _squared(whole: BaseGeometry, up: NDArray[np.float64]) -> NDArray[np.float64]:
    """The side of the smallest rectangle around stairs that is nearest to their direction."""
    corners = shapely.get_coordinates(shapely.oriented_envelope(whole))
    sides = corners[1:3] - corners[:2]
    sides = sides / np.maximum(np.hypot(*sides.T), 1e-9)[:, None]
    sides = np.concatenate([sides, -sides])
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
    landing = max(width, 0.6) if not back else _landing(steps, up, width)
    tread = float(np.clip((high - low - landing) / max(risers - count - 1, 1), *TREADS))
    given: dict[str, object] = {
        "type": "dog_leg",
        # The lower flight is on the other side; the left of who walks down is at -aside.
        "turn": "left" if side > 0 else "right",
        "well": max(across - 2 * width, WELL),
        "landing": landing,
    }
    if not back:
        said = "two flights side by side"
    elif abs(risers - 2 * count) or not _even(spots, last):
        said = "two flights of half the risers each"
    else:
        said = ""
    return Way(_head(up, high, middle, width), risers, tread, given, said)


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
    return depth if depth >= 0.6 else max(width, 0.6)


def _even(spots: NDArray[np.float64], last: NDArray[np.float64]) -> bool:
    """Whether as many steps lead one way as the other."""
    ways = np.diff(spots, axis=0) @ last
    return abs(int((ways > 0.1).sum()) - int((ways < -0.1).sum())) <= 1
