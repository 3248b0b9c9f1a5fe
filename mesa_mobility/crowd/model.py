"""The Mesa model: a floor plan, a crowd on it, and time."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Self

import mesa
import numpy as np
from mesa.datacollection import DataCollector
from numpy.typing import NDArray

from mesa_mobility.crowd.arguments import (
    SETTABLE,
    check_record,
    check_seconds,
    checked_attribute,
    read_scene,
)
from mesa_mobility.crowd.checkpoint.copying import copy_model, refuse_to_pickle
from mesa_mobility.crowd.checkpoint.snapshot import load_model, save_model
from mesa_mobility.crowd.costs.candidates import Candidates
from mesa_mobility.crowd.costs.terms import CostTerm
from mesa_mobility.crowd.dynamics import Dynamics
from mesa_mobility.crowd.hooks import Plugin, Saved, check_behaviours, scheduled_events
from mesa_mobility.crowd.insertion import adding
from mesa_mobility.crowd.insertion.inflow import Sources
from mesa_mobility.crowd.insertion.newcomers import Newcomers
from mesa_mobility.crowd.mesa_clock import set_clock, tell_time
from mesa_mobility.crowd.options.capability import Capability
from mesa_mobility.crowd.options.table import FRAME_SECONDS
from mesa_mobility.crowd.people.pedestrian import Pedestrian
from mesa_mobility.crowd.people.pedestrian_type import PedestrianType
from mesa_mobility.crowd.people.person_data import describe_people
from mesa_mobility.crowd.planning.explanation import Explanation, Watch
from mesa_mobility.crowd.population import Population as People
from mesa_mobility.crowd.presets import Preset
from mesa_mobility.crowd.recorder import DecisionRecorder, Recorder, movements_under_way
from mesa_mobility.crowd.reporters import REPORTERS, add_agent_reporter, add_reporter
from mesa_mobility.crowd.space import space_of
from mesa_mobility.crowd.stall import StallWatch, stall_reason
from mesa_mobility.crowd.statistics import Statistics
from mesa_mobility.crowd.tactics.speed_rules import SpeedRule
from mesa_mobility.crowd.tactics.tactic import Tactic
from mesa_mobility.crowd.tactics.target_choice import TargetChoice
from mesa_mobility.crowd.tactics.waiting import Waits
from mesa_mobility.errors import ModelError
from mesa_mobility.floorplan import FloorPlan
from mesa_mobility.floorplan.occupants import add_occupants
from mesa_mobility.mobility import MobilityMap
from mesa_mobility.plugins.seeds import seed_of
from mesa_mobility.plugins.settings import making
from mesa_mobility.populations import Population


class PedestrianModel(mesa.Model):
    """Pedestrians on a floor plan, driven by recorded movement.

    Concrete models build a floor plan, call this constructor and then
    ``add_pedestrians``.

    Args:
        floor_plan: where people walk.
        preset: "default", "paper", or rules of one's own.
        mobility_map: a map, its file, or None for the able-bodied one that ships; stands
            for a single pedestrian type with default speeds.
        pedestrian_types: the types of pedestrians, instead of ``mobility_map``.
        population: the shares of types that people are drawn from, instead of either: a
            ``Population``, shares by type, or a text such as "mixed" (see ``Population.of``).
        behaviors: cost terms instead of the preset's.
        target_choice: where people go; by default everybody leaves by the nearest exit.
        pedestrian_class: class of the agents, ``Pedestrian`` or one derived from it.
        fields: type (bool, int or float) of each number that every person has in addition, by
            name; agents, behaviours and results see them.
        frames_per_step: frames that one ``step()`` advances; 3 are 0.1 s.
        record: keep every frame in ``recorder``; "decisions" also keeps who has taken which option
            in ``decisions``, from which bodies are drawn.
        rng: seed, also as text, or NumPy generator.

    Attributes:
        preset: name of the preset.
        rules: the preset.
        space: Mesa's continuous space with everybody inside.
        crowd: the crowd's arrays; see ``Crowd``.
        population: who has come and who is inside; see ``Population``.
        statistics: the figures of the run so far; see ``Statistics``.
        dynamics: what happens in each frame; see ``Dynamics``.
        sources: an ``Inflow`` for each ``add_source``.
        journeys: the routes of people who cross gates and visit places in order.
        speed_rules: behaviours that change preferred speeds; the preset's rule for groups is added
            with the first group. May be changed at run time.
        tactics: the steps from a target to what somebody wants of its next movement, in order; may
            be removed, replaced and added to at run time.
        terms: the cost terms; may be added to, removed and re-weighted at run time.
        frame: frames since the start.
        time: ``elapsed``, and between two steps the time of Mesa's events, seconds.
        stalled: whether for a minute nobody has left and people have come no nearer to an exit;
            ``stall_reason`` says why, and ``go_on`` and ``run`` give it another minute.
        watch: set to a ``Watch`` to keep the decisions of one pedestrian as they are taken.
        events_at_first: events that Mesa itself has scheduled.
        framework_attributes: names of the attributes that this class has made.
        datacollector: time, people inside, mean speed and fallback share after each step.

    Raises:
        ModelError: an unknown preset or a parameter out of range.
        MapError: an unusable map file.

    Examples:
        >>> from mesa_mobility import Exit, FloorPlan, PedestrianModel
        >>> plan = FloorPlan(
        ...     "POLYGON ((0 0, 6 0, 6 4, 0 4, 0 0))", exits=[Exit("door", (6, 1.5), (6, 2.5))]
        ... )
        >>> model = PedestrianModel(plan, rng=1)
        >>> people = model.add_pedestrians([(1.0, 2.0), (2.0, 1.0)], preferred_speeds=1.2)
        >>> model.step()
        >>> model.inside, round(model.elapsed, 3)
        (2, 0.1)
        >>> model.run(max_seconds=30)
        >>> model.inside
        0
    """

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
        floor_plan: FloorPlan,
        *,
        preset: str | Preset = "default",
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
        self.events_at_first = scheduled_events(self)
        self.frames_per_step = frames_per_step
        check_record(record)
        self._scene = scene = read_scene(
            floor_plan,
            preset=preset,
            mobility_map=mobility_map,
            pedestrian_types=pedestrian_types,
            population=population,
            pedestrian_class=pedestrian_class,
            fields=fields,
        )
        self.preset, self.rules = scene.preset.name, scene.preset
        self.floor_plan, self.pedestrian_types = floor_plan, scene.types
        self._agents_step = pedestrian_class.step is not mesa.Agent.step
        self.crowd, self.journeys = scene.crowd, scene.journeys
        given: Any = self.rules.make_terms() if behaviors is None else behaviors
        self.terms: list[CostTerm] = given
        self.speed_rules: list[SpeedRule] = []
        self.tactics: list[Tactic] = self.rules.make_tactics()
        self.target_choice = target_choice or self.rules.make_target_choice()
        self.frame, self.time = 0, 0.0
        declared = {name: values.dtype for name, values in scene.crowd.fields.items()}
        self.recorder = Recorder(declared) if record else None
        self.decisions = DecisionRecorder() if record == "decisions" else None
        self.watch: Watch | None = None
        self.space = space_of(floor_plan, float(scene.repertoire.reach.max()), self.random)
        self.population = People(scene, self.space, pedestrian_class)
        self.sources = Sources(scene)
        self.statistics = Statistics(self)
        self.waits = Waits()
        self.dynamics = Dynamics(self, scene)
        self._stall_watch, self.stalled = StallWatch(), False
        add_occupants(floor_plan, self.population)
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
            "population": self.population,
            "sources": self.sources,
            "statistics": self.statistics,
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
    def discs(self) -> NDArray[np.float64] | None:
        """(n, 3, 2) offset along the facing and radius in metres of each disc of everybody's body,
        0 for discs that it does not have; None if all bodies are single discs."""
        return self.population.discs

    @property
    def capabilities(self) -> tuple[Capability, ...]:
        """The capability of each pedestrian type."""
        return self._scene.repertoire.capabilities

    def decided(self, since: int = 0) -> dict[str, NDArray[np.generic]] | None:
        """The decisions from frame ``since`` on, see ``DecisionRecorder.arrays``; None if they are
        not recorded."""
        if self.decisions is None:
            return None
        return self.decisions.arrays(self._scene.repertoire, since)

    def under_way(self) -> dict[str, NDArray[np.generic]]:
        """What everybody inside is doing now: an entry for each of ``rows``, otherwise as
        ``decided``."""
        return movements_under_way(self.crowd, self.rows, self._scene.repertoire)

    @property
    def stall_reason(self) -> str | None:
        """Why the evacuation has stalled, in a few words; None if it has not."""
        return stall_reason(self.floor_plan, self.population.aggregates) if self.stalled else None

    # Functions of a model are methods as they are.
    add_pedestrians = adding.add_pedestrians
    add_source = adding.add_source
    person_data = describe_people
    add_reporter = add_reporter
    add_agent_reporter = add_agent_reporter
    save = save_model
    __deepcopy__ = copy_model
    __reduce_ex__ = refuse_to_pickle

    def draw_types(self, n: int) -> NDArray[np.int64]:
        """(n,) indices of types, drawn from the model's population; 0 where it has none.

        For models that place people by type; ``add_pedestrians`` draws by itself.
        """
        return Newcomers(population=self._scene.shares).draw_types(
            n, self.pedestrian_types, self.rng
        )

    def remove_pedestrians(self, people: Iterable[Pedestrian]) -> None:
        """Take people out of the model."""
        self.population.remove(people)
        self.population.look_over(self.frame)

    def add_tactic(self, tactic: Tactic) -> None:
        """Add a tactic behind the one that it names in ``after``, or else at the end.

        Raises:
            ModelError: it is no tactic, such as the class of one.
        """
        check_behaviours("add_tactic", [tactic], Tactic)
        names = [each.name for each in self.tactics]
        at = names.index(tactic.after) + 1 if tactic.after in names else len(names)
        self.tactics.insert(at, tactic)

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
        while self.frame < end:
            self.dynamics.advance(end)
            tell_time(self)
            if before and len(people.present) == 0 and not self.sources.expecting:
                break  # the last person has left: the step ends here
        people.take_out_inactive()
        people.look_over(self.frame)
        self.stalled = self._stall_watch.stalled(
            self.frame, people.rows, self.crowd, people.aggregates, people.count - self.inside,
            self.journeys.crossed,
        )  # fmt: skip
        self.datacollector.collect(self)
        self.running = (self.inside > 0 or self.sources.expecting) and not self.stalled

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
        """Step until everybody has left, the evacuation stalls or time is up.

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

    def explain(self, row: int) -> Explanation:
        """The decision of the person in ``row`` if it decided now, before all others.

        It keeps the target of its last decision. Set ``watch`` to have decisions as they are taken.

        Raises:
            ModelError: nobody inside has this row.
        """
        if not (0 <= row < self.population.count and self.crowd.active[row]):
            raise ModelError(f"pedestrian {row}: expected the row of somebody inside")
        return self.dynamics.explain(row)

    def summary(self) -> dict[str, Any]:
        """Figures of the run so far, ready for JSON.

        Returns:
            ``model``, ``preset``, ``rules`` (all that the preset decides), ``pedestrians``,
            ``simulated_s``, ``egress_s`` (None while anybody is inside or to come, or where nobody
            ever was), ``left_inside``, ``stalled``,
            ``stall_reason`` (None unless stalled), ``decisions``, ``fallback_decision_share``,
            ``fallback_time_share``, ``mean_speed_mps`` (over all pedestrian-time) and ``occupancy``
            ([[t, inside], ...] each second).
        """
        return self.statistics.summary()

    @classmethod
    def load(
        cls, path: str | os.PathLike[str], *, plugins: Iterable[Plugin] = (), **arguments: Any
    ) -> Self:
        """The model of a checkpoint, in this process or another.

        Args:
            path: the file.
            plugins: behaviours that the model had, and that are neither installed nor made by its
                constructor.
            arguments: constructor's arguments that the file cannot hold, such as a mobility map.

        Raises:
            ModelError: a file that cannot be read or is another model's, other mobility maps, or
                missing arguments or behaviours.
        """
        return load_model(cls, path, plugins, arguments)
