"""Waiting for a lift, getting in, and standing in the car; waiting for a place on escalators."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.buildings.connections.lift import CALLS
from mesa_mobility.crowd.hooks import World
from mesa_mobility.crowd.lifts.escalators import Escalators
from mesa_mobility.crowd.lifts.lifts import NOBODY, Lifts
from mesa_mobility.crowd.lifts.refuges import Refuges
from mesa_mobility.crowd.lifts.spots import THERE
from mesa_mobility.crowd.tactics.deciding import Deciding, Desired
from mesa_mobility.crowd.tactics.tactic import Tactic
from mesa_mobility.crowd.tactics.visits import slow_down
from mesa_mobility.schema import Kind

KEEPS_OFF = 1.2
"""Least metres from the door at which people wait, so that others can get out."""

DETOUR = 1.0
"""Metres by which a route may be shorter than the way to the middle of a door and on from there for
it to lead through that door."""

APART = 0.15
"""Metres that somebody who waits takes up around their body."""


class RideLifts(Tactic):
    """People wait before lifts until there is room for them, get in, and stand in the car.

    On the first step of an escalator they stand until it takes them up. Those who have no way out,
    since they cannot use stairs, go to a refuge.
    """

    name = "lifts"
    saved: ClassVar[Mapping[str, Kind]] = {}  # what they ride is the model's

    _lifts: Lifts
    _escalators: Escalators
    _refuges: Refuges

    def bind(self, model: World) -> None:
        """Keep lifts and escalators, and which openings are doors of lifts."""
        self._lifts, self._escalators = model.lifts, model.escalators
        self._refuges = model.refuges
        numbers = {opening.name: k for k, opening in enumerate(model.floor_plan.openings())}
        self._doors = [[numbers[gate.name] for gate in each.gates] for each in self._lifts.shafts]

    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """Have people stand before doors or on a first step, or go to their spot in the car."""
        if desired.newcomers:
            return
        if len(self._lifts):
            self._ride(deciding, desired)
        if len(self._escalators):
            waits = self._escalators.waits(deciding.pedestrians, deciding.positions)
            if waits.any():
                deciding.hold(desired, waits)
        if len(self._refuges):
            self._seek_refuge(deciding, desired)

    def _seek_refuge(self, deciding: Deciding, desired: Desired) -> None:
        """Send those without a way out to a refuge, and have them wait there."""
        crowd, own = deciding.inside.crowd, np.arange(len(deciding.pedestrians))
        if desired.ordered is not None:
            own = own[~desired.ordered]
        rows = deciding.pedestrians[own]
        sent = own[self._refuges.send(rows, crowd)]
        if len(sent):
            there = deciding.site.targets(
                deciding.positions[sent],
                crowd.destination[deciding.pedestrians[sent]].astype(np.int64),
            )
            desired.points = desired.points.copy()
            desired.points[sent] = there.points
        inside, frame = deciding.inside.pedestrians, deciding.frame
        found, spots = self._refuges.spots(rows, inside, frame, crowd)
        who = own[found]
        if len(who):
            left = np.hypot(*(spots - deciding.positions[who]).T)
            desired.points, desired.speeds = desired.points.copy(), desired.speeds.copy()
            desired.points[who] = spots
            desired.speeds[who] = slow_down(desired.speeds[who], left)
        arrived = own[self._refuges.arrived(rows, inside, frame, crowd)]
        if len(arrived):
            deciding.hold(desired, arrived)

    def _ride(self, deciding: Deciding, desired: Desired) -> None:
        rows, lifts = deciding.pedestrians, self._lifts
        inside = lifts.car_of(deciding.positions) != NOBODY
        new = lifts.rides(rows) == NOBODY
        number, stop, away = self._bound_for(deciding, desired, new)
        lifts.call(rows[new], number[new], stop[new], deciding.frame)
        held = (number != NOBODY) & new
        held &= away < self._rims(number, stop, held, deciding)
        self._step_back(number, stop, held, deciding, desired)
        in_car = np.flatnonzero(inside & ~new)
        if len(in_car):
            spots = lifts.spots(rows[in_car])
            left = np.hypot(*(spots - deciding.positions[in_car]).T)
            held[in_car[left < THERE]] = True
            desired.points, desired.speeds = desired.points.copy(), desired.speeds.copy()
            desired.points[in_car] = spots
            desired.speeds[in_car] = slow_down(desired.speeds[in_car], left)
        if held.any():
            deciding.hold(desired, held)

    def _step_back(
        self,
        number: NDArray[np.int64],
        stop: NDArray[np.int64],
        held: NDArray[np.bool_],
        deciding: Deciding,
        desired: Desired,
    ) -> None:
        """Send those who wait in a doorway to the place before it, instead of holding them."""
        cores = deciding.inside.crowd.core[deciding.pedestrians]
        for lift, k in pairs_of(number[held], stop[held]):
            shaft = self._lifts.shafts[lift]
            back = held & (number == lift) & (stop == k)
            back &= shaft.reached(k, deciding.positions, cores)
            if back.any():
                held &= ~back
                desired.points = desired.points.copy()
                desired.points[back] = shaft.before_door(k)

    def _bound_for(
        self, deciding: Deciding, desired: Desired, who: NDArray[np.bool_]
    ) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]:
        """(n,) number of the lift into which the route of each leads soon, or -1, (n,) of the stop
        there, and (n,) metres to the door."""
        count, lifts = len(deciding.pedestrians), self._lifts
        number, stop = np.full((2, count), NOBODY)
        away = np.full(count, np.inf)
        for lift, shaft in enumerate(lifts.shafts):
            for k, opening in enumerate(self._doors[lift]):
                to_door = np.hypot(*(deciding.positions - shaft.door(k)).T)
                near = np.flatnonzero(who & (to_door < CALLS))
                if not len(near):
                    continue
                before = shaft.before_door(k)
                gates, lengths = lifts.ways(
                    deciding.pedestrians[near],
                    before[None].repeat(len(near), axis=0),
                    deciding.destinations[near],
                )
                # From the door on, since some stand nearer to it than that place.
                onward = lengths - np.hypot(*(before - shaft.door(k)))
                way = to_door[near] + onward
                by = (gates == opening) & (way < desired.targets.distances[near] + DETOUR)
                number[near[by]], stop[near[by]], away[near[by]] = lift, k, to_door[near[by]]
        return number, stop, away

    def _rims(
        self,
        number: NDArray[np.int64],
        stop: NDArray[np.int64],
        calls: NDArray[np.bool_],
        deciding: Deciding,
    ) -> NDArray[np.float64]:
        """(n,) metres from the door within which those who call wait: a half-circle with room for
        all of them."""
        crowd, rims = deciding.inside.crowd, np.zeros(len(number))
        for lift, k in pairs_of(number[calls], stop[calls]):
            cores = crowd.core[self._lifts.waiting(lift, k, crowd)[0]]
            area = float((np.pi * (cores + APART) ** 2).sum())
            rims[calls & (number == lift) & (stop == k)] = KEEPS_OFF + np.sqrt(2.0 * area / np.pi)
        return rims


def pairs_of(lifts: NDArray[np.int64], stops: NDArray[np.int64]) -> list[tuple[int, int]]:
    """The lifts and stops among these, each pair once."""
    return sorted(set(zip(lifts.tolist(), stops.tolist(), strict=True)))
