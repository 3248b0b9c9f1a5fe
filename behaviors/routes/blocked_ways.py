"""Blocked ways are learned when they are seen."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, ClassVar

import numpy as np
from numpy.typing import NDArray

from mesa_mobility import Deciding, FloorPlan, Range, TargetChoice, Targets
from mesa_mobility.floorplan import lines_of_sight
from mesa_mobility.schema import Array, Kind, Several, Text

# Metres before a closed gate, which is a wall, that must be in sight.
_BEFORE = 0.05


class BlockedWays(TargetChoice):
    """A gate or exit that has been closed is taken for open by those who have not seen that.

    They walk up to it by the shortest way that they know, and take another one as soon as it is in
    view: no wall before it, and nearer than ``sight``. That a broken escape route costs more where
    people have to find out is from Kemloh Wagoum, Seyfried and Holl (2012, Advances in Complex
    Systems 15, 1250029; arXiv 1103.4080). Everybody knows what is open. Those with a route of gates
    or places know all of the plan.

    Args:
        sight: how far people look, metres; walls hide, people do not.

    Raises:
        ModelError: a sight out of range.
    """

    name = "blocked_ways"
    saved: ClassVar[Mapping[str, Kind]] = {
        "_seen": Several(Text("openings"), dict, values=Array("?")),
    }

    def __init__(self, sight: Annotated[float, Range(0.0, unit="m", above=True)] = 15.0) -> None:
        self.sight = sight
        self._seen: dict[str, NDArray[np.bool_]] = {}
        self._plans: dict[tuple[str, ...], FloorPlan] = {}
        self._version = -1

    def targets(self, deciding: Deciding) -> Targets:
        """Targets on the shortest ways that people believe in."""
        site, plan = deciding.site, deciding.site.plan
        found = site.targets(deciding.positions, deciding.destinations)
        closed = plan.closed_openings()
        self._seen = {each.name: self._seen.get(each.name, _NOBODY) for each in closed}
        if not closed:
            return found
        rows = deciding.pedestrians
        unseen = np.zeros((len(rows), len(closed)), dtype=np.bool_)
        for number, opening in enumerate(closed):
            unseen[:, number] = ~self._look(opening.name, rows, deciding.positions, plan)
        # The gates of a route are numbers without exits.
        leaving = [bool(site.exits(int(number))) for number in deciding.destinations]
        unseen &= np.array(leaving, dtype=np.bool_)[:, None]
        if not unseen.any():
            return found
        points, gates = np.array(found.points), np.array(found.gates)
        distances, corners = np.array(found.distances), None
        if found.corners is not None:
            corners = np.array(found.corners)
        for key in np.unique(unseen[unseen.any(axis=1)], axis=0):
            own = np.flatnonzero((unseen == key).all(axis=1))
            believed = tuple(each.name for each, hidden in zip(closed, key, strict=True) if hidden)
            there = site.on(self._plan(plan, believed))
            theirs = there.targets(deciding.positions[own], deciding.destinations[own])
            points[own], gates[own] = theirs.points, theirs.gates
            distances[own] = theirs.distances
            if corners is not None:
                corners[own] = -1
        return Targets(points, gates, distances, corners)

    def _look(
        self,
        name: str,
        rows: NDArray[np.int64],
        places: NDArray[np.float64],
        plan: FloorPlan,
    ) -> NDArray[np.bool_]:
        """(n,) whether people have seen by now that an opening is closed, on either sheet."""
        known = self._seen[name]
        more = int(rows.max(initial=-1)) + 1 - len(known)
        if more > 0:
            known = self._seen[name] = np.append(known, np.zeros(more, dtype=np.bool_))
        for opening in plan.drawings(name):
            way = places - opening.midpoint
            away = np.maximum(np.hypot(*way.T), 1e-9)
            before = opening.midpoint + way * np.minimum(_BEFORE / away, 1.0)[:, None]
            near = np.flatnonzero(~known[rows] & (away <= self.sight))
            clear = lines_of_sight(plan, places[near], before[near])
            known[rows[near[clear | (away[near] <= _BEFORE)]]] = True
        return known[rows]

    def _plan(self, plan: FloorPlan, believed: tuple[str, ...]) -> FloorPlan:
        """The plan with these openings open."""
        if self._version != plan.version:
            self._version = plan.version
            self._plans.clear()
        if believed not in self._plans:
            closed = [each.name for each in plan.closed_openings() if each.name not in believed]
            self._plans[believed] = plan.altered(closed=closed)
        return self._plans[believed]


_NOBODY = np.empty(0, dtype=np.bool_)
