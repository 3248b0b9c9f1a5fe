"""One frame of a model: people come, decide, walk and leave."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import replace
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesa_mobility.crowd.bindings import Behaving, Bindings
from mesa_mobility.crowd.costs.candidates import Candidates, Moment
from mesa_mobility.crowd.costs.terms import without_weight
from mesa_mobility.crowd.doors.doors import Doors
from mesa_mobility.crowd.insertion.inflow import PLACES_TRIED, Sources
from mesa_mobility.crowd.insertion.newcomers import Newcomers
from mesa_mobility.crowd.journeys.waiting import Waits
from mesa_mobility.crowd.options.table import FRAMES_A_SECOND
from mesa_mobility.crowd.people.pedestrian import Pedestrian
from mesa_mobility.crowd.planning.decision_order import decision_order, due
from mesa_mobility.crowd.planning.evaluation.candidate_batch import Outlook, make_candidates
from mesa_mobility.crowd.planning.explanation import Explanation, Watch, judge, weigh
from mesa_mobility.crowd.planning.replanning import stop_where_blocked
from mesa_mobility.crowd.planning.scheduler import DecisionScheduler
from mesa_mobility.crowd.population import Population
from mesa_mobility.crowd.running.recorder import DecisionRecorder, Recorder
from mesa_mobility.crowd.running.statistics import Statistics
from mesa_mobility.crowd.running.trace import Trace
from mesa_mobility.crowd.saved import Saved
from mesa_mobility.crowd.scene import Scene
from mesa_mobility.crowd.state.advance import LONG_AFTER, move
from mesa_mobility.crowd.state.people_grid import Grid, grid_of_frame
from mesa_mobility.crowd.state.twins import Twins, change_sheets, laid_twins
from mesa_mobility.crowd.state.wishes import Wishes
from mesa_mobility.crowd.tactics.desired_motion import DesiredMotion, Wants
from mesa_mobility.errors import ModelError
from mesa_mobility.floorplan import Targets
from mesa_mobility.schema import Flag, Kind, Whole


class Run(Behaving, Protocol):
    """A model as its dynamics see it: what may change at any time, and what they change."""

    population: Population
    sources: Sources
    doors: Doors
    statistics: Statistics
    waits: Waits
    recorder: Recorder | None
    decisions: DecisionRecorder | None
    watch: Watch | None
    frame: int


class Dynamics(Saved):
    """Advances a model's people, frame by frame.

    Args:
        model: the model, whose behaviours may change at any time.
        scene: its floor, and what people can do on it.

    Attributes:
        trace: keeps where people have been in the last moments, where somebody watches.
    """

    def members(self) -> Mapping[str, Kind]:
        """What the members of ``state`` are."""
        return {
            "next": Whole(high=LONG_AFTER),
            "grouped": Flag(),
            "plan_has_changed": Flag(),
        }

    def __init__(self, model: Run, scene: Scene) -> None:
        self.trace: Trace | None = None
        self._model = model
        self._scene = scene
        self._scheduler = DecisionScheduler(
            scene.repertoire,
            scene.rules,
            least_core=min(each.least_core for each in scene.types),
            types=[each.name for each in scene.types],
        )
        self._desired_motion = DesiredMotion(scene.environment, scene.crowd)
        # Frame of the next event other than walking: a decision, or somebody leaves.
        self._next = 0
        self._bindings = Bindings()
        self._grouped = False
        self._plan_version = scene.plan.version

    def state(self) -> dict[str, Any]:
        """When the next decision is, and whether the plan has changed since the last ones."""
        return {
            "next": self._next,
            "grouped": self._grouped,
            "plan_has_changed": self._plan_has_changed,
        }

    def restore(self, state: Mapping[str, Any]) -> None:
        """Take over what ``state`` has given; the floor plan must be as it was."""
        self._next, self._grouped = state["next"], state["grouped"]
        self._plan_version = -1 if state["plan_has_changed"] else self._scene.plan.version

    def bind(self) -> None:
        """Bind behaviours that have come in since the last time, and look at all their names.

        Raises:
            ModelError: two cost terms of one name for people of one type, something that is no
                behaviour or has no name, or a behaviour that serves another model by now.
        """
        model = self._model
        if model.population.groups and not self._grouped:
            self._grouped = True
            model.speed_rules += self._scene.preset.make_group_paces()
        self._bindings.bind(model)

    def insert(self, positions: ArrayLike, new: Newcomers) -> list[Pedestrian]:
        """Put people on the floor; see ``PedestrianModel.add_pedestrians``.

        Raises:
            ModelError: see there.
            FloorPlanError: see there.
        """
        model, people = self._model, self._model.population
        rows = people.place(positions, new, model.frame, model.rng)
        # Those who have not set off face their first target, too.
        targets = self._set_targets(rows, np.concatenate([people.present, rows]), newcomers=True)
        agents = people.admit(rows, targets.points, new.headings, model)
        if self.trace is not None:
            self.trace.come(model.frame, rows, self._scene.crowd)
        self._next = model.frame
        people.look_over(model.frame)
        return agents

    def advance(self, end: int) -> None:
        """Take this frame's decisions and advance to the next frame in which anything but walking
        happens, to frame ``end`` at most."""
        model, people, statistics = self._model, self._model.population, self._model.statistics
        crowd, now = self._scene.crowd, self._model.frame
        people.see_off(now)
        known = people.count
        shut = model.doors.advance(now)
        self._let_in()
        lifts, escalators = self._scene.lifts, self._scene.escalators
        shut |= self._ride(people.present)
        if now == 0:
            types = [each.name for each in model.pedestrian_types]
            if said := without_weight(model.terms, types):
                warnings.warn(said, UserWarning, stacklevel=4)
            statistics.count_people(model.elapsed)
            self._record(people.present)
            if self.trace is not None:
                self.trace.add(now, people.present, crowd)
        elif people.count > known:
            self._record(np.arange(known, people.count, dtype=np.int64))
        if self._plan_has_changed or shut:
            self._replan()
        if self._next <= now:
            self._take_decisions()
        full_second = (now // FRAMES_A_SECOND + 1) * FRAMES_A_SECOND
        end = min(end, max(self._next, now + 1), full_second)
        if len(lifts):
            end = min(end, lifts.next_look(now))
        if len(escalators):
            end = min(end, escalators.next_look(now))
        if self.trace is not None:
            end = min(end, self.trace.next(now))
        expecting = len(model.sources) > 0 or model.sources.expecting
        every_frame = model.recorder is not None or expecting or len(model.doors) > 0
        if every_frame or self._plan_has_changed:
            end = now + 1
        model.frame = end
        people.departed.move(end, crowd)
        walking = people.present
        before = np.column_stack([crowd.x[walking], crowd.y[walking]]) if len(model.doors) else None
        moved = move(walking, end, end - now, self._scene.repertoire.table, crowd.records)
        if self._next > now:  # otherwise newcomers decide in this frame
            self._next = moved.next
        self._record(walking)
        people.part(moved)
        if self.trace is not None:
            self.trace.add(end, moved.stay, crowd)
            self.trace.leave(end, moved.gone, crowd)
        if before is not None:
            model.doors.look(walking, before, crowd)
        statistics.add(moved, end - now, model.elapsed)
        if end == full_second:
            statistics.count_people(model.elapsed)

    def candidates(self, rows: NDArray[np.int64]) -> Candidates:
        """Movement options of the people in ``rows`` if they decided now.

        Raises:
            ModelError: one of them is not inside.
        """
        with self._seen(rows) as grid:
            return make_candidates(rows, self._outlook(grid))

    def _outlook(self, grid: Grid) -> Outlook:
        """Neighbours, walls and options of the people, if they decided now."""
        scene = self._scene
        return Outlook(
            scene.repertoire.table,
            scene.crowd,
            grid,
            scene.environment.surroundings,
            scene.rules,
            self._moment.aside(),
        )

    @property
    def _moment(self) -> Moment:
        return Moment(self._model.frame, self._model.rng)

    def explain(self, row: int) -> Explanation:
        """The decision of the person in ``row`` if they decided now, before all others."""
        scene, model = self._scene, self._model
        self.bind()
        names = [each.name for each in scene.types]
        with self._seen(np.array([row])) as grid:
            outlook = self._outlook(grid)
            judged = judge(weigh(row, outlook, scene.repertoire, model.terms, names), outlook)
        return replace(judged, blocked_by=int(self.wishes(np.array([row])).blockers[0]))

    def wishes(
        self,
        rows: NDArray[np.int64],
        points: NDArray[np.float64] | None = None,
        speeds: NDArray[np.float64] | None = None,
    ) -> Wishes:
        """What the people in ``rows`` would do if nobody else were there; see ``World.wishes``."""
        scene, model, people = self._scene, self._model, self._model.population
        crowd = scene.crowd
        if points is None:
            points = np.column_stack([crowd.target_x[rows], crowd.target_y[rows]])
        everybody = people.departed.together_with(people.present)
        # Tactics ask while there are twins.
        with nullcontext() if len(crowd.person_of) else self._twins(everybody):
            return self._scheduler.wishes(
                rows,
                points,
                crowd.preferred[rows] if speeds is None else speeds,
                self._moment,
                everybody,
                crowd,
                scene.environment.surroundings,
                model.terms,
            )

    def _let_in(self) -> None:
        """Insert arrivals of the sources, and measured people, where there is room."""
        model, arrivals = self._model, self._model.sources.arrivals
        for index in arrivals.due(model.frame):
            new, kind = arrivals.newcomer(index), int(arrivals.records["type_index"][index])
            place = model.population.first_free(arrivals.places(index), kind, new, model.frame)
            if place is not None:
                [person] = self.insert([place], new)
                arrivals.let_in(index, person.row, place, model.frame)
        for inflow in model.sources:
            inflow.count(model.frame)
            while inflow.waiting:
                places = inflow.entrance.draw(PLACES_TRIED, model.rng)
                place = model.population.first_free(
                    places, inflow.next_type, inflow.newcomers, model.frame
                )
                if place is None:
                    break
                self.insert([place], inflow.newcomers)
                inflow.let_in()

    def _ride(self, inside: NDArray[np.int64]) -> bool:
        """Carry those in lifts and on escalators on; whether a door has shut."""
        scene, now, crowd = self._scene, self._model.frame, self._scene.crowd
        escalators, journeys, table = scene.escalators, scene.journeys, scene.repertoire.table
        shut = scene.lifts.advance(
            now, inside, crowd, lambda row, gate: journeys.beyond(row, gate, crowd)
        )
        if not len(escalators):
            return shut
        if len(journeys) and escalators.looks(now):
            # Those who are carried on lose their paths, on which crossed gates are found.
            belts = escalators.on_belts(inside, crowd)
            journeys.advance(belts, now, crowd, table, self._model.rng)
        escalators.advance(now, inside, crowd, table)
        return shut

    @property
    def _plan_has_changed(self) -> bool:
        """Whether obstacles or open doors have changed since the last decisions."""
        return self._plan_version != self._scene.plan.version

    def _replan(self) -> None:
        """Stop people whom a change of walls or doors blocks; they decide in this frame."""
        scene, rows, now = self._scene, self._model.population.present, self._model.frame
        # Those who stop lose their paths, on which crossed gates are found.
        scene.journeys.advance(rows, now, scene.crowd, scene.repertoire.table, self._model.rng)
        if self._plan_has_changed:
            self._model.refuges.look_over(rows, scene.crowd)
        self._plan_version = scene.plan.version
        stop_where_blocked(
            rows,
            now,
            scene.repertoire.table,
            scene.crowd.records,
            scene.environment.surroundings,
            scene.rules,
        )
        self._next = now

    def _take_decisions(self) -> None:
        """Take the decisions of those whose movement has ended; note when the next event is."""
        rows, now = self._model.population.present, self._model.frame
        deciding, soonest = due(rows, now, self._scene.crowd.records)
        self._next = LONG_AFTER  # brought forward if a behaviour adds people meanwhile
        if len(deciding):
            self._decide(deciding)
            # Twins may have had the records grow.
            soonest = min(soonest, due(deciding, now, self._scene.crowd.records)[1])
        self._next = min(self._next, soonest)

    def _decide(self, deciding: NDArray[np.int64]) -> None:
        model, scene, people = self._model, self._scene, self._model.population
        inside = people.present
        scene.journeys.advance(
            deciding, model.frame, scene.crowd, scene.repertoire.table, model.rng
        )
        change_sheets(scene.strips, deciding, scene.crowd)
        model.waits.evaluate(deciding, model.frame, scene.crowd)
        everybody = people.departed.together_with(inside)
        with self._twins(everybody):  # whom tactics see beyond seams
            # The crowd has the rest of the targets by then, so they can be freed here.
            order = decision_order(deciding, self._set_targets(deciding, inside))
        scene.grounds.change(deciding, scene.crowd)
        with self._twins(everybody) as (twins, rows):  # with the new targets
            self._scheduler.take(
                order,
                self._moment,
                rows,
                scene.crowd,
                scene.environment.surroundings,
                model.terms,
                model.watch,
                twins,
            )
        if model.decisions is not None:
            model.decisions.add(model.frame, deciding, scene.crowd)

    def _set_targets(
        self, rows: NDArray[np.int64], inside: NDArray[np.int64], *, newcomers: bool = False
    ) -> Targets:
        """Set targets and preferred speeds of those in ``rows``, who are among those ``inside``."""
        model = self._model
        self.bind()
        wants = Wants(model.target_choice, model.tactics, model.rng)
        return self._desired_motion.update(rows, inside, model.frame, wants, newcomers=newcomers)

    def _record(self, rows: NDArray[np.int64]) -> None:
        model = self._model
        if model.recorder is not None:
            model.recorder.add(model.frame, rows, self._scene.crowd)

    def _twins(
        self, rows: NDArray[np.int64]
    ) -> AbstractContextManager[tuple[Twins, NDArray[np.int64]]]:
        """The twins of people for a while, and their rows together with those of the people."""
        scene = self._scene
        return laid_twins(
            scene.strips, rows, self._model.population.count, scene.reach, scene.crowd
        )

    @contextmanager
    def _seen(self, rows: NDArray[np.int64]) -> Iterator[Grid]:
        """A grid of everybody, among them those in ``rows``, as seen on all sheets."""
        people, crowd = self._model.population, self._scene.crowd
        people.see_off(self._model.frame)
        everybody = people.departed.together_with(people.present)
        if not np.isin(rows, everybody).all():
            raise ModelError(f"candidates: got the rows {rows}, expected people inside")
        with self._twins(everybody):
            yield grid_of_frame(np.concatenate([everybody, crowd.copies]), crowd.records)
