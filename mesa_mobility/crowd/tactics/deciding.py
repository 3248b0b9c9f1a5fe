"""The people who decide in a frame, and what they want of their next movement."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.journeys.waiting import HELD, wait_until, waiting
from mesa_mobility.crowd.options.table import FRAME_SECONDS
from mesa_mobility.crowd.state.environment import Environment
from mesa_mobility.crowd.state.view import CrowdView
from mesa_mobility.floorplan import Targets


@dataclass
class Desired:
    """What n deciding pedestrians want, as the tactics before have left it.

    A tactic sets new arrays; those that it gets are not to be changed.

    Attributes:
        points: (n, 2) where each wants to go, metres; at first their target.
        speeds: (n,) how fast, m/s; at first their unhindered preferred speed.
        targets: what the target choice has given; for those who are sent to a place, the way there.
        newcomers: whether the pedestrians have only just been put on the floor, and get a target
            to face even if they are to wait.
        ordered: (n,) whether each has been told where to be, and looks for no refuge; None if
            nobody has.
    """

    points: NDArray[np.float64]
    speeds: NDArray[np.float64]
    targets: Targets
    newcomers: bool = False
    ordered: NDArray[np.bool_] | None = None

    def stand(self, who: NDArray[Any], positions: NDArray[np.float64]) -> None:
        """Let some stand where they are with their next movement.

        People who stand so for long count as hindered; ``Deciding.hold`` is for those who wait.

        Args:
            who: which: (n,) of them true, or (k,) indices.
            positions: (n, 2) where all of them are, metres.
        """
        self.points, self.speeds = self.points.copy(), self.speeds.copy()
        self.points[who], self.speeds[who] = positions[who], 0.0


class Deciding(NamedTuple):
    """The pedestrians who decide in this frame.

    Attributes:
        pedestrians: (n,) rows in the crowd (``Pedestrian.row``).
        positions: (n, 2) metres.
        destinations: (n,) number of the set of exits by which each may leave.
        elapsed: simulated seconds.
        inside: everybody inside, the deciding pedestrians included.
        rng: the model's generator.
        site: the routes.  ``site.targets(positions, destinations)`` gives targets;
            ``site.destination(exit_names, type)`` gives the number of a set of exits for a
            pedestrian type, since routes depend on the core radius; ``site.exits(destination)``
            gives the names of its exits, and ``site.gate(destination)`` that of the gate to cross.
            ``site.route_graph(type)`` is the graph of a type's routes, and ``site.body(type)`` the
            number of their body: types of one body share their routes.
    """

    pedestrians: NDArray[np.int64]
    positions: NDArray[np.float64]
    destinations: NDArray[np.int64]
    elapsed: float
    inside: CrowdView
    rng: np.random.Generator
    site: Environment

    @property
    def types(self) -> NDArray[np.int64]:
        """(n,) index of the pedestrian type."""
        return self.inside.types_of(self.pedestrians)

    @property
    def frame(self) -> int:
        """Number of the frame, counted from 0 on."""
        return round(self.elapsed / FRAME_SECONDS)

    @property
    def waiting(self) -> NDArray[np.bool_]:
        """(n,) whether each waits: told to, at a place that they visit, or held by a behaviour."""
        return waiting(self.pedestrians, self.frame, self.inside.crowd)

    def hold(
        self, desired: Desired, who: NDArray[Any], facing: NDArray[np.float64] | None = None
    ) -> None:
        """Let some wait where they are until they decide again, 0.4 s later.

        As all who wait, they are never hindered, and count as people who stand, for others who look
        ahead and for the test whether a run has stalled. They wait as long as a tactic holds them
        at each of their decisions.

        Args:
            desired: what all of them want so far.
            who: which: (n,) of them true, or (k,) indices.
            facing: (k, 2) points to which they turn meanwhile, metres; by default they stand as
                they are. Who turns decides again at the end of that movement, 1.5 s later at most.
        """
        desired.stand(who, self.positions)
        if facing is not None:
            desired.points[who] = facing
        wait_until(self.pedestrians[who], self.frame + HELD, self.inside.crowd)
