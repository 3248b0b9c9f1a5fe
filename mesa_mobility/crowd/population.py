"""The people in a model: their agents and groups, and the rows of those inside."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, ClassVar

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray

from mesa_mobility._mesa import mesa
from mesa_mobility._numbers import is_number
from mesa_mobility.crowd.insertion.free_space import first_free, too_close
from mesa_mobility.crowd.insertion.newcomers import Newcomers
from mesa_mobility.crowd.insertion.placement import face, place_newcomers
from mesa_mobility.crowd.journeys.visit import Route
from mesa_mobility.crowd.options.capability import Capability
from mesa_mobility.crowd.people.pedestrian import Pedestrian, number_from
from mesa_mobility.crowd.people.space import CrowdSpace
from mesa_mobility.crowd.saved import Saved
from mesa_mobility.crowd.scene import Scene
from mesa_mobility.crowd.state.advance import Moved
from mesa_mobility.crowd.state.aggregates import EMPTY, Aggregates, aggregate, split_active
from mesa_mobility.crowd.state.departed import ROWS, Departed
from mesa_mobility.crowd.state.twins import with_copies
from mesa_mobility.errors import ModelError
from mesa_mobility.floorplan.walls.wall_distances import distances_to_walls
from mesa_mobility.schema import MOST, Either, Kind, Members, Several, Text, Whole


class Population(Saved):
    """A model's people; each keeps their row of the crowd's arrays for ever.

    Args:
        scene: the floor and what people can do on it.
        space: Mesa's space.
        pedestrian_class: class of the agents.

    Attributes:
        count: people who have ever been in the model.
        rows: rows of the people inside, in the order of ``space.active_agents``.
        present: those of ``rows`` who have not left since the step began.
        departed: people who have crossed an exit within the last 1.5 s.
        groups: names of the groups, in the order of their numbers from 1 on.
        aggregates: sums over the people inside, after the last step.
    """

    saved: ClassVar[Mapping[str, Kind]] = {
        "count": Whole(below="people+1"),
        "rows": ROWS,
        "present": ROWS,
        "groups": Several(Either(Text(), Whole(-MOST))),
    }

    def __init__(
        self, scene: Scene, space: CrowdSpace, pedestrian_class: type[Pedestrian] = Pedestrian
    ) -> None:
        self._scene = scene
        self._pedestrian_class = pedestrian_class
        self._space = space
        self.count = 0
        self.rows = np.empty(0, dtype=np.int64)
        self.present = self.rows
        self.departed = Departed()
        self.groups: list[str | int] = []
        self.aggregates: Aggregates = EMPTY
        self._agents_by_row: list[Pedestrian | None] = []

    def members(self) -> Mapping[str, Kind]:
        """What the members of ``state`` are."""
        return {
            **self.saved,
            **self._scene.crowd.members(),
            "departed": Members(self.departed.members()),
        }

    def state(self) -> dict[str, Any]:
        """Everybody's records, and who is inside."""
        crowd = self._scene.crowd
        return {
            **super().state(),
            **crowd.first(self.count),
            "departed": self.departed.state(),
        }

    def restore(self, state: Mapping[str, Any]) -> None:
        """Take over what ``state`` has given; agents are made by ``make_agents``."""
        super().restore(state)
        self.departed.restore(state["departed"])
        self._scene.crowd.replace(state)

    def make_agents(
        self, model: mesa.Model, unique_ids: Sequence[int], last_id: int, frame: int
    ) -> None:
        """Make the agents of those inside anew, with these numbers, and forget all others."""
        for agent in self._space.active_agents:
            model.deregister_agent(agent)
        self._space.take_out(list(range(len(self._space.active_agents))))
        self._agents_by_row = [None] * self.count
        for row, number in zip(self.rows.tolist(), unique_ids, strict=True):
            number_from(model, number - 1)
            self._agents_by_row[row] = self._pedestrian_class(model, row)
        number_from(model, last_id)
        self.look_over(frame)

    @property
    def core_radii(self) -> NDArray[np.float64]:
        """(n,) core radius in metres of everybody who has ever been in the model."""
        return self._scene.crowd.core[: self.count].copy()

    def cluster_of(self, row: int) -> int:
        """Cluster of the pose in which a person's movement ends, in the map by which they move."""
        return self._scene.repertoire.capability_of(int(self._scene.crowd.cluster[row]))[1]

    def capability_of(self, row: int) -> Capability:
        """The capability of the map by which a person moves."""
        return self._scene.repertoire.capability_of(int(self._scene.crowd.cluster[row]))[0]

    def bodies(self) -> tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.float64]]:
        """(n,) row, (n, 2) position and (n,) core radius, metres, of everybody inside."""
        rows, crowd = self.present, self._scene.crowd
        return rows, np.column_stack([crowd.x[rows], crowd.y[rows]]), crowd.core[rows]

    def place(
        self, positions: ArrayLike, new: Newcomers, frame: int, rng: np.random.Generator
    ) -> NDArray[np.int64]:
        """Put people on the floor, standing; they are inside once they are admitted.

        Args:
            positions: (n, 2) metres.
            new: who they are.
            frame: now.
            rng: the model's generator, from which speeds and times are drawn.

        Returns:
            (n,) their rows.

        Raises:
            ModelError: see ``PedestrianModel.add_pedestrians``.
            FloorPlanError: see there.
        """
        rows = place_newcomers(
            self._scene, positions, new, frame, rng, count=self.count, present=self.present
        )
        self._scene.crowd.agenda["group"][rows] = self._group_number(new.group)
        return rows

    def admit(
        self,
        rows: NDArray[np.int64],
        targets: NDArray[np.float64],
        headings: ArrayLike | None,
        model: mesa.Model,
    ) -> list[Pedestrian]:
        """Let people in who have just been placed.

        Args:
            rows: (n,) their rows.
            targets: (n, 2) metres.
            headings: (n,) radians; by default everybody faces their target.
            model: the model.

        Returns:
            Mesa's agent for each.
        """
        crowd = self._scene.crowd
        if headings is None:
            headings = np.arctan2(targets[:, 1] - crowd.y[rows], targets[:, 0] - crowd.x[rows])
        face(crowd, rows, headings)
        self.count += len(rows)
        self.rows = np.concatenate([self.rows, rows])
        self.present = np.concatenate([self.present, rows])
        people: list[Pedestrian] = []
        for row in rows.tolist():
            # Mostly a row equals the unique id of the person before: sharing the int object saves
            # 32 bytes.
            number = people[-1].unique_id if people else row
            people.append(self._pedestrian_class(model, number if number == row else row))
        self._agents_by_row.extend(people)
        return people

    def part(self, moved: Moved) -> None:
        """Record who is still inside and who has left.

        Mesa's lists of agents are updated at the end of the step.
        """
        self.present = moved.stay
        if len(moved.gone):
            self.departed.add(moved.gone)

    def remove(self, people: Iterable[Pedestrian]) -> None:
        """Take people out."""
        for person in people:
            self._scene.crowd.active[person.row] = False
        self.present = self.present[self._scene.crowd.active[self.present]]
        self.take_out_inactive()

    def take_out_inactive(self) -> None:
        """Remove people who have left from Mesa's lists of agents.

        People behind them move up in Mesa's space; ``look_over`` writes the positions anew.
        """
        if len(self.present) == len(self.rows):
            return
        stay, places = np.empty_like(self.rows), np.empty_like(self.rows)
        count = split_active(self.rows, self._scene.crowd.records, stay, places)
        leaving = places[:count].tolist()
        for at in leaving:
            row = self.rows[at]
            person = self._agents_by_row[row]
            if person is not None:
                person.model.deregister_agent(person)
                self._agents_by_row[row] = None
        self._space.take_out(leaving)
        self.rows = self.present = stay[: len(stay) - count]

    def look_over(self, frame: int) -> None:
        """Aggregate everybody inside, and write positions to Mesa's space."""
        self.aggregates = EMPTY
        if len(self.rows):
            self.aggregates = aggregate(
                self.rows, frame, self._scene.crowd, self._space.agent_positions
            )

    def see_off(self, frame: int) -> None:
        """Let people who have just crossed an exit walk on beyond it."""
        scene = self._scene
        self.departed.set_off(frame, scene.crowd, scene.environment.surroundings.exits)

    def first_free(
        self, places: NDArray[np.float64], type_index: int, new: Newcomers, frame: int
    ) -> NDArray[np.float64] | None:
        """(2,) the first of (n, 2) places at which somebody of this type can come in now, or None.

        Doors that have been closed since the places were chosen, and new obstacles, may leave no
        room there, or no way out.
        """
        scene, width = self._scene, self._scene.types[type_index].half_width
        destination, _ = scene.journeys.start(new.exits, new.route, new.loop, type_index)
        places = places[scene.plan.contains(places)]
        room = distances_to_walls(scene.plan, places, width) >= width
        places = places[room & ~scene.environment.without_way_out(places, destination)]
        if scene.plan.seams:
            places = places[~shapely.intersects_xy(scene.plan.copied, *places.T)]
        if not scene.rules.hard_bodies:
            return places[0] if len(places) else None
        # People who have just crossed an exit still take up room.
        there = self.departed.together_with(self.present)
        known = frame, there, scene.repertoire.table, scene.crowd.records, scene.rules.search_radius
        if not scene.plan.seams:
            free = first_free(places, width, *known)
            return places[free] if free >= 0 else None
        for place in places:
            spots, _ = with_copies(scene.strips, place[None], width)
            if too_close(spots, width, *known)[0] < 0:
                return place
        return None

    def awaits(self, row: int | None) -> bool:
        """Whether somebody inside has this row and no agent yet."""
        known = len(self._agents_by_row)
        return row is not None and (
            known <= row < self.count
            or (
                0 <= row < known
                and self._agents_by_row[row] is None
                and bool(self._scene.crowd.active[row])
            )
        )

    def send(self, row: int, exits: Sequence[str] | None, route: Route, frame: int) -> None:
        """Send somebody along a route and out by one of these exits.

        Args:
            row: of the person.
            exits: names of the exits; None for all exits.
            route: the gates that they cross before, and the places that they visit.
            frame: now.

        Raises:
            ModelError: the person has left, or a route that is no list of gates and visits.
            FloorPlanError: an unknown exit or gate, a place without room, or no way there.
        """
        self.check_inside(row)
        scene, crowd = self._scene, self._scene.crowd
        Newcomers(exits=exits, route=route)  # refuses what newcomers may not have
        kind = int(crowd.type_index[row])
        destination, journey = scene.journeys.start(exits, route, False, kind)
        place = np.array([[crowd.x[row], crowd.y[row]]])
        scene.environment.check_way_out(place, destination)
        scene.journeys.stays.end(row, frame, crowd)
        crowd.destination[row] = destination
        agenda = crowd.agenda
        agenda["journey"][row], agenda["crossed"][row] = journey, 0
        agenda["checked"][row], agenda["nearest"][row] = frame, np.inf

    def exits(self, row: int) -> tuple[str, ...]:
        """Names of the exits by which somebody may leave; none if they go round for ever."""
        crowd, journey = self._scene.crowd, int(self._scene.crowd.agenda["journey"][row])
        if journey:
            return self._scene.journeys.exits(journey)
        return self._scene.environment.exits(int(crowd.destination[row]))

    def set_speed(self, row: int, speed: float) -> None:
        """Change somebody's preferred speed, m/s.

        Raises:
            ModelError: the person has left, or a speed out of range.
        """
        self.check_inside(row)
        if not is_number(speed):
            raise ModelError(f"preferred_speed: got {speed!r:.60}, expected m/s, more than 0")
        given, crowd = Newcomers(preferred_speeds=speed), self._scene.crowd
        crowd.agenda["speed"][row] = given.draw_speeds(
            crowd.type_index[[row]].astype(np.int64), self._scene.types, np.random.default_rng(0)
        )[0]

    def join(self, row: int, group: str | int | None) -> None:
        """Let somebody join a group, or leave their own if ``group`` is None.

        Raises:
            ModelError: the person has left, or a group that is neither name nor number.
        """
        self.check_inside(row)
        Newcomers(group=group)
        self._scene.crowd.agenda["group"][row] = self._group_number(group)

    def check_inside(self, row: int) -> None:
        """Raise ModelError if the person in a row has left."""
        if not self._scene.crowd.active[row]:
            raise ModelError(f"pedestrian {row}: has left, expected somebody inside")

    def _group_number(self, group: str | int | None) -> int:
        """Number of a group, a new one for a new name; 0 for None."""
        if group is None:
            return 0
        if group not in self.groups:
            self.groups.append(group)
        return self.groups.index(group) + 1
