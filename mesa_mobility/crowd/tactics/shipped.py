"""The tactics of the presets; models may leave out or replace each."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from mesa_mobility.crowd.options.shapes import ShapeRecords, shapes_of
from mesa_mobility.crowd.state.records import Crowd
from mesa_mobility.crowd.tactics.anticipation import turn_aside
from mesa_mobility.crowd.tactics.corner_spreading import spread_at_corners
from mesa_mobility.crowd.tactics.giving_way.precedence import WIDE, Precedence
from mesa_mobility.crowd.tactics.impatience import back_off, perturb_targets
from mesa_mobility.crowd.tactics.settling import settle
from mesa_mobility.crowd.tactics.speed_adaptation import adapt_speeds
from mesa_mobility.crowd.tactics.speed_compensation import compensate_speed
from mesa_mobility.crowd.tactics.speed_rules import apply_speed_rules
from mesa_mobility.crowd.tactics.stepping_off import step_off
from mesa_mobility.crowd.tactics.tactic import Desired, Tactic
from mesa_mobility.crowd.tactics.target_choice import Deciding
from mesa_mobility.crowd.tactics.turns import Turns
from mesa_mobility.crowd.tactics.visits.journeys import Journeys
from mesa_mobility.crowd.tactics.visits.slowing import slow_down
from mesa_mobility.floorplan.floor.boundaries import opening_segments
from mesa_mobility.floorplan.floor.zones import mean_factors
from mesa_mobility.schema import Kind

LONGEST_S = 1.5
"""The longest movement, seconds."""

if TYPE_CHECKING:
    from mesa_mobility.crowd.model import PedestrianModel
    from mesa_mobility.crowd.people.pedestrian_type import PedestrianType
    from mesa_mobility.floorplan import FloorPlan


class _OfTheCrowd(Tactic):
    """A tactic that keeps its notes in the crowd's records."""

    _crowd: Crowd

    def bind(self, model: PedestrianModel) -> None:
        """Keep the crowd."""
        self._crowd = model.crowd


class SpreadAtCorners(_OfTheCrowd):
    """In a crowd, those behind pass a corner farther out."""

    name = "corner_spreading"

    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """Change the points of those who pass a corner after others."""
        desired.points = spread_at_corners(deciding, desired.targets, self._crowd)


class StayAtPlaces(_OfTheCrowd):
    """People slow down before a place of their route at which they stay, and walk to where they
    stand there."""

    name = "visits"
    saved: ClassVar[Mapping[str, Kind]] = {}  # the journeys are the model's

    _journeys: Journeys

    def bind(self, model: PedestrianModel) -> None:
        """Keep who goes where, and who stays."""
        super().bind(model)
        self._journeys = model.journeys

    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """Send those who have arrived to their spot, and slow down those who come near theirs."""
        rows = deciding.pedestrians
        bound = np.flatnonzero(self._journeys.to_stay(rows, self._crowd))
        if desired.newcomers or not len(bound):
            return
        remaining = desired.targets.distances.copy()
        who, spots = self._journeys.stays.spots(rows)
        if len(who):
            desired.points = desired.points.copy()
            desired.points[who] = spots
            remaining[who] = np.hypot(*(spots - deciding.positions[who]).T)
        desired.speeds = desired.speeds.copy()
        desired.speeds[bound] = slow_down(desired.speeds[bound], remaining[bound])


class SlowInZones(Tactic):
    """People walk more slowly in the speed zones of the floor plan."""

    name = "speed_zones"

    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """Multiply speeds by the mean factor on the way ahead."""
        zones = deciding.site.plan.zones
        if zones:
            way = desired.points - deciding.positions
            way *= (desired.speeds * LONGEST_S / np.maximum(np.hypot(*way.T), 1e-9))[:, None]
            factors = mean_factors(zones, deciding.positions, deciding.positions + way)
            desired.speeds = desired.speeds * factors


class FollowSpeedRules(Tactic):
    """People walk as fast as the model's speed rules say."""

    name = "speed_rules"

    _model: PedestrianModel

    def bind(self, model: PedestrianModel) -> None:
        """Keep the model, whose rules may change."""
        self._model = model

    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """Apply the rules in order."""
        desired.speeds = apply_speed_rules(self._model.speed_rules, deciding, desired.speeds)


class TakeTurns(_OfTheCrowd):
    """People take turns where two cannot pass each other."""

    name = "taking_turns"

    _turns: Turns

    def bind(self, model: PedestrianModel) -> None:
        """Look for narrow passages."""
        super().bind(model)
        self._turns = Turns(model.floor_plan)

    def members(self) -> Mapping[str, Kind]:
        """What the members of ``state`` are."""
        return self._turns.members()

    def state(self) -> dict[str, Any]:
        """Who has the turn where."""
        return self._turns.state()

    def restore(self, state: Mapping[str, Any]) -> None:
        """Take over what ``state`` has given."""
        self._turns.restore(state)
        self._turns.check_mouths(self._crowd)

    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """Let people wait where others have the turn."""
        if not desired.newcomers:
            desired.points, desired.speeds = self._turns.take(
                deciding.pedestrians, deciding.inside.pedestrians, deciding.frame, self._crowd,
                desired.points, desired.speeds,
            )  # fmt: skip


