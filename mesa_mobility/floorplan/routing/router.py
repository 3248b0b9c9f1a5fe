"""Shortest routes to exits and gates, and the target of each person."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

from mesa_mobility.compiled.threads import by_shares, threads_for
from mesa_mobility.errors import FloorPlanError
from mesa_mobility.floorplan.floor.boundaries import opening_segments
from mesa_mobility.floorplan.floor.checks import one_line
from mesa_mobility.floorplan.floor.floor import Floor
from mesa_mobility.floorplan.floor.openings import Exit, Gate
from mesa_mobility.floorplan.routing.corner_offsets import pass_abreast
from mesa_mobility.floorplan.routing.network import network, ways_of
from mesa_mobility.floorplan.routing.route_graph import edges_in_view
from mesa_mobility.floorplan.routing.route_nodes import (
    EDGE_SHARE,
    NODE_SHARE,
    Nodes,
    find_nodes,
    with_points,
)
from mesa_mobility.floorplan.routing.sheet_links import sheet_links
from mesa_mobility.floorplan.routing.target_cache import Found, empty_cache
from mesa_mobility.floorplan.routing.target_search import ALL_FOUND, NO_TABLE, UNSEEN, aim
from mesa_mobility.floorplan.routing.targets import Destination, Targets, is_point
from mesa_mobility.floorplan.routing.visibility_cache import Views, no_views, with_room
from mesa_mobility.floorplan.walls.narrow_gaps import closed_gaps
from mesa_mobility.floorplan.walls.sight import Sight, sight_of

if TYPE_CHECKING:
    import networkx as nx


class Router:
    """Shortest routes to exits, gates and points of a floor plan, kept up to date with it.

    Routes bend at corners that stand `clearance` from the walls and lead through gates and exits,
    but through no exits other than the destination's. At seams they lead to another sheet. A
    person aims at the node in view with the shortest route through it. At a gate or exit the target
    lies `beyond` its line, so that it is crossed. It lies straight behind the nearest point that
    serves, so that nobody is led into the wall beside it.

    Args:
        plan: the floor plan; changes to it are followed.
        clearance: distance in metres that routes keep from walls, above 0. In narrow passages it
            shrinks to 85 % of this; narrower gaps are impassable.
        beyond: how far behind a gate or exit the target lies, metres, above 0; less where a wall
            is nearer.
        climbs: whether routes are for people who use stairs: they lead across seams, and through
            lifts that are for everybody. Other routes lead through all lifts, and across seams
            without steps alone.

    Raises:
        FloorPlanError: clearance or beyond out of range.
    """

    def __init__(
        self, plan: Floor, *, clearance: float = 0.2, beyond: float = 2.0, climbs: bool = True
    ) -> None:
        if not (np.isfinite([clearance, beyond]).all() and clearance > 0 and beyond > 0):
            raise FloorPlanError(
                f"a router needs clearance > 0 and beyond > 0, found {clearance} and {beyond}"
            )
        self._plan = plan
        self._clearance = float(clearance)
        self._beyond = float(beyond)
        self._links = [link for each in plan.shafts_for(climbs) for link in each.links]
        seams = [each for each in plan.seams if climbs or each.stepless]
        self._links += [link for each in seams for link in each.links]
        self._destinations: list[Destination] = [None]
        self._version = -1
        self._distances: dict[int, NDArray[np.float64]] = {}
        self._lengths: NDArray[np.float64] = np.empty((0, 0))
        self._nexts: NDArray[np.int64] = np.empty((0, 0), dtype=np.int64)
        self._follow: dict[int, NDArray[np.int64]] = {}
        self._graph: nx.DiGraph | None = None
        self._views: Views
        self._cache: NDArray[np.void]
        self._update()

    @property
    def clearance(self) -> float:
        """Distance in metres that routes keep from walls."""
        return self._clearance

    @property
    def nodes(self) -> Nodes:
        """The nodes of ``graph``, as arrays; the same object until the floor plan changes."""
        self._update()
        return self._nodes

    @property
    def graph(self) -> nx.DiGraph:
        """The routes, as a graph of nodes in view of each other.

        Nodes have `kind` (corner, gate or exit; points are corners), `position` (x, y), `opening`
        (the name of the gate or exit) and `direction`, the unit vector in which that is crossed:
        every place in a gate is two nodes. Edges have their length as `weight`, metres.
        """
        self._update()
        if self._graph is None:
            self._graph = network(
                self._nodes, self._edges, self._edge_lengths, self._plan.openings()
            )
        return self._graph

    def destination(self, exit_names: Sequence[str] | None = None) -> int:
        """A number for "the nearest of these exits"; None is all exits, number 0.

        Raises FloorPlanError for a name that is not an exit's, or for no names.
        """
        if exit_names is None:
            return 0
        names = (exit_names,) if isinstance(exit_names, str) else tuple(dict.fromkeys(exit_names))
        if not names:
            raise FloorPlanError("a destination needs at least one exit name")
        for name in names:
            if not isinstance(self._plan.gate(name), Exit):
                raise FloorPlanError(f"{name!r} is a gate, a destination needs exits")
        return self._number(tuple(sorted(names)))

    def crossing(self, gate_name: str) -> int:
        """A number for "across this gate", whichever way; FloorPlanError if it is not a gate's."""
        if not isinstance(self._plan.gate(gate_name), Gate):
            raise FloorPlanError(f"{gate_name!r} is an exit, expected a gate to cross")
        return self._number((gate_name,))

    def point(self, place: tuple[float, float]) -> int:
        """A number for "to this point", metres; the routes are searched for anew for each new one.

        The point should be on the floor and 85 % of the clearance from walls.
        """
        if place not in self._destinations:
            self._version = -1
        return self._number((float(place[0]), float(place[1])))

    def _number(self, names: tuple[str, ...] | tuple[float, float]) -> int:
        if names not in self._destinations:
            self._destinations.append(names)
        return self._destinations.index(names)

    def distances(self, destination: int) -> NDArray[np.float64]:
        """(nodes,) length of the route from every node of `graph` in metres; inf where none."""
        self._update()
        if not 0 <= destination < len(self._destinations):
            raise FloorPlanError(
                f"there is no destination {destination}; there are {len(self._destinations)}"
            )
        if destination not in self._distances:
            lengths = self._shortest(self._destinations[destination])
            self._distances[destination] = lengths
            self._follow[destination] = self._next_nodes(lengths)
        return self._distances[destination]

    def targets(self, positions: ArrayLike, destinations: ArrayLike) -> Targets:
        """Targets of people at (n, 2) `positions` with (n,) `destinations`.

        It uses several threads itself, and caches results: only one thread at a time may call it.
        """
        self._update()
        xy = np.ascontiguousarray(positions, dtype=np.float64).reshape(-1, 2)
        numbers = np.ascontiguousarray(destinations, dtype=np.int64).reshape(-1)
        if len(xy) != len(numbers):
            raise FloorPlanError(
                f"targets need a destination for each position, found {len(numbers)} for {len(xy)}"
            )
        n = len(xy)
        points, gates = np.empty((n, 2)), np.empty(n, dtype=np.int64)
        distances, corners = np.empty(n), np.empty((n, 2), dtype=np.int64)
        gates.fill(UNSEEN)
        found = Targets(points, gates, distances, corners)
        if n == 0:
            return found

        def aims(own: slice, learn: bool) -> int:
            outcome: int = aim(
                self._sight,
                self._ways,
                self._views,
                self._cache,
                xy[own],
                numbers[own],
                (self._lengths, self._nexts),
                learn,
                Found(points[own], gates[own], distances[own], corners[own]),
            )
            return outcome

        def known(own: slice) -> int:
            return aims(own, False)

        if threads_for(n) > 1 and NO_TABLE in by_shares(known, n):
            self._tabulate(numbers)
            by_shares(known, n)
        while (outcome := aims(slice(n), True)) != ALL_FOUND:
            if outcome == NO_TABLE:
                self._tabulate(numbers)
            else:
                self._views = with_room(self._views)
        return found

    def abreast(
        self, positions: NDArray[np.float64], targets: Targets, areas: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """(n, 2) targets in metres of people who pass their corner abreast of others.

        Each passes at the nearest point from which the next node is in view, no farther from the
        corner than its value of (n,) `areas`, m2, divided by its own distance. People without a
        corner to pass, and those with too little room behind it, keep the points of `targets`,
        which must be up to date.
        """
        points = np.array(targets.points, dtype=np.float64, order="C")
        if targets.corners is not None:
            pass_abreast(
                self._sight,
                self._ways,
                np.ascontiguousarray(positions, dtype=np.float64),
                np.ascontiguousarray(targets.corners, dtype=np.int64),
                np.ascontiguousarray(areas, dtype=np.float64),
                points,
            )
        return points

    def _tabulate(self, numbers: NDArray[np.int64]) -> None:
        """Tabulate route lengths and next nodes of all destinations, (destinations, nodes)."""
        for number in (numbers.min(), numbers.max()):
            self.distances(int(number))  # raises for an unknown one
        every = range(len(self._destinations))
        self._lengths = np.stack([self.distances(i) for i in every])
        self._nexts = np.stack([self._follow[i] for i in every])

    def way_from(self, start: int, destination: int) -> float:
        """Least distance in metres from one destination to another; inf without a route."""
        lengths = self.distances(destination)
        return float(lengths[self._nodes_of(self._destinations[start])].min(initial=np.inf))

    def _nodes_of(self, destination: Destination) -> NDArray[np.intp]:
        """The nodes at which routes to a destination end."""
        if is_point(destination):
            points = [each for each in self._destinations if is_point(each)]
            return np.array([len(self._ways.kind) - len(points) + points.index(destination)])
        names = set(destination or (e.name for e in self._plan.exits))
        ours = [k for k, each in enumerate(self._plan.openings()) if each.name in names]
        return np.flatnonzero(np.isin(self._nodes.opening, ours))

    def _shortest(self, destination: Destination) -> NDArray[np.float64]:
        sources = self._nodes_of(destination)
        if len(sources) == 0:
            return np.full(len(self._nodes.kind), np.inf)
        lengths: NDArray[np.float64] = dijkstra(self._backwards, indices=sources, min_only=True)
        return lengths

    def _next_nodes(self, lengths: NDArray[np.float64]) -> NDArray[np.int64]:
        """(nodes,) the next node on the route from each, -1 at its end."""
        follow = np.full(len(lengths), -1, dtype=np.int64)
        start, end = self._edges.T
        through = self._edge_lengths + lengths[end]
        order = np.lexsort((end, through, start))
        first = order[np.unique(start[order], return_index=True)[1]]
        first = first[np.isfinite(through[first])]
        follow[start[first]] = end[first]
        # A gate or point that is the destination ends its route, though others lead on from it.
        follow[lengths == 0.0] = -1
        # So does one from which a route goes on on another sheet: nothing there is in view.
        follow[self._leaving[follow[self._leaving] == self._arriving]] = -1
        return follow

    def _update(self) -> None:
        if self._version == self._plan.version:
            return
        plan = self._plan
        walls = plan.walls
        curtains = [
            opening_segments(plan.open_exits()),
            closed_gaps(plan, 2 * NODE_SHARE * self._clearance),
        ]
        self._sight: Sight = sight_of(walls, np.concatenate(curtains), self._clearance)
        points = [each for each in self._destinations if is_point(each)]
        with one_line("routes"):
            nodes = with_points(find_nodes(plan, self._sight, self._clearance), points)
        self._leaving, self._arriving, lengths = sheet_links(self._links, plan.openings(), nodes)
        links = self._leaving, self._arriving
        self._ways = ways_of(plan, nodes, links, len(walls), self._clearance, self._beyond)
        self._edges = edges_in_view(self._sight, self._ways, EDGE_SHARE * self._clearance)
        step = nodes.xy[self._edges[:, 1]] - nodes.xy[self._edges[:, 0]]
        self._edge_lengths = np.hypot(step[:, 0], step[:, 1])
        if len(lengths):
            self._edges = np.concatenate([self._edges, np.column_stack(links)])
            self._edge_lengths = np.concatenate([self._edge_lengths, lengths])
        self._nodes, self._graph = nodes, None
        shape = (len(nodes.kind), len(nodes.kind))
        # From the ends of routes back to their starts.
        self._backwards = csr_matrix((self._edge_lengths, self._edges.T[::-1]), shape=shape)
        self._views = no_views(plan.bounds, len(nodes.kind))
        self._cache = empty_cache()
        self._distances, self._follow = {}, {}
        self._lengths = self._lengths[:0]
        self._version = plan.version
