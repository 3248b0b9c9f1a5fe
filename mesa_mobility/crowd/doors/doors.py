"""The doors of a model that close by themselves, and who has passed them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, ClassVar, overload

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.doors.door import Door
from mesa_mobility.crowd.options.table import FRAME_SECONDS
from mesa_mobility.crowd.saved import Saved
from mesa_mobility.crowd.state.environment import Environment
from mesa_mobility.crowd.state.records import Crowd
from mesa_mobility.errors import ModelError
from mesa_mobility.floorplan import FloorPlan
from mesa_mobility.schema import Array, Each, Flag, Kind, Members, Object, Real, Several, Text


class DoorControl(Saved):
    """A door in a model, with its counts.

    Args:
        door: what it does.
        plan: the floor plan.

    Attributes:
        door: what it does.
    """

    saved: ClassVar[Mapping[str, Kind]] = {
        "_passed": Array("i8", ("passed",), 0, below="people"),
        "_allowance": Real(-1e9, 1e9),
        "_timed": Flag(),
        "_full": Flag(),
    }

    def __init__(self, door: Door, plan: FloorPlan) -> None:
        self.door = door
        self._plan = plan
        gate = plan.gate(door.name)
        self._line = np.array([*gate.a, *gate.b])
        self._passed = np.empty(0, dtype=np.int64)
        self._allowance = 1.0
        self._timed = self._full = False

    @property
    def people(self) -> int:
        """How many people have passed it, each counted once."""
        return len(self._passed)

    @property
    def is_full(self) -> bool:
        """Whether as many have passed it as its capacity."""
        return self._full

    @property
    def shut(self) -> bool:
        """Whether the next person has to wait, since its rate is used up."""
        return self.door.rate is not None and self._allowance < 1.0 - 1e-9

    def follow_times(self, frame: int) -> None:
        """Close or open the gate if it is time."""
        closed = self.door.closed_at(frame * FRAME_SECONDS)
        if closed != self._timed:
            self._timed = closed
            if closed:
                self._plan.close_gate(self.door.name)
            elif not self._full:
                self._plan.open_gate(self.door.name)

    def count(
        self, rows: NDArray[np.int64], before: NDArray[np.float64], after: NDArray[np.float64]
    ) -> None:
        """Count those who have crossed the line in a frame, and close the gate if it is full.

        Args:
            rows: (n,) people.
            before: (n, 2) where they were a frame ago, metres.
            after: (n, 2) where they are, metres.
        """
        if self.door.rate is not None:
            saved = self._allowance + self.door.rate * FRAME_SECONDS
            self._allowance = min(saved, self.door.most_saved)
        crossed = rows[_crossed(self._line, before, after)]
        if not len(crossed):
            return
        if self.door.rate is not None:
            self._allowance -= len(crossed)
        self._passed = np.union1d(self._passed, crossed)
        capacity = self.door.capacity
        if capacity is not None and not self._full and self.people >= capacity:
            self._full = True
            self._plan.close_gate(self.door.name)


class Doors(Sequence[DoorControl], Saved):
    """A model's doors that close by themselves, in the order in which they were added.

    Args:
        plan: the floor plan.
        environment: walls and routes, in which doors are shut.
    """

    def __init__(self, plan: FloorPlan, environment: Environment) -> None:
        self._plan = plan
        self._environment = environment
        self._controls: list[DoorControl] = []
        self._shut: frozenset[str] = frozenset()

    @overload
    def __getitem__(self, index: int) -> DoorControl: ...

    @overload
    def __getitem__(self, index: slice) -> list[DoorControl]: ...

    def __getitem__(self, index: int | slice) -> DoorControl | list[DoorControl]:
        return self._controls[index]

    def __len__(self) -> int:
        return len(self._controls)

    def members(self) -> Mapping[str, Kind]:
        """What the members of ``state`` are."""
        return {
            "doors": Several(Each(Object(Door), Members(DoorControl.saved))),
            "shut": Several(Text("openings")),
        }

    def state(self) -> dict[str, Any]:
        """The doors, who has passed each, and which are shut."""
        return {
            "doors": [(each.door, each.state()) for each in self._controls],
            "shut": sorted(self._shut),
        }

    def restore(self, state: Mapping[str, Any]) -> None:
        """Take over what ``state`` has given; the floor plan must be as it was."""
        self._controls.clear()
        for door, control in state["doors"]:
            self.add(door).restore(control)
        self._shut_openings(state["shut"])

    def add(self, door: Door) -> DoorControl:
        """Let a gate or exit close by itself from now on.

        Raises:
            ModelError: no ``Door``, or another one is there for this gate or exit.
            FloorPlanError: there is no such gate or exit.
        """
        if not isinstance(door, Door):
            raise ModelError(f"door: got {door!r:.60}, expected a Door")
        if any(each.door.name == door.name for each in self._controls):
            raise ModelError(f"door {door.name!r}: is there already, expected one for each gate")
        control = DoorControl(door, self._plan)
        self._controls.append(control)
        return control

    def advance(self, frame: int) -> bool:
        """Close and open doors; whether one has been shut to the next person.

        Args:
            frame: now.
        """
        for each in self._controls:
            each.follow_times(frame)
        return self._shut_openings(each.door.name for each in self._controls if each.shut)

    def _shut_openings(self, names: Iterable[str]) -> bool:
        self._shut = frozenset(names)
        return self._environment.shut_openings("doors", self._shut)

    def look(self, rows: NDArray[np.int64], before: NDArray[np.float64], crowd: Crowd) -> None:
        """Count those who have crossed a line in a frame.

        Args:
            rows: (n,) people.
            before: (n, 2) where they were a frame ago, metres.
            crowd: the crowd.
        """
        after = np.column_stack([crowd.x[rows], crowd.y[rows]])
        for each in self._controls:
            each.count(rows, before, after)


def _crossed(
    line: NDArray[np.float64], before: NDArray[np.float64], after: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """(n,) whether ways from (n, 2) to (n, 2) lead from one side of a line (4,) over it."""
    a, b = line[:2], line[2:]
    along, normal = b - a, np.array([a[1] - b[1], b[0] - a[0]])
    side, later = (before - a) @ normal, (after - a) @ normal
    over = (side > 0.0) != (later > 0.0)
    with np.errstate(invalid="ignore", divide="ignore"):
        share = side / (side - later)
        at = (before + share[:, None] * (after - before) - a) @ along / (along @ along)
    found: NDArray[np.bool_] = over & (at >= 0.0) & (at <= 1.0)
    return found
