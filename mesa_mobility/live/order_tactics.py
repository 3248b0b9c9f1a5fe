"""The tactics by which people follow orders."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.hooks import World
from mesa_mobility.crowd.pedestrian_model import PedestrianModel
from mesa_mobility.crowd.state.clearances import clearance_of
from mesa_mobility.crowd.state.environment import Environment
from mesa_mobility.crowd.state.records import Crowd
from mesa_mobility.crowd.tactics.deciding import Deciding, Desired
from mesa_mobility.crowd.tactics.tactic import Tactic
from mesa_mobility.crowd.tactics.visits import StayAtPlaces
from mesa_mobility.floorplan import Targets
from mesa_mobility.live.making_way import BRISK, step_aside
from mesa_mobility.live.orders import FREE, STANDS, STEERED, WALKS, Orders
from mesa_mobility.live.point_routes import Aims, PointRoutes
from mesa_mobility.schema import Kind

AHEAD = 1.0
"""A steered person aims at where their velocity leads in so many seconds. It is little, so that
movements are short and another velocity soon counts."""

ARRIVED, AROUND = 0.3, 0.35
"""Metres from a place at which the first has arrived, and more for those who stand there."""


def follow_orders(model: PedestrianModel) -> Orders:
    """The orders that a model's people follow; the tactics are added to the model's own.

    A model that has these tactics, such as one of a checkpoint, keeps them and its orders.
    """
    orders = _orders_of(model)
    names = [each.name for each in model.tactics]
    if WalkToPlaces.name not in names:
        first = names.index(StayAtPlaces.name) + 1 if StayAtPlaces.name in names else 0
        # All that people heed on their way, they heed on the way to a place.
        model.tactics.insert(first, WalkToPlaces(orders))
    if Steering.name not in names:
        model.tactics.append(Steering(orders))
    return orders


def _orders_of(model: World) -> Orders:
    """The orders that tactics of a model have, or new ones."""
    found = (each.orders for each in model.tactics if isinstance(each, _OfOrders))
    return next((orders for orders in found if orders is not None), None) or Orders(model)


class _OfOrders(Tactic):
    """A tactic that follows orders.

    Args:
        orders: to the model's people; by default those of the model's other tactics.
    """

    _crowd: Crowd

    def __init__(self, orders: Orders | None = None) -> None:
        self.orders = orders

    def bind(self, model: World) -> None:
        """Keep the model's crowd, and share its orders."""
        self._crowd = model.crowd
        self.orders = self.orders or _orders_of(model)

    def members(self) -> Mapping[str, Kind]:
        """What the members of ``state`` are."""
        return Orders.saved

    def state(self) -> dict[str, Any]:
        """The orders. They are the same of all tactics of a model."""
        assert self.orders is not None
        return self.orders.state()

    def restore(self, state: Mapping[str, Any]) -> None:
        """Take over what ``state`` has given."""
        assert self.orders is not None
        self.orders.restore(state)


