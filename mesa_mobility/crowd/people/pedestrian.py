"""A pedestrian: a Mesa agent that is a view of one row of the crowd's arrays."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from mesa_mobility._mesa import ContinuousSpaceAgent, mesa
from mesa_mobility.crowd.costs.candidates import Candidates
from mesa_mobility.crowd.journeys.visit import Route, Visit
from mesa_mobility.crowd.journeys.waiting import waiting
from mesa_mobility.crowd.options.capability import Capability
from mesa_mobility.crowd.options.table import FRAME_SECONDS
from mesa_mobility.crowd.state.fields import field_column
from mesa_mobility.crowd.state.records import FALLBACK
from mesa_mobility.crowd.types.pedestrian_type import PedestrianType
from mesa_mobility.errors import ModelError
from mesa_mobility.plugins.settings import has_attribute, near_miss

if TYPE_CHECKING:
    from mesa_mobility.bodies import BodyMotion, PoseBank


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


_SETTABLE = ("exits", "group", "preferred_speed", "route")
"""What users set of a person, beside the fields of the model."""

_FOLLOWING = "agent_id_counter"
"""Where models of a newer Mesa keep the number of the next agent."""


def last_number(model: mesa.Model) -> int:
    """Number of the last agent that a model has got."""
    following: int | None = getattr(model, _FOLLOWING, None)
    return Pedestrian._ids[model].last if following is None else following - 1


def number_from(model: mesa.Model, last: int) -> None:
    """Let the numbers of a model's agents go on after ``last``."""
    Pedestrian._ids[model].last = last
    if hasattr(model, _FOLLOWING):
        setattr(model, _FOLLOWING, last + 1)


def _fields_of(person: Pedestrian) -> dict[str, NDArray[Any]]:
    """The fields of a person's model; none while the agent is being made or copied."""
    model = person.__dict__.get("model")
    crowd = None if model is None else model.__dict__.get("crowd")
    return {} if crowd is None else crowd.fields


