"""Keeping away from hazards that grow, and going round them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from mesa_mobility import Deciding, FloorPlan, ListOf, Range, TargetChoice, Targets, check_fields
from mesa_mobility.errors import FloorPlanError, ModelError
from mesa_mobility.floorplan import lines_of_sight
from mesa_mobility.schema import Kind, Several, Whole

# Metres by which an area grows until ways round it are searched for anew, and metres between the
# places at its edge to which people in it may walk.
_STEP = 0.5

# Metres beyond the edge at which somebody is out of it.
_BEYOND = 0.3

# Sides of a quarter of a circle. Those of more give routes with more corners, and no other ways.
_SIDES = 4


@dataclass(frozen=True)
class Hazard:
    """An area that nobody wants to enter, such as smoke, and that may grow.

    The edge of the area advances at the same speed everywhere, and through walls, too. ``within``
    keeps the hazard in a room.

    Attributes:
        area: where the hazard begins: a shapely Polygon or Point, metres, or (x, y).
        speed: at which the edge advances, m/s.
        begins: simulated seconds at which the hazard begins.
        within: a shapely Polygon, metres, that the hazard does not leave, such as a room.

    Raises:
        ModelError: an area that is none, or a speed or time out of range.
    """

    area: Any
    speed: Annotated[float, Range(0.0, unit="m/s")] = 0.0
    begins: Annotated[float, Range(0.0, unit="s")] = 0.0
    within: BaseGeometry | None = None

    def __post_init__(self) -> None:
        area = self.area
        if not isinstance(area, BaseGeometry):
            area = _point(area)
        for what, kinds, each in (
            ("area", ("Polygon", "Point"), area),
            ("within", ("Polygon",), self.within),
        ):
            if each is None and what == "within":
                continue
            if not (
                isinstance(each, BaseGeometry)
                and each.geom_type in kinds
                and not each.is_empty
                and each.is_valid
                and np.isfinite(shapely.get_coordinates(each)).all()
            ):
                given = getattr(self, what)
                raise ModelError(f"hazard: {what} {given!r:.80}, expected a valid shapely Polygon")
        check_fields(self, "hazard")
        object.__setattr__(self, "area", area)

    def at(self, elapsed: float) -> BaseGeometry | None:
        """The area at a simulated time, seconds, as (multi)polygon; None before it begins."""
        return self.grown(self.speed * (elapsed - self.begins)) if elapsed >= self.begins else None

    def grown(self, by: float) -> BaseGeometry | None:
        """The area once its edge has advanced by so many metres; None while it has no extent."""
        # Sides touch the circle from outside.
        wider = self.area.buffer(by / math.cos(math.pi / (4 * _SIDES)), quad_segs=_SIDES)
        if self.within is not None:
            wider = wider.intersection(self.within)
        return None if wider.area == 0.0 else wider


class Hazards(TargetChoice):
    """People keep away from hazards and take the shortest way round them.

    Everybody knows where they are. Ways keep ``margin`` metres from their edges; where there is no
    such way, any that leads clear of them; and where there is none at all, the shortest one,
    through them. Those whom a hazard has overtaken, or who are within the margin, leave it by the
    nearest edge from which a way leads on.

    Args:
        hazards: the hazards; ``hazards`` may be added to while the model runs.
        margin: metres that people keep from them.

    Raises:
        ModelError: a margin out of range.
    """

    name = "hazards"
    saved: ClassVar[Mapping[str, Kind]] = {  # hazards are given again
        "_enclosed": Several(Whole(below="people"), set),
    }

    def __init__(
        self,
        hazards: Annotated[Iterable[Hazard], ListOf(Hazard)] = (),
        margin: Annotated[float, Range(0.0, unit="m")] = 1.0,
    ) -> None:
        self.hazards: list[Hazard] = hazards  # type: ignore[assignment]
        self.margin = margin
        self._enclosed: set[int] = set()
        self._floors: dict[tuple[int, float, tuple[float | None, ...]], _Floor] = {}

    @property
    def enclosed(self) -> list[int]:
        """Rows of those who had no way clear of the hazards when they last decided, sorted."""
        return sorted(self._enclosed)

    def targets(self, deciding: Deciding) -> Targets:
        """Targets on the shortest ways clear of hazards."""
        found = deciding.site.targets(deciding.positions, deciding.destinations)
        grown = tuple(self._grown(each, deciding.elapsed) for each in self.hazards)
        self._enclosed.difference_update(deciding.pedestrians.tolist())
        if not any(each is not None for each in grown):
            return found
        points, gates = np.array(found.points), np.array(found.gates)
        distances, corners = np.array(found.distances), None
        if found.corners is not None:
            corners = np.array(found.corners)
        left = np.flatnonzero(np.isfinite(distances))
        for margin in dict.fromkeys((self.margin, 0.0)):
            floor = self._floor(deciding.site.plan, margin, grown)
            clear, theirs = floor.targets(deciding, left)
            own = left[clear]
            # Those whom no hazard concerns keep their targets, which know the corners.
            other = np.abs(theirs.distances[clear] - distances[own]) > 1e-6
            changed, given = own[other], np.flatnonzero(clear)[other]
            points[changed], gates[changed] = theirs.points[given], theirs.gates[given]
            distances[changed] = theirs.distances[given]
            if corners is not None:
                corners[changed] = -1
            left = left[~clear]
            if not len(left):
                break
        self._enclosed.update(deciding.pedestrians[left].tolist())
        without = self._floor(deciding.site.plan, self.margin, grown).clear
        return Targets(points, gates, distances, corners, without)

    def _grown(self, hazard: Hazard, elapsed: float) -> float | None:
        """Metres by which a hazard has grown, rounded up to steps; None before it begins."""
        if elapsed < hazard.begins:
            return None
        return math.ceil(hazard.speed * (elapsed - hazard.begins) / _STEP) * _STEP

    def _floor(self, plan: FloorPlan, margin: float, grown: tuple[float | None, ...]) -> _Floor:
        key = plan.version, margin, grown
        if key not in self._floors:
            # Hazards grow, so that earlier floors are not asked for again.
            for old in [each for each in self._floors if each[::2] != key[::2]]:
                del self._floors[old]
            zones = [
                area.buffer(margin, quad_segs=_SIDES)
                for hazard, by in zip(self.hazards, grown, strict=True)
                if by is not None and (area := hazard.grown(by)) is not None
            ]
            self._floors[key] = _Floor(plan, shapely.union_all(zones))
        return self._floors[key]


class _Floor:
    """The floor without the zone of the hazards.

    Attributes:
        clear: this floor, or None if nothing is left of it.
    """

    def __init__(self, plan: FloorPlan, zone: BaseGeometry) -> None:
        self._plan = plan
        self._zone = zone
        shapely.prepare(self._zone)
        parts = [part for part in shapely.get_parts(zone) if part.intersects(plan.free)]
        try:
            self.clear: FloorPlan | None = plan.altered(obstacles=parts)
        except FloorPlanError:  # nothing of the floor is left
            self.clear = None
            return
        edge = zone.buffer(_BEYOND, quad_segs=_SIDES).boundary
        steps = np.arange(0.0, edge.length, _STEP)
        places = shapely.get_coordinates(shapely.line_interpolate_point(edge, steps))
        self._edge = places[self.clear.contains(places)] if len(places) else places

    def targets(
        self, deciding: Deciding, who: NDArray[np.int64]
    ) -> tuple[NDArray[np.bool_], Targets]:
        """(k,) whether there is a way clear of the zone for some of those who decide, and their
        targets on it."""
        places, to = deciding.positions[who], deciding.destinations[who]
        if self.clear is None or not len(who):
            return np.zeros(len(who), dtype=np.bool_), _nowhere(places)
        site = deciding.site.on(self.clear)
        there = site.targets(places, to)
        points, distances = np.array(there.points), np.array(there.distances)
        inside = shapely.intersects_xy(self._zone, *places.T)
        distances[inside] = np.inf
        if len(self._edge):
            for destination in np.unique(to[inside]).tolist():
                on = site.targets(self._edge, np.full(len(self._edge), destination))
                for k in np.flatnonzero(inside & (to == destination)):
                    out = self._out(places[k], on.distances)
                    if out is not None:
                        points[k], distances[k] = out
        return np.isfinite(distances), Targets(points, there.gates, distances)

    def _out(
        self, place: NDArray[np.float64], onward: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], float] | None:
        """The nearest place in view outside the zone from which a way leads on, and its length."""
        away = np.hypot(*(self._edge - place).T)
        for k in np.argsort(away, kind="stable").tolist():
            if np.isfinite(onward[k]) and bool(
                lines_of_sight(self._plan, place[None], self._edge[k][None])[0]
            ):
                return self._edge[k], float(away[k] + onward[k])
        return None


def _nowhere(places: NDArray[np.float64]) -> Targets:
    n = len(places)
    return Targets(places, np.full(n, -1, dtype=np.int64), np.full(n, np.inf))


def _point(value: Any) -> shapely.Point | None:
    """The point of two numbers, if they are."""
    try:
        return shapely.Point(np.asarray(value, dtype=np.float64).reshape(2))
    except (TypeError, ValueError):
        return None
