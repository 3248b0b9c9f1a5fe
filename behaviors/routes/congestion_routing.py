"""Going by the way with the least expected time."""

from __future__ import annotations

from bisect import bisect, insort
from collections.abc import Mapping, Sequence
from typing import Annotated, ClassVar

import numpy as np
from mesa_mobility.behaviors.routes.network import Network, queue_numbers
from numpy.typing import NDArray

from mesa_mobility import Deciding, Range, RouteChoice
from mesa_mobility.schema import Array, Kind, Several, Whole


class CongestionRouting(RouteChoice):
    """People take the way by which they expect to be out first, and think again as they go.

    Ways lead through gates. The time expected is that of the walk, at one's own speed, and at each
    gate and exit that of the people to pass before: those heading for it who are nearer, and
    farther on all who head for it, over the flow through it. So the emptier of two corridors is
    taken if each has a gate. People change their mind for a gain of more than ``patience`` of the
    time that they expect to need, every ``interval`` seconds on average.

    Kemloh Wagoum, Seyfried and Holl (2012, Advances in Complex Systems 15, 1250029; arXiv
    1103.4080) let people leave the shortest path for a quicker one by weighing its gain when they
    find a jam; here everybody knows how many head for each gate. The flow through doors is that of
    ``QuickestExit``, 2.23 w - 0.155 people a second through w metres, 0.5 at least. Stairs carry
    1.1 w people a second down and 0.88 w up (IMO MSC.1/Circ.1533), an escalator as many as its
    capacity says, and a lift a full car for each of its longest rides to and fro.

    People who do not use stairs choose among ramps and the lifts that they use. Nobody chooses anew
    on an escalator or in a lift.

    Args:
        interval: mean seconds between two choices.
        patience: least gain for which people take another way, as a share of the time expected.

    Raises:
        ModelError: a parameter out of range.
    """

    name = "congestion_routing"
    saved: ClassVar[Mapping[str, Kind]] = {
        "_again": Array("f8", high=1e9, infinite=True),
        "_under_way": Several(Whole(below="people"), set),
    }

    def __init__(
        self, interval: float = 2.0, patience: Annotated[float, Range(0.0, 1.0, below=True)] = 0.1
    ) -> None:
        super().__init__(interval)
        self.patience = patience
        self._under_way: set[int] = set()
        self._networks: dict[int, Network] = {}

    def routes(self, deciding: Deciding, who: NDArray[np.int64]) -> list[Sequence[str] | None]:
        """The gates of the quickest way; those who gain too little go on as before."""
        site, inside = deciding.site, deciding.inside
        rows, kinds = deciding.pedestrians[who], deciding.types[who].tolist()
        networks = self._networks_of(deciding, kinds)
        at = inside.places(rows)
        speeds, (heading, away) = inside.preferred_speeds[at], self._heading(deciding)
        new = [row not in self._under_way for row in rows.tolist()]
        self._under_way.update(rows.tolist())
        others = (heading >= 0) & np.isfinite(away)  # people without a way stand in no queue
        others[at] = False
        queues = _queues(heading[others], away[others], len(site.plan.openings()))
        queued = np.array([len(queue) for queue in queues])
        bodies = [site.body(kind) for kind in kinds]
        distances: list[NDArray[np.float64]] = [np.empty(0)] * len(who)
        for body, network in networks.items():
            own = [k for k, each in enumerate(bodies) if each == body]
            found = network.distances(deciding.positions[who[own]])
            for k, lengths in zip(own, found, strict=True):
                distances[k] = lengths
        ends = [(body, self._exits(deciding, k)) for body, k in zip(bodies, who, strict=True)]
        speed = float(speeds.mean())
        onward = {
            (body, exits): networks[body].onward(exits, queued, speed) for body, exits in set(ends)
        }
        given: list[Sequence[str] | None] = [None] * len(who)
        # Those in front choose first, and count for the others.
        nearest = [lengths.min(initial=np.inf) for lengths in distances]
        for k in np.argsort(nearest, kind="stable").tolist():
            network = networks[bodies[k]]
            number, on = network.number, onward[ends[k]]
            ahead = [
                bisect(queues[queue], length)
                for queue, length in zip(number.tolist(), distances[k].tolist(), strict=True)
            ]
            times = (distances[k] + on.metres) / speeds[k] + ahead / network.flows + on.seconds
            if not np.isfinite(times.min(initial=np.inf)):
                continue
            best = int(times.argmin())
            before = times[number == heading[at[k]]].min(initial=np.inf)
            if new[k] or times[best] < (1.0 - self.patience) * before:
                given[k] = network.way(best, on.following)
            else:
                best = int(np.where(number == heading[at[k]], times, np.inf).argmin())
            insort(queues[number[best]], float(distances[k][best]))
        return given

    def _networks_of(self, deciding: Deciding, kinds: Sequence[int]) -> dict[int, Network]:
        """The network of each body among people of some types, by its index."""
        site = deciding.site
        for kind in dict.fromkeys(kinds):
            body, graph = site.body(kind), site.route_graph(kind)
            if body not in self._networks or self._networks[body].graph is not graph:
                self._networks[body] = Network(graph, site.plan)
        return {body: self._networks[body] for body in map(site.body, dict.fromkeys(kinds))}

    def _heading(self, deciding: Deciding) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """(m,) number of the queue in which everybody inside is next, -1 for none, and their (m,)
        metres to its end."""
        inside, site = deciding.inside, deciding.site
        numbers, to = queue_numbers(site.plan), inside.destinations
        heading, away = np.full(len(to), -1, dtype=np.int64), inside.distances.copy()
        for destination in np.unique(to).tolist():
            own, gate = to == destination, site.gate(destination)
            if gate is not None:
                heading[own] = numbers[gate]
            elif known := [name for name in site.exits(destination) if site.plan.is_open(name)]:
                middles = [site.plan.gate(name).midpoint for name in known]
                there = np.hypot(*(inside.positions[own][:, None] - middles).T).argmin(axis=0)
                heading[own] = np.array([numbers[name] for name in known])[there]
        # Those in a lift are ahead of all who wait for it.
        lifts = self._model.lifts
        rides = lifts.rides(inside.pedestrians)
        for number, shaft in enumerate(lifts.shafts):
            heading[rides == number] = numbers[shaft.gates[0].name]
        away[rides >= 0] = 0.0
        return heading, away

    def _exits(self, deciding: Deciding, k: int) -> tuple[str, ...]:
        """Names of the exits by which one of those who decide may leave."""
        names = deciding.site.exits(int(deciding.destinations[k]))
        return names or self._model.population.exits(int(deciding.pedestrians[k]))


def _queues(heading: NDArray[np.int64], away: NDArray[np.float64], count: int) -> list[list[float]]:
    """For each of so many queues, the metres of the people in it, in rising order."""
    order = np.lexsort((away, heading))
    ends = np.searchsorted(heading[order], np.arange(1, count))
    return [each.tolist() for each in np.split(away[order], ends)]
