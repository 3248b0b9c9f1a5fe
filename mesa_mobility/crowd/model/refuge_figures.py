"""Who cannot leave a building, and who waits in its refuges."""

from __future__ import annotations

from mesa_mobility.crowd.lifts.refuges import Refuges
from mesa_mobility.crowd.population import Population
from mesa_mobility.crowd.state.records import Crowd
from mesa_mobility.floorplan import FloorPlan


class RefugeFigures:
    """Figures of a model about people who cannot leave."""

    floor_plan: FloorPlan
    population: Population
    crowd: Crowd
    refuges: Refuges

    @property
    def without_stairs(self) -> list[int]:
        """Rows of the people inside who have no way to go since they cannot use stairs.

        They go to the nearest refuge to which they have a way, or stay where they stand.
        """
        if not self.floor_plan.in_sheets:
            return []
        rows, crowd = self.population.present, self.crowd
        lost = self.refuges.cut_off(rows, crowd) | (self.refuges.bound_for(rows, crowd) >= 0)
        found: list[int] = rows[lost].tolist()
        return found

    @property
    def in_refuges(self) -> dict[str, list[int]]:
        """By the name of each refuge, rows of the people who wait there since they cannot leave."""
        rows = self.population.present
        number = self.refuges.waiting(rows, self.crowd)
        return {
            each.name: rows[number == k].tolist() for k, each in enumerate(self.refuges.refuges)
        }

    @property
    def all_in_refuges(self) -> bool:
        """Whether people are inside, and all of them wait in refuges."""
        if not len(self.refuges) or not len(self.population.rows):
            return False
        return sum(map(len, self.in_refuges.values())) == len(self.population.rows)
