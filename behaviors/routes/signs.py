"""Following signs."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np
from numpy.typing import NDArray

from mesa_mobility import Deciding, ListOf, Range, RouteChoice, World, check_fields
from mesa_mobility.errors import ModelError
from mesa_mobility.floorplan import lines_of_sight
from mesa_mobility.schema import Array, Kind

# Metres in front of a sign, which hangs on a wall, that must be in sight.
_BEFORE = 0.1


@dataclass(frozen=True)
class Sign:
    """A sign that points out a way.

    Attributes:
        position: (x, y) metres.
        facing: the direction to which its face points, radians.
        gates: names of the gates of the way, in order.
        distance: metres from which it can be read from straight ahead; 30 m for letters 152 mm
            high (NFPA 101).

    Raises:
        ModelError: a position or direction that is not finite, no gates, or a distance that is not
            positive.
    """

    position: tuple[float, float]
    facing: Annotated[float, Range(-1e6, 1e6, "rad")]
    gates: Sequence[str]
    distance: Annotated[float, Range(0.0, unit="m", above=True)] = 30.0

    def __post_init__(self) -> None:
        try:
            place = np.asarray(self.position)
        except ValueError:  # rows of unequal length
            place = np.empty(0)
        if place.dtype.kind not in "iuf" or place.shape != (2,) or not np.isfinite(place).all():
            raise ModelError(f"sign: position {self.position!r:.80}, expected (x, y) in metres")
        if isinstance(self.gates, str) or not len(self.gates):
            raise ModelError(f"sign: gates {self.gates!r}, expected a list of names of gates")
        check_fields(self, "sign")

    def legible(self, points: NDArray[np.float64]) -> NDArray[np.bool_]:
        """(n,) whether it can be read from (n, 2) points, metres, if nothing hides it."""
        away = points - np.array(self.position)
        ahead = away @ [math.cos(self.facing), math.sin(self.facing)]
        # The distance falls with the cosine of the angle: a circle that touches the sign.
        legible: NDArray[np.bool_] = (away * away).sum(axis=1) <= self.distance * ahead
        return legible & (ahead > 0.0)


class Signs(RouteChoice):
    """Some of the people who come within view of a sign go by the gates to which it points.

    A sign can be read from within a circle that touches it, whose diameter is its ``distance``:
    obliquely only from near by (Xie, Filippidis, Gwynne, Galea, Blackshields and Lawrence 2007,
    Journal of Fire Protection Engineering 17: 41-64, the visibility catchment area). It must be
    ahead of a person and no wall before it. Each person has one chance to notice each sign: 38 %
    did in an experiment, and most of these followed it (Xie, Filippidis, Galea, Blackshields and
    Lawrence 2012, Fire and Materials 36: 367-382). The others go on as before. So do people who
    cannot take the way, such as people in wheelchairs if it leads over stairs.

    Args:
        signs: the signs.
        noticed: share of people who notice a sign.
        followed: share of those who follow it.
        interval: mean seconds between two looks round.

    Raises:
        ModelError: a parameter out of range.
    """

    name = "signs"
    saved: ClassVar[Mapping[str, Kind]] = {
        "_again": Array("f8", high=1e9, infinite=True),
        "_passed": Array("?", (None, "signs+1")),
    }

    def __init__(
        self,
        signs: Annotated[Iterable[Sign], ListOf(Sign, once=True)] = (),
        noticed: Annotated[float, Range(0.0, 1.0)] = 0.38,
        followed: Annotated[float, Range(0.0, 1.0)] = 0.97,
        interval: float = 0.5,
    ) -> None:
        super().__init__(interval)
        self.signs: tuple[Sign, ...] = signs  # type: ignore[assignment]
        self.noticed, self.followed = noticed, followed
        # The last column is for those who have come in: newcomers face nowhere yet.
        self._passed = np.zeros((0, len(self.signs) + 1), dtype=np.bool_)

    def bind(self, model: World) -> None:
        """Keep the model; FloorPlanError if its plan lacks a gate of a sign."""
        super().bind(model)
        for sign in self.signs:
            for name in sign.gates:
                model.floor_plan.gate(name)
        self._serves = {
            climbs: np.array([_is_way(sign.gates, model, climbs) for sign in self.signs])
            for climbs in (False, True)
        }

    def routes(self, deciding: Deciding, who: NDArray[np.int64]) -> list[Sequence[str] | None]:
        """The gates of the first sign in the list that somebody notices now and follows."""
        rows, places, rng = deciding.pedestrians[who], deciding.positions[who], deciding.rng
        more = int(rows.max()) + 1 - len(self._passed)
        if more > 0:
            new = np.zeros((more, len(self.signs) + 1), dtype=np.bool_)
            self._passed = np.concatenate([self._passed, new])
        inside = self._passed[rows, -1]
        self._passed[rows, -1] = True
        headings = self._model.crowd.heading[rows]
        facing = np.column_stack([np.cos(headings), np.sin(headings)])
        types = self._model.pedestrian_types
        serves = np.array([self._serves[bool(types[k].climbs)] for k in deciding.types[who]])
        given: list[Sequence[str] | None] = [None] * len(who)
        for number, sign in enumerate(self.signs):
            there = np.array(sign.position)
            seen = sign.legible(places) & inside & ~self._passed[rows, number]
            seen &= ((there - places) * facing).sum(axis=1) > 0.0
            before = there + _BEFORE * np.array([math.cos(sign.facing), math.sin(sign.facing)])
            near = np.flatnonzero(seen)
            clear = lines_of_sight(
                deciding.site.plan, places[near], np.tile(before, (len(near), 1))
            )
            near = near[clear]
            self._passed[rows[near], number] = True
            follows = rng.random(len(near)) < self.noticed
            follows &= (rng.random(len(near)) < self.followed) & serves[near, number]
            for k in near[follows].tolist():
                if given[k] is None:
                    given[k] = sign.gates
        return given


def _is_way(gates: Sequence[str], model: World, climbs: bool) -> bool:
    """Whether people who use stairs, or those who do not, can go through all of these gates."""
    if model.building is None:
        return True
    level = model.building.levels[0].number
    return model.building.way_out(gates, level, climbs=climbs) == tuple(gates)[::-1]
