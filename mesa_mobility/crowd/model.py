"""The Mesa model: a floor plan, a crowd on it, and time."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from copy import deepcopy
from pathlib import Path
from typing import Any, Self

import numpy as np
from mesa.datacollection import DataCollector
from numpy.typing import NDArray

from mesa_mobility.crowd.costs.candidates import Candidates
from mesa_mobility.crowd.costs.terms import CostTerm
from mesa_mobility.crowd.options.capability import Capability
from mesa_mobility.crowd.options.repertoire import repertoire
from mesa_mobility.crowd.options.table import FRAMES_A_SECOND
from mesa_mobility.crowd.pedestrian import Pedestrian, number_on
from mesa_mobility.crowd.pedestrian_type import PedestrianType, types_of
from mesa_mobility.crowd.planning.candidate_batch import make_candidates
from mesa_mobility.crowd.planning.explanation import Explanation, Watch
from mesa_mobility.crowd.planning.grid import Grid, build_grid
from mesa_mobility.crowd.planning.replanning import stop_where_blocked
from mesa_mobility.crowd.planning.scheduler import DecisionScheduler
from mesa_mobility.crowd.planning.workspace import Rules
from mesa_mobility.crowd.population import Population
from mesa_mobility.crowd.presets import preset_named
from mesa_mobility.crowd.recorder import Recorder
from mesa_mobility.crowd.seeds import seed_of
from mesa_mobility.crowd.sources import Inflow
from mesa_mobility.crowd.space import CrowdSpace
from mesa_mobility.crowd.stall import StallWatch
from mesa_mobility.crowd.state.advance import LONG_AFTER, move, select_due
from mesa_mobility.crowd.state.aggregates import EMPTY
from mesa_mobility.crowd.state.departed import Departed
from mesa_mobility.crowd.state.environment import Environment
from mesa_mobility.crowd.state.records import Crowd
from mesa_mobility.crowd.statistics import CrowdStatistics
from mesa_mobility.crowd.tactics.desired_motion import DesiredMotion, Steps
from mesa_mobility.crowd.tactics.journeys import Journeys
from mesa_mobility.crowd.tactics.speed_rules import SpeedRule
from mesa_mobility.crowd.tactics.target_choice import TargetChoice
from mesa_mobility.crowd.tactics.waiting import Waits
from mesa_mobility.errors import ModelError
from mesa_mobility.floorplan import FloorPlan, Targets
from mesa_mobility.floorplan.entrance import Entrance
from mesa_mobility.floorplan.occupants import add_occupants
from mesa_mobility.mobility import MobilityMap


class PedestrianModel(CrowdStatistics, Population):
    """Pedestrians on a floor plan, driven by recorded movement.

    Concrete models build a floor plan, call this constructor and then
    ``add_pedestrians``.

    Args:
        floor_plan: where people walk.
        preset: "default" or "paper".
        mobility_map: a map, its file, or None for the able-bodied one that ships; stands
            for a single pedestrian type with default speeds.
        pedestrian_types: the types of pedestrians, instead of ``mobility_map``.
        behaviors: cost terms instead of the preset's.
        target_choice: where people go; by default everybody leaves by the nearest exit.
        frames_per_step: frames that one ``step()`` advances; 3 are 0.1 s.
        record: keep every frame in ``recorder``.
        rng: seed, also as text, or NumPy generator.

    Attributes:
        space: Mesa's continuous space with everybody inside.
        crowd: the crowd's arrays; see ``Crowd``.
        journeys: the routes of people who cross gates in order.
        waits: conditions for which people wait.
        sources: an ``Inflow`` for each ``add_source``.
        groups: names of the groups, in the order of their numbers from 1 on.
        speed_rules: behaviours that change preferred speeds; the preset's rule for groups is added
            with the first group. May be changed at run time.
        terms: the cost terms; may be added to, removed and re-weighted at run time.
        frame: frames since the start.
        occupancy: (seconds, people inside) each simulated second.
        last_left: seconds at which somebody last left.
        stalled: whether for a minute nobody has left and people have come no nearer to an exit;
            ``stall_reason`` says why.
        watch: set to a ``Watch`` to keep the decisions of one pedestrian as they are taken.
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

    def __init__(
        self,
        floor_plan: FloorPlan,
        *,
        preset: str = "default",
        mobility_map: MobilityMap | str | Path | None = None,
        pedestrian_types: Sequence[PedestrianType] | None = None,
        behaviors: Iterable[CostTerm] | None = None,
        target_choice: TargetChoice | None = None,
        frames_per_step: int = 3,
        record: bool = False,
        rng: Any = None,
    ) -> None:
        super().__init__(rng=seed_of(rng))
        if not isinstance(frames_per_step, int) or frames_per_step < 1:
            raise ModelError(f"frames_per_step: got {frames_per_step!r}, expected 1, 2, 3 or more")
        rules = self._preset = preset_named(preset)
        self.preset = rules.name
        self.floor_plan = floor_plan
        self.pedestrian_types = types_of(mobility_map, pedestrian_types)
        self._repertoire = repertoire(
            tuple(each.mobility_map for each in self.pedestrian_types),
            rules.durations,
            rules.shares,
        )
        self.terms: list[CostTerm] = list(rules.make_terms() if behaviors is None else behaviors)
        self.speed_rules: list[SpeedRule] = []
        self.target_choice = target_choice or rules.make_target_choice()
        self.frames_per_step = frames_per_step
        self.frame = 0
        self.recorder = Recorder() if record else None
        self.crowd = Crowd(64)
        self.count = 0
        self.watch: Watch | None = None

        core = max(each.core_radius for each in self.pedestrian_types)
        reach = self._repertoire.reach
        self._rules = Rules(
            search_radius=reach + self._repertoire.extent + 2.0 * core + 0.01,
            hard_bodies=rules.hard_bodies,
            standing=self._repertoire.standing,
            first_option=self._repertoire.first_option,
        )
        self._decisions = DecisionScheduler(
            self._repertoire,
            self._rules,
            least_core=min(each.core_radius for each in self.pedestrian_types),
        )
        self._site = Environment(
            floor_plan,
            reach=reach + core + 0.02,
            core_radii=[each.core_radius for each in self.pedestrian_types],
        )
        self._desired_motion = DesiredMotion(
            self._site,
            Steps(
                spread_at_corners=rules.abreast,
                take_turns=rules.turns,
                compensate_speed=rules.even_pace,
                perturb_targets=rules.impatience,
            ),
        )
        self.journeys = Journeys(floor_plan, self._site)
        self.waits = Waits()
        self.groups: list[str | int] = []
        self.sources: list[Inflow] = []
        self._entrances: list[Entrance] = []
        self._plan_version = floor_plan.version
        x0, y0, x1, y1 = floor_plan.bounds
        self.space = CrowdSpace(
            # People who cross an exit end up a step outside.
            [[x0 - reach, x1 + reach], [y0 - reach, y1 + reach]],
            random=self.random,
            n_agents=64,
        )
        self._rows = np.empty(0, dtype=np.int64)
        add_occupants(floor_plan, self)
        self._next = 0
        self._seen = EMPTY
        self._beyond = Departed()
        self._agents_by_row: list[Pedestrian | None] = []
        self._stall_watch = StallWatch()
        self.stalled = False
        self.last_left: float | None = None
        self.occupancy: list[tuple[float, int]] = []
        self._walked = 0.0
        self._person_frames = self._fallback_frames = 0
        self.datacollector = DataCollector(
            model_reporters={
                "elapsed": "elapsed",
                "inside": "inside",
                "mean_speed": "mean_speed",
                "fallback_time_share": "fallback_time_share",
            }
        )

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        """An independent copy that continues exactly as this model would.

        Both share the mobility map and compiled code, which neither changes.
        """
        copied = type(self).__new__(type(self))
        memo[id(self)] = copied
        # Its agents go into registers that use their model's number.
        number_on(self, copied)
        for name, value in self.__dict__.items():
            copied.__dict__[name] = deepcopy(value, memo)
        return copied

    def __reduce_ex__(self, protocol: Any) -> Any:
        raise ModelError(
            f"{type(self).__name__}: a model can be copied by copy.deepcopy, neither by copy.copy "
            "nor by pickle; expected its parameters and seed, which make it anew"
        )

    @property
    def capabilities(self) -> tuple[Capability, ...]:
        """The capability of each pedestrian type."""
        return self._repertoire.capabilities

    @property
    def first_cluster(self) -> NDArray[np.int32]:
        """(types,) number in ``crowd.cluster`` of the first cluster of each type."""
        return self._repertoire.first_cluster

    # -- time -----------------------------------------------------------------------------------

    def step(self) -> None:
        """Advance ``frames_per_step`` frames."""
        rows, end = self._rows, self.frame + self.frames_per_step
        while self.frame < end:
            rows = self._advance(rows, end)
            if len(rows) == 0 and not self.expecting:
                break  # the last person has left: the step ends here
        if len(rows) < len(self._rows):
            self._take_out_inactive()
        self._look_over()
        self.stalled = self._stall_watch.stalled(
            self.frame, self._rows, self.crowd, self._seen, self.count - self.inside,
            self.journeys.crossed,
        )  # fmt: skip
        self.datacollector.collect(self)
        self.running = (self.inside > 0 or self.expecting) and not self.stalled

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
            ModelError: ``max_seconds`` is missing where people go round or come for ever.
        """
        if max_seconds is None and self._endless:
            raise ModelError("max_seconds: got none, but people go round or come for ever")
        told = 0
        self._stall_watch = StallWatch()
        self.stalled = False
        self.running = True
        while self.running and (max_seconds is None or self.elapsed < max_seconds - 1e-9):
            self.step()
            if progress is not None and int(self.elapsed) > told:
                told = int(self.elapsed)
                progress(self.elapsed, self.inside)

    def _advance(self, rows: NDArray[np.int64], end: int) -> NDArray[np.int64]:
        """Take this frame's decisions and advance to the next frame in which anything but walking
        happens, to frame ``end`` at most; return those of ``rows`` who are left."""
        self._beyond.set_off(self.frame, self.crowd, self._site.surroundings.exits)
        if self.sources:
            newcomers = self._let_in()
            rows = np.concatenate([rows, newcomers])
            if self.recorder is not None and self.frame > 0 and len(newcomers):
                self.recorder.add(self.frame, newcomers, self.crowd)
        if self.frame == 0:
            self.occupancy.append((0.0, len(rows)))
            if self.recorder is not None:
                self.recorder.add(0, rows, self.crowd)
        if self._plan_version != self.floor_plan.version:
            self._plan_version = self.floor_plan.version
            # Those who stop lose their paths, on which crossed gates are found.
            self.journeys.advance(rows, self.frame, self.crowd, self._repertoire.table)
            stop_where_blocked(
                rows, self.frame, self._repertoire.table, self.crowd.records,
                self._site.surroundings, self._rules,
            )  # fmt: skip
            self._next = self.frame
        now = self.frame
        if self._next <= now:
            self._have_decide(rows)
        full_second = (now // FRAMES_A_SECOND + 1) * FRAMES_A_SECOND
        end = min(end, max(self._next, now + 1), full_second)
        replanned = self._plan_version != self.floor_plan.version
        if self.recorder is not None or self.sources or replanned:
            end = now + 1
        self.frame = end
        self._beyond.move(end, self.crowd)
        moved = move(rows, end, end - now, self._repertoire.table, self.crowd.records)
        stay, gone = moved.stay, moved.gone
        if self._next > now:  # otherwise newcomers decide in this frame
            self._next = moved.next
        for _ in range(now, end):  # rounding must not depend on how many frames are skipped
            self._walked += moved.speeds
        self._person_frames += (end - now) * (len(stay) + len(gone))
        self._fallback_frames += (end - now) * moved.fallen
        if self.recorder is not None:
            self.recorder.add(end, rows, self.crowd)
        if len(gone):
            self.last_left = self.elapsed
            self._beyond.add(gone)
        if end == full_second:
            self.occupancy.append((self.elapsed, len(stay)))
        return stay

    def _have_decide(self, rows: NDArray[np.int64]) -> None:
        """Take the decisions of those in ``rows`` whose movement has ended; note the next event."""
        state = self.crowd.records
        deciding, self._next = np.empty_like(rows), LONG_AFTER
        count, soonest = select_due(rows, self.frame, state, deciding)
        if count:
            deciding = deciding[:count]
            self._decide(deciding, rows)
            theirs = select_due(deciding, self.frame, state, np.empty_like(deciding))[1]
            soonest = min(soonest, theirs)
        self._next = min(self._next, soonest)

    def _decide(self, deciding: NDArray[np.int64], rows: NDArray[np.int64]) -> None:
        self.journeys.advance(deciding, self.frame, self.crowd, self._repertoire.table)
        self.waits.ask(deciding, self.frame, self.crowd)
        # Those nearest to their destination decide first, which frees space for those behind. The
        # crowd has the rest of the targets by now, so they can be freed here.
        order = deciding[self._set_targets(deciding, rows).nearest_first]
        self._decisions.take(
            order,
            self.frame,
            self._beyond.together_with(rows),
            self.crowd,
            self._site.surroundings,
            self.terms,
            self.watch,
        )

    def _set_targets(
        self, rows: NDArray[np.int64], inside: NDArray[np.int64], *, all_go: bool = False
    ) -> Targets:
        return self._desired_motion.update(
            rows, inside, self.frame, self.crowd, self.target_choice, self.speed_rules, self.rng,
            all_go=all_go,
        )  # fmt: skip

    def candidates(self, rows: NDArray[np.int64]) -> Candidates:
        """Movement options of the people in ``rows`` if they decided now."""
        return make_candidates(rows, self._repertoire.table, self.crowd, self._grid(), self._rules)

    def explain(self, row: int) -> Explanation:
        """The decision of the person in ``row`` if it decided now, before all others.

        It keeps the target of its last decision. Set ``watch`` to have decisions as they are taken.

        Raises:
            ModelError: nobody inside has this row.
        """
        if not (0 <= row < self.count and self.crowd.active[row]):
            raise ModelError(f"pedestrian {row}: expected the row of somebody inside")
        weighed = self._decisions.weigh(row, self.frame, self._grid(), self.crowd, self.terms)
        return self._decisions.judge(weighed, self.crowd, self._site.surroundings)

    def _grid(self) -> Grid:
        self._beyond.set_off(self.frame, self.crowd, self._site.surroundings.exits)
        rows = self._beyond.together_with(self._rows)
        return build_grid(rows, self.crowd.x, self.crowd.y)
