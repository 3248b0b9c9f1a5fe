"""What can be read of a running model."""

from __future__ import annotations

from typing import Any

import mesa
import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesa_mobility.crowd.costs.candidates import Candidates
from mesa_mobility.crowd.dynamics import Dynamics
from mesa_mobility.crowd.options.capability import Capability
from mesa_mobility.crowd.options.table import FRAME_SECONDS
from mesa_mobility.crowd.people.pedestrian_type import PedestrianType
from mesa_mobility.crowd.planning.explanation import Explanation
from mesa_mobility.crowd.population import Population
from mesa_mobility.crowd.recorder import DecisionRecorder
from mesa_mobility.crowd.scene import Scene
from mesa_mobility.crowd.stall import stall_reason
from mesa_mobility.crowd.state.records import Crowd
from mesa_mobility.crowd.statistics import Statistics
from mesa_mobility.errors import ModelError
from mesa_mobility.floorplan import FloorPlan


class ObservedModel(mesa.Model):
    """A model whose state, figures and decisions can be read."""

    floor_plan: FloorPlan
    pedestrian_types: tuple[PedestrianType, ...]
    crowd: Crowd
    population: Population
    statistics: Statistics
    decisions: DecisionRecorder | None
    frame: int
    stalled: bool
    _scene: Scene
    _dynamics: Dynamics

    @property
    def elapsed(self) -> float:
        """Simulated seconds since the start."""
        return self.frame * FRAME_SECONDS

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
        return self._scene.repertoire.capabilities

    def decided(self, since: int = 0) -> dict[str, NDArray[np.generic]] | None:
        """The decisions from frame ``since`` on, see ``DecisionRecorder.arrays``; None if they are
        not recorded."""
        if self.decisions is None:
            return None
        return self.decisions.arrays(self._scene.repertoire, since)

    @property
    def stall_reason(self) -> str | None:
        """Why the evacuation has stalled, in a few words; None if it has not."""
        return stall_reason(self.floor_plan, self.population.aggregates) if self.stalled else None

    def candidates(self, rows: NDArray[np.int64]) -> Candidates:
        """Movement options of the people in ``rows`` if they decided now."""
        return self._dynamics.candidates(rows)

    def explain(self, row: int) -> Explanation:
        """The decision of the person in ``row`` if it decided now, before all others.

        It keeps the target of its last decision. Set ``watch`` to have decisions as they are taken.

        Raises:
            ModelError: nobody inside has this row.
        """
        if not (0 <= row < self.population.count and self.crowd.active[row]):
            raise ModelError(f"pedestrian {row}: expected the row of somebody inside")
        return self._dynamics.explain(row)

    def person_data(self) -> dict[str, ArrayLike]:
        """What trajectories say of each person besides its place; models may add to it.

        Returns:
            (n,) ``type`` and ``group``, names, of everybody who has ever been in the model, by row.
            The group is an empty text for people without one.
        """
        crowd, count = self.crowd, self.population.count
        types = np.array([kind.name for kind in self.pedestrian_types])
        groups = np.array(["", *map(str, self.population.groups)])
        return {
            "type": types[crowd.type_index[:count]],
            "group": groups[crowd.agenda["group"][:count]],
        }

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
