"""The people in a model: their agents and groups, and the rows of those inside."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesa_mobility.crowd.insertion import (
    TOUCHING,
    Assigned,
    Newcomers,
    check_beside_walls,
    check_column,
    check_places,
    distinct,
    face,
    first_free,
    place,
    too_close,
)
from mesa_mobility.crowd.pedestrian import Pedestrian
from mesa_mobility.crowd.scene import Scene
from mesa_mobility.crowd.space import CrowdSpace
from mesa_mobility.crowd.state.advance import Moved
from mesa_mobility.crowd.state.aggregates import EMPTY, Aggregates, aggregate, split_active
from mesa_mobility.crowd.state.departed import Departed
from mesa_mobility.crowd.suited_places import suited
from mesa_mobility.errors import MobilityError, ModelError
from mesa_mobility.floorplan.walls.line_of_sight import distances_to_walls

if TYPE_CHECKING:
    from mesa_mobility.crowd.model import PedestrianModel


class Population:
    """A model's people; each keeps its row of the crowd's arrays for ever.

    Args:
        scene: the floor and what people can do on it.
        space: Mesa's space.

    Attributes:
        count: people who have ever been in the model.
        rows: rows of the people inside, in the order of ``space.active_agents``.
        present: those of ``rows`` who have not left since the step began.
        departed: people who have crossed an exit within the last 1.5 s.
        groups: names of the groups, in the order of their numbers from 1 on.
        aggregates: sums over the people inside, after the last step.
    """

    def __init__(self, scene: Scene, space: CrowdSpace) -> None:
        self._scene = scene
        self._space = space
        self.count = 0
        self.rows = np.empty(0, dtype=np.int64)
        self.present = self.rows
        self.departed = Departed()
        self.groups: list[str | int] = []
        self.aggregates: Aggregates = EMPTY
        self._agents_by_row: list[Pedestrian | None] = []

    @property
    def core_radii(self) -> NDArray[np.float64]:
        """(n,) core radius in metres of everybody who has ever been in the model."""
        return self._scene.crowd.core[: self.count].copy()

    def cluster_of(self, row: int) -> int:
        """Cluster, in the map of its type, of the pose in which a person's movement ends."""
        crowd, first_cluster = self._scene.crowd, self._scene.repertoire.first_cluster
        return int(crowd.cluster[row]) - int(first_cluster[crowd.type_index[row]])

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
        scene = self._scene
        points = check_places(positions, scene.plan)
        n = len(points)
        if new.type_index is None and new.population is None:
            new = replace(new, population=scene.shares)
        kinds = new.draw_types(n, scene.types, rng)
        ways = {
            kind: scene.journeys.start(new.exits, new.route, new.loop, kind)
            for kind in distinct(kinds)
        }
        if new.population is not None and len(ways) > 1:
            kinds = self._suited(points, kinds, ways, rng)
        speeds = new.draw_speeds(kinds, scene.types, rng)
        sets_off = frame + new.draw_waits(n, rng)
        if new.headings is not None:
            check_column("headings", new.headings, n)
        rows = np.arange(self.count, self.count + n, dtype=np.int64)
        if self.count + n > len(scene.crowd.x):
            scene.crowd.grow(max(self.count + n, 2 * len(scene.crowd.x)))
        placed = rows[:0]
        try:
            for kind, (destination, journey) in ways.items():
                own = np.flatnonzero(kinds == kind)
                core, there = scene.types[kind].core_radius, points[own]
                check_beside_walls(there, core, scene.plan, own)
                self._check_room(there, core, frame, own, placed)
                scene.environment.check_way_out(there, destination)
                assigned = Assigned(
                    type_index=kind,
                    core=core,
                    standing=int(scene.rules.standing[kind]),
                    destination=destination,
                    journey=journey,
                )
                place(scene.crowd, rows[own], there, speeds[own], frame, sets_off[own], assigned)
                placed = np.sort(np.concatenate([placed, rows[own]]))
        except MobilityError:
            scene.crowd.active[placed] = False
            raise
        scene.crowd.agenda["group"][rows] = self._group_number(new.group)
        return rows

    def _suited(
        self,
        points: NDArray[np.float64],
        kinds: NDArray[np.int64],
        ways: dict[int, tuple[int, int]],
        rng: np.random.Generator,
    ) -> NDArray[np.int64]:
        """(n,) the same types, at places with room for their bodies and a way out as wide."""
        scene = self._scene
        cores = np.array([kind.core_radius for kind in scene.types])
        _, others, radii = self.bodies()

        def suits(kind: int) -> NDArray[np.bool_]:
            away = distances_to_walls(scene.plan, points, float(cores[kind]))
            lost = scene.environment.without_way_out(points, ways[kind][0])
            return (away >= cores[kind] - TOUCHING) & ~lost

        if not scene.rules.hard_bodies:
            others, radii = others[:0], radii[:0]
        found, short = suited(points, kinds, cores, suits, (others, radii), rng)
        if short is not None:
            kind, room = short
            raise ModelError(
                f"population: {int((kinds == kind).sum())} people are of type "
                f"{scene.types[kind].name!r}, but only {room} of them can stand at the "
                f"{len(points)} places and leave, expected room and a way out for bodies of "
                f"{cores[kind]:g} m radius"
            )
        return found

    def admit(
        self,
        rows: NDArray[np.int64],
        targets: NDArray[np.float64],
        headings: ArrayLike | None,
        model: PedestrianModel,
    ) -> list[Pedestrian]:
        """Let people in who have just been placed.

        Args:
            rows: (n,) their rows.
            targets: (n, 2) metres.
            headings: (n,) radians; by default everybody faces its target.
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
            people.append(Pedestrian(model, number if number == row else row))
        self._agents_by_row.extend(people)
        return people

    def part(self, moved: Moved) -> None:
        """Note who has stayed and who has left; Mesa's registers follow at the end of the step."""
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
        """Remove people who have left from Mesa's registers.

        Later ones take their indices in its space; ``look_over`` writes the positions anew.
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
        self, places: NDArray[np.float64], type_index: int, frame: int
    ) -> NDArray[np.float64] | None:
        """(2,) the first of (n, 2) places with room for a body of this type, or None."""
        scene = self._scene
        if not scene.rules.hard_bodies:
            return places[0] if len(places) else None
        # People who have just crossed an exit still take up room.
        there = self.departed.together_with(self.present)
        free = first_free(
            places, scene.types[type_index].core_radius, frame, there, scene.repertoire.table,
            scene.crowd.records, scene.rules.search_radius,
        )  # fmt: skip
        return places[free] if free >= 0 else None

    def _check_room(
        self,
        points: NDArray[np.float64],
        core: float,
        frame: int,
        numbers: NDArray[np.int64],
        placed: NDArray[np.int64],
    ) -> None:
        """Refuse places without room; (n,) ``numbers`` of people, and rows of newcomers before."""
        scene = self._scene
        if not scene.rules.hard_bodies:
            return
        where, who = too_close(
            points, core, frame, np.concatenate([self.present, placed]), scene.repertoire.table,
            scene.crowd.records, scene.rules.search_radius,
        )  # fmt: skip
        if where >= 0:
            newcomer = who < 0 or who >= self.count
            other = "another newcomer" if newcomer else f"where pedestrian {who} is or will be"
            raise ModelError(
                f"pedestrian {numbers[where]} at {points[where].tolist()}: too close to {other}, "
                "expected room for both bodies"
            )

    def _group_number(self, group: str | int | None) -> int:
        """Number of a group, which is new if its name is; 0 for none."""
        if group is None:
            return 0
        if group not in self.groups:
            self.groups.append(group)
        return self.groups.index(group) + 1
