"""A pedestrian: a Mesa agent that is a view of one row of the crowd's arrays."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any
from weakref import WeakKeyDictionary

import numpy as np
from mesa.experimental.continuous_space import ContinuousSpaceAgent
from numpy.typing import NDArray

from mesa_mobility.crowd.costs.candidates import Candidates
from mesa_mobility.crowd.options.capability import Capability
from mesa_mobility.crowd.options.table import FRAME_SECONDS
from mesa_mobility.crowd.pedestrian_type import PedestrianType
from mesa_mobility.crowd.state.records import FALLBACK

if TYPE_CHECKING:
    from mesa_mobility.bodies import BodyMotion, PoseBank
    from mesa_mobility.crowd.model import PedestrianModel


class _Counter:
    """A counter from 1 on."""

    def __init__(self) -> None:
        self.last = 0

    def __next__(self) -> int:
        self.last += 1
        return self.last


class _Counters(WeakKeyDictionary[Any, _Counter]):
    """A counter for each model, freed with the model."""

    def __getitem__(self, model: Any) -> _Counter:
        return self.setdefault(model, _Counter())


def number_on(model: PedestrianModel, copied: PedestrianModel) -> None:
    """Continue the numbers of a model's pedestrians in a copy."""
    Pedestrian._ids[copied].last = Pedestrian._ids[model].last


class Pedestrian(ContinuousSpaceAgent):
    """One person.

    Attributes:
        row: row of this person in the crowd's arrays, the same for ever.
    """

    # Mesa 3.3 keeps agent numbers in a dictionary that never frees a model.
    _ids = _Counters()

    def __init__(self, model: PedestrianModel, row: int) -> None:
        super().__init__(model.space, model)
        self.row = row

    @property
    def position(self) -> NDArray[np.float64]:
        """(2,) position, metres."""
        state = self.model.crowd
        return np.array([state.x[self.row], state.y[self.row]])

    @property
    def heading(self) -> float:
        """Facing, radians counter-clockwise from +x."""
        return float(self.model.crowd.heading[self.row])

    @property
    def velocity(self) -> NDArray[np.float64]:
        """(2,) mean velocity of the movement under way, m/s."""
        state = self.model.crowd
        return np.array([state.vx[self.row], state.vy[self.row]])

    @property
    def speed(self) -> float:
        """Mean speed of the movement under way, m/s."""
        return float(np.hypot(*self.velocity))

    @property
    def preferred_speed(self) -> float:
        """Preferred speed, m/s."""
        return float(self.model.crowd.agenda["speed"][self.row])

    @property
    def start_time(self) -> float:
        """Simulated time in seconds at which the person sets off, after its pre-movement time."""
        return float(self.model.crowd.agenda["sets_off"][self.row]) * FRAME_SECONDS

    def wait(
        self, seconds: float | None = None, *, until: Callable[[], bool] | None = None
    ) -> None:
        """Let the person stop when the movement under way has ended, and wait.

        Args:
            seconds: how long it waits, from now on.
            until: instead, a function that is called whenever the person could decide; the wait
                ends when it returns true.

        It walks on with its next decision, 0.4 s later at most.

        Raises:
            ModelError: neither of them, both, or a time out of range.
        """
        self.model.waits.tell(self.row, seconds, until, self.model.frame, self.model.crowd)

    @property
    def waiting(self) -> bool:
        """Whether the person waits, by ``wait`` or during its pre-movement time."""
        return bool(self.model.crowd.agenda["waits_until"][self.row] > self.model.frame)

    @property
    def group(self) -> str | int | None:
        """The group that the person belongs to, if any."""
        number = int(self.model.crowd.agenda["group"][self.row])
        return self.model.population.groups[number - 1] if number else None

    @property
    def route(self) -> tuple[str, ...]:
        """Names of the gates on the person's journey, in order; none if it has no journey."""
        return self.model.journeys.gates(int(self.model.crowd.agenda["journey"][self.row]))

    @property
    def gates_crossed(self) -> int:
        """Gates that the person had crossed when it last decided, over all laps."""
        return int(self.model.crowd.agenda["crossed"][self.row])

    @property
    def target(self) -> NDArray[np.float64]:
        """(2,) target of the last decision, metres."""
        state = self.model.crowd
        return np.array([state.target_x[self.row], state.target_y[self.row]])

    @property
    def pedestrian_type(self) -> PedestrianType:
        """The person's type."""
        return self.model.pedestrian_types[int(self.model.crowd.type_index[self.row])]

    @property
    def capability(self) -> Capability:
        """The component through which the person consults its type's mobility map."""
        return self.model.capabilities[int(self.model.crowd.type_index[self.row])]

    @property
    def cluster(self) -> int:
        """Cluster, in the type's map, of the pose in which the movement under way ends."""
        return self.model.population.cluster_of(self.row)

    @property
    def in_fallback(self) -> bool:
        """Whether the movement under way is the fallback."""
        return bool(self.model.crowd.option[self.row] == FALLBACK)

    @property
    def next_decision(self) -> float:
        """Seconds until the person decides again."""
        return float(self.model.crowd.end[self.row] - self.model.frame) * FRAME_SECONDS

    def pose(self, bank: PoseBank | None = None) -> BodyMotion:
        """The person's body now: joint positions and orientations, see ``BodyMotion``.

        Feet are held where they bear on the floor, as far as the last 3 s tell.

        Args:
            bank: poses of the person's type; by default those that ship for its map.

        Raises:
            ModelError: the model does not record decisions, or has taken no step.
            MapError: no poses of the person's map ship, or the bank is of another map.
        """
        from mesa_mobility.crowd.body import body_now

        return body_now(self, bank)

    def movement_options(self) -> Candidates:
        """The person's movement options, were it to decide here and now."""
        return self.model.candidates(np.array([self.row], dtype=np.int64))

    def remove(self) -> None:
        """Take the person out of the model."""
        self.model.remove_pedestrians([self])
