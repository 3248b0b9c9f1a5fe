"""The people in a model: adding, removing and counting them."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Sequence
from numbers import Integral
from typing import TYPE_CHECKING

import mesa
import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesa_mobility.crowd.insertion import (
    Newcomer,
    check_beside_walls,
    check_column,
    check_places,
    draw_column,
    face,
    first_free,
    place,
    too_close,
)
from mesa_mobility.crowd.options.repertoire import Repertoire
from mesa_mobility.crowd.pedestrian import Pedestrian
from mesa_mobility.crowd.pedestrian_type import PedestrianType
from mesa_mobility.crowd.planning.workspace import Rules
from mesa_mobility.crowd.presets import preset_named
from mesa_mobility.crowd.sources import PLACES_TRIED, Inflow, Source
from mesa_mobility.crowd.space import CrowdSpace
from mesa_mobility.crowd.state.aggregates import EMPTY, Aggregates, aggregate, split_active
from mesa_mobility.crowd.state.departed import Departed
from mesa_mobility.crowd.state.environment import Environment, passing_of
from mesa_mobility.crowd.state.records import Crowd
from mesa_mobility.crowd.tactics.journeys import Journeys
from mesa_mobility.crowd.tactics.speed_rules import FASTEST, SpeedRule
from mesa_mobility.crowd.tactics.waiting import frames_of
from mesa_mobility.distributions import Distribution
from mesa_mobility.errors import ModelError
from mesa_mobility.floorplan import FloorPlan
from mesa_mobility.floorplan.entrance import Entrance, read_entrance

if TYPE_CHECKING:
    from mesa_mobility.floorplan import Targets


class Population(mesa.Model, ABC):
    """A model's people; each keeps its row of the crowd's arrays for ever."""

    floor_plan: FloorPlan
    pedestrian_types: tuple[PedestrianType, ...]
    space: CrowdSpace
    crowd: Crowd
    count: int
    frame: int
    _repertoire: Repertoire
    _rules: Rules
    _site: Environment
    journeys: Journeys
    groups: list[str | int]
    speed_rules: list[SpeedRule]
    sources: list[Inflow]
    _entrances: list[Entrance]
    preset: str
    _rows: NDArray[np.int64]
    _next: int
    _seen: Aggregates
    _beyond: Departed
    _agents_by_row: list[Pedestrian | None]

    def add_pedestrians(
        self,
        positions: ArrayLike,
        *,
        headings: ArrayLike | None = None,
        preferred_speeds: ArrayLike | Distribution | None = None,
        pre_movement: ArrayLike | Distribution = 0.0,
        exits: Sequence[str] | None = None,
        route: Sequence[str] = (),
        loop: bool = False,
        group: str | int | None = None,
        type_index: int = 0,
    ) -> list[Pedestrian]:
        """Put people on the floor, standing.

        Args:
            positions: (n, 2) metres, on free floor, with room for the body between walls.
            headings: (n,) radians; by default everybody faces its first target.
            preferred_speeds: (n,) m/s or a distribution; by default drawn from the type.
            pre_movement: (n,) seconds, or a distribution of them, for which they stand before they
                set off; their first decision is in the first frame after that.
            exits: names of the exits by which they may leave; by default all.
            route: names of gates that they cross in this order, in either direction, before they
                leave.
            loop: whether the route starts over after its last gate, and they never leave. On a
                closed track three gates or more determine the direction.
            group: name or number of the group that they join.
            type_index: index of their type in ``pedestrian_types``.

        Raises:
            ModelError: positions off the floor, too near to a wall, or where somebody is or will
                be; an unknown type; arrays of the wrong length; numbers out of range.
            FloorPlanError: an unknown exit or gate, or no way from a position to any exit, or to
                the route's first gate, or on from a gate.
        """
        points = check_places(positions, self.floor_plan)
        n = len(points)
        self._check_type_index(type_index)
        ptype = self.pedestrian_types[type_index]
        if preferred_speeds is None:
            preferred_speeds = ptype.draw_speeds(n, self.rng)
        speeds = draw_column("preferred_speeds", preferred_speeds, n, self.rng)
        off = ~((speeds > 0.0) & (speeds <= FASTEST))
        if off.any():
            raise ModelError(
                f"preferred_speeds: got {speeds[off][0]}, expected more than 0 and at most "
                f"{FASTEST:g} m/s"
            )
        waits = draw_column("pre_movement", pre_movement, n, self.rng)
        sets_off = self.frame + frames_of(waits, "pre_movement")
        facing = None if headings is None else check_column("headings", headings, n)
        destination, journey = self._where_to(exits, route, loop, type_index)
        new = Newcomer(
            type_index=type_index,
            core=ptype.core_radius,
            standing=int(self._rules.standing[type_index]),
            destination=destination,
            journey=journey,
            group=self._group_number(group),
        )
        check_beside_walls(points, new.core, self.floor_plan)
        self._check_room(points, new.core)
        self._site.check_way_out(points, new.destination)
        rows = np.arange(self.count, self.count + n, dtype=np.int64)
        if self.count + n > len(self.crowd.x):
            self.crowd.grow(max(self.count + n, 2 * len(self.crowd.x)))
        place(self.crowd, rows, points, speeds, self.frame, sets_off, new)
        inside = np.concatenate([self._present, rows])
        # Those who have not set off face their first target, too.
        aim = self._set_targets(rows, inside, all_go=True).points - points
        face(self.crowd, rows, np.arctan2(aim[:, 1], aim[:, 0]) if facing is None else facing)
        self.count += n
        self._rows = np.concatenate([self._rows, rows])
        self._next = self.frame
        people = self._make_agents(range(self.count - n, self.count))
        self._agents_by_row.extend(people)
        self._look_over()
        self.running = True
        return people

    def _make_agents(self, rows: range) -> list[Pedestrian]:
        """Mesa's agents for the people in ``rows``."""
        people: list[Pedestrian] = []
        for row in rows:
            # Mostly a row equals the unique id of the person before: sharing the int object saves
            # 32 bytes.
            number = people[-1].unique_id if people else row
            people.append(Pedestrian(self, number if number == row else row))
        return people

    def add_source(self, source: Source) -> Inflow:
        """Let people in over time.

        Each appears at a random place of the source's area with room for its body. While there is
        no room, people are held back in order.

        Returns:
            The inflow, which counts those who have come and those held back.

        Raises:
            ModelError: an unknown type.
            FloorPlanError: an area without room for a body, an unknown exit or gate, or no route
                from there.
        """
        self._check_type_index(source.type_index)
        core = self.pedestrian_types[source.type_index].core_radius
        entrance = Entrance(
            self.floor_plan,
            read_entrance(source.area),
            clearance=core + 0.01,
            passing=passing_of(core),
        )
        destination, _ = self._where_to(source.exits, source.route, source.loop, source.type_index)
        somewhere = entrance.room.representative_point()
        self._site.check_way_out(np.array([[somewhere.x, somewhere.y]]), destination)
        inflow = Inflow(source, self.frame, self.rng)
        self.sources.append(inflow)
        self._entrances.append(entrance)
        self.running = True
        return inflow

    @property
    def expecting(self) -> bool:
        """Whether a source has more people to come."""
        return not all(inflow.finished for inflow in self.sources)

    @property
    def _endless(self) -> bool:
        """Whether somebody inside never leaves, or people come for ever."""
        journeys = np.unique(self.crowd.agenda["journey"][self._rows]).tolist()
        round_ = any(self.journeys.endless(number) for number in journeys)
        return round_ or any(inflow.source.endless for inflow in self.sources)

    def _let_in(self) -> NDArray[np.int64]:
        """Let in those who have come, as far as there is room; (n,) their rows."""
        first = self.count
        for inflow, entrance in zip(self.sources, self._entrances, strict=True):
            inflow.count(self.frame)
            while inflow.waiting:
                place = self._free_place(entrance, inflow.source.type_index)
                if place is None:
                    break
                self.add_pedestrians([place], **inflow.source.keywords())
                inflow.entered += 1
        return np.arange(first, self.count, dtype=np.int64)

    def _free_place(self, entrance: Entrance, type_index: int) -> NDArray[np.float64] | None:
        places = entrance.draw(PLACES_TRIED, self.rng)
        core, rules = self.pedestrian_types[type_index].core_radius, self._rules
        if not rules.hard_bodies:
            return places[0] if len(places) else None
        # People who have just crossed an exit still take up room.
        there = self._beyond.together_with(self._present)
        free = first_free(
            places, core, self.frame, there, self._repertoire.table, self.crowd.records,
            rules.search_radius,
        )  # fmt: skip
        return places[free] if free >= 0 else None

    @property
    def _present(self) -> NDArray[np.int64]:
        """Rows of the people inside, without those who have left since the step began."""
        return self._rows[self.crowd.active[self._rows]]

    def bodies(self) -> tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.float64]]:
        """(n,) row, (n, 2) position and (n,) core radius, metres, of everybody inside."""
        rows, crowd = self._present, self.crowd
        return rows, np.column_stack([crowd.x[rows], crowd.y[rows]]), crowd.core[rows]

    def remove_pedestrians(self, people: Iterable[Pedestrian]) -> None:
        """Take people out of the model."""
        for person in people:
            self.crowd.active[person.row] = False
        self._take_out_inactive()
        self._look_over()

    def _take_out_inactive(self) -> None:
        """Remove people who have left from Mesa's registers.

        Later ones take their indices in its space; positions must be written anew.
        """
        stay, places = np.empty_like(self._rows), np.empty_like(self._rows)
        count = split_active(self._rows, self.crowd.records, stay, places)
        leaving = places[:count].tolist()
        for at in leaving:
            row = self._rows[at]
            person = self._agents_by_row[row]
            if person is not None:
                self.deregister_agent(person)
                self._agents_by_row[row] = None
        self.space.take_out(leaving)
        self._rows = stay[: len(stay) - count]

    @property
    def rows(self) -> NDArray[np.int64]:
        """Rows of the people inside, in the order of ``space.active_agents``."""
        return self._rows

    @property
    def core_radii(self) -> NDArray[np.float64]:
        """(n,) core radius in metres of everybody who has ever been in the model."""
        return self.crowd.core[: self.count].copy()

    def _where_to(
        self, exits: Sequence[str] | None, route: Sequence[str], loop: bool, type_index: int
    ) -> tuple[int, int]:
        """Numbers of the first destination and of the journey."""
        if isinstance(exits, str):
            raise ModelError(f"exits: got {exits!r}, expected a list of names such as [{exits!r}]")
        if loop and not len(route):
            raise ModelError("loop: got no route, expected names of at least two gates")
        names = None if exits is None else tuple(exits)
        if not len(route):
            return self._site.destination(names, type_index), 0
        journey = self.journeys.add(route, loop, names, type_index)
        return self.journeys.first(journey), journey

    def _check_type_index(self, type_index: int) -> None:
        if not (isinstance(type_index, Integral) and 0 <= type_index < len(self.pedestrian_types)):
            raise ModelError(
                f"type_index: got {type_index!r}, expected the index of a type, "
                f"0 to {len(self.pedestrian_types) - 1}"
            )

    def _group_number(self, group: str | int | None) -> int:
        if group is None:
            return 0
        if not isinstance(group, str | int):
            raise ModelError(f"group: got {group!r}, expected a name or number")
        if group not in self.groups:
            if not self.groups:
                self.speed_rules += preset_named(self.preset).make_group_paces()
            self.groups.append(group)
        return self.groups.index(group) + 1

    def _check_room(self, points: NDArray[np.float64], core: float) -> None:
        if not self._rules.hard_bodies:
            return
        where, who = too_close(
            points, core, self.frame, self._present, self._repertoire.table, self.crowd.records,
            self._rules.search_radius,
        )  # fmt: skip
        if where >= 0:
            other = "another newcomer" if who < 0 else f"where pedestrian {who} is or will be"
            raise ModelError(
                f"pedestrian {where} at {points[where].tolist()}: too close to {other}, "
                "expected room for both bodies"
            )

    @abstractmethod
    def _set_targets(
        self, rows: NDArray[np.int64], inside: NDArray[np.int64], *, all_go: bool = False
    ) -> Targets:
        """Set the targets of the people in ``rows``, who are among those ``inside``; those who wait
        get one only if ``all_go``."""

    def _look_over(self) -> None:
        """Aggregate everybody inside, and write positions to Mesa's space."""
        self._seen = EMPTY
        if len(self._rows):
            self._seen = aggregate(self._rows, self.frame, self.crowd, self.space.agent_positions)
