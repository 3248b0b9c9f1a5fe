"""Following a guide."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from graphlib import CycleError, TopologicalSorter
from typing import Annotated, Any, ClassVar

import numpy as np
import shapely
from numpy.typing import NDArray

from mesa_mobility import Deciding, Desired, Pedestrian, Range, Tactic, World
from mesa_mobility.errors import ContentError, FloorPlanError, ModelError
from mesa_mobility.floorplan import lines_of_sight
from mesa_mobility.schema import Array, Kind, Several, Whole

# Metres between two places of a leader's trail, and the number of them that is kept.
_STEP, _PLACES = 0.25, 400

# Persons/m2 of a bunch behind a leader.
_DENSITY = 1.0

# Seconds within which somebody closes up to their leader, and the speed below which they stand,
# m/s.
_CLOSES_UP, _STANDS = 2.0, 0.15

# Metres from a place of the trail at which somebody goes on to the next ones.
_AT_IT = 0.75

# Metres from an exit within which people are followed after they have left: 1.5 s at a run.
_BEYOND = 4.0

# Metres from walls at which a way straight to the leader must lead, or as wide as bodies are.
_CLEARANCE = 0.2


class Following(Tactic):
    """People walk behind a leader, at the leader's speed, and leave by the leader's exit.

    Followers who see their leader close up to ``distance``, and then walk as fast as the leader.
    The others walk along the leader's trail. Nobody walks faster than they prefer, so a leader who
    hurries loses their followers. Behind one leader people are a bunch: the k-th keeps as far away
    as a half circle with k people, one to each m2, reaches. A leader may follow another.

    People who walk behind somebody match that person's speed, rather than keep a certain distance
    (Rio, Rhea and Warren 2014, Journal of Vision 14(2): 4).

    Args:
        distance: metres, between their middles, to which people close up.

    Raises:
        ModelError: a distance out of range.
    """

    name = "following"
    after = "speed_rules"
    saved: ClassVar[Mapping[str, Kind]] = {
        "_leaders": Several(Whole(below="people"), dict, values=Whole(below="people")),
        "_trails": Several(
            Whole(below="people"), dict, values=Array("f8", (None, 2), -1e9, 1e9, filled=True)
        ),
    }

    _model: World

    def __init__(self, distance: Annotated[float, Range(0.0, unit="m", above=True)] = 1.5) -> None:
        self.distance = distance
        self._leaders: dict[int, int] = {}
        self._trails: dict[int, NDArray[np.float64]] = {}

    def bind(self, model: World) -> None:
        """Keep the model, whose people follow and lead."""
        self._model = model

    def restore(self, state: Mapping[str, Any]) -> None:
        """Take over what ``state`` has given."""
        super().restore(state)
        try:
            TopologicalSorter({row: [ahead] for row, ahead in self._leaders.items()}).prepare()
        except CycleError as error:
            raise ContentError(
                f"_leaders: pedestrian {error.args[1][0]} would follow themselves"
            ) from error

    def follow(self, people: Iterable[Pedestrian], leader: Pedestrian | None) -> None:
        """Let people follow a leader from their next decision on, or nobody any more.

        Raises:
            ModelError: somebody would follow themselves, directly or by way of others.
        """
        rows = [person.row for person in people]
        if leader is None:
            for row in rows:
                self._leaders.pop(row, None)
            return
        ahead: int | None = leader.row
        while ahead is not None:
            if ahead in rows:
                raise ModelError(
                    f"{self.name}: pedestrian {ahead} would follow themselves, "
                    "expected another leader"
                )
            ahead = self._leaders.get(ahead)
        self._leaders.update(dict.fromkeys(rows, leader.row))

    def apply(self, deciding: Deciding, desired: Desired) -> None:
        """Send those who follow after their leaders, at their speeds."""
        if not self._leaders or desired.newcomers:
            return
        self._note_trails(deciding)
        rows = deciding.pedestrians
        leads = np.array([self._leaders.get(row, -1) for row in rows.tolist()])
        who = np.flatnonzero(leads >= 0)
        if not len(who):
            return
        crowd, leads, here = self._model.crowd, leads[who], deciding.positions[who]
        there = deciding.inside.seen_by(rows[who], leads)
        clearance = max(_CLEARANCE, float(crowd.core[rows[who]].max()))
        seen = lines_of_sight(deciding.site.plan, here, there, clearance)
        to_go = np.hypot(*(there - here).T)
        points = np.array(there)
        for k in np.flatnonzero(~seen).tolist():
            found = self._on_the_trail(deciding, here[k], int(leads[k]), clearance)
            points[k], to_go[k] = (desired.points[who[k]], np.inf) if found is None else found

        ahead = points - here
        away = np.maximum(np.hypot(*ahead.T), 1e-9)
        velocity = np.column_stack([crowd.vx[leads], crowd.vy[leads]])
        speed = np.where(seen, (velocity * ahead).sum(axis=1) / away, np.hypot(*velocity.T))
        speed += (to_go - self._distances(rows[who], leads)) / _CLOSES_UP
        speed = np.clip(speed, 0.0, desired.speeds[who])
        stands = speed < _STANDS
        desired.points, desired.speeds = desired.points.copy(), desired.speeds.copy()
        desired.points[who], desired.speeds[who] = points, speed
        deciding.hold(desired, who[stands])

    def _note_trails(self, deciding: Deciding) -> None:
        """Note where leaders are, and part from those who have left."""
        crowd = self._model.crowd
        for leader in sorted(set(self._leaders.values())):
            here = np.array([[crowd.x[leader], crowd.y[leader]]])
            if not crowd.active[leader]:
                self._part(leader, self._exit_near(deciding, here[0]))
                continue
            trail = self._trails.get(leader, here)
            if np.hypot(*(here - trail[-1:])[0]) >= _STEP:
                trail = np.concatenate([trail, here])[-_PLACES:]
            self._trails[leader] = trail

    def _exit_near(self, deciding: Deciding, place: NDArray[np.float64]) -> str | None:
        """Name of the exit by which a person now at this place, metres, must have left."""
        away = {each.line.distance(shapely.Point(place)): each for each in deciding.site.plan.exits}
        return away[min(away)].name if away and min(away) <= _BEYOND else None

    def _part(self, leader: int, name: str | None) -> None:
        """Let people follow a leader no more, and leave by the exit of this name if they can."""
        people, frame = self._model.population, self._model.frame
        for row in [row for row, ahead in self._leaders.items() if ahead == leader]:
            del self._leaders[row]
            if name is not None and self._model.crowd.active[row]:
                try:
                    people.send(row, [name], (), frame)
                except FloorPlanError:  # too narrow for them: they leave as they would have
                    continue
        self._trails.pop(leader, None)

    def _on_the_trail(
        self, deciding: Deciding, here: NDArray[np.float64], leader: int, clearance: float
    ) -> tuple[NDArray[np.float64], float] | None:
        """The last place of a leader's trail that is in view, and the metres to the trail's end."""
        trail = self._trails[leader]
        starts = np.tile(here, (len(trail), 1))
        # Beside a corner nothing is in view with room to spare.
        for room in (clearance, 0.0):
            seen = np.flatnonzero(lines_of_sight(deciding.site.plan, starts, trail, room))
            if len(seen):
                break
        else:
            return None
        to_go = np.append(np.cumsum(np.hypot(*np.diff(trail, axis=0).T)[::-1])[::-1], 0.0)
        last = int(seen[-1])
        away = float(np.hypot(*(trail[last] - here)))
        if away < _AT_IT:
            last = min(last + round(_AT_IT / _STEP), len(trail) - 1)
        return trail[last], away + float(to_go[seen[-1]])

    def _distances(self, rows: NDArray[np.int64], leads: NDArray[np.int64]) -> NDArray[np.float64]:
        """(n,) metres that each person in ``rows`` keeps from their leader."""
        crowd = self._model.crowd
        followers = np.array([row for row in self._leaders if crowd.active[row]])
        whose = np.array([self._leaders[row] for row in followers.tolist()])
        away = np.hypot(crowd.x[followers] - crowd.x[whose], crowd.y[followers] - crowd.y[whose])
        own = np.hypot(crowd.x[rows] - crowd.x[leads], crowd.y[rows] - crowd.y[leads])
        nearer = ((whose == leads[:, None]) & (away < own[:, None])).sum(axis=1)
        kept: NDArray[np.float64] = np.maximum(
            self.distance, np.sqrt(2.0 * nearer / (math.pi * _DENSITY))
        )
        return kept