class WalkToPlaces(_OfOrders):
    """People walk to places to which they were sent, and wait there."""

    name = "walking_orders"

    def __init__(self, orders: Orders | None = None) -> None:
        super().__init__(orders)
        self._routes: dict[int, PointRoutes] = {}

    def bind(self, model: World) -> None:
        """Keep the model's crowd, share its orders, and have lifts heed them."""
        super().bind(model)
        model.lifts.sent = self._go_on

    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """Set the points of those who are on the way."""
        orders, rows = self.orders, deciding.pedestrians
        assert orders is not None
        does = orders.of(rows)
        if desired.newcomers or not does.any():
            return
        # Their wait is over.
        over = (does == STANDS) & ~deciding.waiting
        orders.does[rows[over]] = does[over] = FREE
        desired.ordered = (does == WALKS) | (does == STANDS)
        going = np.flatnonzero(does == WALKS)
        own = rows[going]
        aims = self._aims(own, deciding.positions[going], deciding.site)
        points, speeds = desired.points.copy(), desired.speeds.copy()
        points[going], self._crowd.route[own] = aims.points, aims.lengths
        speeds[going[~np.isfinite(aims.lengths)]] = 0.0
        for at in _alike(orders.place[own]):
            x, y = orders.place[own[at[0]]].tolist()
            near = ARRIVED + AROUND * np.sqrt(orders.standing_at((x, y)))
            orders.arrive(own[at[aims.lengths[at] <= near]])
        desired.points, desired.speeds = points, speeds
        desired.targets = _with_aims(desired.targets, going, aims)

    def _aims(
        self, rows: NDArray[np.int64], positions: NDArray[np.float64], site: Environment
    ) -> Aims:
        """How people on the way to their places go on from (n, 2) positions, metres."""
        assert self.orders is not None
        places, kinds = self.orders.place[rows], self._crowd.type_index[rows].tolist()
        bodies = np.array([site.body(kind) for kind in kinds], dtype=np.int64)
        found = Aims(positions.copy(), np.full(len(rows), -1), np.full(len(rows), np.inf))
        for own in _alike(np.column_stack([places, bodies])):
            body, (x, y) = int(bodies[own[0]]), places[own[0]].tolist()
            if body not in self._routes:
                clearance = clearance_of(site.core_radius(body))
                self._routes[body] = PointRoutes(site.plan, clearance, climbs=site.climbs(body))
            aims = self._routes[body].targets(positions[own], (x, y))
            for values, theirs in zip(found, aims, strict=True):
                values[own] = theirs
        return found

    def _go_on(
        self,
        site: Environment,
        rows: NDArray[np.int64],
        points: NDArray[np.float64],
        gates: NDArray[np.int64],
        lengths: NDArray[np.float64],
    ) -> None:
        """Write the ways of people with orders; see ``Lifts.sent``."""
        assert self.orders is not None
        does = self.orders.of(rows)
        stands, walks = does == STANDS, does == WALKS
        gates[stands], lengths[stands] = -1, np.inf
        aims = self._aims(rows[walks], points[walks], site)
        gates[walks], lengths[walks] = aims.gates, aims.lengths


class Steering(_OfOrders):
    """People go as somebody steers them, whatever else they would heed, and others make way."""

    name = "steering"

    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """Set points and speeds of those who are steered, and of those in their way."""
        orders, rows = self.orders, deciding.pedestrians
        assert orders is not None
        steered = orders.steered()
        if desired.newcomers or not len(steered):
            return
        points, speeds = desired.points.copy(), desired.speeds.copy()
        by_hand = orders.of(rows) == STEERED
        velocity = orders.velocity[rows[by_hand]]
        points[by_hand] = deciding.positions[by_hand] + AHEAD * velocity
        speeds[by_hand] = np.hypot(velocity[:, 0], velocity[:, 1])
        others = np.flatnonzero(~by_hand)
        who, places = step_aside(rows[others], steered, orders.velocity[steered], self._crowd)
        points[others[who]] = places
        speeds[others[who]] = np.maximum(speeds[others[who]], BRISK)
        desired.points, desired.speeds = points, speeds


def _with_aims(targets: Targets, who: NDArray[np.intp], aims: Aims) -> Targets:
    """Targets of which those of some, ``who``, are other aims."""
    points, gates = np.array(targets.points), np.array(targets.gates)
    distances = np.array(targets.distances)
    points[who], gates[who], distances[who] = aims.points, aims.gates, aims.lengths
    corners = targets.corners
    if corners is not None:
        corners = np.array(corners)
        corners[who] = -1
    return Targets(points, gates, distances, corners, targets.floor)


def _alike(values: NDArray[np.float64]) -> list[NDArray[np.intp]]:
    """Indices of the (n, k) values, those of equal ones together."""
    if not len(values):
        return []
    _, which = np.unique(values, axis=0, return_inverse=True)
    which = which.reshape(-1)
    return [np.flatnonzero(which == k) for k in range(int(which.max()) + 1)]
