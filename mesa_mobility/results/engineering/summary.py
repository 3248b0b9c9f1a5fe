"""The figures of doors, rooms, storeys, stairs and lifts that the summary of a run has."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from mesa_mobility.results.engineering.doors import crossings_of_doors, door_figures
from mesa_mobility.results.engineering.rooms import Room, room_figures
from mesa_mobility.results.measures.climbs import by_stairs
from mesa_mobility.results.measures.lifts import by_lift
from mesa_mobility.results.measures.storeys import by_level
from mesa_mobility.results.tracks import Tracks

if TYPE_CHECKING:
    from mesa_mobility.buildings import Building
    from mesa_mobility.floorplan import FloorPlan


def figures_of_places(
    trajectories: Tracks, plan: FloorPlan | Building, rooms: Sequence[Room]
) -> dict[str, Any]:
    """``doors`` and ``rooms``, ready for JSON.

    Both are figures by name: ``people``, ``first_s``, ``last_s`` and ``flow_per_s``, as `doors` and
    `room_figures` define them.

    Args:
        trajectories: the run.
        plan: its floor plan, or its building.
        rooms: named areas.

    Raises:
        ResultsError: as these functions.
    """
    found = crossings_of_doors(trajectories, plan)
    return {
        "doors": {name: door_figures(own) for name, own in found.items()},
        "rooms": room_figures(trajectories, plan, rooms),
    }


def figures_of_storeys(trajectories: Tracks, building: Building | None) -> dict[str, Any]:
    """``by_level``, ``by_stairs`` and ``by_lift``: rows of these tables; none outside buildings.

    Args:
        trajectories: the run.
        building: its building, if it has one.

    Raises:
        ResultsError: the tracks have no elevations.
    """
    if building is None:
        return {}
    tables = {"by_level": by_level, "by_stairs": by_stairs, "by_lift": by_lift}
    return {
        name: measure(trajectories, building).reset_index().to_dict("records")
        for name, measure in tables.items()
    }