class GiveWay(_OfTheCrowd):
    """Wide people go one after the other through openings too narrow for two of them."""

    name = "giving_way"

    _precedence: Precedence | None = None

    def bind(self, model: PedestrianModel) -> None:
        """Keep the crowd; without wide types there is nothing to do."""
        super().bind(model)
        widest = max(each.half_width for each in model.pedestrian_types)
        if widest > WIDE:
            stretch = np.array([_stretch(each) for each in model.pedestrian_types])
            self._precedence = Precedence(model.floor_plan, widest, stretch)

    def members(self) -> Mapping[str, Kind]:
        """What the members of ``state`` are."""
        return {} if self._precedence is None else self._precedence.members()

    def state(self) -> dict[str, Any]:
        """Who goes first where."""
        return {} if self._precedence is None else self._precedence.state()

    def restore(self, state: Mapping[str, Any]) -> None:
        """Take over what ``state`` has given."""
        if self._precedence is not None:
            self._precedence.restore(state)

    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """Let wide people wait clear of openings where another goes first."""
        if self._precedence is not None and not desired.newcomers:
            desired.points, desired.speeds = self._precedence.heed(
                deciding.pedestrians, deciding.inside.pedestrians, deciding.frame, self._crowd,
                desired.points, desired.speeds,
            )  # fmt: skip


class Wait(_OfTheCrowd):
    """People who wait, by ``Pedestrian.wait`` or before they set off, stand where they are."""

    name = "waiting"

    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """As for people without a route: they stop, and stay."""
        # Those who stand already may turn to something meanwhile (``Deciding.hold``).
        waits = deciding.waiting & (desired.speeds > 0.0)
        if not desired.newcomers and waits.any():
            desired.stand(waits, deciding.positions)


class CompensateSpeed(_OfTheCrowd):
    """Free walkers correct their accumulated distance error."""

    name = "speed_compensation"

    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """Change the speeds of free walkers by little."""
        desired.speeds = compensate_speed(deciding.pedestrians, self._crowd, desired.speeds)


class Anticipation(_OfTheCrowd):
    """People who walk turn aside early for those whom they would come too near."""

    name = "anticipation"

    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """Turn the points of those for whom another course is better, or slow them down."""
        if not desired.newcomers:
            desired.points, desired.speeds = turn_aside(
                deciding.pedestrians, deciding.inside.grid, deciding.frame, self._crowd,
                deciding.site.plan, desired.points, desired.speeds,
            )  # fmt: skip


class AdaptSpeed(_OfTheCrowd):
    """People walk as fast as those ahead of them let them."""

    name = "speed_adaptation"

    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """Slow down those who have people ahead."""
        if not desired.newcomers:
            desired.speeds = adapt_speeds(
                deciding.pedestrians, deciding.inside.grid, self._crowd, desired.points,
                desired.speeds,
            )  # fmt: skip


class Impatience(_OfTheCrowd):
    """People who make no progress look for a way round; long bodies back off as well."""

    name = "impatience"

    _has_long_body: NDArray[np.bool_]

    def bind(self, model: PedestrianModel) -> None:
        """Keep the crowd, and which types have bodies of several discs."""
        super().bind(model)
        self._has_long_body = np.array([len(each.shape) > 1 for each in model.pedestrian_types])

    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """Turn the points of some who make no progress."""
        rows, crowd = deciding.pedestrians, self._crowd
        settle(rows, desired.points, desired.speeds, crowd.records)
        changed = perturb_targets(rows, crowd, deciding.elapsed, deciding.rng)
        if self._has_long_body.any() and back_off(
            rows, crowd, self._has_long_body, deciding.elapsed
        ):
            changed, desired.speeds = True, crowd.preferred[rows]
        if changed:
            desired.points = np.column_stack([crowd.target_x[rows], crowd.target_y[rows]])


class StepOff(_OfTheCrowd):
    """People step off the line of a gate or exit that has closed on them, whatever else they want.

    A door is no place to stand in, and people whose only way out has closed would stay there.
    """

    name = "stepping_off"

    saved: ClassVar[Mapping[str, Kind]] = {}  # the plan and the types are the model's

    _plan: FloorPlan
    _shapes: ShapeRecords

    def bind(self, model: PedestrianModel) -> None:
        """Keep the floor plan, whose doors may close, and the bodies of all types."""
        super().bind(model)
        self._plan = model.floor_plan
        self._shapes = shapes_of([each.shape for each in model.pedestrian_types])

    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """Send those away from the line who are across it."""
        closed = self._plan.closed_openings()
        if desired.newcomers or not closed:
            return
        lines, points = opening_segments(closed), desired.points.copy()
        rows, crowd = deciding.pedestrians, self._crowd
        across = np.zeros(len(rows), dtype=np.bool_)
        step_off(rows, lines, self._shapes, crowd.records, points, across)
        if across.any():
            # Those without a route would rather stand.
            steps = points[across] - deciding.positions[across]
            crowd.route[rows[across]] = np.hypot(steps[:, 0], steps[:, 1])
            own = crowd.agenda["speed"][rows]
            desired.points, desired.speeds = points, np.where(across, own, desired.speeds)


def _stretch(kind: PedestrianType) -> float:
    """Radius of a circle that holds a body of a type, in core radii."""
    return max(abs(offset) + radius for offset, radius in kind.shape)
