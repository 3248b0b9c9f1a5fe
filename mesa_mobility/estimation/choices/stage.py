"""A model whose people are where tracks put them, so that the engine sees what they saw."""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from mesa_mobility.crowd.costs.candidates import Candidates, Moment
from mesa_mobility.crowd.options.table import FRAME_SECONDS, SAMPLES, OptionTable
from mesa_mobility.crowd.pedestrian_model import PedestrianModel
from mesa_mobility.crowd.planning.evaluation.candidate_batch import Outlook, candidates_of
from mesa_mobility.crowd.state.people_grid import grid_of_frame
from mesa_mobility.crowd.state.records import FALLBACK, NO_CORNER
from mesa_mobility.crowd.tactics.desired_motion import DesiredMotion, Wants
from mesa_mobility.estimation.choices.availability import what_is_hit
from mesa_mobility.estimation.choices.poses import STANDS
from mesa_mobility.floorplan import FloorPlan

_DRAWN = "anticipation.wander"
"""The number by which what people want is drawn at random, which estimation leaves out."""


class Stage:
    """The engine, with people put where they were.

    Args:
        plan: the floor plan.
        arguments: those of ``PedestrianModel``, such as ``preset``.
        tactics: names of the preset's tactics that shape what people want.

    Attributes:
        model: a model without agents; its crowd's first rows are the people who are there.
    """

    def __init__(self, plan: FloorPlan, tactics: tuple[str, ...], **arguments: Any) -> None:
        self.model = PedestrianModel(plan, **arguments)
        self.model.tactics = [each for each in self.model.tactics if each.name in tactics]
        if _DRAWN in self.model.parameters():
            self.model.set_parameters({_DRAWN: 0.0})
        self.scene = self.model._scene
        self._desired = DesiredMotion(self.scene.environment, self.scene.crowd)
        self._plan = plan
        self._walls = np.empty((self.scene.environment.surroundings.most_walls + 1, 3 * SAMPLES))
        self.model.bind()

    @property
    def table(self) -> OptionTable:
        """The options of all types."""
        return self.scene.repertoire.table

    def destinations(self, exits: NDArray[np.int64]) -> NDArray[np.int64]:
        """(k,) the engine's numbers of exits with (k,) indices in the plan's ``exits``."""
        numbers = [self.scene.environment.destination((each.name,)) for each in self._plan.exits]
        return np.array(numbers, dtype=np.int64)[exits]

    def put(
        self,
        places: NDArray[np.float64],
        velocities: NDArray[np.float64],
        destinations: NDArray[np.int64],
        speeds: NDArray[np.float64],
        frames: int,
    ) -> None:
        """Replace everybody in the crowd by these people. Each walks straight on.

        Args:
            places: (m, 2) metres. Places off the floor are moved to the nearest point on it.
            velocities: (m, 2) of their last movement, m/s. People keep them.
            destinations: (m,) the engine's numbers of their exits, as the method
                ``Stage.destinations`` returns them.
            speeds: (m,) preferred speeds, m/s.
            frames: number of the engine's frames, 1/30 s each, for which each of them walks on.
        """
        crowd, m = self.scene.crowd, len(places)
        if m > len(crowd.x):
            crowd.grow(2 * m)
        crowd.active[:] = False
        rows = slice(0, m)
        x, y = _on_floor(places, self._plan).T
        crowd.x[rows], crowd.y[rows] = x, y
        crowd.from_x[rows], crowd.from_y[rows] = x, y
        on_x, on_y = np.array([x, y]) + velocities.T * frames * FRAME_SECONDS
        crowd.to_x[rows], crowd.to_y[rows] = on_x, on_y
        crowd.vx[rows], crowd.vy[rows] = velocities.T
        low, high = np.minimum([x, y], [on_x, on_y]), np.maximum([x, y], [on_x, on_y])
        crowd.box[rows] = np.vstack([low, high]).T
        crowd.core[rows] = self.scene.types[0].half_width
        crowd.option[rows], crowd.gone[rows] = FALLBACK, -1
        crowd.start[rows], crowd.end[rows] = 0, frames
        crowd.spacing[rows], crowd.knots[rows] = frames, 2
        crowd.destination[rows], crowd.active[rows] = destinations, True
        crowd.agenda["speed"][rows] = speeds
        crowd.agenda["corner"][rows] = NO_CORNER
        self.aim(np.arange(m, dtype=np.int64), speeds)
        toward = np.arctan2(crowd.target_y[rows] - y, crowd.target_x[rows] - x)
        walks = np.hypot(*velocities.T) > STANDS
        heading = np.where(walks, np.arctan2(velocities[:, 1], velocities[:, 0]), toward)
        crowd.heading[rows] = crowd.from_heading[rows] = crowd.to_heading[rows] = heading

    def aim(self, rows: NDArray[np.int64], speeds: NDArray[np.float64]) -> None:
        """Set what the people in ``rows`` (n,) want, who prefer ``speeds`` (n,) m/s when alone."""
        crowd, model = self.scene.crowd, self.model
        crowd.agenda["speed"][rows] = speeds
        inside = np.flatnonzero(crowd.active).astype(np.int64)
        wants = Wants(model.target_choice, model.tactics, model.rng)
        self._desired.update(rows, inside, 0, wants)

    def hits(self, row: int, options: NDArray[np.int64]) -> NDArray[np.int8]:
        """What the options of a person would hit if everybody else walked on as before.

        Only people ahead count: those behind keep their distance themselves.

        Args:
            row: of the person.
            options: (n,) rows of the table.

        Returns:
            (n,) ``FREE``, ``WALL`` or ``PERSON``.
        """
        hit = np.empty(len(options), dtype=np.int8)
        crowd, around = self.scene.crowd, self.scene.environment.surroundings
        hard, heading = self.scene.rules.hard_bodies, crowd.heading[row]
        inside = np.flatnonzero(crowd.active)
        dx, dy = crowd.x[inside] - crowd.x[row], crowd.y[inside] - crowd.y[row]
        near = np.hypot(dx, dy) < self.scene.rules.search_radius
        ahead = inside[near & (np.cos(heading) * dx + np.sin(heading) * dy > 0.0)]
        what_is_hit(row, options, ahead, hard, self.table, crowd.records, around, self._walls, hit)
        return hit

    def candidates(
        self, rows: NDArray[np.int64], options: NDArray[np.int64], offsets: NDArray[np.int64]
    ) -> Candidates:
        """Options, rows of the table, of the people in ``rows``, as cost terms get them.

        A person may occur more than once.
        """
        scene, crowd = self.scene, self.scene.crowd
        farthest = np.argmax(self.table.farthest)
        crowd.cluster[rows] = farthest  # for walls: those within reach of any option
        inside = np.flatnonzero(crowd.active).astype(np.int64)
        outlook = Outlook(
            self.table,
            crowd,
            grid_of_frame(inside, crowd.records),
            scene.environment.surroundings,
            scene.rules,
            Moment(0, self.model.rng).aside(),
        )
        return candidates_of(rows, options, offsets, outlook)


def _on_floor(places: NDArray[np.float64], plan: FloorPlan) -> NDArray[np.float64]:
    """(m, 2) the places, or the nearest on the floor for heads over walls, metres."""
    off = ~plan.contains(places)
    if not off.any():
        return places
    on = places.copy()
    lines = shapely.shortest_line(plan.free, shapely.points(places[off]))
    on[off] = shapely.get_coordinates(shapely.get_point(lines, 0))
    return on
