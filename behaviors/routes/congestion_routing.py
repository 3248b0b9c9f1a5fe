"""Going by the way with the least expected time."""

from __future__ import annotations

from bisect import bisect, insort
from collections.abc import Mapping, Sequence
from typing import Annotated, ClassVar

import numpy as np
from mesa_mobility.behaviors.routes.network import Network
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
    find a jam; here everybody knows how many head for each gate. The flow is that of
    ``QuickestExit``, 2.23 w - 0.155 people a second through w metres, 0.5 at least.

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
        self._network: Network | None = None

    def routes(self, deciding: Deciding, who: NDArray[np.int64]) -> list[Sequence[str] | None]:
        """The gates of the quickest way; those who gain too little go on as before."""
        if self._network is None or self._network.graph is not self.graph:
            self._network = Network(self.graph, self._model.floor_plan)
        network, inside = self._network, deciding.inside
        rows = deciding.pedestrians[who]
        at = inside.places(rows)
        speeds, heading = inside.preferred_speeds[at], self._heading(deciding, network)
        new = [row not in self._under_way for row in rows.tolist()]
        self._under_way.update(rows.tolist())
        others = np.ones(len(heading), dtype=np.bool_)
        others[at] = False
        queues = [
            np.sort(inside.distances[others & (heading == number)]).tolist()
            for number in range(len(network.names))
        ]
        distances = network.distances(deciding.positions[who])
        exits = [self._exits(deciding, k) for k in who.tolist()]
        speed = float(speeds.mean())
        onward = {each: network.onward(each, queues, speed) for each in set(exits)}
        given: list[Sequence[str] | None] = [None] * len(who)
        # Those in front choose first, and count for the others.
        for k in np.argsort(distances.min(axis=1), kind="stable").tolist():
            rest, following = onward[exits[k]]
            ahead = [
                bisect(queues[number], away)
                for number, away in zip(network.number, distances[k].tolist(), strict=True)
            ]
            times = distances[k] / speeds[k] + ahead / network.flows[network.number] + rest
            best = int(times.argmin())
            if not np.isfinite(times[best]):
                continue
            before = times[network.number == heading[at[k]]].min(initial=np.inf)
            if new[k] or times[best] < (1.0 - self.patience) * before:
                given[k] = network.way(best, following)
            else:
                best = int(np.where(network.number == heading[at[k]], times, np.inf).argmin())
            insort(queues[network.number[best]], float(distances[k, best]))
        return given

    def _heading(self, deciding: Deciding, network: Network) -> NDArray[np.int64]:
        """(m,) number of the gate or exit to which everybody inside goes next, -1 for none."""
        inside, site = deciding.inside, deciding.site
        to = inside.destinations
        heading = np.full(len(to), -1, dtype=np.int64)
        kinds = np.unique(inside.types_of(inside.pedestrians)).tolist()
        gates = {gate.name for gate in site.plan.gates}
        for number, name in enumerate(network.names):
            if name in gates:
                heading[np.isin(to, [site.crossing(name, kind) for kind in kinds])] = number
        for destination in np.unique(to[heading < 0]).tolist():
            known = set(site.exits(destination))
            mine = [number for number, name in enumerate(network.names) if name in known]
            if mine:
                own = np.flatnonzero(to == destination)
                away = np.hypot(*(inside.positions[own][:, None] - network.middles[mine]).T)
                heading[own] = np.array(mine)[away.argmin(axis=0)]
        return heading

    def _exits(self, deciding: Deciding, k: int) -> tuple[str, ...]:
        """Names of the exits by which one of those who decide may leave."""
        names = deciding.site.exits(int(deciding.destinations[k]))
        return names or self._model.population.exits(int(deciding.pedestrians[k]))
