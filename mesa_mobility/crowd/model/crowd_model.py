"""A Mesa model that runs a crowd on a floor plan."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from mesa_mobility._mesa import DataCollector, mesa
from mesa_mobility.buildings import Building
from mesa_mobility.crowd.arguments import (
    SETTABLE,
    building_of,
    check_record,
    check_seconds,
    checked_attribute,
    read_scene,
)
from mesa_mobility.crowd.costs.candidates import Candidates
from mesa_mobility.crowd.costs.terms import CostTerm
from mesa_mobility.crowd.doors.doors import Doors
from mesa_mobility.crowd.dynamics import Dynamics
from mesa_mobility.crowd.insertion.inflow import Sources
from mesa_mobility.crowd.journeys.waiting import Waits
from mesa_mobility.crowd.lifts.refuges import Refuges
from mesa_mobility.crowd.model.clock import scheduled_events, set_clock, tell_time
from mesa_mobility.crowd.model.refuge_figures import RefugeFigures
from mesa_mobility.crowd.options.capability import Capability
from mesa_mobility.crowd.options.table import FRAME_SECONDS
from mesa_mobility.crowd.people.pedestrian import Pedestrian
from mesa_mobility.crowd.people.space import space_of
from mesa_mobility.crowd.planning.explanation import Watch
from mesa_mobility.crowd.population import Population as People
from mesa_mobility.crowd.presets.given import now
from mesa_mobility.crowd.presets.preset import Preset
from mesa_mobility.crowd.presets.sources import Sources as NumberSources
from mesa_mobility.crowd.running.blocking import Blockers
from mesa_mobility.crowd.running.recorder import DecisionRecorder, Recorder
from mesa_mobility.crowd.running.stall import StallWatch, stall_reason
from mesa_mobility.crowd.running.standing import Blocked, StandingWatch
from mesa_mobility.crowd.running.statistics import Statistics
from mesa_mobility.crowd.saved import Saved
from mesa_mobility.crowd.state.wishes import Wishes
from mesa_mobility.crowd.tactics.speed_rules import SpeedRule
from mesa_mobility.crowd.tactics.tactic import Tactic
from mesa_mobility.crowd.tactics.target_choice import TargetChoice
from mesa_mobility.crowd.types.pedestrian_type import PedestrianType
from mesa_mobility.errors import ModelError
from mesa_mobility.floorplan import FloorPlan
from mesa_mobility.floorplan.occupants import add_occupants
from mesa_mobility.mobility import MobilityMap
from mesa_mobility.plugins.seeds import seed_of
from mesa_mobility.plugins.settings import making
from mesa_mobility.populations import Population

REPORTERS: dict[str, Any] = {
    "elapsed": "elapsed",
    "inside": "inside",
    "mean_speed": lambda model: model.statistics.mean_speed,
    "fallback_time_share": lambda model: model.statistics.fallback_time_share,
}
"""What is collected of every model."""


class CrowdModel(RefugeFigures, mesa.Model):
    """A Mesa model that runs a crowd; see ``PedestrianModel``, which can do more with it."""

    reference_occupancy: dict[float, int] | None = None
    """People inside at given seconds as published for this scenario, if any."""

    frame_rate = 1.0 / FRAME_SECONDS
    """Frames a second."""

    made_with: tuple[tuple[Any, ...], dict[str, Any]]
    """The arguments that the constructor was called with."""

    def __new__(cls, *args: Any, **keywords: Any) -> Self:
        """A model that knows what it was made with."""
        model = super().__new__(cls)
        model.made_with = args, keywords
        return model

    def __init_subclass__(cls, **keywords: Any) -> None:
        super().__init_subclass__(**keywords)
        if "__init__" in vars(cls):
            cls.__init__ = making(cls.__init__)  # type: ignore[method-assign]

    @making
    def __init__(
        self,
        floor_plan: FloorPlan | Building,
        *,
        preset: str | os.PathLike[str] | Preset = "default",
        mobility_map: MobilityMap | str | Path | None = None,
        pedestrian_types: Sequence[PedestrianType] | None = None,
        population: Population | Mapping[str | PedestrianType, float] | str | None = None,
        behaviors: Iterable[CostTerm] | None = None,
        target_choice: TargetChoice | None = None,
        pedestrian_class: type[Pedestrian] = Pedestrian,
        fields: Mapping[str, type] | None = None,
        frames_per_step: int = 3,
        record: bool | str = False,
        rng: Any = None,
    ) -> None:
        super().__init__(rng=seed_of(rng))
        self.building, plan = building_of(floor_plan, fields)
        self.events_at_first = scheduled_events(self)
        self.frames_per_step = frames_per_step
        check_record(record)
        given = now()
        base = given.base(preset)
        changes = given.changes(base)
        self._scene = scene = read_scene(
            plan,
            rules=base.with_parameters(changes),
            mobility_map=mobility_map,
            pedestrian_types=pedestrian_types,
            population=population,
            pedestrian_class=pedestrian_class,
            fields=fields,
        )
        self.preset, self.rules = scene.preset.name, scene.preset
        self.floor_plan, self.pedestrian_types = plan, scene.types
        self._agents_step = pedestrian_class.step is not mesa.Agent.step
        self.crowd, self.journeys, self.lifts = scene.crowd, scene.journeys, scene.lifts
        self.escalators = scene.escalators
        self.refuges = Refuges(
            self.building.refuges if self.building else (),
            scene.environment,
            [bool(each.climbs) for each in scene.types],
        )
        terms: Any = self.rules.make_terms() if behaviors is None else behaviors
        self.terms: list[CostTerm] = terms
        self.speed_rules: list[SpeedRule] = []
        self.tactics: list[Tactic] = self.rules.make_tactics()
        self.target_choice = target_choice or self.rules.make_target_choice()
        own = [] if behaviors is not None else self.terms
        own = [*own, *self.tactics, *([] if target_choice else [self.target_choice])]
        self.numbers = NumberSources(base, self.rules, changes, given.source, own)
        self.frame, self.time = 0, 0.0
        self.start_recording(record)
        self.watch: Watch | None = None
        self.space = space_of(plan, float(scene.repertoire.reach.max()), self.random)
        self.population = People(scene, self.space, pedestrian_class)
        self.sources = Sources(scene, self.rng)
        self.doors = Doors(plan, scene.environment)
        self.statistics = Statistics(self.population, self.crowd)
        self.waits = Waits()
        self.dynamics = Dynamics(self, scene)
        self._standing_watch = StandingWatch()
        self._stall_watch, self.stalled = StallWatch(), False
        add_occupants(plan, self.population)
        self.datacollector = DataCollector(model_reporters=REPORTERS)
        set_clock(self)
        self.framework_attributes = frozenset({*vars(self), "framework_attributes"})

    def __setattr__(self, name: str, value: Any) -> None:
        if name in SETTABLE or not (name[:1] == "_" or name in self.__dict__):
            value = checked_attribute(self, name, value)
        super().__setattr__(name, value)

    def __repr__(self) -> str:
        if "population" not in self.__dict__:
            return f"<{type(self).__name__}, not made yet>"
        count = self.population.count
        people = f"{count} {'person' if count == 1 else 'people'}, {self.inside} inside"
        return f"<{type(self).__name__}: {people}, {self.elapsed:.1f} s>"

    @property
    def elapsed(self) -> float:
        """Simulated seconds since the start."""
        return self.frame * FRAME_SECONDS

    def parts(self) -> dict[str, Saved]:
        """The parts that a checkpoint holds, in the order in which they are restored."""
        parts: dict[str, Saved] = {
            "environment": self._scene.environment,
            "journeys": self.journeys,
            "lifts": self.lifts,
            "rides": self.lifts.log,
            "escalators": self.escalators,
            "refuges": self.refuges,
            "population": self.population,
            "sources": self.sources,
            "doors": self.doors,
            "statistics": self.statistics,
            "standing": self._standing_watch,
            "stall_watch": self._stall_watch,
            "dynamics": self.dynamics,
        }
        if self.recorder is not None:
            parts["recorder"] = self.recorder
        if self.decisions is not None:
            parts["decisions"] = self.decisions
        return parts

    def bind(self) -> None:
        """Bind behaviours that the model has not used yet."""
        self.dynamics.bind()

    @property
    def inside(self) -> int:
        """People inside."""
        return len(self.population.rows)

    @property
    def rows(self) -> NDArray[np.int64]:
        """Rows of the people inside, in the order of ``space.active_agents``."""
        return self.population.rows

    @property
    def core_radii(self) -> NDArray[np.float64]:
        """(n,) core radius in metres of everybody who has ever been in the model."""
        return self.population.core_radii

    @property
    def capabilities(self) -> tuple[Capability, ...]:
        """The capability of each pedestrian type."""
        return self._scene.repertoire.capabilities[: len(self.pedestrian_types)]

    @property
    def mobility_maps(self) -> tuple[tuple[MobilityMap, ...], ...]:
        """The maps by which people of each type move: that of the type, and those for stairs."""
        known = self._scene.grounds.known
        return tuple(
            tuple(known.maps[number] for number in known.of_type(kind))
            for kind in range(len(self.pedestrian_types))
        )

    @property
    def stall_reason(self) -> str | None:
        """Why the evacuation has stalled, in a few words; None if it has not."""
        if not self.stalled:
            return None
        return stall_reason(
            self.floor_plan,
            self.population.aggregates,
            self._stall_watch.ring,
            self.without_stairs,
            self.lifts.shut_in(self.population.present, self.crowd, self.floor_plan.is_open),
        )

    @property
    def blocked(self) -> list[Blocked]:
        """The people inside who have stood for a minute although they want to move, without a
        reason, by row: a ``Blocked`` each."""
        return [each for each in self._standing_watch.now if self.crowd.active[each.person]]

    def remove_pedestrians(self, people: Iterable[Pedestrian]) -> None:
        """Take people out of the model."""
        people = [each for each in people if self.crowd.active[each.row]]
        if self.dynamics.trace is not None:
            rows = np.array([each.row for each in people], dtype=np.int64)
            self.dynamics.trace.leave(self.frame, rows, self.crowd)
        self.population.remove(people)
        self.population.look_over(self.frame)

    def start_recording(self, record: bool | str = True) -> None:
        """Record this run, where the constructor was not told to.

        Args:
            record: True, False or "decisions", as in the constructor.

        Raises:
            ModelError: something else, or the model has taken a step: tracks would lack their
                beginnings.
        """
        check_record(record)
        if self.frame:
            raise ModelError(
                f"start_recording: the model has run for {self.elapsed:.1f} s, expected a call "
                "before its first step"
            )
        declared = {name: values.dtype for name, values in self.crowd.fields.items()}
        self.recorder = Recorder(declared) if record else None
        self.decisions = DecisionRecorder() if record == "decisions" else None

    def step(self) -> None:
        """Advance ``frames_per_step`` frames.

        Before anybody moves, agents of other classes than ``Pedestrian`` take their ``step``, so
        that people heed what these do; then people take theirs.
        """
        tell_time(self)
        for kind, agents in list(self.agents_by_type.items()):
            if not issubclass(kind, Pedestrian):
                for agent in list(agents):
                    if agent in agents:  # others may have removed it
                        agent.step()
        if self._agents_step:
            for agent in list(self.space.active_agents):
                if self.crowd.active[agent.row]:  # others may have removed it
                    agent.step()
        people, end, before = self.population, self.frame + self.frames_per_step, self.inside
        self._standing_watch.look(self)
        while self.frame < end:
            self.dynamics.advance(end)
            tell_time(self)
            self._standing_watch.look(self)
            if before and len(people.present) == 0 and not self.sources.expecting:
                break  # the last person has left: the step ends here
        people.take_out_inactive()
        people.look_over(self.frame)
        had_stalled = self.stalled
        self.stalled = self._stall_watch.stalled(
            self.frame,
            people.rows,
            self.crowd,
            people.aggregates,
            people.count - self.inside,
            self.journeys.crossed,
            self._standing_watch.nobody_can_move,
        )
        if self.stalled and not had_stalled:
            rings = Blockers(self, self._standing_watch.minute).rings(self.rows.tolist())
            self._stall_watch.ring = rings[0] if rings else []
        self.datacollector.collect(self)
        going_on = self.inside > 0 and not self.all_in_refuges
        self.running = (going_on or self.sources.expecting) and not self.stalled

    def go_on(self) -> None:
        """Let an evacuation that has stalled run on: people have another minute to come nearer.

        ``run``, ``add_pedestrians`` and ``add_source`` do so, too. A loop of ``step`` calls it
        after a change of doors, obstacles or behaviours.
        """
        self._stall_watch, self.stalled = StallWatch(), False
        self.running = True

    def run(
        self,
        max_seconds: float | None = None,
        progress: Callable[[float, int], None] | None = None,
    ) -> None:
        """Step until all have left who can, the evacuation stalls or time is up.

        People who cannot use stairs may be left in refuges.

        Args:
            max_seconds: simulated seconds at most.
            progress: called as ``progress(elapsed, inside)`` each simulated second.

        Raises:
            ModelError: ``max_seconds`` is no time, or is missing where people go round or come for
                ever.
        """
        if max_seconds is not None:
            check_seconds("max_seconds", max_seconds)
        endless = self.journeys.endless(self.rows, self.crowd) or self.sources.endless
        if max_seconds is None and endless:
            raise ModelError("max_seconds: got none, but people go round or come for ever")
        reported = 0
        self.go_on()
        while self.running and (max_seconds is None or self.elapsed < max_seconds - 1e-9):
            self.step()
            if progress is not None and int(self.elapsed) > reported:
                reported = int(self.elapsed)
                progress(self.elapsed, self.inside)

    def candidates(self, rows: NDArray[np.int64]) -> Candidates:
        """Movement options of the people in ``rows`` if they decided now."""
        return self.dynamics.candidates(rows)

    def wishes(
        self,
        rows: NDArray[np.int64],
        points: NDArray[np.float64] | None = None,
        speeds: NDArray[np.float64] | None = None,
    ) -> Wishes:
        """What people would do if nobody else were there; see ``World.wishes``."""
        return self.dynamics.wishes(rows, points, speeds)

    def check_inside(self, row: int) -> None:
        """Raise ModelError if nobody inside has this row."""
        if not (0 <= row < self.population.count and self.crowd.active[row]):
            raise ModelError(f"pedestrian {row}: expected the row of somebody inside")
