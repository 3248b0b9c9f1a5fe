"""The floor plan as the crowd needs it: walls, exits and routes, up to date with its changes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.saved import Saved
from mesa_mobility.crowd.state.clearances import clearance_of, passing_of
from mesa_mobility.crowd.state.corners import Corners
from mesa_mobility.crowd.state.records import FARTHEST
from mesa_mobility.crowd.state.surroundings import Surroundings, survey
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan import FloorPlan, Router, Targets
from mesa_mobility.floorplan.routing.targets import Destination, is_point
from mesa_mobility.schema import Each, Either, Kind, Maybe, Members, Real, Several, Text, Whole

if TYPE_CHECKING:
    import networkx as nx

_SLIM = 0.05
"""Clearance in metres of routes for a body so slim that only walls stop it."""


class Environment(Saved):
    """Walls for the collision tests and routes for the targets of one floor plan.

    A body is a core radius and, on a plan of several sheets, whether it uses stairs. Each body has
    routes of its own, which are searched for when the first person with such a body has a
    destination. The number of a destination stands for two things: a set of exits, a gate or a
    point, and a body.

    Args:
        plan: the floor plan; obstacles and doors may change while a model runs.
        reach: how far from a person walls matter, metres.
        core_radii: core radius of each pedestrian type, metres.
        climbs: whether each type uses stairs; by default all do.

    Attributes:
        plan: the floor plan.
        corners: the corners of all routes.
        shut: names of gates and exits that are walls for now, though routes lead through them.
    """

    def __init__(
        self,
        plan: FloorPlan,
        *,
        reach: float,
        core_radii: Sequence[float],
        climbs: Sequence[bool] | None = None,
    ) -> None:
        self.plan = plan
        self.shut: frozenset[str] = frozenset()
        self._shut_by: dict[str, frozenset[str]] = {}
        self._reach = reach
        self._of_types = tuple(core_radii)
        self._climbs = (True,) * len(core_radii) if climbs is None else tuple(climbs)
        # On one sheet all bodies of one size have the same routes.
        over = self._climbs if plan.in_sheets else (True,) * len(core_radii)
        types = list(zip(core_radii, over, strict=True))
        bodies = list(dict.fromkeys(types))
        self._radii = [radius for radius, _ in bodies]
        self._climbing = [climbs for _, climbs in bodies]
        self._clearances = [clearance_of(radius) for radius in self._radii]
        self._body_of = [bodies.index(each) for each in types]
        self._make_routers([None])
        self._elsewhere: WeakKeyDictionary[FloorPlan, Environment] = WeakKeyDictionary()

    def _make_routers(self, destinations: list[Destination]) -> None:
        self._routers: list[Router | None] = [None] * len(self._radii)
        self._destinations = destinations
        self._climber: Router | None = None
        self._made_when_open = (-1, 0)
        self._when_open: dict[int, Router] = {}
        self._version = -1
        self.corners = Corners(self._routers)

    def members(self) -> Mapping[str, Kind]:
        """What the members of ``state`` are."""
        number = Real(-FARTHEST, FARTHEST)
        ways = Either(Each(number, number), Several(Text("openings"), tuple))
        return {
            "plan": Members(self.plan.members()),
            "destinations": Several(Maybe(ways)),
            "routed": Several(Whole(below="bodies")),
        }

    def state(self) -> dict[str, Any]:
        """The destinations, in the order of their numbers, and the bodies that have routes.

        Corners around one edge have the number of the first body with routes.
        """
        return {
            "plan": self.plan.state(),
            "destinations": self._destinations,
            "routed": [body for body, router in enumerate(self._routers) if router is not None],
        }

    def restore(self, state: Mapping[str, Any]) -> None:
        """Take over what ``state`` has given, the floor plan's changes included."""
        self.plan.restore(state["plan"])
        if self._destinations != state["destinations"]:
            self._make_routers(list(state["destinations"]))
        for body in state["routed"]:
            self._router(body)

    @property
    def destinations(self) -> int:
        """Upper bound of the numbers of destinations."""
        return len(self._destinations) * self.bodies

    @property
    def bodies(self) -> int:
        """Number of distinct bodies."""
        return len(self._radii)

    def body(self, type_index: int) -> int:
        """Index of the body of a pedestrian type."""
        return self._body_of[type_index]

    def core_radius(self, body: int) -> float:
        """Core radius of the body with this index, metres."""
        return self._radii[body]

    def climbs(self, destination: int) -> bool:
        """Whether people of this destination use stairs; on a plan of one sheet all do."""
        return self._climbing[destination % self.bodies]

    def destination(self, exits: tuple[str, ...] | None, type_index: int = 0) -> int:
        """Number of the destination "the nearest of these exits"; None stands for all.

        Args:
            exits: their names.
            type_index: index of the pedestrian type that goes there.
        """
        body = self._body_of[type_index]
        return self._numbered(self._router(body).destination(exits), exits, body)

    def crossing(self, gate: str, type_index: int = 0) -> int:
        """Number of the destination "across this gate"; routes to it lead through no exit."""
        body = self._body_of[type_index]
        return self._numbered(self._router(body).crossing(gate), (gate,), body)

    def point(self, place: tuple[float, float], type_index: int = 0) -> int:
        """Number of the destination "to this point", metres; routes lead through no exit."""
        body = self._body_of[type_index]
        return self._numbered(self._router(body).point(place), place, body)

    def _numbered(self, number: int, names: Destination, body: int) -> int:
        if number == len(self._destinations):
            self._destinations.append(names)
            self._version = -1
            # All routers number destinations alike.
            for router in (*self._routers, self._climber):
                if router is not None:
                    self._add_destination(router, names)
        return number * self.bodies + body

    def _router(self, body: int) -> Router:
        router = self._routers[body]
        if router is None:
            router = self._routers[body] = self._new_router(
                self.plan, self._clearances[body], self._climbing[body]
            )
        return router

    def _new_router(self, plan: FloorPlan, clearance: float, climbs: bool = True) -> Router:
        """A router that knows all destinations by their numbers."""
        router = Router(plan, clearance=clearance, climbs=climbs)
        for names in self._destinations:
            self._add_destination(router, names)
        return router

    def _add_destination(self, router: Router, names: Destination) -> None:
        if is_point(names):
            router.point(names)
        elif names is not None and any(gate.name == names[0] for gate in self.plan.gates):
            router.crossing(str(names[0]))
        else:
            router.destination(None if names is None else [str(each) for each in names])

    def exits(self, destination: int) -> tuple[str, ...]:
        """Names of the exits of a destination, open or closed; none for a gate or a point."""
        names = self._destinations[destination // self.bodies]
        return tuple(e.name for e in self.plan.exits if names is None or e.name in names)

    def gate(self, destination: int) -> str | None:
        """Name of the gate to which a destination leads across; None for exits and points."""
        names = self._destinations[destination // self.bodies]
        if names is None or is_point(names) or self.exits(destination):
            return None
        return str(names[0])

    def route_graph(self, type_index: int) -> nx.DiGraph:
        """The routes of people of one type, as ``FloorPlan.route_graph`` has those of adults.

        Routes of people who use no stairs lead over ramps and through lifts. The graph is the same
        object until the floor plan changes.
        """
        return self._router(self._body_of[type_index]).graph

    def targets(self, points: NDArray[np.float64], destinations: NDArray[np.int64]) -> Targets:
        """Targets of people, who may have different body sizes.

        Args:
            points: (n, 2) places of the people, metres.
            destinations: (n,) numbers of their destinations.

        Returns:
            The targets. Their corners are numbered as in the attribute ``corners``.
        """
        if self.bodies == 1:
            return self._router(0).targets(points, destinations)
        n = len(points)
        points_of, gates = np.empty((n, 2)), np.empty(n, dtype=np.int64)
        distances, corners = np.empty(n), np.empty((n, 2), dtype=np.int64)
        to, body = np.divmod(np.asarray(destinations, dtype=np.int64), self.bodies)
        for number in np.unique(body).tolist():
            own = np.flatnonzero(body == number)
            theirs = self._router(number).targets(points[own], to[own])
            points_of[own], gates[own], distances[own] = (
                theirs.points,
                theirs.gates,
                theirs.distances,
            )
            assert theirs.corners is not None
            corners[own] = self.corners.numbers(theirs.corners, number)
        return Targets(points_of, gates, distances, corners)

    def on(self, plan: FloorPlan) -> Environment:
        """The routes on another plan with the same exits and gates, such as one of
        ``FloorPlan.altered``; destinations have the same numbers.

        Corners of its targets are not those of this site: ``TargetChoice.targets`` gives -1.
        """
        known = self._elsewhere.get(plan)
        if known is None:
            known = Environment(
                plan, reach=self._reach, core_radii=self._of_types, climbs=self._climbs
            )
            self._elsewhere[plan] = known
        for names in self._destinations[len(known._destinations) :]:
            known._destinations.append(names)
            for router in known._routers:
                if router is not None:
                    known._add_destination(router, names)
        return known

    def abreast(
        self, points: NDArray[np.float64], targets: Targets, areas: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Targets, (n, 2) metres, of people who pass a corner side by side with others.

        Args:
            points: (n, 2) places of the people, metres.
            targets: their targets, which must be up to date.
            areas: (n,) m2, which limit how far from the corner they pass; see ``Router.abreast``.
        """
        if self.bodies == 1 or targets.corners is None:
            return self._router(0).abreast(points, targets, areas)
        found = np.array(targets.points, dtype=np.float64)
        whose = self.corners.router_of(targets.corners[:, 0])
        nodes = self.corners.nodes(targets.corners)
        for number in np.unique(whose[whose >= 0]).tolist():
            own = np.flatnonzero(whose == number)
            theirs = Targets(
                targets.points[own], targets.gates[own], targets.distances[own], nodes[own]
            )
            found[own] = self._router(number).abreast(points[own], theirs, areas[own])
        return found

    def check_way_out(self, points: NDArray[np.float64], destination: int) -> None:
        """Raise FloorPlanError if some places would have no route even if everything were open, and
        everybody climbed stairs."""
        lost = points[self.without_way_out(points, destination)]
        if len(lost):
            raise FloorPlanError(
                f"{len(lost)} of {len(points)} people have no way to {self._text(destination)}; "
                f"the first stands at ({lost[0, 0]:.2f}, {lost[0, 1]:.2f})"
                + self._too_narrow(lost, destination)
            )

    def without_way_out(self, points: NDArray[np.float64], destination: int) -> NDArray[np.bool_]:
        """(n,) whether there would be no route from (n, 2) places even if everything were open, and
        everybody climbed stairs. On stairs nobody has one who does not climb them."""
        number, body = divmod(destination, self.bodies)
        lost = _without_way(self._router(body), points, number)
        if lost.any() and not (self._all_open() and self._climbing[body]):
            lost[lost] = _without_way(self._router_when_open(body), points[lost], number)
        if not self._climbing[body]:
            lost |= self.plan.on_steps(points)
        return lost

    def leads_over_stairs(
        self, points: NDArray[np.float64], destinations: NDArray[np.int64]
    ) -> NDArray[np.bool_]:
        """(n,) whether a slim person who uses stairs has a way from (n, 2) places, metres, to (n,)
        destinations, by the doors that are open now."""
        if self._climber is None:
            self._climber = self._new_router(self.plan, _SLIM)
        found = np.empty(len(points), np.bool_)
        numbers = np.asarray(destinations, dtype=np.int64) // self.bodies
        for number in np.unique(numbers).tolist():
            own = numbers == number
            found[own] = ~_without_way(self._climber, points[own], number)
        return found

    def _too_narrow(self, lost: NDArray[np.float64], destination: int) -> str:
        """Text naming what is too narrow on the way of (n, 2) lost people, or an empty one."""
        core, body = self._radii[destination % self.bodies], destination % self.bodies
        router = self._router(body) if self._all_open() else self._router_when_open(body)
        passable = {name for _, name in router.graph.nodes(data="opening")}
        names = self._destinations[destination // self.bodies]
        wanted = [] if is_point(names) else names or [exit_.name for exit_ in self.plan.exits]
        narrow = [name for name in wanted if name not in passable]
        if not narrow:
            slim = self._new_router(self.plan, _SLIM)
            if _without_way(slim, lost, destination // self.bodies).any():
                return ""
            return (
                f"; the ways there have gaps of less than {2.0 * passing_of(core):.2f} m, too "
                f"narrow for bodies of {core:g} m radius"
            )
        # The floor behind an exit ends in a wall, too, which may be nearer than the body's radius.
        return (
            f"; bodies of {core:g} m radius have no room between the walls beside or behind "
            f"{', '.join(repr(name) for name in narrow)}"
        )

    def check_way_on(self, stop: int, destination: int) -> None:
        """Raise FloorPlanError if no route leads on from a gate or point, even if everything were
        open."""
        number, body = divmod(destination, self.bodies)
        router = self._router(body) if self._all_open() else self._router_when_open(body)
        if not np.isfinite(router.way_from(stop // self.bodies, number)):
            raise FloorPlanError(
                f"there is no way from {self._text(stop)} to {self._text(destination)}"
            )

    def _all_open(self) -> bool:
        return all(self.plan.is_open(opening.name) for opening in self.plan.openings())

    def _router_when_open(self, body: int) -> Router:
        """A router with everything open; destinations have the same numbers."""
        made = (self.plan.version, len(self._destinations))
        if self._made_when_open != made:
            self._made_when_open, self._when_open = made, {}
        if body not in self._when_open:
            plan = self.plan.altered(closed=())
            self._when_open[body] = self._new_router(plan, self._clearances[body])
        return self._when_open[body]

    def _text(self, destination: int) -> str:
        names = self._destinations[destination // self.bodies]
        if is_point(names):
            return f"({names[0]:.2f}, {names[1]:.2f})"
        return "any exit" if names is None else " or ".join(repr(name) for name in names)

    def shut_openings(self, whose: str, names: frozenset[str]) -> bool:
        """Note which gates and exits are shut now; whether more are than before.

        Args:
            whose: what shuts them, which shuts no others from now on.
            names: their names.
        """
        before = self.shut
        self._shut_by[whose] = names
        self.shut = frozenset[str]().union(*self._shut_by.values())
        return bool(self.shut - before)

    @property
    def surroundings(self) -> Surroundings:
        """Walls and exits as they are now."""
        if self._version != self.plan.version:
            self._version = self.plan.version
            self._surveys: dict[frozenset[str], Surroundings] = {}
        if self.shut not in self._surveys:
            self._surveys[self.shut] = survey(
                self.plan, self._destinations, self._climbing, self._reach, self.shut
            )
        return self._surveys[self.shut]


def _without_way(
    router: Router, points: NDArray[np.float64], destination: int
) -> NDArray[np.bool_]:
    return ~np.isfinite(
        router.targets(points, np.full(len(points), destination, dtype=np.int64)).distances
    )