class Pedestrian(ContinuousSpaceAgent):
    """One person.

    The fields that a model declares for its people are attributes, read and written. A subclass
    may have attributes of its own, and a ``step``, which is called for each person inside once a
    step of the model, before anybody moves.

    Attributes:
        row: row of this person in the crowd's arrays, the same for ever.
    """

    # Mesa 3.3 keeps agent numbers in a dictionary that never frees a model.
    _ids = _Counters()

    def __init__(self, model: Any, row: int | None = None) -> None:
        if not model.population.awaits(row):
            raise ModelError(
                f"{type(self).__name__}(...): nobody stands on the floor for this agent, expected "
                "add_pedestrians or add_source, which make agents"
            )
        super().__init__(model.space, model)
        assert row is not None
        self.row = row

    def __getattr__(self, name: str) -> Any:
        """The value of a field that the model declares; called where there is nothing else."""
        fields = _fields_of(self)
        if name in fields:
            return fields[name][self.row].item()
        raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")

    def __setattr__(self, name: str, value: Any) -> None:
        fields = _fields_of(self)
        if name == "row" and "row" in self.__dict__:
            raise ModelError(
                f"pedestrian {self.row}: their row is the same for ever, got {value!r}"
            )
        if name in fields:
            column = fields[name]
            column[self.row] = field_column(name, column.dtype, value, 1)[0]
        else:
            if not (name in self.__dict__ or name[:1] == "_" or has_attribute(self, name)):
                self._refuse_misspelt(name, fields)
            object.__setattr__(self, name, value)

    def _refuse_misspelt(self, name: str, fields: Iterable[str]) -> None:
        """Raise ModelError where a new attribute is a misspelling of one that can be set.

        Agents may have attributes of their users' own, so that no other names are refused, and
        none in a constructor.
        """
        meant, model = near_miss(name, (*_SETTABLE, *fields)), self.__dict__.get("model")
        row = self.__dict__.get("row")
        if meant is None or model is None or model.population.awaits(row):
            return
        raise ModelError(
            f"pedestrian {row}: no attribute {name!r}, did you mean {meant!r}? One of your own is "
            "set in the constructor, or declared in the class"
        )

    def __repr__(self) -> str:
        called = f"{type(self).__name__} {self.__dict__.get('row', '')}".rstrip()
        if "row" not in self.__dict__ or not self.model.crowd.active[self.row]:
            return f"<{called}, not inside>"
        x, y = self.position
        return f"<{called} at ({x:.2f}, {y:.2f}), {self.speed:.2f} m/s>"

    @property
    def position(self) -> NDArray[np.float64]:
        """(2,) position, metres; people walk, and cannot be put elsewhere."""
        state = self.model.crowd
        return np.array([state.x[self.row], state.y[self.row]])

    @position.setter
    def position(self, value: object) -> None:
        raise ModelError(
            f"pedestrian {self.row}: people walk by themselves; expected remove() and "
            "add_pedestrians to put somebody elsewhere"
        )

    @property
    def pos(self) -> NDArray[np.float64]:
        """(2,) the position, by the name that Mesa's drawings use."""
        return self.position

    @pos.setter
    def pos(self, value: object) -> None:
        if value is not None:  # Mesa begins with None
            self.position = value

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
        """Preferred speed, m/s; a new one counts from the next decision on."""
        return float(self.model.crowd.agenda["speed"][self.row])

    @preferred_speed.setter
    def preferred_speed(self, speed: float) -> None:
        self.model.population.set_speed(self.row, speed)

    @property
    def exits(self) -> tuple[str, ...]:
        """Names of the exits by which the person may leave; none if they go round for ever.

        New exits count from the next decision on, and end the person's route. Set None for all
        exits.
        """
        return self.model.population.exits(self.row)

    @exits.setter
    def exits(self, names: Sequence[str] | None) -> None:
        self.model.population.send(self.row, names, (), self.model.frame)

    @property
    def start_time(self) -> float:
        """Simulated time in seconds at which the person sets off, after their pre-movement time."""
        return float(self.model.crowd.agenda["sets_off"][self.row]) * FRAME_SECONDS

    def wait(
        self, seconds: float | None = None, *, until: Callable[[], bool] | None = None
    ) -> None:
        """Let the person stop when the movement under way has ended, and wait.

        Args:
            seconds: how long the person waits, from now on.
            until: instead, a function that is called whenever the person could decide; the wait
                ends when it returns true.

        The person walks on with their next decision, 0.4 s after the wait at most.

        Raises:
            ModelError: neither of them, both, a time out of range, or the person has left.
        """
        self.model.population.check_inside(self.row)
        self.model.waits.tell(self.row, seconds, until, self.model.frame, self.model.crowd)

    @property
    def waiting(self) -> bool:
        """Whether the person waits: told to, at a place that they visit, held by a behaviour, or
        before they set off."""
        return bool(waiting(np.array([self.row]), self.model.frame, self.model.crowd)[0])

    @property
    def group(self) -> str | int | None:
        """The group that the person belongs to, or None; set None to let them leave it."""
        number = int(self.model.crowd.agenda["group"][self.row])
        return self.model.population.groups[number - 1] if number else None

    @group.setter
    def group(self, name: str | int | None) -> None:
        self.model.population.join(self.row, name)

    @property
    def route(self) -> tuple[str | Visit, ...]:
        """Names of the gates, and the places, on the person's journey, in order; empty without a
        journey.

        A new route begins with the next decision, and ends at the exits that the person had.
        """
        return self.model.journeys.stops(int(self.model.crowd.agenda["journey"][self.row]))

    @route.setter
    def route(self, stops: Route) -> None:
        self.model.population.send(self.row, self.exits or None, stops, self.model.frame)

    @property
    def next_stop(self) -> str | Visit | None:
        """The gate or place of their route to which the person goes, or at which they stay; None if
        they go to their exits."""
        return self.model.journeys.next_stop(self.row, self.model.crowd)

    @property
    def gates_crossed(self) -> int:
        """How many gates the person had crossed, and places they had visited, when they last
        decided, over all laps."""
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
        """The component through which the person consults the mobility map by which they move:
        that of their type, or one for stairs."""
        return self.model.population.capability_of(self.row)

    @property
    def cluster(self) -> int:
        """Cluster, in the map by which they move, of the pose in which the movement ends."""
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
            bank: poses of the person's type; by default those that ship for the type's map.

        Raises:
            ModelError: the model does not record decisions, or has taken no step.
            MapError: no poses of the person's map ship, or the bank is of another map.
        """
        from mesa_mobility.crowd.people.body import body_now

        maps = self.model.mobility_maps[int(self.model.crowd.type_index[self.row])]
        return body_now(self.model, self.row, maps, bank)

    def movement_options(self) -> Candidates:
        """The person's movement options if they decided here and now."""
        return self.model.candidates(np.array([self.row], dtype=np.int64))

    def remove(self) -> None:
        """Take the person out of the model."""
        self.model.remove_pedestrians([self])


def check_pedestrian_class(kind: object) -> None:
    """Raise ModelError unless this is a class of agents for people."""
    if not (isinstance(kind, type) and issubclass(kind, Pedestrian)):
        raise ModelError(
            f"pedestrian_class: got {kind!r}, expected a class derived from Pedestrian"
        )
